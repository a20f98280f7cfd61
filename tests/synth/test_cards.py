"""Rendered divers with cards: what is drawn is what the truth says, and what the reader reads."""

from itertools import pairwise

import cv2
import numpy as np
import pytest

from lightgesture.features.tags.detector import make_detector
from lightgesture.fsm import load_grammar
from lightgesture.synth.card_motion import drawn_shape
from lightgesture.synth.card_script import card_steps, motion_steps
from lightgesture.synth.output import with_truth
from lightgesture.synth.scene import Scene, SceneFrame
from lightgesture.synth.script import Timing
from lightgesture.synth.spec import CardSpec, DiverSpec, SceneSpec, WaterSpec

GRAMMAR = load_grammar()
TIMING = Timing(hold=(6, 6), passage=(2, 2), pause=(2, 2))


def spec(signing, **cards):
    return SceneSpec(
        seed=3,
        sentences=("STOP UP GO",),
        size=(400, 300),
        fps=10.0,
        hold=(6, 7),
        passage=(2, 2),
        pause=(2, 2),
        signing=signing,
        cards=CardSpec(**cards),
        diver=DiverSpec(distance_mm=1100.0),
        water=WaterSpec(turbidity=0.1),
    )


def read(image):
    grey = np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), np.uint8)
    return {tag.id: tag for tag in make_detector("aruco", "36h11").process(grey, 0.0)}


def step_of(scene, kind):
    """The middle frame of the first step of a kind."""
    step = next(step for step in scene.cards.steps if step.kind == kind)
    return (step.start + step.end) // 2


def test_cards_come_one_after_the_other():
    steps = card_steps(GRAMMAR, ["STOP HOVER 50 GO"], TIMING, np.random.default_rng(0))
    assert [step.word for step in steps if step.kind == "card"] == ["STOP", "HOVER", "5", "AND", "0", "GO"]
    assert [step.id for step in steps if step.kind == "card"] == [0, 4, 25, 3, 20, 2]
    assert all(before.end <= after.start for before, after in pairwise(steps))
    assert (steps[0].kind, steps[-1].kind) == ("lowered", "lowered")


def test_motions_have_rest_before_and_after():
    steps = motion_steps(GRAMMAR, ["STOP UP GO"], TIMING, 10.0, np.random.default_rng(0))
    kinds = [step.kind for step in steps]
    assert kinds == ["lowered", "ready", *["motion", "ready"] * 3, "lowered", "lowered"]
    assert [step.motion for step in steps if step.kind == "motion"] == [
        ("left", "right"),
        ("up", "up"),
        ("clockwise", "clockwise"),
    ]
    assert all(step.end - step.start >= 8 for step in steps if step.kind == "ready")


@pytest.mark.parametrize("make", [card_steps, lambda *given: motion_steps(*given[:3], 10.0, given[3])])
def test_a_word_that_nothing_says(make):
    with pytest.raises(ValueError, match="for the word 'DANCE'; the grammar has"):
        make(GRAMMAR, ["STOP DANCE GO"], TIMING, np.random.default_rng(0))


def test_shapes_are_drawn_as_people_draw_and_end_near_where_they_began():
    rng = np.random.default_rng(1)
    for name in ("up", "clockwise", "wave"):
        curve = drawn_shape(name, 100.0, 1.0, rng)
        assert np.allclose(curve[0], 0.0)
        assert np.hypot(*curve[-1]) < 60.0
        assert 120.0 < np.ptp(curve, axis=0).max() < 320.0
    assert not drawn_shape("still", 100.0, 1.0, rng).any()


@pytest.mark.parametrize("hands", ["left", "right", "both"])
def test_a_card_is_read_where_the_truth_has_it(hands):
    scene = Scene(spec("tags", hands=hands, tilt_deg=20.0))
    frame = scene.frame(step_of(scene, "card"))
    (told,) = frame.record.signs
    assert (told.id, told.word, told.side) == (0, "STOP", None)
    found = read(frame.image)
    assert {*found} == {0}
    assert np.abs(found[0].corners - np.array(told.corners)).max() < 2.0
    assert frame.signs.shown == ("STOP",)


def test_two_cards_are_moved():
    scene = Scene(spec("tag-motion", tilt_deg=10.0))
    ready, moving = (scene.frame(step_of(scene, kind)) for kind in ("ready", "motion"))
    assert {sign.side: sign.id for sign in ready.record.signs} == {"left": 50, "right": 51}
    assert {*read(ready.image)} == {50, 51}
    assert moving.signs.shown is None
    left, right = (
        np.mean([sign.corners for sign in ready.record.signs if sign.side == side])
        for side in ("left", "right")
    )
    assert left > right  # the diver faces the camera


def test_the_truth_is_what_was_said():
    grammar = GRAMMAR
    scene = Scene(spec("tags"))
    # Only the signs decide, so that no picture need be drawn.
    frames = [_unseen(scene, index) for index in range(scene.frame_count)]
    records = [record for _, found in with_truth(frames, grammar, 15, None, "tags") for record in found]
    assert [record.text for record in records if record.type == "instruction"] == ["STOP UP GO"]


def _unseen(scene, index):
    from lightgesture.fsm import Sign, Signs
    from lightgesture.records import FrameRecord

    step = next((step for step in scene.cards.steps if step.start <= index < step.end), None)
    word = step.word if step is not None and step.kind == "card" else None
    signs = Signs() if word is None else Signs(left=Sign(word, is_word=True))
    record = FrameRecord(source=None, frame=index, time_s=index / 10.0, signs=())
    return SceneFrame(np.zeros((2, 2, 3), np.uint8), record, signs)
