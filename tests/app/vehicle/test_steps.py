"""Pictures and parameters as steps of a task, tick by tick, without a link and without a wait."""

import threading
from concurrent.futures import Future
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from types import SimpleNamespace

import numpy as np
import pytest

from lightgesture.fsm import Notice, State
from lightgesture.fsm.events import Growth
from lightgesture.records import FrameRecord, Hand
from lightgesture.vehicle import (
    NEUTRAL,
    Picture,
    ReadParameter,
    Reply,
    Status,
    StopPictures,
    TakePictures,
    WriteParameter,
)
from lightgesture.vehicle.bench import Frame, Helper, seconds_of
from lightgesture.vehicle.camera_run import GRACE_S, MOST_WAITING, CameraRun, OwnPictures
from lightgesture.vehicle.guard import Senses
from lightgesture.vehicle.intake import MAX_AGE_S, Intake
from lightgesture.vehicle.motion import Motion
from lightgesture.vehicle.parameter_run import ParameterRun, changed
from lightgesture.vehicle.profile import ParameterTable
from lightgesture.vehicle.profile_file import load_vehicle
from lightgesture.vehicle.steps import CameraStep

IMAGE = np.zeros((8, 8, 3), np.uint8)
START_S = 16.0


class Bench:
    """What a step works with; a helper that works at once, or not before it is told to.

    answer: what becomes of an order.
    """

    def __init__(self, answer="accepted", interval_s=None, value=None):
        self.vehicle, self.helper = self, self
        self.orders, self.waiting, self.is_slow = [], [], False
        self.answer, self.interval_s, self.cap = answer, interval_s, 0.4
        self.status, self.frame, self.value = Status(), None, value

    def order(self, order, now_s):
        self.orders.append(order)
        return Reply(state=self.answer, detail="as it says", value=self.value)

    def start(self, work):
        future = Future()
        self.waiting.append((future, work))
        if not self.is_slow:
            self.work()
        return future

    def work(self):
        for future, work in self.waiting:
            try:
                future.set_result(work())
            except Exception as error:
                future.set_exception(error)
        self.waiting = []


def own_pictures(instruction, tmp_path, text="CONTD SNAP 2 GO", **bench):
    step = CameraStep(camera=0, interval_s=0.5, folder=str(tmp_path))
    run, own = CameraRun(instruction(text), step), Bench(**bench)
    run.begin(own, START_S)
    return run, own


def tick(run, own, after_s, age_s=0.0):
    """A tick, with a frame that was seen so long before it; how it stands, and how many pictures there are."""
    own.frame = None if age_s is None else Frame(IMAGE, START_S + after_s - age_s)
    return run.tick(own, START_S + after_s), len(run.news)


def test_own_frames_are_taken_each_when_it_is_due(instruction, tmp_path):
    run, own = own_pictures(instruction, tmp_path)
    assert run.detail == "4 pictures"
    told = [tick(run, own, after_s) for after_s in (0.0, 0.25, 0.49, 0.5, 0.75, 1.0, 1.25, 1.5)]
    assert told == [("going", count) for count in (1, 1, 1, 2, 2, 3, 3)] + [("done", 4)]
    assert run.detail == f"4 of 4 own frames in {tmp_path}"
    assert len(list(tmp_path.glob("*.jpg"))) == 4
    assert own.orders == []


def test_a_frame_of_before_the_last_interval_is_no_picture(instruction, tmp_path):
    run, own = own_pictures(instruction, tmp_path, "CONTD SNAP 1 GO")
    assert tick(run, own, 0.0, age_s=0.5) == ("going", 1)
    assert tick(run, own, 0.5, age_s=0.51) == ("done", 1)
    assert run.detail == f"1 of 2 own frames in {tmp_path}"
    run, own = own_pictures(instruction, tmp_path, "CONTD SNAP 1 GO")
    assert tick(run, own, 0.0, age_s=None) == ("going", 0)
    assert tick(run, own, 0.5, age_s=None) == ("refused", 0)
    assert run.reason == "no picture came to be kept"


