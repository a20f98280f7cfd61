"""A stream as frames: their times, damaged pictures, and an end that is always told."""

from itertools import count

import cv2
import numpy as np
import pytest

from lightgesture.errors import InputError, UsageError
from lightgesture.sources import LiveSource, SourceOptions, StreamFrames, open_any
from lightgesture.sources.video import VideoFile

PICTURE = np.zeros((48, 64, 3), np.uint8)
JPEG = cv2.imencode(".jpg", PICTURE)[1].tobytes()
DAMAGED = JPEG[:40]


class Stream(LiveSource):
    """Gives what it was made of, then ends."""

    name = "camera"

    def __init__(self, contents):
        self.contents, self.is_open = contents, False

    def __enter__(self):
        self.is_open = True
        return self

    def close(self):
        self.is_open = False

    def __iter__(self):
        return iter(self.contents)


def ticking(step_s=1.5):
    """A clock that moves on whenever it is read."""
    ticks = count(100)
    return lambda: next(ticks) * step_s


def test_times_are_those_of_coming_and_damaged_pictures_are_passed_over():
    stream = Stream([DAMAGED, JPEG, PICTURE, DAMAGED, JPEG])
    frames = []
    with StreamFrames(stream, clock=ticking()) as source:
        assert stream.is_open
        with pytest.raises(InputError, match=r"^camera: the stream ended after 3 pictures$"):
            frames.extend((frame.index, frame.time_s, frame.image.shape) for frame in source)
    assert not stream.is_open
    assert frames == [(1, 0.0, PICTURE.shape), (2, 1.5, PICTURE.shape), (4, 4.5, PICTURE.shape)]


def test_pictures_that_are_all_damaged_end_it():
    contents = (DAMAGED for _ in count())
    frames = StreamFrames(Stream(contents), ticking())
    with (
        frames,
        pytest.raises(InputError, match="camera: sends pictures, but for 10 s none that can be decoded"),
    ):
        next(iter(frames))


def test_recordings_before_streams(make_video, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    make_video("0.avi").rename("0")
    with open_any("0", SourceOptions()) as source:
        assert isinstance(source, VideoFile)
    for name in ("1", "/dev/video7", "http://camera/", "rtsp://camera/"):
        assert isinstance(open_any(name, SourceOptions()), StreamFrames)
    with pytest.raises(UsageError, match="is no stream"):
        open_any("gopher://camera/", SourceOptions())
    with pytest.raises(InputError, match="no such file"):
        open_any("missing", SourceOptions())
