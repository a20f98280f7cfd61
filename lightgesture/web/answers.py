"""What a browser is answered: a page's files, pictures as multipart JPEG, updates as server-sent events; it only ever
reads."""

import io
import json
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http import HTTPStatus
from http.client import HTTPMessage
from http.server import BaseHTTPRequestHandler
from typing import TYPE_CHECKING, Any, Final, cast
from urllib.parse import SplitResult, urlsplit

from lightgesture._version import __version__
from lightgesture.web.door import Refusal, name_of
from lightgesture.web.head import read_head

if TYPE_CHECKING:
    from lightgesture.web.server import WebServer

HEADERS = {
    "Content-Security-Policy": "default-src 'none'; img-src 'self'; style-src 'self'; script-src 'self'; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
    "Cache-Control": "no-store",
}
"""Of every answer: nothing but what this server gives is loaded, and no other site may show it."""

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


class Answers(BaseHTTPRequestHandler):
    """Answers one request of a browser."""

    server_version, sys_version = "lightgesture", ""

    @property
    def _web(self) -> "WebServer":
        return cast("WebServer", self.server)

    def setup(self) -> None:
        self.request.settimeout(CLIENT_TIMEOUT_S)
        self.request.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER)
        super().setup()

    def log_message(self, format: str, *arguments: Any) -> None:  # noqa: A002 - the base class's name
        """Nothing on standard error, which is for the decoder."""

    def handle(self) -> None:
        """One request; its head is read before anything of it is looked at."""
        self.close_connection = True
        self.headers, self.requestline, self.request_version = HTTPMessage(), "", self.protocol_version
        head = read_head(self.connection)
        self.connection.settimeout(CLIENT_TIMEOUT_S)
        if isinstance(head, Refusal):
            self._refuse(head)
            return
        self.rfile.close()
        self.rfile = io.BytesIO(head)
        self.handle_one_request()

    def parse_request(self) -> bool:
        """As its base, but for HTTP/0.9, whose answers have no headers to protect them."""
        if not super().parse_request():
            return False
        if self.request_version == "HTTP/0.9":
            self.send_error(HTTPStatus.HTTP_VERSION_NOT_SUPPORTED)
            return False
        return True

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:  # noqa: ARG002 - the base's
        """A line in place of the page that the base class makes of what it was sent."""
        status = HTTPStatus(code)
        self.request_version = self.protocol_version  # which is empty after a line that is none
        self._refuse(Refusal(status, status.phrase.lower()))

    def do_GET(self) -> None:
        door = self._web.door
        refusal = door.objection(self.client_address[0], self.path, self.headers, self._cookie)
        if refusal is not None:
            self._refuse(refusal)
            return
        split = _split(self.path)
        path = split.path
        if path in self._web.pages and door.token and "token=" in split.query:
            self._let_in(path)
        elif path in self._web.pages:
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
            self._refuse(Refusal(HTTPStatus.NOT_FOUND, "there is nothing here; the page is at /"))

    @property
    def _cookie(self) -> str:
        """Name of the cookie with the token; those of a machine's other ports have the same host."""
        return f"lightgesture-{self._web.server_port}"

    def _let_in(self, path: str) -> None:
        """Put the token into a cookie and lead on to the page, so that it stands in no address that is seen."""
        self.send_response(HTTPStatus.SEE_OTHER)
        self.send_header("Location", path)
        self.send_header(
            "Set-Cookie", f"{self._cookie}={self._web.door.token}; Path=/; HttpOnly; SameSite=Lax"
        )
        self._send_headers(0)

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

    def _frameable(self, value: str) -> str:
        """The header that lets pages of the same machine, on any port, show this one in a frame."""
        name = name_of((self.headers.get("Host") or "").strip())
        is_shown = name is not None and ":" not in name and self._web.door.is_called(self.headers.get("Host"))
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
                text = "too many look already; close another page"
                self._refuse(Refusal(HTTPStatus.SERVICE_UNAVAILABLE, text))
            yield is_free
        finally:
            if is_free:
                places.release()

    def _begin(self, kind: str, status: HTTPStatus = HTTPStatus.OK, length: int | None = None) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        if status in (HTTPStatus.SERVICE_UNAVAILABLE, HTTPStatus.TOO_MANY_REQUESTS):
            self.send_header("Retry-After", "5")
        if status == HTTPStatus.UNAUTHORIZED:
            self.send_header("WWW-Authenticate", 'Bearer realm="lightgesture"')
        self._send_headers(length)

    def _send_headers(self, length: int | None) -> None:
        for name, value in HEADERS.items():
            self.send_header(name, self._frameable(value) if self._web.is_extension else value)
        if length is not None:
            self.send_header("Content-Length", str(length))
        self.end_headers()

    def _send(self, content: bytes, kind: str, status: HTTPStatus = HTTPStatus.OK) -> None:
        self._begin(kind, status, len(content))
        self.wfile.write(content)

    def _refuse(self, refusal: Refusal) -> None:
        self._send(f"{refusal.text}\n".encode(), "text/plain; charset=utf-8", refusal.status)


def to_part(jpeg: bytes) -> bytes:
    """A picture as a part of the stream; the next boundary follows at once, for it is the end of the part."""
    head = f"Content-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
    return head.encode() + jpeg + f"\r\n--{BOUNDARY}\r\n".encode()


def _split(address: str) -> SplitResult:
    """The parts of what was asked for; nothing of what is no address."""
    try:
        return urlsplit(address)
    except ValueError:
        return SplitResult("", "", "", "", "")
