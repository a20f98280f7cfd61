"""Encodings of image messages."""

from types import SimpleNamespace

import cv2
import numpy as np
import pytest

from lightgesture.features.image import BitDepth
from lightgesture.sources.ros_images import message_to_bgr8

GREY = np.arange(48, dtype=np.uint8).reshape(6, 8) * 5
BGR = np.dstack([GREY, 255 - GREY, np.full_like(GREY, 77)])
FLAT = np.full((8, 8, 3), (40, 120, 200), np.uint8)


def to_bgr8(content, depth=None):
    return message_to_bgr8(content, depth or BitDepth(pytest.fail))


def message(values, encoding, **changes):
    values = np.ascontiguousarray(values)
    data = values.reshape(values.shape[0], -1).view(np.uint8)
    fields = {"height": values.shape[0], "width": values.shape[1], "encoding": encoding, "is_bigendian": 0}
    return SimpleNamespace(**{**fields, "step": data.shape[1], "data": data.ravel(), **changes})


@pytest.mark.parametrize(
    ("values", "encoding", "expected"),
    [
        (BGR, "bgr8", BGR),
        (BGR, "8UC3", BGR),
        (BGR[..., ::-1], "rgb8", BGR),
        (np.dstack([BGR, GREY]), "bgra8", BGR),
        (np.dstack([BGR[..., ::-1], GREY]), "rgba8", BGR),
        (GREY, "mono8", np.dstack([GREY] * 3)),
        (GREY.astype(np.uint16) * 257, "mono16", np.dstack([GREY] * 3)),
        (BGR.astype(np.uint16) * 257, "bgr16", BGR),
    ],
)
def test_encodings(values, encoding, expected):
    assert np.abs(to_bgr8(message(values, encoding)).astype(int) - expected).max() <= 6


def test_big_endian():
    values = GREY.astype(">u2") * 257
    picture = to_bgr8(message(values.view(np.uint16), "mono16", is_bigendian=1))
    assert np.abs(picture[..., 0].astype(int) - GREY).max() <= 6


@pytest.mark.parametrize(("encoding", "order"), [("yuv422", "UYVY"), ("yuv422_yuy2", "YUYV")])
def test_half_the_colours(encoding, order):
    y, u, v = cv2.cvtColor(FLAT, cv2.COLOR_BGR2YUV)[0, 0]
    y = np.uint8(round(16 + int(y) * 219 / 255))  # video levels
    pairs = {"UYVY": [u, y, v, y], "YUYV": [y, u, y, v]}[order]
    values = np.tile(np.array(pairs, np.uint8), (8, 4)).reshape(8, 8, 2)
    assert np.abs(to_bgr8(message(values, encoding)).astype(int) - FLAT).max() <= 40


@pytest.mark.parametrize("tile", ["rggb", "bggr", "gbrg", "grbg"])
@pytest.mark.parametrize("bits", [8, 10, 12, 16])
def test_mosaics(tile, bits):
    value = dict(zip("bgr", FLAT[0, 0].tolist(), strict=True))
    mosaic = np.tile(np.array([value[name] for name in tile], np.uint16).reshape(2, 2), (4, 4))
    if bits == 8:
        assert np.array_equal(to_bgr8(message(mosaic.astype(np.uint8), f"bayer_{tile}8")), FLAT)
    else:
        depth = BitDepth(pytest.fail, bits)
        assert np.array_equal(to_bgr8(message(mosaic << bits - 8, f"bayer_{tile}16"), depth), FLAT)


@pytest.mark.parametrize(("encoding", "order"), [("nv12", (0, 1)), ("nv21", (1, 0))])
@pytest.mark.parametrize("padding", [0, 8])
def test_colours_of_two_by_two_pixels(encoding, order, padding):
    planes = cv2.cvtColor(FLAT, cv2.COLOR_BGR2YUV_I420).reshape(-1)
    colours = np.stack([planes[64:80], planes[80:96]], axis=1)[:, order].reshape(4, 8)
    rows = np.pad(np.concatenate([planes[:64].reshape(8, 8), colours]), ((0, 0), (0, padding)))
    sent = SimpleNamespace(
        height=8, width=8, step=8 + padding, encoding=encoding, is_bigendian=0, data=rows.ravel()
    )
    assert np.abs(to_bgr8(sent).astype(int) - FLAT).max() <= 3
    sent.data = sent.data[:-9]
    with pytest.raises(ValueError, match="too few for 8 x 8"):
        to_bgr8(sent)
    sent.width = 7
    with pytest.raises(ValueError, match=f"has 7 x 8 pixels, and {encoding} needs even numbers"):
        to_bgr8(sent)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"encoding": "32FC1"}, "has encoding '32FC1', known are mono8"),
        ({"height": 7}, "holds 144 bytes, too few for 8 x 7 bgr8"),
        ({"step": 20}, "too few"),
        ({"width": 0}, "too few"),
    ],
)
def test_messages_that_do_not_fit(changes, reason):
    with pytest.raises(ValueError, match=reason):
        to_bgr8(message(BGR, changes.pop("encoding", "bgr8"), **changes))


def test_a_compressed_picture_and_none():
    fields = {"format": "jpeg", "data": cv2.imencode(".png", BGR)[1].ravel()}
    assert np.array_equal(to_bgr8(SimpleNamespace(**fields)), BGR)
    for data in (np.zeros(0, np.uint8), np.zeros(90, np.uint8)):
        with pytest.raises(ValueError, match="holds no picture"):
            to_bgr8(SimpleNamespace(format="jpeg", data=data))


def test_a_topic_has_one_bit_depth():
    depth = BitDepth(pytest.fail)
    for level in (4095, 1000, 255, 0):
        picture = to_bgr8(message(np.full((4, 4), level, np.uint16), "mono16"), depth)
        assert picture[0, 0].tolist() == [level >> 4] * 3