def test_a_step_ends_when_its_pictures_are_written(instruction, tmp_path):
    run, own = own_pictures(instruction, tmp_path, "CONTD SNAP GO")
    assert run.detail == "a picture"
    own.is_slow = True
    assert tick(run, own, 0.0) == ("going", 0)
    assert tick(run, own, 9.0) == ("going", 0)
    own.work()
    assert tick(run, own, 9.1) == ("done", 1)


def test_where_writing_is_slow_pictures_are_left_out(tmp_path):
    pictures, bench = OwnPictures(tmp_path), Bench()
    bench.is_slow = True
    for _ in range(MOST_WAITING + 3):
        pictures.take(bench, IMAGE, 0.0)
    assert len(bench.waiting) == MOST_WAITING
    assert pictures.is_writing
    bench.work()
    assert len(pictures.written()) == pictures.count == MOST_WAITING
    assert not pictures.is_writing
    assert pictures.written() == []


@pytest.mark.parametrize(("age_s", "expected_s"), [(0.0, 0.0), (-100.0, -100.0), (50.0, 0.0)])
def test_a_picture_is_named_by_when_it_was_seen(tmp_path, age_s, expected_s):
    pictures, bench = OwnPictures(tmp_path), Bench()
    for _ in range(2):
        pictures.take(bench, IMAGE, age_s)
    names = sorted(path.name for path in tmp_path.iterdir())
    assert len(names) == 2
    stem = names[0].removesuffix("Z.jpg")
    moment = datetime.strptime(stem[:15] + stem[15:19] + "000", "%Y%m%dT%H%M%S.%f").replace(tzinfo=UTC)
    assert abs(moment - datetime.now(UTC) - timedelta(seconds=expected_s)) < timedelta(seconds=20)


@pytest.mark.parametrize(
    ("text", "interval_s", "count", "detail"),
    [
        ("CONTD SNAP GO", None, 1, "a picture"),
        ("CONTD SNAP 3 GO", None, 6, "6 pictures"),
        ("CONTD SNAP 3 GO", 1.0, 3, "3 pictures"),
        ("CONTD SNAP 1 GO", 4.0, 1, "a picture"),
    ],
)
def test_a_camera_is_asked_for_as_many_pictures_as_fit_the_time(instruction, text, interval_s, count, detail):
    run = CameraRun(instruction(text), CameraStep(camera=100, interval_s=0.5, missing=0.5))
    bench = Bench(interval_s=interval_s)
    run.begin(bench, START_S)
    assert bench.orders == [TakePictures(component=100, interval_s=interval_s or 0.5, count=count)]
    assert run.detail == detail


def by_camera(instruction, **bench):
    run, own = (
        CameraRun(instruction("CONTD SNAP 2 GO"), CameraStep(camera=100, interval_s=1.0)),
        Bench(**bench),
    )
    run.begin(own, START_S)
    return run, own


def test_a_camera_is_done_with_its_last_picture(instruction):
    run, own = by_camera(instruction)
    assert run.tick(own, START_S) == "going"
    own.status = Status(pictures=(Picture(number=7, place="/dcim/7.jpg"),))
    assert run.tick(own, START_S + 1) == "going"
    run.end(own, START_S + 1)
    assert own.orders[1:] == [StopPictures(component=100)]
    own.status = Status(pictures=(Picture(number=8),))
    assert run.tick(own, START_S + 2) == "done"
    assert run.news == ["picture 7 by camera 100 /dcim/7.jpg", "picture 8 by camera 100"]
    assert run.detail == "2 pictures by camera 100"
    run.end(own, START_S + 2)
    assert len(own.orders) == 2  # it has nothing left to stop


def test_a_camera_has_its_time_to_tell_of_its_pictures(instruction):
    run, own = by_camera(instruction)
    assert run.tick(own, START_S + 1 + GRACE_S - 0.01) == "going"
    assert run.tick(own, START_S + 1 + GRACE_S) == "refused"
    assert run.reason == "camera 100 told of 0 of 2 pictures"


