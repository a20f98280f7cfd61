"""What lies in a bag and the messages of one topic: by its index or, where none can be read, from its start."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lightgesture.errors import InputError
from lightgesture.sources.bag_messages import CDR, ROS1
from lightgesture.sources.bag_name import FILE_SUFFIXES, METADATA
from lightgesture.sources.bag_scan import Channel, Message, ScanError, scan
from lightgesture.sources.folder import natural_key
from lightgesture.sources.inflate import inflate, inflate_whole

if TYPE_CHECKING:
    from rosbags.highlevel import AnyReader

_LISTED_FILE = re.compile(r"^\s*-\s+[\"']?(\S+\.(?:db3|mcap)(?:\.zstd)?)[\"']?\s*$", re.MULTILINE)

_ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
"""Begins a message that was compressed by itself; none begins so otherwise."""


def storage_files(folder: Path) -> list[Path]:
    """The files of a bag that is a folder, in their order."""
    found = [one for one in folder.iterdir() if one.name.lower().endswith(FILE_SUFFIXES) and one.is_file()]
    return sorted(
        (one for one in found if not one.name.startswith(".")), key=lambda one: natural_key(one.name)
    )


class Bag:
    """The topics of a bag and their messages.

    remark: why it is read from its start, None where its index is good. missing: names of its files that are not there.
    InputError when made: it is no bag.
    """

    def __init__(self, path: str) -> None:
        self._path, self._name = Path(path), path
        self._reader: AnyReader | None = None
        self.remark: str | None = None
        self.missing = _missing_files(self._path)
        self.channels: Counter[Channel] = Counter()
        try:
            self._reader = _open_reader(self._path, path)
            self.channels.update({self._channel(one): one.msgcount for one in self._reader.connections})
        except InputError:
            raise
        except Exception as error:  # the reader leaves it to its storage what a damaged file raises
            self.close()
            self._survey(str(error).splitlines()[0] if str(error) else type(error).__name__)

    def close(self) -> None:
        """Close its files."""
        if self._reader is not None:
            with suppress(Exception):
                self._reader.close()
            self._reader = None

    def messages(self, topic: str) -> Iterator[Message]:
        """Those of a topic, in the order in which they were recorded. ScanError: that was not all."""
        given = 0
        if self._reader is not None:
            wanted = [one for one in self._reader.connections if one.topic == topic]
            channels = {id(one): self._channel(one) for one in wanted}
            try:
                for connection, recorded_ns, data in self._reader.messages(wanted):
                    given += 1
                    yield channels[id(connection)], recorded_ns, _plain(data)
            except Exception:  # as above, for a damaged place: what lies behind it needs no index
                pass
            else:
                return
        yield from self._scan(topic, given)

    def _channel(self, connection: Any) -> Channel:
        is_ros1 = not getattr(self._reader, "is2", True)
        written = ROS1 if is_ros1 else str(getattr(connection.ext, "serialization_format", CDR))
        return Channel(connection.topic, connection.msgtype, written)

    def _files(self) -> list[Path]:
        return storage_files(self._path) if self._path.is_dir() else [self._path]

    def _survey(self, reason: str) -> None:
        """Find the topics by reading all messages once."""
        with suppress(ScanError):
            for channel, _, _ in _scan_all(self._files()):
                self.channels[channel] += 1
        if not self.channels:
            raise InputError(f"{self._name}: is no bag that can be read ({reason}); copy or record it again")
        self.remark = f"is read from its start, for its index cannot be ({reason})"

    def _scan(self, topic: str, given: int) -> Iterator[Message]:
        for channel, recorded_ns, data in _scan_all(self._files()):
            if channel.topic != topic:
                continue
            if given:
                given -= 1
            else:
                yield channel, recorded_ns, _plain(data)


def _missing_files(path: Path) -> list[str]:
    """What the metadata of a folder name and is not there."""
    try:
        text = (path / METADATA).read_text("utf-8", "replace")
    except OSError:  # none, or no folder
        return []
    names = [Path(match[1]).name for match in _LISTED_FILE.finditer(text)]
    return [name for name in dict.fromkeys(names) if not (path / name).exists()]


def _scan_all(files: Sequence[Path]) -> Iterator[Message]:
    """All messages of files; what is wrong with one of them is raised after the last."""
    failure: ScanError | None = None
    for file in files:
        try:
            yield from scan(file)
        except ScanError as error:
            failure = failure or error
    if failure is not None:
        raise failure


def _plain(data: bytes) -> bytes:
    return inflate(data, "zstd") if data.startswith(_ZSTD_MAGIC) else data


def _open_reader(path: Path, name: str) -> "AnyReader":
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise InputError(f"{name}: is a bag; install lightgesture[bag] to read it") from None
    _bound_chunks()
    # Older ROS 2 bags do not say what their messages look like, and the reader wants to know.
    reader = AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE))
    reader.open()
    return reader


def _bound_chunks() -> None:
    """Have the reader unpack no chunk beyond our bound: its tables name functions that know none."""
    from rosbags.rosbag1.reader import decompressors
    from rosbags.rosbag2.storage_mcap import DECOMPRESSORS

    for compression in ("bz2", "lz4"):
        decompressors[compression] = partial(inflate_whole, compression=compression)
    for compression in ("lz4", "zstd"):
        DECOMPRESSORS[compression] = partial(_sized, compression)


def _sized(compression: str, content: bytes, _size: int) -> bytes:
    return inflate_whole(content, compression)
