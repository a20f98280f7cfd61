"""What every source of frames offers, and what it may be told beyond a name."""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from types import TracebackType
from typing import Final, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from lightgesture.frames import Frame

Content = bytes | NDArray[np.uint8]
"""A picture as a stream brings it: a JPEG file, or uint8 (height, width, 3), BGR."""


DEFAULT_FPS: Final = 30.0
"""Frames a second of sources without time stamps, where the user names no other."""


@dataclass(frozen=True, slots=True)
class SourceOptions:
    """What the user may say about a source; each is used by some sources only."""

    fps: float = DEFAULT_FPS
    """Frames a second, above 0, of what has no clock: a folder, standard input, a bare stream of H.264 or JPEG."""
    size: tuple[int, int] | None = None
    """Width and height in pixels: of raw standard input, which is taken for JPEG pictures without it; asked of a
    camera, which may give another."""
    topic: str | None = None
    """The image topic of a bag, needed where it has several."""


TIMEOUT_S: Final = 5.0
"""Seconds until a peer must have answered, and without data after which a stream counts as broken off."""

NO_PICTURE_S: Final = 10.0
"""Seconds in which data came and no whole picture, after which a stream counts as broken off."""

CHUNK_BYTES: Final = 1 << 16
"""Bytes read of a stream at once."""


class Source(Protocol):
    """An open source of frames: a context manager that is iterated once, from the first frame to the last.

    name: as the user wrote it. frame_count: how many frames it promises, None where it does not say. start_utc: the
    moment at which `time_s` is 0, None where no absolute clock tells.
    Iterating raises InputError after the last frame that could be read if that was not all: what was
    yielded before is good.
    """

    name: str
    frame_count: int | None
    start_utc: datetime | None

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def __iter__(self) -> Iterator[Frame]: ...


class LiveSource(Protocol):
    """A stream of pictures that come as time goes by; `with` opens it, as often as it breaks off.

    name: for messages and records, without a password. is_reopened: whether opening it again may bring more.
    Opening and iterating raise InputError where the stream cannot be opened or breaks off. What is wrong with the
    name or with this installation is told by a UsageError when the object is made.
    """

    name: str
    is_reopened: bool

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def __iter__(self) -> Iterator[Content]: ...