@pytest.mark.parametrize(("answer", "outcome"), [("pending", "pending"), ("refused", "refused")])
def test_a_camera_that_has_not_begun_is_not_stopped(instruction, answer, outcome):
    run, own = by_camera(instruction, answer=answer)
    assert run.tick(own, START_S + 60) == outcome
    run.end(own, START_S + 60)
    assert len(own.orders) == 1


def test_seconds_are_those_of_the_step_or_of_the_instruction_or_what_stands_for_them(instruction):
    assert seconds_of(3.0, 9.0, instruction("STOP HOVER 5 GO")) == 3.0
    assert seconds_of("duration_s", 9.0, instruction("STOP HOVER 5 GO")) == 5.0
    assert seconds_of("duration_s", 9.0, instruction("STOP HOVER GO")) == 9.0


# Parameters

TABLE = ParameterTable(number=1, name="SPEED", step=2.0, minimum=1.0, maximum=6.0, default=3.0)


@pytest.mark.parametrize(
    ("change", "value", "expected"),
    [
        ("INCREASE", 3.0, 5.0),
        ("INCREASE", 5.0, 6.0),
        ("INCREASE", 6.0, "SPEED is 6, at its limit already"),
        ("DECREASE", 3.0, 1.0),
        ("DECREASE", 2.0, 1.0),
        ("DECREASE", 1.0, "SPEED is 1, at its limit already"),
        ("INCREASE", 1.0, 3.0),
        ("DECREASE", 6.0, 4.0),
        ("INCREASE", 6.5, "SPEED is 6.5, outside of 1 to 6"),
        ("DECREASE", 0.5, "SPEED is 0.5, outside of 1 to 6"),
        ("DEFAULT", 5.0, 3.0),
        ("DEFAULT", 9.0, 3.0),
        ("HALVE", 3.0, "HALVE is no change of a parameter"),
    ],
)
def test_a_parameter_changes_by_its_step_within_its_limits(change, value, expected):
    assert changed(TABLE, change, value) == expected


def parameter_run(instruction, answer, value=None):
    run, own = ParameterRun(instruction("CONTD PARAM 1 INCREASE GO"), TABLE), Bench(answer, value=value)
    run.begin(own, START_S)
    return run, own


def test_a_parameter_is_read_then_written(instruction):
    run, own = parameter_run(instruction, "accepted", 3.0)
    assert own.orders == [ReadParameter(name="SPEED")]
    assert run.tick(own, START_S) == "pending"
    assert own.orders[1:] == [WriteParameter(name="SPEED", value=5.0)]
    assert run.tick(own, START_S) == "done"
    assert run.detail == "SPEED 3 to 5"


@pytest.mark.parametrize(
    ("answer", "value", "outcome", "reason"),
    [
        ("pending", None, "pending", ""),
        ("refused", None, "refused", "SPEED: as it says"),
        ("accepted", 6.0, "refused", "SPEED is 6, at its limit already"),
    ],
)
def test_nothing_is_written_before_a_parameter_is_known(instruction, answer, value, outcome, reason):
    run, own = parameter_run(instruction, answer, value)
    assert (run.tick(own, START_S), run.reason) == (outcome, reason)
    assert len(own.orders) == 1


def test_a_parameter_of_the_executor_is_changed_here(instruction):
    table = ParameterTable(number=2, name="cap", own=True, step=0.25, minimum=0.05, maximum=1.0, default=0.5)
    run, own = ParameterRun(instruction("CONTD PARAM 2 INCREASE GO"), table), Bench()
    run.begin(own, START_S)
    assert run.tick(own, START_S) == "done"
    assert (own.cap, own.orders, run.detail) == (0.65, [], "cap 0.4 to 0.65")
    pictures = table.model_copy(update={"name": "interval_s"})
    run = ParameterRun(instruction("CONTD PARAM 2 DECREASE GO"), pictures)
    run.begin(own, START_S)
    assert run.tick(own, START_S) == "done"
    assert own.interval_s == 0.25  # from its default


