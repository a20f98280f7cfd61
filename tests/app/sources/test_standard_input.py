"""Pictures from standard input, all of them or as they come."""

import io
import subprocess
import sys

import cv2
import numpy as np
import pytest

from lightgesture.errors import InputError
from lightgesture.sources import SourceOptions, open_source, to_image
from lightgesture.sources.standard_input import StandardInput, StandardInputStream

IMAGE = np.full((48, 64, 3), (10, 120, 240), np.uint8)
JPEG = cv2.imencode(".jpg", IMAGE)[1].tobytes()


def read(content, kind=StandardInput, **options):
    with kind(SourceOptions(**options), stream=io.BytesIO(content)) as source:
        return list(source)


def test_jpegs_in_time_steps():
    frames = read(JPEG * 3, fps=20)
    assert [(frame.index, frame.time_s) for frame in frames] == [(0, 0.0), (1, 0.05), (2, 0.1)]
    assert all(np.abs(frame.image.astype(int) - IMAGE).max() < 8 for frame in frames)


def test_raw_pictures():
    frames = read(IMAGE.tobytes() * 2 + b"a rest", size=(64, 48))
    assert len(frames) == 2
    assert all(np.array_equal(frame.image, IMAGE) for frame in frames)


def test_live_jpegs_stay_encoded():
    contents = read(JPEG * 2, StandardInputStream)
    assert contents == [JPEG, JPEG]
    assert to_image(contents[0]).shape == (48, 64, 3)


@pytest.mark.parametrize("content", [b"", b"some words", JPEG[:-9]])
@pytest.mark.parametrize("kind", [StandardInput, StandardInputStream])
def test_no_picture_at_all(content, kind):
    with pytest.raises(InputError, match="standard input: held no whole JPEG picture; send MJPEG"):
        read(content, kind)
    with pytest.raises(InputError, match="held no whole raw picture of 64x48"):
        read(content, kind, size=(64, 48))


def test_a_damaged_picture_is_left_out():
    damaged = b"\xff\xd8\xff\xdb\x00\x09aaaaaaa\xff\xda\x00\x04aaaa\xff\xd9"
    frames = []
    with pytest.raises(InputError, match="1 pictures left out; the first: picture 1 is damaged"):
        frames.extend(StandardInput(SourceOptions(), stream=io.BytesIO(JPEG + damaged + JPEG)))
    assert [frame.index for frame in frames] == [0, 2]


def test_the_name_of_standard_input_opens_it(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(JPEG)))
    with open_source("-") as source:
        assert (source.name, source.frame_count, len(list(source))) == ("-", None, 1)


def test_a_picture_is_given_as_soon_as_it_is_whole():
    """A pipe that stays open: a reader that waited for more than the picture would wait for ever."""
    code = (
        "from lightgesture.sources import SourceOptions, live_source\n"
        "for content in live_source('-', SourceOptions()): print(len(content), flush=True)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as child:
        child.stdin.write(JPEG)
        child.stdin.flush()
        assert child.stdout.readline() == f"{len(JPEG)}\n".encode()
        child.stdin.close()
        assert child.wait(10) == 0


@pytest.mark.parametrize(
    ("between", "is_gap"), [(bytes(20_000), False), (b"\r\n--frame\r\n" * 9, False), (b"\x47ts" * 9000, True)]
)
def test_something_else_between_two_pictures_is_a_gap(between, is_gap):
    picture = cv2.imencode(".jpg", np.full((16, 16, 3), 90, np.uint8))[1].tobytes()
    content = io.BytesIO(picture * 2 + between + picture * 2)
    with StandardInput(SourceOptions(fps=10), content) as source:
        frames = list(source)
    assert [frame.time_s for frame in frames] == [0.0, 0.1, 0.2, 0.3]
    assert [frame.gap for frame in frames] == [
        None,
        None,
        "27000 bytes are no picture" if is_gap else None,
        None,
    ]
