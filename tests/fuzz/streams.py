"""Targets that come over a line: JPEG files, answers of cameras, MAVLink, requests to the page."""

import socket
import sys
import threading
from contextlib import suppress
from functools import cache
from itertools import islice
from typing import Any

from lightgesture.errors import InputError
from lightgesture.fsm import load_grammar
from lightgesture.sinks.mavlink_link import Link
from lightgesture.sources.http_stream import HttpStream
from lightgesture.sources.jpeg import JpegSplitter
from lightgesture.sources.pictures import to_image
from lightgesture.vehicle import ReadParameter, SetMode, StartMission, TakePictures, WriteParameter
from lightgesture.vehicle.mavlink_vehicle import MavlinkVehicle
from lightgesture.vehicle.profile_file import load_vehicle
from lightgesture.web.board import Board
from lightgesture.web.language import Language
from lightgesture.web.server import WebServer

from .scratch import FaultError

LOOPBACK = "127.0.0.1"
PICTURES = 2
WAIT_S = 2.0
"""Longest wait for an answer that has to come."""
ORDERS = (
    SetMode(names=("STABILIZE", "MANUAL")),
    ReadParameter(name="SURFACE_DEPTH"),
    WriteParameter(name="PILOT_SPEED", value=50.0),
    TakePictures(component=100, interval_s=0.0, count=1),
    StartMission(first=1, last=3, mode="AUTO"),
)
"""What the vehicle is asked for, so that every answer has somebody who waits for it."""
GOING_ON = (b"/events", b"/stream.mjpg")
"""Requests whose answers have no end."""


def mjpeg(content: bytes) -> None:
    """However the bytes are cut, the same files come out."""
    whole = JpegSplitter(max_bytes=1 << 16).feed(content)
    splitter = JpegSplitter(max_bytes=1 << 16)
    step = 1 + (content[0] if content else 0)
    parts = [content[place : place + step] for place in range(0, len(content), step)]
    if [file for part in parts for file in splitter.feed(part)] != whole:
        raise FaultError("files depend on how the stream was cut")
    for file in whole[:PICTURES]:
        with suppress(InputError):
            to_image(file)


def camera(content: bytes) -> None:
    """The answer of a camera over HTTP, whole."""
    server = _Camera.running()
    server.answer = content
    with HttpStream(f"http://user:word@{LOOPBACK}:{server.port}/video") as stream:
        for file in islice(stream, PICTURES):
            with suppress(InputError):
                to_image(file)


def mavlink(content: bytes) -> None:
    """Bytes as they come on the link of a vehicle that was asked for something."""
    _vehicle_told(content[place : place + 280] for place in range(0, min(len(content), 2800), 280))


def mavlink_messages(content: bytes) -> None:
    """Messages that are whole: kind, system and component of each are the content's, and its fields."""
    dialect = Link(f"udpin:{LOOPBACK}:0").dialect
    kinds = sorted(dialect.mavlink_map)
    packets = []
    for place in range(0, min(len(content), 640), 64):
        part = content[place : place + 64].ljust(64, b"\0")
        kind = dialect.mavlink_map[kinds[int.from_bytes(part[:2], "big") % len(kinds)]]
        packer = dialect.MAVLink(None, part[2] or 1, part[3])
        fields = part[4:].ljust(kind.unpacker.size, b"\0")[: kind.unpacker.size]
        made = kind(*_arguments(kind, fields))
        with suppress(Exception):  # what cannot be packed cannot be sent either
            packets.append(bytes(made.pack(packer)))
    _vehicle_told(packets)


def request(content: bytes) -> None:
    """A request to the page: it is answered or left, and the next one is answered."""
    server = _Page.running()
    answer = _ask(server.server_port, content)
    if answer and not answer.startswith(b"HTTP/1."):
        raise FaultError(f"no answer of HTTP: {answer[:60]!r}")
    if server.errors:
        raise server.errors.pop()


def _vehicle_told(parts: Any) -> None:
    vehicle, sender = _vehicle()
    now_s = _Clock.tick()
    for order in ORDERS:
        vehicle.order(order, now_s)
    for part in parts:
        if part:
            sender.send(part)
    status = vehicle.poll(now_s + 0.01)
    if status.trouble.count("\n"):
        raise FaultError("trouble of several lines")


@cache
def _vehicle() -> tuple[MavlinkVehicle, socket.socket]:
    port = _free_port()
    vehicle = MavlinkVehicle(Link(f"udpin:{LOOPBACK}:{port}"), load_vehicle("ardusub"), clock=_Clock.now)
    vehicle.poll(0.0)
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.connect((LOOPBACK, port))
    return vehicle, sender


class _Clock:
    """Seconds that pass only with the inputs."""

    seconds = 1.0

    @classmethod
    def now(cls) -> float:
        return cls.seconds

    @classmethod
    def tick(cls) -> float:
        cls.seconds += 0.25
        return cls.seconds


class _Camera:
    """Answers every request with the same bytes and ends the connection."""

    def __init__(self) -> None:
        self.answer = b""
        self._listening = socket.create_server((LOOPBACK, 0))
        self.port = self._listening.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    @staticmethod
    @cache
    def running() -> "_Camera":
        return _Camera()

    def _serve(self) -> None:
        while True:
            peer, _ = self._listening.accept()
            with peer, suppress(OSError):
                peer.settimeout(WAIT_S)
                peer.recv(1 << 16)
                peer.sendall(self.answer)
                peer.shutdown(socket.SHUT_WR)


class _Page(WebServer):
    """The page, which keeps what went wrong in its threads."""

    def __init__(self) -> None:
        language = Language(load_grammar())
        super().__init__(LOOPBACK, 0, Board(language.expected), language.files())
        self.errors: list[BaseException] = []
        threading.Thread(target=self.serve_forever, args=(0.05,), daemon=True).start()

    @staticmethod
    @cache
    def running() -> "_Page":
        return _Page()

    def handle_error(self, request: Any, client_address: Any) -> None:
        error = sys.exception()
        if error is not None and not isinstance(error, OSError):
            self.errors.append(error)


def _ask(port: int, content: bytes) -> bytes:
    """The answer, or the first part of one that has no end."""
    answer = b""
    with socket.create_connection((LOOPBACK, port), WAIT_S) as peer, suppress(ConnectionError):
        peer.sendall(content)
        peer.shutdown(socket.SHUT_WR)
        is_endless = any(path in content for path in GOING_ON)
        while part := peer.recv(1 << 16):
            answer += part
            if is_endless:
                break
    return answer


def _arguments(kind: Any, fields: bytes) -> list[Any]:
    """Values of the fields of a message, in the order that its class takes them in."""
    values = list(kind.unpacker.unpack(fields))
    arguments: list[Any] = []
    place = 0
    for name, length in zip(kind.ordered_fieldnames, kind.array_lengths, strict=True):
        is_list = length > 0 and not isinstance(values[place], bytes)
        taken = length if is_list else 1
        arguments.append((name, values[place : place + taken] if is_list else values[place]))
        place += taken
    by_name = dict(arguments)
    return [by_name[name] for name in kind.fieldnames]


def _free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind((LOOPBACK, 0))
        return int(probe.getsockname()[1])
