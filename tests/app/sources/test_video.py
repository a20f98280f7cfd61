"""Frames and times of whole videos, whatever their codec, colours and clocks."""

import json
import os
from datetime import UTC, datetime
from pathlib import Path

import av
import numpy as np
import pytest

from lightgesture.errors import ExitStatus
from lightgesture.sources import open_source
from lightgesture.sources.clock import RecordingClock, creation_time
from lightgesture.sources.conversion import Converter
from tests.app.sources.video_makers import read, times

from .conftest import noise


def differ(frame, picture):
    return float(np.abs(frame.image.astype(int) - picture).mean())


@pytest.mark.parametrize("suffix", ["avi", "mkv", "mov", "mp4", "mpg", "ts", "webm"])
@pytest.mark.parametrize("is_reordered", [False, True])
def test_times_begin_at_nothing_and_are_in_order(write_video, suffix, is_reordered):
    """Transport and programme streams begin somewhere, and AVI tells only when a frame is to be decoded."""
    codec = {"avi": "mpeg4", "mpg": "mpeg2video", "webm": "libvpx-vp9"}.get(suffix, "libx264")
    options = {"bf": "2" if is_reordered else "0"} if codec != "libvpx-vp9" else {"deadline": "realtime"}
    pictures = noise(20)
    frames = read(write_video(f"a.{suffix}", pictures, codec, options=options | {"b": "2000000"}))
    assert times(frames) == list(range(20))
    assert all(differ(frame, picture) < 12 for frame, picture in zip(frames, pictures, strict=True))


def test_av1(write_video):
    assert times(read(write_video("a.mkv", noise(6), "libsvtav1", options={"preset": "12"}))) == list(
        range(6)
    )


def test_interlaced_frames_are_deinterlaced(write_video):
    """Two fields of different moments: no picture has the comb of both."""
    pictures = [np.full((64, 96, 3), 40, np.uint8) for _ in range(12)]
    for number, picture in enumerate(pictures):
        picture[0::2, 4 * number : 4 * number + 30] = 200
        picture[1::2, 4 * number + 2 : 4 * number + 32] = 200
    options = {"flags": "+ildct+ilme", "x264-params": "tff=1", "crf": "10"}
    path = write_video("a.ts", pictures, options=options)
    with av.open(str(path)) as container:
        assert next(container.decode(video=0)).interlaced_frame
    frames = read(path)
    assert times(frames) == list(range(12))
    for frame, picture in zip(frames, pictures, strict=True):
        combs = np.abs(np.diff(picture[8:-8].astype(int), axis=0)).mean()
        assert np.abs(np.diff(frame.image[8:-8].astype(int), axis=0)).mean() < combs / 4
        assert 80 < frame.image[32, :, 0].astype(int).max() <= 255


COLOUR = (40, 90, 180)


def planes(y, u, v, size=(48, 64)):
    levels = np.stack([np.full(size, level, np.uint8) for level in (y, u, v)])
    return av.VideoFrame.from_ndarray(levels.reshape(-1, size[1]).reshape(3, *size), format="yuv444p")


def test_ycgco_in_its_true_colours(write_video):
    blue, green, red = COLOUR
    co, cg = red - blue, green - (red + blue) / 2
    level = round(16 + (green / 2 + (red + blue) / 4) * 219 / 255)
    frame = planes(level, round(128 + cg / 2 * 224 / 255), round(128 + co / 2 * 224 / 255))
    path = write_video("a.mkv", [frame] * 2, pixels="yuv444p", options={"qp": "0"}, colours=8)
    assert np.abs(read(path)[0].image.astype(int) - COLOUR).max() <= 3


@pytest.mark.parametrize("colours", [10, 11, 14])
def test_a_matrix_that_is_not_known_is_taken_for_the_usual_one_and_told(write_video, capsys, colours):
    pictures = noise(3)
    frames = read(write_video("a.mkv", pictures, colours=colours))
    assert all(differ(frame, picture) < 12 for frame, picture in zip(frames, pictures, strict=True))
    assert capsys.readouterr().err.count(f"number {colours} of H.273") == 1


def test_frames_that_cannot_be_shown_fail(write_video, run, fake, monkeypatch):
    def refuse(converter, frame):
        raise ValueError("pixels of the form bayer cannot be converted")

    monkeypatch.setattr(Converter, "bgr8", refuse)
    result = run("decode", write_video("a.mp4", noise(4)))
    assert result.status == ExitStatus.SOME_FAILED
    assert "no frame of this video (h264) can be shown: pixels of the form bayer" in result.err[0]


