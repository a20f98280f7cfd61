"""Messages that hold a picture, from the bytes that a bag has of them: ROS 1, ROS 2 (CDR) and protocol buffers.

Their layouts are read here, so that a bag that lost its definitions, or has one among them that nobody can read, loses
no picture.
"""

import re
import struct
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

NANOSECONDS: Final = 1_000_000_000

ROS1, CDR, PROTOBUF = "ros1", "cdr", "protobuf"
"""How a message is written: by ROS 1, by ROS 2, as a protocol buffer."""

_HEADER, _FRAME = "header", (("stamp", "time"), ("frame_id", "text"))

_LAYOUTS: dict[str, tuple[tuple[str, str], ...]] = {
    "sensor_msgs/Image": (
        *((_HEADER, "header"), ("height", "u4"), ("width", "u4"), ("encoding", "text")),
        *(("is_bigendian", "u1"), ("step", "u4"), ("data", "bytes")),
    ),
    "sensor_msgs/CompressedImage": ((_HEADER, "header"), ("format", "text"), ("data", "bytes")),
    "foxglove/CompressedImage": (*_FRAME, ("data", "bytes"), ("format", "text")),
    "foxglove/CompressedVideo": (*_FRAME, ("data", "bytes"), ("format", "text")),
    "foxglove/RawImage": (
        *(*_FRAME, ("width", "u4"), ("height", "u4")),
        *(("encoding", "text"), ("step", "u4"), ("data", "bytes")),
    ),
    "ffmpeg_image_transport/FFMPEGPacket": (
        *((_HEADER, "header"), ("width", "u4"), ("height", "u4"), ("format", "text")),
        *(("pts", "u8"), ("flags", "u1"), ("is_bigendian", "u1"), ("data", "bytes")),
    ),
}
"""Message to its fields in order, and what each is; the encoding of a packet is its `format`."""

_NUMBERS: dict[str, dict[int, str]] = {
    "foxglove/CompressedImage": {1: "stamp", 2: "data", 3: "format"},
    "foxglove/CompressedVideo": {1: "stamp", 3: "data", 4: "format"},
    "foxglove/RawImage": {1: "stamp", 2: "width", 3: "height", 4: "encoding", 5: "step", 6: "data"},
}
"""Likewise the numbers of the fields of a protocol buffer."""

VARINT_BITS: Final = 70
"""Of the longest whole number of a protocol buffer, ten bytes of seven each."""

_PACKETS = ("foxglove/CompressedVideo", "ffmpeg_image_transport/FFMPEGPacket")
_SIZES = {"u1": "B", "u4": "I", "u8": "Q"}


@dataclass(slots=True)
class PictureMessage:
    """A message that holds a picture, or a piece of a video.

    stamp_ns: nanoseconds of its header, 0 where it has none. data: uint8 (n,). format: of a compressed picture or a
    packet, None for raw pixels, which `height`, `width`, `step` (bytes of a row), `encoding` and `is_bigendian`
    describe.
    """

    stamp_ns: int = 0
    data: NDArray[np.uint8] = field(default_factory=lambda: np.zeros(0, np.uint8))
    format: str | None = None
    height: int = 0
    width: int = 0
    step: int = 0
    encoding: str = ""
    is_bigendian: int = 0


def picture_type(name: str) -> str | None:
    """The layout of a type of messages by its name in any bag, None where it holds no picture."""
    words = re.split(r"[/.:]+", name)
    package = words[0].removesuffix("_msgs") if words[0] != "sensor_msgs" else words[0]
    kind = f"{package}/{words[-1]}"
    return kind if kind in _LAYOUTS else None


def is_packet(kind: str, message: PictureMessage) -> bool:
    """Whether a message holds a piece of a video, that its own picture is not whole in."""
    return kind in _PACKETS or (message.format or "").lower().startswith(("h264", "h265", "hevc"))


def read_message(kind: str, content: bytes, written: str) -> PictureMessage:
    """A message of `picture_type` kind. ValueError: the bytes are none, or are cut off."""
    try:
        if written == PROTOBUF:
            return _message(_read_protobuf(kind, content))
        return _message(_read_fields(kind, content, written))
    except (struct.error, IndexError, KeyError) as error:
        raise ValueError(f"cannot be read ({error})") from None


