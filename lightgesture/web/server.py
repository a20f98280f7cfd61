"""The HTTP server: a page, its pictures as multipart JPEG, its updates as server-sent events; it only ever reads.

Every browser has a thread of its own, and there is a bound to everything that one may ask for.
"""

import ipaddress
import json
import re
import socket
import socketserver
import threading
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from typing import Any, Final, cast
from urllib.parse import urlsplit

from lightgesture._version import __version__
from lightgesture.web.board import Board

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

HEADERS = {
    "Content-Security-Policy": "default-src 'none'; img-src 'self'; style-src 'self'; script-src 'self'; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
"""Of every answer: nothing but what this server gives is loaded, and no other site may show it."""

# Beyond these numbers a browser is told to come again later.

VIEWERS: Final = 4
"""Browsers that get pictures at a time."""

LISTENERS: Final = 8
"""Browsers that get updates at a time."""

CONNECTIONS: Final = 24
"""Connections of any kind at a time."""

UPDATES_PER_S: Final = 10.0
"""Most updates of the sentence and the state that a browser gets, a second."""

CLIENT_TIMEOUT_S: Final = 10.0
"""A browser that takes nothing for so many seconds is left."""

BEAT_S: Final = 2.0
"""Longest time without a word to a browser, seconds, by which one that has gone is noticed."""

SEND_BUFFER: Final = 128 * 1024
"""Bytes that may wait in the system for a browser: what lies there is old by the time it is seen."""

NO_FRAMES: Final = "frame-ancestors 'none'"
"""What `HEADERS` says of frames, unless it is an extension."""

LOCAL_NAME: Final = re.compile(r"[a-z0-9-]{1,63}\.local")
"""Names of multicast DNS: no other site of the internet can have one."""

SERVICE: Final = {
    "name": "Diver's signs",
    "description": "Reads a diver's hand signs and turns them into instructions",
    "icon": "mdi-hand-okay",
    "company": "lightgesture",
    "version": __version__,
    "webpage": "",
    "api": "/state.json",
}
"""What an extension tells BlueOS of itself."""

BOUNDARY = "lightgesture"
_BUSY = b"HTTP/1.0 503 Service Unavailable\r\nRetry-After: 5\r\nContent-Length: 0\r\n\r\n"


class WebServer(ThreadingHTTPServer):
    """Serves a board. more: path to content and type of further files. is_extension: of BlueOS, which lists it by what
    `/register_service` says, shows it within its own page, and calls it by any name that ends in `.local`.

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
    ) -> None:
        self.board, self.is_extension = board, is_extension
        self.names = known_names(host)
        self.viewers = threading.BoundedSemaphore(VIEWERS)
        self.listeners = threading.BoundedSemaphore(LISTENERS)
        self._connections = threading.BoundedSemaphore(CONNECTIONS)
        folder = files("lightgesture.web") / "static"
        self.pages = {path: ((folder / name).read_bytes(), kind) for path, (name, kind) in PAGES.items()}
        self.pages |= more or {}
        self.address_family = socket.AF_INET6 if ":" in host else socket.AF_INET
        super().__init__((host, port), _Handler)

    def server_bind(self) -> None:
        """Bind without asking for the machine's full name, which takes long where there is no network."""
        socketserver.TCPServer.server_bind(self)
        self.server_name, self.server_port = self.server_address[0], self.server_address[1]  # type: ignore[assignment]

    def process_request(self, request: Any, client_address: Any) -> None:
        """Hand a connection to a thread, or refuse it where there are too many."""
        if not self._connections.acquire(blocking=False):
            with suppress(OSError):
                request.setblocking(False)
                request.send(_BUSY)
            self.shutdown_request(request)
            return
        super().process_request(request, client_address)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Serve one connection in its thread."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._connections.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing of a browser that went away in the middle of a word."""


class _Handler(BaseHTTPRequestHandler):
    server_version, sys_version = "lightgesture", ""

    @property
    def _web(self) -> WebServer:
        return cast(WebServer, self.server)

    def setup(self) -> None:
        self.request.settimeout(CLIENT_TIMEOUT_S)
        self.request.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER)
        super().setup()

    def log_message(self, format: str, *arguments: Any) -> None:  # noqa: A002 - the base class's name
        """Nothing on standard error, which is for the decoder."""

    def do_GET(self) -> None:
        if not self._is_called_by_its_name():
            self._refuse(
                HTTPStatus.MISDIRECTED_REQUEST, "call this server by its address, localhost or its name"
            )
            return
        path = urlsplit(self.path).path
        if path in self._web.pages:
            self._send(*self._web.pages[path])
        elif path == "/state.json":
            update = self._web.board.update(-1, 0, 0)
            content = {} if update is None else {**update.state, "entries": update.entries}
            self._send(json.dumps(content).encode(), "application/json")
        elif path == "/log.jsonl":
            self._send(self._web.board.log().encode(), "application/jsonl; charset=utf-8")
        elif path == "/register_service" and self._web.is_extension:
            self._send(json.dumps(SERVICE).encode(), "application/json")
        elif path == "/stream.mjpg":
            self._stream()
        elif path == "/events":
            self._events()
        else:
            self._refuse(HTTPStatus.NOT_FOUND, "there is nothing here; the page is at /")

    def _stream(self) -> None:
        board = self._web.board
        with self._place(self._web.viewers) as is_free:
            if not is_free:
                return
            self._begin(f"multipart/x-mixed-replace; boundary={BOUNDARY}")
            self.wfile.write(f"--{BOUNDARY}\r\n".encode())
            number, jpeg = 0, b""
            with board.viewing():
                while not board.is_closed:
                    # Where no new one comes, the last is sent again: some browsers show a picture only when the next
                    # begins, and one that has gone is noticed.
                    number, jpeg = board.jpeg(number, BEAT_S) or (number, jpeg)
                    if jpeg and not board.is_closed:
                        self.wfile.write(to_part(jpeg))

    def _events(self) -> None:
        board = self._web.board
        with self._place(self._web.listeners) as is_free:
            if not is_free:
                return
            self._begin("text/event-stream")
            version, entry = -1, self._last_entry()
            while not board.is_closed:
                update = board.update(version, entry, BEAT_S)
                if update is None:
                    self.wfile.write(b": still here\n\n")
                    continue
                self.wfile.write(update.to_events(board.run))
                version = update.version
                entry = update.entries[-1]["number"] if update.entries else entry
                time.sleep(1.0 / UPDATES_PER_S)

    def _is_called_by_its_name(self) -> bool:
        header = self.headers.get("Host")
        name = name_of((header or "").strip()) if self._web.is_extension else None
        is_local = name is not None and LOCAL_NAME.fullmatch(name.lower()) is not None
        return is_local or is_known(header, self._web.names)

    def _frameable(self, value: str) -> str:
        """The header that lets pages of the same machine, on any port, show this one in a frame."""
        name = name_of((self.headers.get("Host") or "").strip())
        is_shown = name is not None and ":" not in name and self._is_called_by_its_name()
        return value.replace(NO_FRAMES, f"frame-ancestors http://{name}:*") if is_shown else value

    def _last_entry(self) -> int:
        """Number of the last entry that a browser had before it lost the connection; 0 in another run."""
        run, _, number = self.headers.get("Last-Event-ID", "").partition("-")
        return int(number) if run == self._web.board.run and number.isascii() and number.isdigit() else 0

    @contextmanager
    def _place(self, places: threading.BoundedSemaphore) -> Iterator[bool]:
        """A place among those who stay; where none is free, the browser is told so and it gives False."""
        is_free = places.acquire(blocking=False)
        try:
            if not is_free:
                self._refuse(HTTPStatus.SERVICE_UNAVAILABLE, "too many look already; close another page")
            yield is_free
        finally:
            if is_free:
                places.release()

    def _begin(self, kind: str, status: HTTPStatus = HTTPStatus.OK, length: int | None = None) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        for name, value in HEADERS.items():
            self.send_header(name, self._frameable(value) if self._web.is_extension else value)
        if length is not None:
            self.send_header("Content-Length", str(length))
        if status == HTTPStatus.SERVICE_UNAVAILABLE:
            self.send_header("Retry-After", "5")
        self.end_headers()

    def _send(self, content: bytes, kind: str, status: HTTPStatus = HTTPStatus.OK) -> None:
        self._begin(kind, status, len(content))
        self.wfile.write(content)

    def _refuse(self, status: HTTPStatus, text: str) -> None:
        self._send(f"{text}\n".encode(), "text/plain; charset=utf-8", status)


