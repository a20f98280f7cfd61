"""ROS 1 bags, ROS 2 bags and MCAP files: the pictures of one topic."""

from collections.abc import Iterator
from datetime import UTC, datetime
from itertools import chain, islice
from typing import NamedTuple

from lightgesture.console import warn
from lightgesture.errors import InputError
from lightgesture.features.types import Image
from lightgesture.frames import Frame
from lightgesture.sources.bag_clock import LOOKED_AT, BagClock, has_stamps
from lightgesture.sources.bag_messages import (
    NANOSECONDS,
    PictureMessage,
    is_packet,
    picture_type,
    read_message,
)
from lightgesture.sources.bag_scan import UNCLOSED, ScanError
from lightgesture.sources.bag_storage import Bag
from lightgesture.sources.packets import PacketDecoder
from lightgesture.sources.pictures import depth_of
from lightgesture.sources.ros_images import message_to_bgr8
from lightgesture.sources.types import Source

_YEAR_2000_S, _YEAR_2100_S = 946_684_800, 4_102_444_800
"""A clock before or after tells no time of day: it is that of a simulation, or counts from the start of a machine."""


class _Entry(NamedTuple):
    """A message with its place in the topic; `kind`: as of `picture_type`. message: or what is wrong with it."""

    number: int
    kind: str
    recorded_ns: int
    message: PictureMessage | ValueError

    @property
    def stamp_ns(self) -> int:
        """Of its header, 0 where it has none."""
        return self.message.stamp_ns if isinstance(self.message, PictureMessage) else 0


class BagFile(Source):
    """The images of one topic of a bag, in the order in which they were recorded: pictures, or packets of a video.

    topic: its name; None takes the only image topic there is. The clock is that of the headers of its messages, or,
    where most have none, the times at which they were recorded; seconds from the first message. start_utc: the
    moment of it. Messages that hold no picture are left out; after the last one InputError tells how
    many, and whether the bag is damaged or was cut off. InputError when opened: no bag, no such topic, no image topic
    or several of them.
    """

    def __init__(self, path: str, topic: str | None = None) -> None:
        self.name = path
        self.start_utc: datetime | None = None
        self._damage: str | None = None
        self._left_out: list[str] = []
        self._given = 0
        self._bag = Bag(path)
        try:
            self._topic = _choose(self._bag, path, topic)
            self._begin()
        except BaseException:
            self._bag.close()
            raise

    def _begin(self) -> None:
        if self._bag.remark is not None:
            self._tell(self._bag.remark)
        self.frame_count = sum(n for one, n in self._bag.channels.items() if one.topic == self._topic)
        self._entries = self._read()
        self._first = list(islice(self._entries, LOOKED_AT))
        self._clock = BagClock(has_stamps([one.stamp_ns for one in self._first]))
        if self._first:
            first = self._first[0]
            stamped = next((one for one in self._first if one.stamp_ns > 0), first)
            stamp_ns = stamped.stamp_ns - (stamped.recorded_ns - first.recorded_ns)
            self._clock.start(stamp_ns, first.recorded_ns)
            moment_ns = stamp_ns if _is_day(stamp_ns) else first.recorded_ns
            if _is_day(moment_ns):
                self.start_utc = datetime.fromtimestamp(moment_ns / NANOSECONDS, UTC)

    def close(self) -> None:
        """Close the bag."""
        self._bag.close()

    def __iter__(self) -> Iterator[Frame]:
        depth = depth_of(self.name)
        decoder: PacketDecoder | None = None
        for entry in chain(self._first, self._entries):
            index, kind, recorded_ns, message = entry
            time_ns = self._clock.read(entry.stamp_ns, recorded_ns)
            try:
                if isinstance(message, ValueError):
                    raise message
                if not is_packet(kind, message):
                    yield self._frame(message_to_bgr8(message, depth), index, time_ns)
                    continue
                decoder = decoder or PacketDecoder(message.format or "", self._tell)
                pictures = decoder.feed(index, time_ns, message.data)
            except ValueError as error:
                self._left_out.append(f"message {index} {error}")
                continue
            yield from self._video_frames(pictures)
        if decoder is not None:
            yield from self._video_frames(decoder.flush())
        self._check_end()

    def _tell(self, text: str) -> None:
        warn(f"{self.name}: {text}")

    def _video_frames(self, pictures: list[tuple[Image, int]]) -> Iterator[Frame]:
        for image, time_ns in pictures:
            if not self._given and self._left_out:
                # A recorder that joined in the middle has packets that need one before its first.
                self._tell(f"{len(self._left_out)} messages before the first whole picture")
                self._left_out.clear()
            yield self._frame(image, self._given + len(self._left_out), time_ns)

    def _frame(self, image: Image, index: int, time_ns: int) -> Frame:
        self._given += 1
        return Frame(image, index, round(time_ns / NANOSECONDS, 6))

    def _read(self) -> Iterator[_Entry]:
        index = 0
        try:
            for channel, recorded_ns, data in self._bag.messages(self._topic):
                kind = picture_type(channel.msgtype)
                if kind is not None:
                    yield _Entry(index, kind, recorded_ns, _parse(kind, data, channel.written))
                    index += 1
        except ScanError as error:
            self._damage = str(error)
        else:
            if self.frame_count is not None and index < self.frame_count:
                self._damage = f"is damaged and lacks {self.frame_count - index} of its messages"

    def _check_end(self) -> None:
        """InputError: not all could be read."""
        wrong = [f"the bag lacks its file {', '.join(self._bag.missing)}"] if self._bag.missing else []
        if self._damage == UNCLOSED and not self._left_out:
            self._tell(f"the bag {UNCLOSED}; read as far as it goes, {self._given} pictures")
        elif self._damage is not None:
            wrong.append(f"the bag {self._damage}, {self._given} pictures of it could be read")
        if self._left_out:
            count = f"{len(self._left_out)} of {self.frame_count} messages left out"
            wrong.append(f"{count}; the first: {self._left_out[0]}")
        if wrong:
            raise InputError(f"{self.name}: {'; '.join(wrong)}")


def _is_day(moment_ns: int) -> bool:
    return _YEAR_2000_S <= moment_ns / NANOSECONDS < _YEAR_2100_S


def _parse(kind: str, data: bytes, written: str) -> PictureMessage | ValueError:
    try:
        return read_message(kind, data, written)
    except ValueError as error:
        return error


def _choose(bag: Bag, path: str, topic: str | None) -> str:
    names = sorted({one.topic for one in bag.channels if picture_type(one.msgtype) is not None})
    if topic is None and len(names) > 1:
        raise InputError(
            f"{path}: holds {len(names)} image topics; choose one with --topic: {', '.join(names)}"
        )
    if not names:
        others = ", ".join(sorted({one.topic for one in bag.channels})) or "none at all"
        raise InputError(f"{path}: holds no image topic; its topics: {others}")
    wanted = names[0] if topic is None else topic
    if wanted not in names:
        raise InputError(f"{path}: has no image topic {wanted}; those there are: {', '.join(names)}")
    return wanted