def _message(fields: dict[str, Any]) -> PictureMessage:
    known = {name: value for name, value in fields.items() if name in PictureMessage.__dataclass_fields__}
    return PictureMessage(stamp_ns=fields.get("stamp", 0), **known)


class _Bytes:
    """Reads the fields of ROS 1, and with `aligned` those of CDR, whose numbers stand at multiples of their size."""

    def __init__(self, content: bytes, place: int, order: str, aligned: bool) -> None:
        self._content, self._start, self._place = content, place, place
        self._order, self._aligned = order, aligned

    def number(self, code: str) -> int:
        size = struct.calcsize(code)
        if self._aligned:
            self._place += -(self._place - self._start) % size
        (value,) = struct.unpack_from(self._order + code, self._content, self._place)
        self._place += size
        return int(value)

    def block(self) -> memoryview:
        length = self.number("I")
        start, self._place = self._place, self._place + length
        if self._place > len(self._content):
            raise ValueError(f"is cut off, {len(self._content)} bytes of {self._place}")
        return memoryview(self._content)[start : self._place]

    def value(self, what: str) -> Any:
        match what:
            case "time":
                return self.number("I") * NANOSECONDS + self.number("I")
            case "text":
                return bytes(self.block()).rstrip(b"\0").decode("utf-8", "replace")
            case "bytes":
                return np.frombuffer(self.block(), np.uint8)
        return self.number(_SIZES[what])


def _read_fields(kind: str, content: bytes, written: str) -> dict[str, Any]:
    if written == CDR:
        reader = _Bytes(content, 4, "<" if content[1] & 1 else ">", aligned=True)
    else:
        reader = _Bytes(content, 0, "<", aligned=False)
    fields: dict[str, Any] = {}
    for name, what in _LAYOUTS[kind]:
        if what != "header":
            fields[name] = reader.value(what)
            continue
        if written == ROS1:
            reader.number("I")  # counts the messages
        fields |= {inner: reader.value(of) for inner, of in _FRAME}
    return fields


def _read_protobuf(kind: str, content: bytes) -> dict[str, Any]:
    """Fields by their numbers; a time is a message of its own: seconds, then nanoseconds."""
    names, kinds = _NUMBERS[kind], dict(_LAYOUTS[kind])
    fields: dict[str, Any] = {}
    for number, value in _numbered(content):
        name = names.get(number)
        if name is None:
            continue
        what = kinds[name]
        # A field of another kind than its name has: a number in the place of bytes would be taken for their count.
        if isinstance(value, int) != (what in _SIZES):
            raise ValueError(f"cannot be read ({name} is of another kind)")
        if what == "time":
            seconds, rest = (_whole(dict(_numbered(bytes(value))), part) for part in (1, 2))
            fields[name] = seconds * NANOSECONDS + rest
        elif what == "bytes":
            fields[name] = np.frombuffer(value, np.uint8)
        else:
            fields[name] = value if isinstance(value, int) else bytes(value).decode("utf-8", "replace")
    return fields


def _whole(parts: dict[int, Any], number: int) -> int:
    """A whole number of a message, 0 where it stands not there."""
    value = parts.get(number, 0)
    if not isinstance(value, int):
        raise ValueError("cannot be read (its time is no number)")
    return value


def _numbered(content: bytes) -> list[tuple[int, Any]]:
    """Number and value of each field: a whole number, or the bytes of anything else."""
    found: list[tuple[int, Any]] = []
    place = 0
    while place < len(content):
        key, place = _varint(content, place)
        value: Any
        match key & 7:
            case 0:
                value, place = _varint(content, place)
            case 2:
                length, place = _varint(content, place)
                value, place = memoryview(content)[place : place + length], place + length
                if place > len(content):
                    raise ValueError(f"is cut off, {len(content)} bytes of {place}")
            case 1 | 5 as width:
                size = 8 if width == 1 else 4
                value, place = int.from_bytes(content[place : place + size], "little"), place + size
            case other:
                raise ValueError(f"cannot be read (field of kind {other})")
        found.append((key >> 3, value))
    return found


def _varint(content: bytes, place: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = content[place]
        place += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, place
        shift += 7
        if shift >= VARINT_BITS:
            raise ValueError("cannot be read (a number has no end)")