def to_part(jpeg: bytes) -> bytes:
    """A picture as a part of the stream; the next boundary follows at once, for it is the end of the part."""
    head = f"Content-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
    return head.encode() + jpeg + f"\r\n--{BOUNDARY}\r\n".encode()


def known_names(host: str) -> frozenset[str]:
    """Names that a browser may call a server by that is bound to `host`, in small letters.

    A page of another site can make its own name point to this machine and read what it likes ("DNS rebinding"). It
    cannot make a bare address do so, and it does not know the names of this machine.
    """
    own = socket.gethostname().lower()
    names = {"localhost", host.lower(), own, own.split(".")[0], own.split(".")[0] + ".local"}
    return frozenset(name for name in names if name)


def is_known(header: str | None, names: Iterable[str]) -> bool:
    """Whether a `Host` header, with or without a port, is an address or one of the names.

    Any port is right, for a tunnel has one of its own.
    """
    name = name_of((header or "").strip())
    if name is None:
        return False
    return name.lower().rstrip(".") in names or _is_address(name)


def name_of(header: str) -> str | None:
    """The name or address of a `Host` header without its port; None where it is malformed."""
    if header.startswith("["):
        name, bracket, port = header[1:].partition("]")
        is_port = port == "" or (port[0] == ":" and port[1:].isdigit())
        return name if bracket and is_port and ":" in name else None
    name, colon, port = header.partition(":")
    return name if name and (not colon or port.isdigit()) else None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
