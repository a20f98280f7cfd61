"""The server with its threads, as a listener of the live loop."""

import threading
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final, Self

import cv2

from lightgesture.errors import UsageError
from lightgesture.features.types import Image
from lightgesture.fsm import Grammar
from lightgesture.records import Record
from lightgesture.results.overlay import Overlay
from lightgesture.web.board import Board
from lightgesture.web.language import Language
from lightgesture.web.server import WebServer

LOOPBACK = "127.0.0.1"
STOP_S = 0.1
"""Longest time until the server heeds that it shall stop."""

PICTURES_PER_S: Final = 15.0
"""Most pictures that a browser gets, a second. Each is drawn and encoded once for all, and only while somebody looks;
more take time from the decoder on a small board."""

PICTURE_WIDTH: Final = 960
"""Widest picture that is sent, pixels; wider ones are reduced."""

JPEG_QUALITY: Final = 75
"""Of the pictures that are sent, 1 to 100."""

Draw = Callable[[Image, Sequence[Record]], Image]
"""Draws records on a picture, uint8 (height, width, 3) BGR, and gives a new one."""


class WebListener:
    """Serves the page; use it in a `with` block, or `start` and `stop` it.

    port: 0 for any that is free. host: address to listen on; all but loopback lets the whole network look.
    draw: what makes the annotated picture. grammar: of the page of signs; None: there is none. obeys: whether a vehicle
    says what becomes of instructions. is_extension: of BlueOS, see `WebServer`. token: what browsers must name; None: a
    new one where the whole network may ask; `door.OPEN`: none at all. `show` never waits for a browser, and
    draws nothing itself.
    """

    def __init__(
        self,
        port: int,
        host: str = LOOPBACK,
        draw: Draw | None = None,
        grammar: Grammar | None = None,
        *,
        obeys: bool = False,
        is_extension: bool = False,
        token: str | None = None,
    ) -> None:
        self._port, self._host, self._is_extension, self._token = port, host, is_extension, token
        self._draw = draw or Overlay("below").draw
        self._language = None if grammar is None else Language(grammar)
        self._board = Board(None if self._language is None else self._language.expected, obeys)
        self._server: WebServer | None = None
        self._threads: list[threading.Thread] = []

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(self, *reason: object) -> None:
        self.stop()

    @property
    def viewers(self) -> int:
        """How many browsers look at the picture."""
        return self._board.viewers

    @property
    def address(self) -> str:
        """Where a browser finds the page, once started."""
        if self._server is None:
            raise RuntimeError("the server is not started")
        host = f"[{self._host}]" if ":" in self._host else self._host
        return f"http://{host}:{self._server.server_port}/"

    def link(self, page: str = "") -> str:
        """The address of a page, "" being the first, with the token where one is asked for."""
        token = self._server.door.token if self._server is not None else ""
        return f"{self.address}{page}" + (f"?token={token}" if token else "")

    def start(self) -> None:
        """Begin to serve. UsageError: the address cannot be had."""
        try:
            more = {} if self._language is None else self._language.files()
            self._server = WebServer(
                self._host, self._port, self._board, more, self._is_extension, self._token
            )
        except OSError as error:
            raise UsageError(
                f"--web {self._port}: cannot listen on {self._host} ({error.strerror}); take another port or --web-host"
            ) from None
        serve = partial(self._server.serve_forever, STOP_S)
        for name, work in (("web server", serve), ("web pictures", self._encode)):
            thread = threading.Thread(target=work, name=name, daemon=True)
            thread.start()
            self._threads.append(thread)

    def stop(self) -> None:
        """End all connections and free the port."""
        self._board.close()
        if self._server is not None:
            self._server.shutdown()
            self._server.server_close()
        for thread in self._threads:
            thread.join()
        self._threads.clear()

    def show(self, image_bgr: Image | None, records: Sequence[Record]) -> None:
        """Take a picture, which must not be changed afterwards, and its records; None for records without one."""
        self._board.post(image_bgr, records)

    def tell(self, name: str, value: Any) -> None:
        """Show something that no record tells: its name and value, plain as JSON, in what browsers get."""
        self._board.put(name, value)

    def _encode(self) -> None:
        """Draw and encode the newest picture, again and again, while somebody looks."""
        while (picture := self._board.picture_to_draw()) is not None:
            start = time.monotonic()
            drawn = _fitted(self._draw(picture.image, picture.records), PICTURE_WIDTH)
            jpeg = cv2.imencode(".jpg", drawn, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])[1].tobytes()
            self._board.post_jpeg(picture.number, jpeg)
            time.sleep(max(1.0 / PICTURES_PER_S - (time.monotonic() - start), 0.0))


def _fitted(image: Image, width: int) -> Image:
    if image.shape[1] <= width:
        return image
    height = max(round(image.shape[0] * width / image.shape[1]), 1)
    return cv2.resize(image, (width, height), interpolation=cv2.INTER_AREA)  # type: ignore[return-value]
