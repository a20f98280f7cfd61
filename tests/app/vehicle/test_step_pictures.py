"""Pictures as steps of a task, tick by tick, without a link and without a wait."""

import threading
from datetime import UTC, datetime, timedelta

import pytest

from lightgesture.vehicle import (
    Picture,
    Status,
    StopPictures,
    TakePictures,
)
from lightgesture.vehicle.bench import Frame, Helper, seconds_of
from lightgesture.vehicle.camera_run import GRACE_S, MOST_WAITING, CameraRun, OwnPictures
from lightgesture.vehicle.steps import CameraStep
from tests.app.vehicle.step_bench import IMAGE, START_S, Bench


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
