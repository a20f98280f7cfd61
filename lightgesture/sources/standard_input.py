"""Pictures from standard input: JPEG files one after the other, or raw BGR of a given size."""

import io
import sys
from collections.abc import Iterator
from typing import IO, Final

import numpy as np

from lightgesture.errors import InputError
from lightgesture.frames import Frame
from lightgesture.sources.jpeg import JpegSplitter
from lightgesture.sources.pictures import to_image
from lightgesture.sources.types import CHUNK_BYTES, Content, LiveSource, Source, SourceOptions

STANDARD_INPUT = "-"
"""What the user writes for it."""

HEADER_BYTES: Final = 4096
"""Bytes between two pictures that are taken for the headers of a multipart stream; more is a hole."""


class StandardInputStream(LiveSource):
    """The pictures of standard input as they come, still encoded if they are JPEG files.

    With `options.size` the bytes are raw pictures, blue, green, red, without anything between them.
    `stream`: another stream of bytes in its place. passed_over: bytes before the last picture that belong to none.
    InputError at the end: not one picture came.
    """

    def __init__(self, options: SourceOptions, stream: IO[bytes] | None = None) -> None:
        self.name = STANDARD_INPUT
        self.is_reopened = False
        self.passed_over = 0
        self._size = options.size
        self._stream = stream or _open_raw()

    def __iter__(self) -> Iterator[Content]:
        is_empty = True
        for content in self._jpegs() if self._size is None else self._raws(*self._size):
            is_empty = False
            yield content
        if is_empty:
            wanted = "JPEG picture" if self._size is None else "raw picture of {}x{}".format(*self._size)
            raise InputError(
                f"standard input: held no whole {wanted}; send MJPEG, or raw BGR with --size WIDTHxHEIGHT"
            )

    def _chunks(self) -> Iterator[bytes]:
        while chunk := self._stream.read(CHUNK_BYTES):
            yield chunk

    def _jpegs(self) -> Iterator[bytes]:
        splitter = JpegSplitter()
        for chunk in self._chunks():
            for picture, self.passed_over in zip(splitter.feed(chunk), splitter.passed_over, strict=True):
                yield picture

    def _raws(self, width: int, height: int) -> Iterator[Content]:
        length = width * height * 3
        buffer = bytearray()
        for chunk in self._chunks():
            buffer += chunk
            while len(buffer) >= length:
                yield np.frombuffer(bytes(buffer[:length]), np.uint8).reshape(height, width, 3).copy()
                del buffer[:length]


def _open_raw() -> IO[bytes]:
    """Standard input without a buffer.

    It gives what is there: a full block would keep a small picture waiting for the next one. And it has no lock, which
    a thread that waits for a picture would hold while the program ends; Python then aborts.
    """
    try:
        return io.FileIO(sys.stdin.fileno(), closefd=False)
    except (OSError, ValueError):  # something else stands in its place
        return sys.stdin.buffer


class StandardInput(Source):
    """All pictures of standard input as frames, in time steps of 1 / `options.fps`, for it has no clock of its own.

    A frame after bytes that are no picture, more than the headers of a multipart stream are, says so (`gap`).
    """

    def __init__(self, options: SourceOptions, stream: IO[bytes] | None = None) -> None:
        self.name = STANDARD_INPUT
        self._fps = options.fps
        self._stream = StandardInputStream(options, stream)

    def __iter__(self) -> Iterator[Frame]:
        left_out: list[str] = []
        for index, content in enumerate(self._stream):
            try:
                image = to_image(content)
            except InputError as error:
                left_out.append(f"picture {index} {error}")
            else:
                foreign = self._stream.passed_over
                gap = f"{foreign} bytes are no picture" if index and foreign > HEADER_BYTES else None
                yield Frame(image, index, round(index / self._fps, 6), gap)
        if left_out:
            raise InputError(f"standard input: {len(left_out)} pictures left out; the first: {left_out[0]}")
