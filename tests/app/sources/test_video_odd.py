"""Videos that are cut off, odd, tiny, or no videos at all."""

import gc
import os
import threading
import weakref
from contextlib import suppress

import av
import numpy as np
import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.errors import ExitStatus, InputError
from lightgesture.sources import open_source
from lightgesture.sources.file_size import is_cut_off
from tests.app.sources.video_makers import read, times

from .conftest import noise


def test_a_picture_of_another_size_between_is_a_gap(tmp_path, write_video):
    parts = [
        write_video(f"{number}.h264", noise(8, size)) for number, size in enumerate([(64, 48), (96, 64)])
    ]
    path = tmp_path / "both.h264"
    path.write_bytes(b"".join(part.read_bytes() for part in (parts[0], parts[1], parts[0])))
    frames = read(path)
    assert [(frame.index, frame.gap) for frame in frames if frame.gap] == [
        (8, "the picture changes from 64 x 48 to 96 x 64"),
        (16, "the picture changes from 96 x 64 to 64 x 48"),
    ]


@pytest.mark.parametrize("suffix", ["avi", "mkv", "mov", "mp4"])
def test_a_file_that_was_cut_off(write_video, suffix):
    path = write_video(f"a.{suffix}", noise(60), "mjpeg", "yuvj420p", movflags="faststart")
    assert not is_cut_off(str(path))
    content = path.read_bytes()
    path.write_bytes(content[: len(content) * 2 // 3])
    assert is_cut_off(str(path))
    frames = []
    with open_source(path) as source, pytest.raises(InputError, match=r"ends early, after \d\d of 60 frames"):
        frames.extend(source)
    assert 30 < len(frames) < 50


def test_a_file_that_lost_only_its_index_is_whole(write_video):
    path = write_video("a.avi", noise(30), "mjpeg", "yuvj420p")
    path.write_bytes(path.read_bytes()[:-100])
    assert is_cut_off(str(path))
    assert len(read(path)) == 30


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"RIFF",
        b"\0\0\0\x10ftyp",
        b"\0\0\0\1ftyp" + bytes(4),
        b"\x1aE\xdf\xa3",
        b"\x1aE\xdf\xa3\0",
        b"\x1aE\xdf\xa3\x80\x18S\x80g\x01" + b"\xff" * 7,
        bytes(99),
    ],
)
def test_headers_of_any_length_are_endured(tmp_path, content):
    path = tmp_path / "a.mp4"
    path.write_bytes(content)
    with suppress(IndexError):
        assert is_cut_off(str(path)) in (True, False)
    with pytest.raises(InputError):
        open_source(path)


def test_a_file_that_grows_while_it_is_read(write_video):
    path = write_video("a.ts", noise(90))
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    frames = []
    with open_source(path) as source:
        pictures = iter(source)
        frames.append(next(pictures))
        path.write_bytes(content)
        with pytest.raises(InputError, match="is still being written"):
            frames.extend(pictures)
    assert len(frames) > 30


def test_a_pipe_is_sent_to_standard_input(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match=r"is a pipe; send pictures to standard input"):
        open_source(tmp_path / "pipe")


def test_raw_video_whose_pixels_look_like_text(write_video):
    path = write_video("a.y4m", [np.full((48, 64, 3), 90, np.uint8)] * 3, "wrapped_avframe")
    assert times(read(path)) == [0, 1, 2]


def test_a_header_without_a_size(write_video):
    path = write_video("a.avi", noise(9), "mjpeg", "yuvj420p")
    content = bytearray(path.read_bytes())
    for name, place in ((b"avih", 40), (b"strf", 12)):
        start = content.find(name) + place
        content[start : start + 8] = bytes(8)
    path.write_bytes(content)
    frames = read(path)
    assert (len(frames), frames[0].image.shape) == (9, (48, 64, 3))


def test_a_picture_of_one_row(write_video, run):
    wide = np.tile(noise(1)[0][:1], (1, 1563, 1))[:, :100_000]
    result = run("decode", write_video("a.mkv", [wide] * 2, "ffv1", "bgr0"))
    assert (result.status, result.err) == (ExitStatus.OK, [])


def test_a_video_of_one_frame(write_video, run):
    result = run("decode", write_video("a.mp4", noise(1)))
    assert (result.status, result.err) == (ExitStatus.OK, [])
    assert "1 frame in 0.00 s" in result.out[-1]


def test_sound_alone(tmp_path):
    path = tmp_path / "a.wav"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("pcm_s16le", rate=48_000)
        frame = av.AudioFrame.from_ndarray(np.zeros((1, 4800), np.int16), format="s16", layout="mono")
        frame.sample_rate = 48_000
        container.mux([*stream.encode(frame), *stream.encode(None)])
    with pytest.raises(InputError, match="holds no pictures"):
        open_source(path)


def test_sources_of_several_threads(write_video):
    path, found = write_video("a.mp4", noise(20)), []
    threads = [threading.Thread(target=lambda: found.append(len(read(path)))) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [20] * 3


def test_a_video_that_was_read_is_given_back_at_once():
    """Not when Python collects what hangs in circles: by then the decoders of many videos would fill the memory."""
    gc.disable()
    try:
        with open_source(str(SAMPLE)) as source:
            next(iter(source))
        left = weakref.ref(source)
        del source
        assert left() is None
    finally:
        gc.enable()
