"""What every source of frames offers."""

from collections.abc import Iterator
from types import TracebackType
from typing import Protocol, Self

from lightgesture.frames import Frame


class Source(Protocol):
    """An open source of frames: a context manager that is iterated once, from the first frame to the last.

    name: as the user wrote it. frame_count: how many frames it promises, None where it does not say.
    Iterating raises InputError after the last frame that could be read if that was not all: what was
    yielded before is good.
    """

    name: str
    frame_count: int | None

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def __iter__(self) -> Iterator[Frame]: ...
