"""The process that is measured: `live` on a clip that goes round and round, as fast as it is decoded."""

import threading
from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import ExitStatus
from lightgesture.records import Record
from lightgesture.sources import Content, LiveSource

FPS: Final = 30.0
"""Pictures a second of the stream's own time."""

STEP_S: Final = 60.0
"""Seconds that a picture may take before the stream ends, for a decoder that hangs shall be told."""


class RoundStream(LiveSource):
    """Pictures again and again, the next one when the last was decoded, so that none is passed over.

    It is a listener of the live loop too, and its clock: time goes on with the pictures, 1 / FPS each.
    pictures: JPEG files. count: how many pictures there are in all.
    """

    name = "soak"
    is_reopened = False

    def __init__(self, pictures: Sequence[bytes], count: int) -> None:
        self._pictures, self._count = pictures, count
        self._now_s = 0.0
        self._is_decoded = threading.Event()

    def clock(self) -> float:
        """Seconds of the stream."""
        return self._now_s

    def show(self, image_bgr: NDArray[np.uint8] | None, records: Sequence[Record]) -> None:  # noqa: ARG002
        """Let the next picture come, once this one is decoded."""
        if image_bgr is not None:
            self._is_decoded.set()

    def __iter__(self) -> Iterator[Content]:
        for index in range(self._count):
            self._now_s = round(index / FPS, 6)
            self._is_decoded.clear()
            yield self._pictures[index % len(self._pictures)]
            if not self._is_decoded.wait(STEP_S):
                return


def decode_round(pictures: Sequence[bytes], count: int, options: dict[str, Any]) -> ExitStatus:
    """Decode the stream by `live` with these options."""
    from lightgesture.actions.live import run_live
    from lightgesture.config.settings import DecodeSettings
    from lightgesture.console import native_messages_muted

    stream = RoundStream(pictures, count)
    settings = DecodeSettings.model_validate({"json": True, "quiet": True, **options})
    with native_messages_muted():
        return run_live(stream, settings, [stream], clock=stream.clock)
