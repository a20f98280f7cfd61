"""Who is at the other ends of `live`: a receiver of datagrams, a browser, a vehicle, each on loopback."""

import http.client
import socket
import threading
import time
from contextlib import suppress
from typing import Final, Self

from lightgesture.synth.pool.autopilot import Autopilot
from lightgesture.synth.pool.body import BodySpec, Motion
from lightgesture.synth.pool.mavlink_front import MavlinkFront

HOST: Final = "127.0.0.1"
WAIT_S: Final = 0.02
"""Longest wait for a datagram, seconds, and so from one tick of the vehicle to the next."""
SPEED: Final = 20.0
"""Seconds of the vehicle a second: the stream runs as much faster than the clock, and wants as many heartbeats."""
DATAGRAM_BYTES: Final = 1 << 16
AT_REST: Final = Motion((0.0, 0.0, 3.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
"""Three metres deep."""


class Peer:
    """Works in a thread of its own within a `with` block. count: of what came."""

    def __init__(self) -> None:
        self.count = 0
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *reason: object) -> None:
        self._is_over.set()
        self._thread.join(5.0)

    def _run(self) -> None:
        raise NotImplementedError


class Receiver(Peer):
    """Takes datagrams on a free port."""

    def __init__(self) -> None:
        super().__init__()
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((HOST, 0))
        self._socket.settimeout(WAIT_S)
        self.port: int = self._socket.getsockname()[1]

    def __exit__(self, *reason: object) -> None:
        super().__exit__(*reason)
        self._socket.close()

    def _run(self) -> None:
        while not self._is_over.is_set():
            with suppress(TimeoutError, ConnectionError):
                content, sender = self._socket.recvfrom(DATAGRAM_BYTES)
                self.count += 1
                self._take(content, sender)
            self._tick()

    def _take(self, content: bytes, sender: tuple[str, int]) -> None:
        """A datagram came."""

    def _tick(self) -> None:
        """Some time passed."""


class SimulatedVehicle(Receiver):
    """An armed vehicle with a position, at rest, that answers as ArduSub does."""

    def __init__(self) -> None:
        super().__init__()
        self._sender: tuple[str, int] | None = None
        pilot = Autopilot(BodySpec().thrust_n)
        pilot.arm(True)
        self._pilot, self._start_s = pilot, time.monotonic()
        self._front = MavlinkFront(pilot, self._send)

    @property
    def _now_s(self) -> float:
        return SPEED * (time.monotonic() - self._start_s)

    def _send(self, content: bytes) -> None:
        if self._sender is not None:
            with suppress(OSError):
                self._socket.sendto(content, self._sender)

    def _take(self, content: bytes, sender: tuple[str, int]) -> None:
        self._sender = sender
        self._front.receive(content, self._now_s)

    def _tick(self) -> None:
        self._pilot.thrusts(self._now_s, AT_REST)
        self._front.tick(self._now_s, AT_REST)


class Browser(Peer):
    """Looks at a page: takes what comes of one path, for as long as it comes. count: bytes."""

    def __init__(self, port: int, path: str) -> None:
        super().__init__()
        self._port, self.path = port, path

    def _run(self) -> None:
        while not self._is_over.is_set():
            connection = http.client.HTTPConnection(HOST, self._port, timeout=1.0)
            with suppress(OSError, http.client.HTTPException):
                connection.request("GET", self.path)
                answer = connection.getresponse()
                while not self._is_over.is_set() and (part := answer.read1(DATAGRAM_BYTES)):
                    self.count += len(part)
            connection.close()
            self._is_over.wait(0.2)


def free_port() -> int:
    """A port of TCP that nobody listens on."""
    with socket.create_server((HOST, 0)) as server:
        port: int = server.getsockname()[1]
        return port
