"""Bags read from their first byte on, without their index: those whose recorder was killed, or that were cut off.

Three containers: bags of ROS 1 (wiki.ros.org/Bags/Format/2.0), MCAP (mcap.dev/spec) and SQLite, which ROS 2 writes. A
damaged chunk is left out, of one that is cut off all is taken that is there.
"""

import re
import sqlite3
import struct
from collections.abc import Iterator
from contextlib import closing
from io import BytesIO
from pathlib import Path
from typing import BinaryIO, Final, NamedTuple
from urllib.parse import quote

from lightgesture.sources.bag_messages import CDR, NANOSECONDS, ROS1
from lightgesture.sources.inflate import inflate

ROS1_MAGIC, MCAP_MAGIC, SQLITE_MAGIC = b"#ROSBAG V2.0\n", b"\x89MCAP0\r\n", b"SQLite format 3\0"

MAX_HEADER: Final = 1 << 20
"""Most bytes of the header of a record of ROS 1; a longer one is damage. Real ones hold a definition at most."""

MAX_RECORD: Final = 1 << 30
"""Likewise of a record: a chunk has some hundred thousand, a picture some million."""

_ROS1_MESSAGE, _ROS1_CHUNK, _ROS1_CONNECTION, _ROS1_END = 2, 5, 7, 6
_MCAP_FOOTER, _MCAP_SCHEMA, _MCAP_CHANNEL, _MCAP_MESSAGE, _MCAP_CHUNK = 2, 3, 4, 5, 6


class Channel(NamedTuple):
    """What messages of a bag have in common; written: as `bag_messages.read_message` takes it."""

    topic: str
    msgtype: str
    written: str


Message = tuple[Channel, int, bytes]
"""A message as it stands in a bag, with the nanoseconds at which it was recorded."""


UNCLOSED: Final = "was not closed by its recorder"
"""Why a file ends without the index that comes last, all its messages being whole."""


class ScanError(Exception):
    """Why no more of a bag can be read, after the last message that could be."""


def scan(path: Path) -> Iterator[Message]:
    """All messages of a file, in the order in which they stand in it. ScanError: it is cut off, damaged, or no bag."""
    try:
        with path.open("rb") as stream:
            magic = stream.read(len(SQLITE_MAGIC))
            if magic.startswith(ROS1_MAGIC):
                stream.seek(len(ROS1_MAGIC))
                yield from _Ros1().all(stream)
            elif magic.startswith(MCAP_MAGIC):
                stream.seek(len(MCAP_MAGIC))
                yield from _Mcap().all(stream)
            elif magic != SQLITE_MAGIC:
                raise ScanError("is no bag" if magic else "is empty")
        if magic == SQLITE_MAGIC:
            yield from _scan_sqlite(path)
    except OSError as error:
        raise ScanError(f"cannot be read ({error.strerror})") from None
    except (struct.error, KeyError, IndexError):
        raise ScanError("is damaged") from None


class _Records:
    """Records one after the other, some of which are chunks: compressed records."""

    def __init__(self) -> None:
        self._damaged = 0

    def all(self, stream: BinaryIO) -> Iterator[Message]:
        """The messages of a file. ScanError: that was not all."""
        yield from self.records(stream, is_chunk=False)
        if self._damaged:
            raise ScanError(f"is damaged in {self._damaged} place{'s' * (self._damaged > 1)}")

    def records(self, stream: BinaryIO, is_chunk: bool) -> Iterator[Message]:
        raise NotImplementedError

    def chunk(self, content: bytes, compression: str, size: int, is_cut: bool) -> Iterator[Message]:
        """The messages of a chunk that holds `size` bytes."""
        whole = inflate(content, compression)
        self._damaged += len(whole) < size and not is_cut
        try:
            yield from self.records(BytesIO(whole), is_chunk=True)
        except (ScanError, struct.error, KeyError, IndexError):
            self._damaged += len(whole) == size and not is_cut