def test_a_frame_that_cannot_be_shown_is_an_end_with_status_1(write_video, run, fake, monkeypatch):
    convert, seen = Converter.bgr8, []

    def refuse_some(converter, frame):
        seen.append(frame)
        if 4 <= len(seen) < 14:
            raise ValueError("pixels of the form bayer cannot be converted")
        return convert(converter, frame)

    monkeypatch.setattr(Converter, "bgr8", refuse_some)
    result = run("decode", write_video("a.mp4", noise(20)), "--json")
    assert result.status == ExitStatus.SOME_FAILED
    assert "10 of its frames cannot be shown: pixels of the form bayer" in result.err[-1]
    assert sum('"reason":"gap"' in line for line in result.out) == 1


def test_what_cannot_be_deinterlaced_is_passed_on(write_video, monkeypatch):
    monkeypatch.setattr("lightgesture.sources.conversion.DEINTERLACER", "loudnorm")
    path = write_video("a.ts", noise(6), options={"flags": "+ildct+ilme", "x264-params": "tff=1"})
    assert times(read(path)) == list(range(6))


def test_interlaced_ycgco(write_video, capsys):
    options = {"flags": "+ildct+ilme", "x264-params": "tff=1"}
    assert times(read(write_video("a.mkv", noise(6), options=options, colours=8))) == list(range(6))
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("name", "codec"), [("a.h264", "libx264"), ("a.hevc", "libx265"), ("a.mjpeg", "mjpeg")]
)
def test_a_stream_without_a_clock_takes_the_rate_of_the_user(write_video, capsys, name, codec):
    pixels, options = ("yuvj420p", {}) if codec == "mjpeg" else ("yuv420p", {"x265-params": "log-level=none"})
    path = write_video(name, noise(12), codec, pixels, options=options)
    assert [frame.time_s for frame in read(path, fps=10)] == [round(index / 10, 6) for index in range(12)]
    assert capsys.readouterr().err == (
        f"lightgesture: {path}: has no clock; taken for 10 frames a second (--fps)\n"
    )


@pytest.mark.parametrize("suffix", ["mp4", "mkv"])
def test_when_it_was_taken(write_video, suffix):
    path = write_video(f"a.{suffix}", noise(3), metadata={"creation_time": "2026-05-04T10:20:30Z"})
    with open_source(path) as source:
        assert source.start_utc == datetime(2026, 5, 4, 10, 20, 30, tzinfo=UTC)


def test_records_have_the_time_of_day(write_video, run):
    path = write_video("a.mp4", noise(4), metadata={"creation_time": "2026-05-04T10:20:30Z"})
    records = [json.loads(line) for line in run("decode", path, "--json", "--frames").out]
    assert [record["utc"] for record in records[:2]] == [
        "2026-05-04T10:20:30.000Z",
        "2026-05-04T10:20:30.033Z",
    ]
    assert records[-1]["utc"] == "2026-05-04T10:20:30.100Z"


@pytest.mark.parametrize(
    ("text", "moment"),
    [
        ("2026-05-04T12:20:30+02:00", datetime(2026, 5, 4, 10, 20, 30, tzinfo=UTC)),
        ("2026-05-04 10:20:30", datetime(2026, 5, 4, 10, 20, 30, tzinfo=UTC)),
        ("1970-01-01T00:00:00Z", None),
        ("1904-01-01T00:00:00Z", None),
        ("yesterday", None),
    ],
)
def test_times_of_day_as_cameras_write_them(text, moment):
    assert creation_time({"CREATION_TIME": text}) == moment
    assert creation_time({"title": text}) is None


def test_stamps_that_jump_back_by_a_day():
    clock = RecordingClock(None, 0.1)
    assert [clock.read(stamp) for stamp in (86_400.0, 86_400.1, 86_400.05)] == [0.0, 0.1, 0.05]
    assert (clock.read(3.0), clock.jump_s) == (0.15, pytest.approx(86_397.05))
    assert (clock.read(3.1), clock.jump_s) == (0.25, 0.0)
    assert (clock.read(None), clock.read(None, 3)) == (0.35, 0.65)


@pytest.mark.skipif(
    not Path("/proc/self/task").is_dir() or os.cpu_count() == 1, reason="threads cannot be told"
)
@pytest.mark.parametrize(("size", "is_threaded"), [((640, 480), False), ((640, 496), True)])
def test_threads_decode_large_frames_alone(write_video, size, is_threaded):
    """Each holds memory, and a frame back."""
    path = write_video("a.mp4", noise(3, size), "mpeg4")

    def decoders():
        names = [task.joinpath("comm").read_text() for task in Path("/proc/self/task").iterdir()]
        return sum(name.startswith("av:mpeg4") for name in names)

    before = decoders()
    with open_source(str(path)):
        assert (decoders() > before) == is_threaded
