"""What the executor is shown: pictures, records, instructions."""

import pytest

from lightgesture.fsm import Notice, State
from lightgesture.fsm.events import Growth
from lightgesture.records import FrameRecord, Hand
from lightgesture.vehicle.bench import Frame
from lightgesture.vehicle.guard import Senses
from lightgesture.vehicle.intake import MAX_AGE_S, Intake
from tests.app.vehicle.step_bench import IMAGE, START_S


def shown(*records, image=IMAGE):
    """An intake that was shown this at START_S, a second after an empty frame."""
    clock = iter([START_S - 1, START_S])
    intake = Intake(lambda: next(clock))
    intake.show(IMAGE, [])
    intake.show(image, list(records))
    return intake


def frame_record(*hands):
    return FrameRecord(source="cam", frame=1, time_s=1.0, hands=hands)


def state(dwell=None):
    return State(source="cam", frame=1, time_s=1.0, state="idle", sentence="", dwell=dwell)


def notice(reason):
    return Notice(source="cam", frame=1, time_s=1.0, reason=reason, detail="no frame came")


HAND = Hand(side="left", token=None, confidence=0.1, box=(0, 0, 9, 9), track=1, reason="unknown_shape")
GROWTH = Growth(pair=("5", "5"), word=None, progress=0.5)


@pytest.mark.parametrize(
    ("record", "is_seen"),
    [
        (frame_record(HAND), True),
        (frame_record(), False),
        (state(GROWTH), True),
        (state(), False),
        (notice("unknown_pair"), False),
    ],
)
def test_a_diver_is_seen_by_hands_and_by_signs_that_grow(record, is_seen):
    senses = shown(record).take(START_S).senses
    assert senses == Senses(picture_s=START_S, hand_s=START_S if is_seen else None, hole=None)


def test_a_hole_in_the_pictures_is_told_once_and_other_notices_are_none():
    intake = shown(notice("gap"), notice("repeat"))
    assert intake.take(START_S).senses.hole == "no frame came"
    assert intake.take(START_S).senses.hole is None
    assert shown(notice("repeat")).take(START_S).senses.hole is None


def test_records_without_a_picture_make_none_fresh():
    taken = shown(frame_record(HAND), image=None).take(START_S)
    assert (taken.senses.picture_s, taken.senses.hand_s) == (START_S - 1, START_S)
    assert taken.frame == Frame(IMAGE, START_S - 1)


@pytest.mark.parametrize(("late_s", "is_new"), [(0.0, True), (MAX_AGE_S, True), (MAX_AGE_S + 0.01, False)])
def test_an_instruction_is_fresh_for_a_moment(instruction, late_s, is_new):
    record = instruction()
    intake = shown(record, state())
    taken = intake.take(START_S + late_s)
    assert (taken.new, taken.late) == (((record,), ()) if is_new else ((), (record,)))
    assert intake.take(START_S).new == ()
