"""The HTTP server of the page, and how many may ask it for how much; `answers` has what they get.

Every browser has a thread of its own, and there is a bound to everything that one may ask for.
"""

import socket
import socketserver
import threading
from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from http.server import ThreadingHTTPServer
from importlib.resources import files
from typing import Any, Final

from lightgesture.web.answers import Answers
from lightgesture.web.board import Board
from lightgesture.web.door import Door, token_for

PAGES = {
    "/": ("page.html", "text/html; charset=utf-8"),
    "/page.css": ("page.css", "text/css; charset=utf-8"),
    "/page.js": ("page.js", "text/javascript; charset=utf-8"),
    "/display": ("display.html", "text/html; charset=utf-8"),
    "/display.css": ("display.css", "text/css; charset=utf-8"),
    "/display.js": ("display.js", "text/javascript; charset=utf-8"),
    "/icon.svg": ("icon.svg", "image/svg+xml"),
    "/signs": ("signs.html", "text/html; charset=utf-8"),
    "/signs.css": ("signs.css", "text/css; charset=utf-8"),
    "/signs.js": ("signs.js", "text/javascript; charset=utf-8"),
    "/hands.js": ("hands.js", "text/javascript; charset=utf-8"),
    "/practice": ("practice.html", "text/html; charset=utf-8"),
    "/practice.css": ("practice.css", "text/css; charset=utf-8"),
    "/practice.js": ("practice.js", "text/javascript; charset=utf-8"),
}
"""Path to the file in `static` and its type."""

# Beyond these numbers a browser is told to come again later.

VIEWERS: Final = 4
"""Browsers that get pictures at a time."""

LISTENERS: Final = 8
"""Browsers that get updates at a time."""

CONNECTIONS: Final = 24
"""Connections of any kind at a time."""

CONNECTIONS_OF_ONE: Final = 16
"""Of these, those of one address: a browser takes up to six, a tunnel all of its browsers'."""

_BUSY = b"HTTP/1.0 503 Service Unavailable\r\nRetry-After: 5\r\nContent-Length: 0\r\n\r\n"


class WebServer(ThreadingHTTPServer):
    """Serves a board. more: path to content and type of further files. is_extension: of BlueOS, which lists it by what
    `/register_service` says, shows it within its own page, and calls it by any name that ends in `.local`. token: what
    browsers must name, see `door.token_for`.

    Raises OSError where the port or the address cannot be had.
    """

    daemon_threads = True

    def __init__(
        self,
        host: str,
        port: int,
        board: Board,
        more: Mapping[str, tuple[bytes, str]] | None = None,
        is_extension: bool = False,
        token: str | None = None,
    ) -> None:
        self.board, self.is_extension = board, is_extension
        self.door = Door(host, token_for(host, token, is_extension), is_extension)
        self.viewers = threading.BoundedSemaphore(VIEWERS)
        self.listeners = threading.BoundedSemaphore(LISTENERS)
        self._connections = threading.BoundedSemaphore(CONNECTIONS)
        self._of_one: Counter[str] = Counter()
        self._counting = threading.Lock()
        folder = files("lightgesture.web") / "static"
        self.pages = {path: ((folder / name).read_bytes(), kind) for path, (name, kind) in PAGES.items()}
        self.pages |= more or {}
        self.address_family = socket.AF_INET6 if ":" in host else socket.AF_INET
        super().__init__((host, port), Answers)

    def server_bind(self) -> None:
        """Bind without asking for the machine's full name, which takes long where there is no network."""
        socketserver.TCPServer.server_bind(self)
        self.server_name, self.server_port = self.server_address[0], self.server_address[1]  # type: ignore[assignment]

    def process_request(self, request: Any, client_address: Any) -> None:
        """Hand a connection to a thread, or refuse it where there are too many."""
        if not self._admit(client_address[0]):
            with suppress(OSError):
                request.setblocking(False)
                request.send(_BUSY)
            self.shutdown_request(request)
            return
        try:
            super().process_request(request, client_address)
        except BaseException:  # no thread is to be had
            self._leave(client_address[0])
            raise

    def _admit(self, address: str) -> bool:
        """Count one more connection of an address; False: it, or all together, have too many."""
        with self._counting:
            is_free = self._of_one[address] < CONNECTIONS_OF_ONE and self._connections.acquire(blocking=False)
            self._of_one[address] += is_free
            return is_free

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Serve one connection in its thread."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._leave(client_address[0])

    def _leave(self, address: str) -> None:
        with self._counting:
            self._of_one[address] -= 1
            self._of_one += Counter()  # which drops those at zero
            self._connections.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing of a browser that went away in the middle of a word."""
