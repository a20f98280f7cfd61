"""ROS 1 bags, ROS 2 bags and MCAP files: the pictures of one topic."""

import os
from collections.abc import Iterator
from contextlib import suppress
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from lightgesture.config import DEFAULT_FPS
from lightgesture.errors import InputError
from lightgesture.frames import Frame
from lightgesture.sources.clock import FIRST_YEAR, RecordingClock
from lightgesture.sources.pictures import depth_of
from lightgesture.sources.ros_images import IMAGE_TYPES, message_to_bgr8
from lightgesture.sources.types import Source

if TYPE_CHECKING:
    from rosbags.highlevel import AnyReader
    from rosbags.interfaces import Connection

_SUFFIXES = (".bag", ".mcap", ".db3")
_METADATA, _METADATA_KEY, _METADATA_BYTES = "metadata.yaml", b"rosbag2_bagfile_information", 4096
_NANOSECONDS = 1_000_000_000

CLOCK_MESSAGES: Final = 10
"""Messages whose headers decide upon a bag's clock."""


def is_bag(path: str) -> bool:
    """Whether the name is that of a bag: a file's by its ending, a folder's by the metadata in it."""
    if os.path.isdir(path):
        return _is_metadata(os.path.join(path, _METADATA))
    return os.path.isfile(path) and path.lower().endswith(_SUFFIXES)


def _is_metadata(path: str) -> bool:
    """Whether it is the metadata of a bag; other programs have files of that name too."""
    try:
        with open(path, "rb") as stream:
            return _METADATA_KEY in stream.read(_METADATA_BYTES)
    except OSError:
        return False


class BagFile(Source):
    """The images of one topic of a bag, in the order in which they were recorded.

    topic: its name; None takes the only image topic there is. A bag has one clock, counted from the first message:
    that of the messages' headers, or, where one of the first headers has none, that of the recording. start_utc: its
    start, by the recording where headers have the time of a simulation. Messages that hold no picture are left out;
    after the last one InputError tells how many. InputError when opened: no bag, no such topic, no image topic or
    several of them.
    """

    def __init__(self, path: str, topic: str | None = None) -> None:
        self.name = path
        self._reader = _open(path)
        try:
            self._connections = _choose(self._reader, path, topic)
        except InputError:
            self._reader.close()
            raise
        self.frame_count = sum(one.msgcount for one in self._connections)
        self._has_stamps, self._start_ns, self.start_utc = self._find_clock()

    def close(self) -> None:
        """Close the bag."""
        self._reader.close()

    def __iter__(self) -> Iterator[Frame]:
        left_out: list[str] = []
        depth = depth_of(self.name)
        clock = RecordingClock(0.0, 1 / DEFAULT_FPS)
        last: tuple[int, int] | None = None
        before = -1
        for index, (connection, recorded_ns, data) in enumerate(self._messages()):
            try:
                message = self._deserialize(connection, data)
                image = message_to_bgr8(message, depth)
            except ValueError as error:
                left_out.append(f"message {index} {error}")
                continue
            time_ns = _stamp(message) if self._has_stamps else recorded_ns
            if time_ns == 0 and last is not None:  # a header without a stamp among others
                time_ns = last[0] + recorded_ns - last[1]
            last = time_ns, recorded_ns
            time_s = clock.read((time_ns - self._start_ns) / _NANOSECONDS, index - before)
            before = index
            gap = f"the time stamps jump back by {clock.jump_s:g} s" if clock.jump_s else None
            yield Frame(image, index, time_s, gap)
        if left_out:
            raise InputError(
                f"{self.name}: {len(left_out)} of {self.frame_count} messages left out; the first: {left_out[0]}"
            )

    def _find_clock(self) -> tuple[bool, int, datetime | None]:
        """Whether the headers have a clock, the nanoseconds of its start, and the moment of that."""
        stamps: list[tuple[int, int]] = []
        with suppress(InputError):  # of a damaged bag, which is told where the damage is
            for connection, recorded_ns, data in islice(self._messages(), CLOCK_MESSAGES):
                with suppress(ValueError):
                    stamps.append((_stamp(self._deserialize(connection, data)), recorded_ns))
        if not stamps:
            return False, 0, None
        has_stamps = all(stamp for stamp, _ in stamps)
        first = stamps[0] if has_stamps else stamps[0][::-1]
        return has_stamps, first[0], next((moment for moment in map(_moment, first) if moment), None)

    def _messages(self) -> Iterator[tuple["Connection", int, bytes]]:
        try:
            yield from self._reader.messages(self._connections)
        except Exception as error:  # the reader leaves it to its storage what a damaged file raises
            raise InputError(f"{self.name}: the bag is damaged ({error}); copy or record it again") from None

    def _deserialize(self, connection: "Connection", data: bytes) -> Any:
        try:
            return self._reader.deserialize(data, connection.msgtype)
        except Exception as error:  # as above, for the bytes of one message
            raise ValueError(f"cannot be read ({error})") from None


def _open(path: str) -> "AnyReader":
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise InputError(f"{path}: is a bag; install lightgesture[bag] to read it") from None
    try:
        # Older ROS 2 bags do not say what their messages look like; images have not changed since.
        reader = AnyReader([Path(path)], default_typestore=get_typestore(Stores.ROS2_HUMBLE))
        reader.open()
    except Exception as error:  # the reader leaves it to its storage what a damaged file raises
        raise InputError(f"{path}: is no bag that can be read ({error}); copy or record it again") from None
    return reader


def _choose(reader: "AnyReader", path: str, topic: str | None) -> list["Connection"]:
    images = [one for one in reader.connections if one.msgtype in IMAGE_TYPES]
    names = sorted({one.topic for one in images})
    if topic is None and len(names) > 1:
        raise InputError(
            f"{path}: holds {len(names)} image topics; choose one with --topic: {', '.join(names)}"
        )
    if not names:
        others = ", ".join(sorted({one.topic for one in reader.connections})) or "none at all"
        raise InputError(f"{path}: holds no image topic; its topics: {others}")
    wanted = names[0] if topic is None else topic
    if wanted not in names:
        raise InputError(f"{path}: has no image topic {wanted}; those there are: {', '.join(names)}")
    return [one for one in images if one.topic == wanted]


def _moment(time_ns: int) -> datetime | None:
    """Nanoseconds since 1970 as a moment; None for those of a clock that was never set, or of a simulation."""
    with suppress(OverflowError, OSError, ValueError):
        moment = datetime.fromtimestamp(time_ns / _NANOSECONDS, UTC)
        return moment if moment.year >= FIRST_YEAR else None
    return None


def _stamp(message: Any) -> int:
    """Nanoseconds of the message's header, 0 where it has none."""
    with suppress(AttributeError):
        stamp = message.header.stamp
        return int(stamp.sec) * _NANOSECONDS + int(stamp.nanosec)
    return 0