class _Ros1(_Records):
    """Records of a header of named fields and their data."""

    def __init__(self) -> None:
        super().__init__()
        self._channels: dict[bytes, Channel] = {}

    def records(self, stream: BinaryIO, is_chunk: bool) -> Iterator[Message]:
        is_closed = is_chunk
        while header := stream.read(4):
            fields = self._fields(stream, header)
            data, is_cut = _block(stream, "<I")
            kind = fields.get(b"op", b"\0")[0]
            if kind == _ROS1_CHUNK and not is_chunk:
                compression = fields.get(b"compression", b"none").decode("ascii", "replace")
                (size,) = struct.unpack("<I", fields[b"size"])
                yield from self.chunk(data, compression, size, is_cut)
            if is_cut:
                raise ScanError("is cut off")
            if kind == _ROS1_CONNECTION:
                self._learn(fields, data)
            elif kind == _ROS1_MESSAGE and fields.get(b"conn") in self._channels:
                seconds, nanoseconds = struct.unpack("<II", fields[b"time"])
                yield self._channels[fields[b"conn"]], seconds * NANOSECONDS + nanoseconds, data
            is_closed = is_closed or kind == _ROS1_END
        if not is_closed:
            raise ScanError(UNCLOSED)

    def _fields(self, stream: BinaryIO, length: bytes) -> dict[bytes, bytes]:
        size = int.from_bytes(length, "little")
        header = stream.read(min(size, MAX_HEADER))
        if len(length) < 4 or size > MAX_HEADER or len(header) < size:
            raise ScanError("is cut off" if size <= MAX_HEADER else "is damaged")
        fields: dict[bytes, bytes] = {}
        place = 0
        while place + 4 <= len(header):
            size = int.from_bytes(header[place : place + 4], "little")
            name, _, value = header[place + 4 : place + 4 + size].partition(b"=")
            fields[name], place = value, place + 4 + size
        return fields

    def _learn(self, fields: dict[bytes, bytes], data: bytes) -> None:
        inner = self._fields(BytesIO(data), len(data).to_bytes(4, "little"))
        topic = re.sub("/+", "/", fields.get(b"topic", b"").decode("utf-8", "replace"))
        kind = inner.get(b"type", b"").decode("utf-8", "replace")
        self._channels[fields.get(b"conn", b"")] = Channel(topic, kind, ROS1)


class _Mcap(_Records):
    """Records of a kind, a length and their content."""

    def __init__(self) -> None:
        super().__init__()
        self._schemas: dict[int, str] = {}
        self._channels: dict[int, Channel] = {}

    def records(self, stream: BinaryIO, is_chunk: bool) -> Iterator[Message]:
        while kind := stream.read(1):
            if kind == b"\0":  # no kind of record
                raise ScanError("is damaged")
            content, is_cut = _block(stream, "<Q")
            if kind[0] == _MCAP_CHUNK and len(content) >= 40 and not is_chunk:
                (size,) = struct.unpack_from("<Q", content, 16)
                compression, place = _text(content, 28)
                yield from self.chunk(content[place + 8 :], compression, size, is_cut)
            if is_cut:
                raise ScanError("is cut off")
            if kind[0] == _MCAP_FOOTER:
                return
            if kind[0] == _MCAP_SCHEMA:
                self._schemas[int.from_bytes(content[:2], "little")] = _text(content, 2)[0]
            elif kind[0] == _MCAP_CHANNEL:
                number, schema = struct.unpack_from("<HH", content)
                topic, place = _text(content, 4)
                self._channels[number] = Channel(
                    topic, self._schemas.get(schema, ""), _text(content, place)[0]
                )
            elif kind[0] == _MCAP_MESSAGE and len(content) >= 22:
                number, _, recorded_ns = struct.unpack_from("<HIQ", content)
                if number in self._channels:
                    yield self._channels[number], recorded_ns, content[22:]
        if not is_chunk:
            raise ScanError(UNCLOSED)


def _block(stream: BinaryIO, code: str) -> tuple[bytes, bool]:
    """A length and so many bytes, or what is there of them, and whether that is not all."""
    length = stream.read(struct.calcsize(code))
    if len(length) < struct.calcsize(code):
        raise ScanError("is cut off")
    (size,) = struct.unpack(code, length)
    if size > MAX_RECORD:
        raise ScanError("is damaged")
    place = stream.tell()
    rest = stream.seek(0, 2) - place
    stream.seek(place)
    return stream.read(min(size, rest)), size > rest


def _text(content: bytes, place: int) -> tuple[str, int]:
    (length,) = struct.unpack_from("<I", content, place)
    end = place + 4 + length
    return content[place + 4 : end].decode("utf-8", "replace"), end


def _scan_sqlite(path: Path) -> Iterator[Message]:
    """Rows in the order in which they were written, until the first that lies in a page that is not there."""
    try:
        with closing(_connect(path)) as base:
            rows = base.execute("SELECT id, name, type, serialization_format FROM topics")
            channels = {
                number: Channel(topic, kind, CDR if written == "cdr" else str(written))
                for number, topic, kind, written in rows
            }
            for number, recorded_ns, data in base.execute(
                "SELECT topic_id, timestamp, data FROM messages ORDER BY id"
            ):
                if number in channels and isinstance(data, bytes):
                    yield channels[number], int(recorded_ns), data
    except sqlite3.Error as error:
        raise ScanError(f"is cut off or damaged ({error})") from None


def _connect(path: Path) -> sqlite3.Connection:
    # Read only; where no companion file may be made beside it, as it is.
    address = f"file:{quote(str(path.resolve()))}?mode=ro"
    for options in ("", "&immutable=1"):
        base = sqlite3.connect(address + options, uri=True, check_same_thread=False)
        try:
            # Without it SQLite opens no file that is shorter than its first page says.
            base.execute("PRAGMA writable_schema=ON")
            base.execute("SELECT count(*) FROM topics").fetchone()
            return base
        except sqlite3.Error:
            base.close()
            if options:
                raise
    raise AssertionError("unreachable")
