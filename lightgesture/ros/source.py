"""Pictures of a topic as a live source: the newest message only, converted when it is its turn."""

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator
from typing import Any, Final

from lightgesture.features.image import BitDepth
from lightgesture.sources.ros_images import message_to_bgr8
from lightgesture.sources.types import Content, LiveSource

HEADERS_KEPT: Final = 64
"""Headers of the last pictures that are kept, for who asks when one was taken; more than are ever on the way."""


class TopicSource(LiveSource):
    """What is `put` in by the callback of a subscription, from any thread; a newer message takes the place of an older.

    Compressed pictures are handed on as they are, raw ones converted. A message that holds none is passed over and told
    once by `report`. `end` ends the stream for good.
    """

    is_reopened = False

    def __init__(self, name: str, report: Callable[[str], None]) -> None:
        self.name = name
        self._report = report
        self._changed = threading.Condition()
        self._newest: Any = None
        self._is_ended = self._is_told = False
        self._depth = BitDepth(lambda text: report(f"{name}: {text}"))
        self._headers: OrderedDict[int, Any] = OrderedDict()

    def put(self, message: Any) -> None:
        """Leave a message, at once."""
        with self._changed:
            self._newest = message
            self._changed.notify()

    def end(self) -> None:
        """Nothing more comes."""
        with self._changed:
            self._is_ended = True
            self._changed.notify()

    def header_of(self, index: int | None) -> Any:
        """The header of the message that picture number `index` came in; None where it is not known any more."""
        return None if index is None else self._headers.get(index)

    def __iter__(self) -> Iterator[Content]:
        index = 0
        while (message := self._take()) is not None:
            content = self._content(message)
            if content is None:
                continue
            self._headers[index] = message.header
            if len(self._headers) > HEADERS_KEPT:
                self._headers.popitem(last=False)
            yield content
            index += 1

    def _take(self) -> Any:
        with self._changed:
            self._changed.wait_for(lambda: self._newest is not None or self._is_ended)
            message, self._newest = self._newest, None
            return None if self._is_ended else message

    def _content(self, message: Any) -> Content | None:
        if getattr(message, "format", None) is not None:
            return bytes(message.data)
        try:
            return message_to_bgr8(message, self._depth)
        except ValueError as error:
            if not self._is_told:
                self._is_told = True
                self._report(f"{self.name}: a picture {error}; such pictures are passed over")
            return None
