"""Finding without reading: the product's own boxes, trained files on what they did not see, and their tables."""

import json
from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks.finding import pipelines as finding
from lightgesture.benchmarks.finding.pipelines import (
    NoReader,
    Stages,
    run_left_out,
    selector_method,
    shared_parts,
    variant,
)
from lightgesture.benchmarks.finding.regions import Run, make_answer, run_methods, run_single
from lightgesture.benchmarks.finding.tables import finding_tables, found_table
from lightgesture.benchmarks.scorer import Reading
from lightgesture.features.find.selector_file import (
    BUNDLED,
    SelectorError,
    load_classical,
    load_learned,
)
from lightgesture.features.find.settings import LEARNED
from lightgesture.features.track.tracker import Tracker
from lightgesture.features.types import Candidates, HandRegion
from lightgesture.hands import ReadingStage
from lightgesture.training.datasets import Label, Sample, read_frames, read_negatives
from lightgesture.training.model_files import write_selector


def show_nothing(samples, _heading):
    return samples


@pytest.fixture(name="scene")
def _scene():
    """Two skin-coloured palms with fingers, before water."""
    image = np.full((480, 640, 3), (150, 110, 40), np.uint8)
    for x in (170, 430):
        cv2.ellipse(image, (x, 260), (34, 40), 0, 0, 360, (120, 150, 210), -1)
        for angle in (-40, -15, 10, 35):
            end = round(x + 95 * np.sin(np.radians(angle))), round(250 - 95 * np.cos(np.radians(angle)))
            cv2.line(image, (x, 250), end, (120, 150, 210), 16)
    return image


def test_the_first_extent_is_kept_and_nothing_is_read():
    stage = ReadingStage(NoReader())
    boxes = ((5, 6, 30, 40), (0, 0, 60, 80))
    (hand,) = stage.process(
        np.zeros((90, 90, 3), np.uint8),
        [HandRegion(boxes[0], np.zeros((0, 2), np.int32), "left", 0.9, boxes[1:])],
    )
    assert (hand.box, hand.token, hand.side, hand.track) == (boxes[0], None, "left", None)


def test_other_stages_take_the_place_of_the_products(scene):
    made = []

    class Refusing:
        settings = LEARNED

        def __init__(self):
            made.append(self)

        def process(self, *arguments, **options):
            return Candidates((), np.zeros((0, 0), np.float32), (640, 480))

        def follow(self, *arguments):
            return None

    assert len(selector_method("classical").read(scene)) == 2
    method = variant("refuses everything", Stages(regions=Refusing))
    assert method.name == "refuses everything"
    assert method.read(scene) == []
    stream = method.stream(None)
    assert [stream.process(scene, index / 30) for index in range(3)] == [[]] * 3
    assert stream.finish().words == ()
    assert len(made) == 2


def test_every_stream_has_tracks_of_its_own():
    made = []

    def tracks():
        made.append(Tracker())
        return made[-1]

    method = variant("tracks", Stages(tracks=tracks))
    method.stream(None)
    method.stream(None)
    assert len({id(stage) for stage in made}) == 3


def test_a_selector_file_is_called_after_its_name(tmp_path):
    copy = tmp_path / "fold 2.npz"
    copy.write_bytes(BUNDLED.read_bytes())
    assert selector_method("classical").name == "classical"
    assert selector_method("classical", str(copy)).name == "classical, fold 2"
    assert selector_method(str(copy)).name == "learned, fold 2"
    with pytest.raises(SelectorError, match="missing"):
        selector_method(str(tmp_path / "missing.npz"))


@pytest.fixture(name="folds")
def _folds(tmp_path, monkeypatch, fake_method):
    """Two files that left out "lab" and "reef"; which of them scored what is recorded."""
    used = []

    class Opened(type(fake_method)):
        def __init__(self, file):
            super().__init__()
            self.file = file

        def read(self, image):
            used.append(self.file)
            return super().read(image)

    monkeypatch.setattr(finding, "selector_method", lambda _, file: Opened(file[-5]))
    monkeypatch.setattr(finding, "shared_parts", lambda _, file: ())
    files = []
    for number, sources in enumerate((["lab"], ["lab", "reef"])):
        card = {"left_out": {"sources": sources, "fold": None}}
        (tmp_path / f"{number}.json").write_text(json.dumps(card), encoding="utf-8")
        files.append(str(tmp_path / f"{number}.npz"))
    return files, used


def test_files_are_scored_on_what_they_did_not_see(data, folds):
    files, used = folds
    told = []
    runs = run_left_out("any", files, read_frames(data), show_nothing, told.append)
    assert [(run.method, run.group, run.mode, len(run.answers), run.seen) for run in runs] == [
        ("any, left out", "hover", "single", 2, "no"),
        ("any, left out", "hover", "sequence", 2, "no"),
        ("any, left out", "tank", "single", 1, "no"),
    ]
    assert used == ["0"] * 5
    used.clear()
    assert len(run_left_out("any", files, read_negatives(data), show_nothing, told.append)) == 2
    assert used == ["1"] * 4
    assert told == []


