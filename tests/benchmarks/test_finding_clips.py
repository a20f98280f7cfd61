"""Finding in clips: what is counted, glare that only brightens, and excerpts that keep their truth."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from lightgesture.benchmarks.finding import clips as finding_clips
from lightgesture.benchmarks.finding.clips import (
    TILE_STEP,
    clip_tables,
    evaluate_clips,
    find_in_clips,
    missed_sheets,
)
from lightgesture.benchmarks.finding.difficulties import (
    DIFFICULTIES,
    GLARE,
    GLOVES,
    SENTENCES,
    SHOWN,
    STRENGTH,
    Excerpt,
    ExcerptTake,
    Glare,
    difficulty_takes,
    profile_take,
)
from lightgesture.benchmarks.methods import Decoded
from lightgesture.benchmarks.scorer import Reading
from lightgesture.benchmarks.suite.cache import fetch_clip
from lightgesture.benchmarks.suite.scenarios import ALONE, Scenario, scene_spec
from lightgesture.synth.scene import Scene


def show_nothing(takes, _heading):
    return takes


class Follower:
    """Finds both hands of `SignedTake`; from some frame on under other numbers, the left hand not at all."""

    name = "follower"

    def __init__(self, lost_at=None):
        self.lost_at = lost_at

    def stream(self, hold):
        assert hold is None
        return Stream(self.lost_at)


class Stream:
    def __init__(self, lost_at):
        self.lost_at, self.index = lost_at, -1

    def process(self, image, time_s):
        assert image.shape == (48, 64, 3)
        self.index += 1
        assert time_s == pytest.approx(self.index / 30, abs=1e-3)
        right = Reading((8, 10, 12, 12), "right", None, 1)
        left = Reading((40, 10, 12, 10), "left", None, 2)
        if self.lost_at is None or self.index < self.lost_at:
            return [right, left]
        return [replace(right, track=3)]

    def finish(self):
        return Decoded((), (), 0)


def test_hands_and_tracks_of_a_clip_are_counted(tmp_path, signed_take):
    answers = find_in_clips(
        lambda clip: [Follower(), Follower(30)], [signed_take], tmp_path / "cache", show_nothing
    )
    whole, lost = answers
    # Sixteen frames of each of three signs show both hands; from frame 30 on one is missed in 6 + 16 of them.
    assert (whole.score.hands, whole.score.found, whole.switches, whole.restarts) == (96, 96, 0, 0)
    assert (lost.score.hands, lost.score.found, lost.switches, lost.restarts) == (96, 96 - 22, 1, 1)
    assert whole.tiles == ()
    assert len(lost.tiles) == len(range(30, 36, TILE_STEP)) + len(range(45, 56, TILE_STEP))
    assert sorted(whole.overlaps[:2]) == [pytest.approx(10 / 12), 1.0]
    assert missed_sheets(answers) == {"missed_water_follower": [*lost.tiles]}


def test_tables_of_clips(tmp_path, signed_take):
    (whole,) = find_in_clips(lambda clip: [Follower()], [signed_take], tmp_path, show_nothing)
    lost = replace(whole, method="other", switches=3, restarts=1, score=replace(whole.score, found=48))
    worse = replace(lost, switches=5, restarts=0, scenario=replace(lost.scenario, suite="land"))
    tables = {table.name: table.to_dicts() for table in clip_tables([whole, lost, worse], [])}
    assert set(tables) == {"found_suite", "found_suite_by_difficulty"}
    rows = [
        (row["suite"], row["method"], row["found_share"], row["switches"]) for row in tables["found_suite"]
    ]
    assert rows == [("water", "follower", 1.0, 0), ("water", "other", 0.5, 3), ("land", "other", 0.5, 5)]
    both = tables["found_suite_by_difficulty"][-1]
    assert (both["clips"], both["a_clip"], both["worst"], both["restarts"]) == (2, 4.0, 5, 1)
    assert both["median_iou"] == pytest.approx((1 + 10 / 12) / 2, abs=1e-5)


def test_each_difficulty_stands_alone_twice():
    takes = difficulty_takes()
    assert [take.scenario.difficulty for take in takes] == [name for name in DIFFICULTIES for _ in SENTENCES]
    assert len({take.scenario.seed for take in takes}) == len(takes)
    assert {take.scenario.suite for take in takes} == {ALONE}
    assert len({take.recipe for take in takes}) == len(takes)


def test_a_profile_is_learnt_from_other_frames_of_the_same_scene():
    (take, *_) = [take for take in difficulty_takes() if take.scenario.difficulty == GLOVES]
    learnt = profile_take(take.scenario)
    shown = {SHOWN.first + index * SHOWN.step for index in range(SHOWN.count)}
    other = {learnt.excerpt.first + index * learnt.excerpt.step for index in range(learnt.excerpt.count)}
    assert not shown & other
    assert scene_spec(learnt.scenario) == scene_spec(take.scenario)


def test_glare_only_adds_light_and_moves():
    glare = Glare((80, 60), np.random.default_rng(1))
    picture = np.full((60, 80, 3), 0.2, np.float32)
    lit = [glare.lay_over(picture, time_s) for time_s in (0.0, 0.4)]
    assert all((one >= picture).all() for one in lit)
    assert lit[0].max() <= 0.2 + STRENGTH
    assert lit[0].max() > 0.5
    assert not np.array_equal(*lit)
    upper, lower = lit[0][:20].mean(), lit[0][40:].mean()
    assert upper > lower


def test_an_excerpt_is_the_scene_from_a_frame_on():
    scenario = Scenario(ALONE, ("STOP UP GO",), "clear", "water", 7_300_000)
    spec = scene_spec(scenario)
    take = ExcerptTake(scenario, spec.fps, spec.size, "", Excerpt(20, 2, 5))
    frames, scene = list(take.frames()), Scene(spec)
    assert [frame.record.frame for frame in frames] == [0, 1]
    assert [frame.record.time_s for frame in frames] == pytest.approx([0.0, 1 / spec.fps])
    for frame, number in zip(frames, (20, 25), strict=True):
        whole = scene.frame(number)
        assert np.array_equal(frame.image, whole.image)
        assert frame.record.hands == whole.record.hands
    veiled = replace(take, scenario=replace(scenario, difficulty=GLARE))
    (first,) = islice(veiled.frames(), 1)
    clear = Scene(scene_spec(veiled.scenario)).frame(20)
    assert first.image.astype(int).mean() > clear.image.astype(int).mean() + 5


def test_gloves_are_also_found_with_their_profile(monkeypatch, tmp_path, signed_take):
    asked = []

    def method_of(selector, profile=None):
        asked.append((selector, profile is not None))
        named = Follower()
        named.name = selector if profile is None else f"{selector}, profile"
        return named

    gloved = replace(
        signed_take, recipe="gloves", scenario=replace(signed_take.scenario, suite=ALONE, difficulty=GLOVES)
    )
    monkeypatch.setattr(finding_clips, "selector_method", method_of)
    monkeypatch.setattr(finding_clips, "synthetic_takes", lambda _: [])
    monkeypatch.setattr(finding_clips, "difficulty_takes", lambda: [signed_take, gloved])
    monkeypatch.setattr(finding_clips, "profile_take", lambda _: gloved)
    report = evaluate_clips(["learned"], tmp_path / "cache", show_nothing)
    assert asked == [("learned", False), ("learned", True)]
    (table,) = report.tables
    assert [(row["difficulty"], row["method"]) for row in table.to_dicts()] == [
        ("clear", "learned"),
        ("gloves", "learned"),
        ("gloves", "learned, profile"),
    ]


def test_a_profile_is_learnt_from_the_hands_of_a_clip(tmp_path, signed_take):
    profile = finding_clips.glove_profile(fetch_clip(signed_take, tmp_path))
    assert profile.kind == "glove"
