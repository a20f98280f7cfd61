"""Stalled cameras and frames that show nothing, whatever the source, and the time of day in records."""

import json
import math
from datetime import UTC, datetime

import numpy as np
import pytest

from lightgesture.errors import ExitStatus
from lightgesture.live import LiveLoop, Mailbox, Snapshot
from lightgesture.pipeline import Pipeline
from lightgesture.records import utc_text
from lightgesture.watch import BLANK_S, Watch

SEEN = np.arange(48 * 64 * 3, dtype=np.uint8).reshape(48, 64, 3)
BLACK = np.zeros((48, 64, 3), np.uint8)


def told(frames):
    watch = Watch()
    return [(time_s, hole) for image, time_s in frames if (hole := watch.look(image, time_s))], watch


def seconds(count, rate=30.0, start_s=0.0):
    return [start_s + number / rate for number in range(count)]


def test_a_stalled_camera():
    times = seconds(30) + seconds(30, start_s=101.0)
    holes, watch = told((SEEN, time_s) for time_s in times)
    assert holes == [(101.0, "no frame from 0.97 to 101.00 s")]
    assert not watch.is_blank


@pytest.mark.parametrize("rate", [0.2, 1.0, 5.0, 30.0])
def test_a_camera_of_any_rate_has_no_stall(rate):
    assert told((SEEN, time_s) for time_s in seconds(40, rate))[0] == []


def test_frames_that_were_dropped_here_and_there_are_no_stall():
    assert told((SEEN, time_s) for time_s in seconds(90) if round(time_s * 30) % 20 > 12)[0] == []


def changing(times):
    """A picture that is another one in each frame."""
    return [(SEEN + np.uint8(number + 1), time_s) for number, time_s in enumerate(times)]


def test_a_picture_that_stands_still_is_told_while_it_does_and_when_it_ends():
    frozen = [(SEEN.copy(), time_s) for time_s in seconds(90, start_s=1.0)]
    holes, watch = told([*changing(seconds(30)), *frozen, *changing(seconds(30, start_s=4.0))])
    assert holes == [
        (pytest.approx(2.033, abs=0.04), "the picture stands still from 1.00 s on: all frames are the same"),
        (4.0, "no new picture from 1.00 to 4.00 s"),
    ]
    assert not watch.is_blank


def test_a_picture_that_comes_again_for_less_than_a_second_is_none_that_stands_still():
    frozen = [(SEEN.copy(), time_s) for time_s in seconds(29, start_s=1.0)]
    assert told([*changing(seconds(30)), *frozen, *changing(seconds(30, start_s=59 / 30))])[0] == []