# What the executor is shown


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


# A nod and a shake, under the guard


class Rig:
    """A motion of the bundled profile on a vehicle that says what a test tells it."""

    def __init__(self, **status):
        profile = load_vehicle("ardusub")
        self.sticks, self.held = Recorder(), []
        known = {"heard_s": START_S, "is_armed": True, **status}
        self.bench = SimpleNamespace(profile=profile, sticks=self.sticks, cap=0.4, status=Status(**known))
        self.motion = Motion(self.bench)

    def tick(self, after_s, **status):
        now_s = START_S + after_s
        self.bench.status = replace(self.bench.status, heard_s=now_s, **status)
        self.motion.tick(Senses(picture_s=now_s, hand_s=now_s), now_s)
        return self.sticks.now


class Recorder:
    """now: what the sticks are held at; None: not held."""

    now = None
    releases = 0

    def hold(self, stick):
        self.now = stick

    def release(self, now_s, to_another=False):
        self.now = None
        self.releases += 1


def test_a_nod_begins_in_the_middle_and_comes_to_its_end():
    rig = Rig()
    assert rig.tick(0.0) is None
    rig.motion.ask("nod")
    assert rig.tick(0.1) == NEUTRAL
    assert rig.tick(0.3).z > 0
    table = rig.bench.profile.motion
    assert rig.tick(0.1 + table.beat_s * 1.5).z < 0
    assert rig.tick(0.1 + table.beat_s * 2 * table.times - 0.01) is not None
    assert rig.tick(0.1 + table.beat_s * 2 * table.times + 0.01) is None
    assert rig.tick(9.0) is None
    assert rig.sticks.releases == 1


@pytest.mark.parametrize(
    "status",
    [
        {"trouble": "two vehicles"},
        {"is_armed": False},
        {"pilot_s": START_S + 0.1},
        {"stick_s": START_S + 0.1},
    ],
)
def test_what_stands_against_a_nod_forgets_it_and_what_comes_ends_it(status):
    rig = Rig()
    rig.motion.ask("nod")
    assert rig.tick(0.1, **status) is None
    cleared = {"trouble": "", "is_armed": True, "pilot_s": None, "stick_s": None}
    assert rig.tick(0.2, **cleared) is None
    rig.motion.ask("nod")
    assert rig.tick(0.3) == NEUTRAL
    later = {key: START_S + 0.4 if key.endswith("_s") else value for key, value in status.items()}
    assert rig.tick(0.5, **later) is None
    assert rig.tick(0.6, **cleared) is None


def test_a_nod_is_not_asked_for_twice_nor_where_it_is_not_allowed():
    rig = Rig()
    rig.motion.ask("nod")
    rig.motion.ask("shake")
    rig.tick(0.0)
    assert rig.tick(0.25).r == 0
    rig.motion.stop(START_S)
    rig.motion.is_allowed = False
    rig.motion.ask("nod")
    assert rig.tick(0.5) is None
    releases = rig.sticks.releases
    rig.motion.stop(START_S)
    assert rig.sticks.releases == releases


def test_a_nod_that_was_asked_for_and_stopped_before_it_began_does_not_begin():
    rig = Rig()
    rig.motion.ask("nod")
    rig.motion.stop(START_S)
    assert rig.tick(0.1) is None


# One thread for what takes its time


def test_what_has_not_begun_is_left_undone_at_the_end():
    helper, gate, done = Helper(), threading.Event(), []
    helper.close()
    first = helper.start(lambda: gate.wait(10) and "first")
    second = helper.start(lambda: done.append("second"))
    helper.close()
    gate.set()
    assert first.result(10) == "first"
    assert second.cancelled()
    assert done == []
    with pytest.raises(RuntimeError):
        helper.start(str)
