"""JPEG files cut out of a stream."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.sources import to_image
from lightgesture.sources.jpeg import JpegSplitter


def jpeg(value=0, size=(48, 64), *, progressive=False):
    image = np.random.default_rng(value).integers(0, 256, (*size, 3), np.uint8)
    flags = [cv2.IMWRITE_JPEG_PROGRESSIVE, int(progressive), cv2.IMWRITE_JPEG_RST_INTERVAL, 2 * progressive]
    return cv2.imencode(".jpg", image, flags)[1].tobytes()


def with_thumbnail(content):
    """The file with a whole file inside its first segment, as EXIF has it."""
    inner = jpeg(9, (8, 8))
    return content[:2] + b"\xff\xe1" + (len(inner) + 2).to_bytes(2, "big") + inner + content[2:]


def split(stream, step=None, **limits):
    splitter = JpegSplitter(**{"max_bytes": 1 << 20, "max_pixels": 1 << 20, **limits})
    step = step or len(stream)
    return [
        file for start in range(0, len(stream), step) for file in splitter.feed(stream[start : start + step])
    ]


FILES = [jpeg(1), jpeg(2, progressive=True), with_thumbnail(jpeg(3)), jpeg(4, (9, 7))]


@pytest.mark.parametrize("step", [1, 2, 7, 1000, None])
def test_files_come_out_as_they_went_in(step):
    stream = b"".join(b"--frame\r\nContent-Length: 7\r\n\r\n" + file + b"\r\n" for file in FILES)
    assert split(stream, step) == FILES


@settings(max_examples=25, deadline=None)
@given(noise=st.binary(max_size=300), step=st.integers(1, 500))
def test_noise_before_a_file_costs_no_more_than_one(noise, step):
    found = split(noise + FILES[0] + FILES[1] + FILES[3] * 3, step)
    assert found[-2:] == [FILES[3]] * 2


def test_a_file_that_is_cut_off_is_left_out():
    assert split(FILES[0][:-500] + FILES[1]) == [FILES[1]]
    assert split(FILES[0][:30] + FILES[1] + FILES[3])[-1] == FILES[3]


def test_a_camera_that_never_sends_the_mark_of_the_end():
    part = b"\r\n--frame\r\nContent-Type: image/jpeg\r\n\r\n"
    found = split(b"".join(FILES[0][:-2] + part for _ in range(8)))
    assert len(found) == 4
    pictures = [to_image(file) for file in found]
    assert all(np.array_equal(picture, to_image(FILES[0])) for picture in pictures)
    assert split(FILES[0] + b"".join(FILES[1][: 600 + n] for n in range(8)) + FILES[3]) == [
        FILES[0],
        FILES[3],
    ]


@pytest.mark.parametrize("file", [FILES[0], FILES[2], jpeg(5, (40, 30))])
def test_files_without_tables_have_the_usual_ones(file):
    bare, place = bytearray(file[:2]), 2
    while file[place + 1] != 0xDA:
        end = place + 2 + int.from_bytes(file[place + 2 : place + 4], "big")
        bare += b"" if file[place + 1] == 0xC4 else file[place:end]
        place = end
    bare += file[place:]
    assert len(bare) < len(file) - 400
    assert np.array_equal(to_image(bytes(bare)), to_image(file))


def test_too_many_bytes_or_pixels_are_left_out():
    assert split(FILES[0] + FILES[3], step=64, max_bytes=len(FILES[0]) - 200) == [FILES[3]]
    assert split(FILES[0] + FILES[3], max_pixels=63) == [FILES[3]]


def test_memory_is_bounded():
    splitter = JpegSplitter(max_bytes=10_000, max_pixels=1 << 20)
    endless = FILES[0][:-2]
    for _ in range(50):
        assert splitter.feed(endless[:2] + b"\xff\xfe\xff\xff" + b"a" * 4000) == []
        assert splitter.held <= 10_000
