"""A stream as frames, for those who want some seconds of it and not the newest picture for ever."""

import time
from collections.abc import Callable, Iterator
from datetime import datetime
from types import TracebackType
from typing import Self

from lightgesture.errors import InputError
from lightgesture.frames import Frame
from lightgesture.sources import types
from lightgesture.sources.pictures import to_image
from lightgesture.sources.types import LiveSource


class StreamFrames:
    """The pictures of a stream, each stamped as it comes, in seconds since the first; damaged ones are passed over.

    The stream is opened once. It has no end of its own, so that iterating it always ends by an InputError, unless
    whoever iterates has enough: it broke off, ended, or sends nothing that can be decoded. clock: seconds.
    """

    def __init__(self, stream: LiveSource, clock: Callable[[], float] = time.monotonic) -> None:
        self.name = stream.name
        self.frame_count: int | None = None
        self.start_utc: datetime | None = None
        self._stream, self._clock = stream, clock

    def __enter__(self) -> Self:
        self._stream.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stream.__exit__(kind, error, trace)

    def __iter__(self) -> Iterator[Frame]:
        start_s: float | None = None
        seen_s, given = self._clock(), 0
        for index, content in enumerate(self._stream):
            now_s = self._clock()
            try:
                image = to_image(content)
            except InputError:
                self._check_wait(now_s - seen_s)
                continue
            start_s = now_s if start_s is None else start_s
            seen_s, given = now_s, given + 1
            yield Frame(image, index, round(now_s - start_s, 6))
        raise InputError(f"{self.name}: the stream ended after {given} pictures")

    def _check_wait(self, waited_s: float) -> None:
        if waited_s > types.NO_PICTURE_S:
            raise InputError(
                f"{self.name}: sends pictures, but for {types.NO_PICTURE_S:g} s none that can be decoded; "
                "look at what the camera sends"
            )
