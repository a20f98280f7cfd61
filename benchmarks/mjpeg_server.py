"""A network camera for trials: `python -m lightgesture.benchmarks.mjpeg_server VIDEO` sends it round and round.

Each client gets the pictures from the first one on, in the steps of a clock that does not wait for it.
"""

import argparse
import http.server
import sys
import threading
import time
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Self

from lightgesture.console import messages_shown, say
from lightgesture.errors import ExitStatus, InputError

_BOUNDARY = "frame"


class MjpegServer:
    """Serves JPEG files as MJPEG over HTTP on loopback, from a thread of its own; use it in a `with` block.

    pictures: JPEG files. fps: pictures a second. port: 0 for any free one. limit: pictures after which an answer ends,
    None for never. note: is called with the number of each picture, counted in its answer from 0, before it is sent.
    """

    def __init__(
        self,
        pictures: Sequence[bytes],
        fps: float,
        port: int = 0,
        limit: int | None = None,
        note: Callable[[int], None] | None = None,
    ) -> None:
        self.pictures, self.fps, self.limit = pictures, fps, limit
        self._note = note
        self._stopping = threading.Event()
        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", port), self._make_handler())
        self._server.daemon_threads = True
        self.port: int = self._server.server_address[1]
        self.address = f"http://127.0.0.1:{self.port}/?action=stream"
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.05,), daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stopping.set()
        self._server.shutdown()
        self._server.server_close()

    def _make_handler(self) -> type[http.server.BaseHTTPRequestHandler]:
        serve = self._serve

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                serve(self)

            def log_message(self, format: str, *args: object) -> None:  # noqa: A002
                """Standard error is for messages to the user."""

        return Handler

    def _serve(self, handler: http.server.BaseHTTPRequestHandler) -> None:
        handler.send_response(200)
        handler.send_header("Content-Type", f"multipart/x-mixed-replace; boundary={_BOUNDARY}")
        handler.end_headers()
        start_s = time.monotonic()
        number = 0
        while number != self.limit and not self._stopping.wait(
            max(0.0, start_s + number / self.fps - time.monotonic())
        ):
            picture = self.pictures[number % len(self.pictures)]
            head = f"--{_BOUNDARY}\r\nContent-Type: image/jpeg\r\nContent-Length: {len(picture)}\r\n\r\n"
            if self._note is not None:
                self._note(number)
            try:
                handler.wfile.write(head.encode("ascii") + picture + b"\r\n")
            except OSError:  # the client went away
                return
            number += 1


def read_jpegs(path: str) -> list[bytes]:
    """Every frame of a video as a JPEG file. InputError: it is none."""
    import cv2

    from lightgesture.sources import open_source

    with open_source(path) as source:
        return [cv2.imencode(".jpg", frame.image)[1].tobytes() for frame in source]


@messages_shown()
def main(argv: Sequence[str] | None = None) -> int:
    """Serve until interrupted."""
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False)
    parser.add_argument("video", metavar="VIDEO")
    parser.add_argument("--fps", type=float, default=30.0, metavar="F", help="default 30")
    parser.add_argument("--port", type=int, default=8090, metavar="N", help="default 8090")
    args = parser.parse_args(argv)
    try:
        with MjpegServer(read_jpegs(args.video), args.fps, args.port) as server:
            say(f"serving {server.address} until Ctrl-C")
            threading.Event().wait()
    except InputError as error:
        say(str(error))
        return ExitStatus.SOME_FAILED
    except KeyboardInterrupt:
        pass
    return ExitStatus.OK


if __name__ == "__main__":
    sys.exit(main())