def test_what_every_file_has_seen_is_told_and_not_scored(data, folds):
    files, used = folds
    told = []
    assert run_left_out("any", files[:1], read_negatives(data), show_nothing, told.append) == []
    assert told == ["reef_1: 2 of 2 frames are of sources that no file was trained without"]
    assert used == []


def test_folds_of_a_group_are_pooled(data, folds):
    files, used = folds
    lab, *others = read_frames(data)
    members = [replace(sample, order=None, group="rooms", source="reef") for sample in others]
    (run,) = run_left_out(
        "any", files, [*members, replace(lab, order=None, group="rooms")], show_nothing, print
    )
    assert used == ["0", "1", "1"]
    assert run.score.frames == 3


def test_a_file_with_shipped_parts_has_left_nothing_out(data, tmp_path):
    file = tmp_path / "fold.npz"
    parts = load_learned()
    own = replace(parts, **{name: altered(getattr(parts, name)) for name in ("places", "pairs")})
    write_selector(load_classical(), own, file)
    card = {"left_out": {"sources": ["lab", "tank"], "fold": None}}
    file.with_suffix(".json").write_text(json.dumps(card), encoding="utf-8")
    assert shared_parts("classical", file) == ("trees", "trees of pairs", "bank")
    assert shared_parts("learned", file) == ("locator", "refiner", "verifier")
    assert shared_parts("learned", file, file) == (
        "locator",
        "refiner",
        "verifier",
        "trees",
        "trees of pairs",
    )
    for selector, parts in (
        ("classical", "trees, trees of pairs, bank"),
        ("learned", "locator, refiner, verifier"),
    ):
        told = []
        assert run_left_out(selector, [str(file)], read_frames(data), show_nothing, told.append) == []
        assert len(told) == 1
        assert (
            f"not scored by the {selector} choice, whose parts ({parts}) are those of the bundled" in told[0]
        )


def altered(trees):
    """Trees with one other leaf."""
    return replace(trees, value=trees.value + np.float32(0.01))


def sample_of(folder, labels, source="a", complete=True):
    return Sample(folder / f"{source}.png", tuple(labels), source, "rooms", complete=complete)


def test_rows_of_what_was_found(tmp_path):
    square = (0, 0, 100, 100)
    labels = [Label(square, "right", "5"), Label((200, 0, 100, 100), "left", None)]
    found = [Reading((0, 0, 100, 80), "right", None), Reading((210, 0, 100, 100), "right", None)]
    answers = [
        make_answer(sample_of(tmp_path, labels), found),
        make_answer(sample_of(tmp_path, labels[:1], "b"), [Reading((300, 300, 9, 9), None, None)]),
        make_answer(sample_of(tmp_path, labels[:1], "a"), [Reading(square, None, None)] * 3),
    ]
    run = Run("some", "rooms", "single", None, tuple(answers), None)
    (row,) = found_table([run]).to_dicts()
    assert (row["frames"], row["hands"], row["found"], row["extra"]) == (3, 4, 3, 2)
    assert (row["sides"], row["side_share"]) == (3, pytest.approx(1 / 3, abs=1e-6))
    assert row["median_iou"] == pytest.approx(90 / 110, abs=1e-6)
    assert row["mean_iou"] == pytest.approx((0.8 + 90 / 110 + 1.0) / 3, abs=1e-6)
    tables = {table.name: table.to_dicts() for table in finding_tables([run], [])}
    assert set(tables) == {"found", "found_by_source", "found_by_token"}
    assert [tuple(row.values())[1:] for row in tables["found_by_source"]] == [("some", "rooms", "b", 1, 0)]
    assert [tuple(row.values())[2:5] for row in tables["found_by_token"]] == [("5", 3, 2), ("other", 1, 1)]
    assert [answer.misfound for answer in answers] == [False, True, True]


def test_false_hands_are_counted_and_summed(data, fake_method):
    class Pair(type(fake_method)):
        def read(self, image):
            return super().read(image + 1) * 2

    tables = finding_tables([], run_methods([fake_method, Pair()], read_negatives(data), show_nothing))
    rows = [tuple(row.values())[2:] for table in tables for row in table.to_dicts()]
    assert rows == [
        ("reef_1", "no", "single", 2, 0, 0),
        ("reef_1", "no", "sequence", 2, 0, 0),
        ("reef_1", "no", "single", 2, 2, 2),
        ("reef_1", "no", "sequence", 2, 2, 2),
        ("all", None, "single", 4, 2, 2),
    ]


def test_the_bundled_selector_finds_hands_of_real_pictures(real_data):
    hover = [sample for sample in read_frames(real_data) if sample.group == "underwater"]
    run = run_single(selector_method("classical"), "underwater", hover)
    assert run.score.found >= 2
    assert all(reading.token is None for answer in run.answers for reading in answer.readings)
