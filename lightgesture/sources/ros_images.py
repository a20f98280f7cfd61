"""Image messages of ROS 1 and ROS 2, raw and compressed, to pictures."""

import sys
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.image import BitDepth
from lightgesture.features.types import Image
from lightgesture.sources.pictures import decode_picture


@dataclass(frozen=True, slots=True)
class _Layout:
    """Bits and values of a pixel in a row, and what OpenCV makes BGR with (None: BGR, BGRA or grey already)."""

    bits: int
    channels: int
    conversion: int | None = None
    rows: float = 1.0
    """Rows of bytes for each row of pixels."""


_MOSAICS = {
    "rggb": cv2.COLOR_BayerBG2BGR,
    "bggr": cv2.COLOR_BayerRG2BGR,
    "gbrg": cv2.COLOR_BayerGR2BGR,
    "grbg": cv2.COLOR_BayerGB2BGR,
}
"""ROS names the first two pixels of the first row, OpenCV those of the second row from the second column."""

_LAYOUTS = {
    **{name: _Layout(8, 1) for name in ("mono8", "8UC1")},
    **{name: _Layout(16, 1) for name in ("mono16", "16UC1")},
    **{name: _Layout(8, 3) for name in ("bgr8", "8UC3")},
    **{name: _Layout(8, 4) for name in ("bgra8", "8UC4")},
    "rgb8": _Layout(8, 3, cv2.COLOR_RGB2BGR),
    "rgba8": _Layout(8, 4, cv2.COLOR_RGBA2BGR),
    "bgr16": _Layout(16, 3),
    "rgb16": _Layout(16, 3, cv2.COLOR_RGB2BGR),
    **{name: _Layout(8, 2, cv2.COLOR_YUV2BGR_UYVY) for name in ("uyvy", "yuv422")},
    **{name: _Layout(8, 2, cv2.COLOR_YUV2BGR_YUYV) for name in ("yuyv", "yuv422_yuy2")},
    **{f"bayer_{name}{bits}": _Layout(bits, 1, code) for name, code in _MOSAICS.items() for bits in (8, 16)},
    # All brightnesses, then the colours of two by two pixels each.
    "nv12": _Layout(8, 1, cv2.COLOR_YUV2BGR_NV12, rows=1.5),
    "nv21": _Layout(8, 1, cv2.COLOR_YUV2BGR_NV21, rows=1.5),
}


def message_to_bgr8(message: Any, depth: BitDepth) -> Image:
    """Convert a deserialized message, raw or compressed, to uint8 (height, width, 3), BGR.

    depth: of the topic, for "mono16" says how wide a value is stored and not how much of it the camera fills.
    ValueError: its encoding is not known, its data are too short, or it is no picture.
    """
    if getattr(message, "format", None) is None:
        return depth.bgr8(_unpack(message))
    image = decode_picture(message.data)
    if image is None:
        raise ValueError(f"holds no picture (format {message.format!r})")
    return depth.bgr8(image)


def _unpack(message: Any) -> NDArray[Any]:
    layout = _LAYOUTS.get(message.encoding)
    if layout is None:
        raise ValueError(f"has encoding {message.encoding!r}, known are {', '.join(_LAYOUTS)}")
    height, width, step = int(message.height), int(message.width), int(message.step)
    row = width * layout.channels * layout.bits // 8
    data = np.frombuffer(message.data, np.uint8)
    if layout.rows != 1.0 and (width % 2 or height % 2):
        raise ValueError(f"has {width} x {height} pixels, and {message.encoding} needs even numbers")
    lines = round(height * layout.rows)
    if not row or not lines or step < row or data.size < lines * step:
        raise ValueError(f"holds {data.size} bytes, too few for {width} x {height} {message.encoding}")
    rows = np.ascontiguousarray(data[: lines * step].reshape(lines, step)[:, :row])
    if layout.bits == 16:
        is_swapped = bool(message.is_bigendian) != (sys.byteorder == "big")
        values: NDArray[Any] = rows.view(np.uint16)
        rows = values.byteswap() if is_swapped else values
    shape = (lines, width) if layout.channels == 1 else (lines, width, layout.channels)
    image: NDArray[Any] = rows.reshape(shape)
    return image if layout.conversion is None else cv2.cvtColor(image, layout.conversion)
