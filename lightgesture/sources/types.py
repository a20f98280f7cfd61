"""What every source of frames offers, and what it may be told beyond a name."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from typing import Final, Self

import numpy as np
from numpy.typing import NDArray

from lightgesture.config import DEFAULT_FPS
from lightgesture.frames import Frame

Content = bytes | NDArray[np.uint8]
"""A picture as a stream brings it: a JPEG file, or uint8 (height, width, 3), BGR."""


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
    insecure: bool = False
    """Take a camera's certificate that nobody vouches for."""


TIMEOUT_S: Final = 5.0
"""Seconds until a peer must have answered, and without data after which a stream counts as broken off."""

NO_PICTURE_S: Final = 10.0
"""Seconds in which data came and no whole picture, after which a stream counts as broken off."""

CHUNK_BYTES: Final = 1 << 16
"""Bytes read of a stream at once."""


class _Opened:
    """What a `with` block holds open."""

    name: str
    """As the user wrote it, without a password: for messages and records."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *reason: object) -> None:
        self.close()

    def close(self) -> None:
        """Give back what is held open: here nothing."""


class Source(_Opened, ABC):
    """An open source of frames: a context manager that is iterated once, from the first frame to the last.

    Iterating raises InputError after the last frame that could be read if that was not all: what was
    yielded before is good.
    """

    frame_count: int | None = None
    """How many frames it promises, None where it does not say."""

    start_utc: datetime | None = None
    """The moment at which `time_s` is 0, None where no absolute clock tells."""

    @abstractmethod
    def __iter__(self) -> Iterator[Frame]: ...


class LiveSource(_Opened, ABC):
    """A stream of pictures that come as time goes by; `with` opens it, as often as it breaks off.

    Opening and iterating raise InputError where the stream cannot be opened or breaks off. What is wrong with the
    name or with this installation is told by a UsageError when the object is made.
    """

    is_reopened = True
    """Whether opening it again may bring more."""

    @abstractmethod
    def __iter__(self) -> Iterator[Content]: ...