def test_pictures_that_always_last_are_shown_so_on_purpose():
    """As of still pictures that follow each other, two seconds each."""
    times = seconds(60 * 20)
    assert told((SEEN + np.uint8(time_s // 2), time_s) for time_s in times)[0] == []


@pytest.mark.parametrize(("frames", "end"), [(45, "2.50"), (15, "1.50")])
def test_nothing_for_a_moment_is_a_hole_when_it_ends(frames, end):
    """It is told by itself after two seconds; in one a sign may have been made, in less one is counted twice."""
    nothing = [(BLACK, time_s) for time_s in seconds(frames, start_s=1.0)]
    after = changing(seconds(30, start_s=1.0 + frames / 30))
    holes, _ = told([*changing(seconds(30)), *nothing, *after])
    assert holes == [(float(end), f"nothing was shown from 1.00 to {end} s")]


def test_a_few_frames_of_nothing_are_no_hole():
    nothing = [(BLACK, time_s) for time_s in seconds(7, start_s=1.0)]
    assert told([*changing(seconds(30)), *nothing, *changing(seconds(30, start_s=37 / 30))])[0] == []


def test_a_clock_that_stands_still_while_frames_come_is_told_once():
    times = [*seconds(30), *[1.0] * 90, *seconds(30, start_s=1.033)]
    holes, _ = told(changing(times))
    assert holes == [(1.0, "time stands still at 1.00 s: 31 frames came with no later stamp")]


@pytest.mark.parametrize(
    "stamps", [[0.0] * 200, [0.0, -5.0] * 100, [time_s for time_s in range(50) for _ in range(2)]]
)
def test_a_clock_that_never_went_or_goes_in_steps_is_no_hole(stamps):
    """The rule by frames reads such a stream; those by time read nothing in it."""
    assert told(changing(stamps))[0] == []


@pytest.mark.parametrize("stamp", [math.nan, math.inf])
def test_stamps_that_are_no_time_are_endured(stamp):
    assert told((SEEN, time_s) for time_s in [0.0, 0.1, stamp, 0.2, 0.3])[0] == []


@pytest.mark.parametrize(
    "picture", [BLACK, np.full_like(BLACK, (0, 135, 0)), BLACK[..., 0], BLACK.astype(np.uint16)]
)
def test_frames_that_show_nothing_are_told_once(picture):
    holes, watch = told((picture, time_s) for time_s in seconds(150))
    assert [hole for _, hole in holes] == ["frames show nothing from 0.00 s on: all pixels are the same"]
    assert holes[0][0] == pytest.approx(BLANK_S)
    assert watch.is_blank


def test_a_dark_dive_is_no_failure():
    noise = np.random.default_rng(1).integers(0, 6, BLACK.shape).astype(np.uint8)
    holes, watch = told((noise, time_s) for time_s in seconds(150))
    assert (holes, watch.is_blank) == ([], False)


def test_a_cap_on_the_lens_at_the_start_is_told_and_no_failure():
    frames = [(BLACK, time_s) for time_s in seconds(75)] + [
        (SEEN, time_s) for time_s in seconds(90, start_s=2.5)
    ]
    holes, watch = told(frames)
    assert (len(holes), watch.is_blank) == (1, False)


def test_less_than_a_moment_of_nothing_is_not_told():
    assert told((BLACK, time_s) for time_s in seconds(30))[0] == []


def test_a_folder_of_black_pictures_fails(run, fake, make_picture):
    for number in range(75):
        folder = make_picture(f"frames/{number}.png", BLACK).parent
    result = run("decode", folder, "--json")
    assert result.status == ExitStatus.SOME_FAILED
    assert "most frames show nothing" in result.err[0]
    gap, summary = [
        record for record in map(json.loads, result.out) if record["type"] in ("notice", "summary")
    ][-2:]
    assert (gap["reason"], gap["frame"]) == ("gap", 60)
    assert summary["status"] == "failed"


def test_live_tells_a_stall_and_frames_that_show_nothing(fake):
    class Outlet:
        is_gone = False
        put = staticmethod(lambda record: records.append(record))

    records, box = [], Mailbox()
    pipeline = fake(model="svm", source="0", frames=True, debug=None)
    moment = datetime(2026, 5, 4, tzinfo=UTC)
    loop = LiveLoop(
        "0",
        box,
        pipeline,
        [Outlet],
        clock=lambda: 0.0,
        report=records.append,
        start_utc=moment,
        heartbeat_s=-1.0,
    )
    times = [0.0, 0.1, 0.2, 9.0, *seconds(30, 10.0, 9.1)]
    for index, time_s in enumerate(times):
        loop.take_in(Snapshot(BLACK if time_s > 9.0 else SEEN, index, time_s))
    notices = [record.detail for record in records if record.type == "notice" and record.reason == "gap"]
    assert notices == [
        "no frame from 0.20 to 9.00 s",
        "frames show nothing from 9.10 s on: all pixels are the same",
    ]
    assert pipeline.start_utc == moment
    loop.beat(1.5)
    assert records[-1].utc == "2026-05-04T00:00:01.500Z"
    box.close()
    loop.run(type("Never", (), {"is_set": lambda self: False})())
    assert (records[-1].type, records[-1].status) == ("summary", "failed")


def test_every_record_has_the_time_of_day_where_it_is_known():
    pipeline = Pipeline(source="a")
    assert pipeline.process(SEEN, 0.0)[0].utc is None
    pipeline.start_utc = datetime(2026, 5, 4, 10, 0, 0, tzinfo=UTC)
    records = [*pipeline.process(SEEN, 1.25), *pipeline.interrupt("a hole", 90.0), *pipeline.finish()]
    assert [(record.type, record.utc) for record in records] == [
        ("frame", "2026-05-04T10:00:01.250Z"),
        ("notice", "2026-05-04T10:01:30.000Z"),
        ("summary", "2026-05-04T10:00:01.250Z"),
    ]
    assert all("utc" in record.to_dict() for record in records)
    assert pipeline.for_stream("b").start_utc is None


@pytest.mark.parametrize("time_s", [None, math.nan, math.inf, 1e18])
def test_no_time_of_day_for_what_is_no_time(time_s):
    assert utc_text(datetime(2026, 5, 4, tzinfo=UTC), time_s) is None
