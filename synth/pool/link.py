"""Our link to the simulated vehicle without a network: what is sent arrives at once."""

from __future__ import annotations

from typing import Any

from lightgesture.sinks.mavlink_link import Link, Wire
from lightgesture.synth.pool.mavlink_front import MavlinkFront


class PoolLink(Link):
    """A link whose other end is called. `connect` it to a vehicle, whose `write` is `deliver`."""

    def __init__(self) -> None:
        super().__init__("udpout:127.0.0.1:1")  # never opened
        self.name = "mavlink pool"
        self._front: MavlinkFront | None = None
        self._now_s = 0.0
        self._arrived: list[bytes] = []
        self._in: Any = self.dialect.MAVLink(None)

    def connect(self, front: MavlinkFront) -> None:
        """Join the vehicle's end."""
        self._front = front

    def deliver(self, content: bytes) -> None:
        """Bytes from the vehicle."""
        self._arrived.append(bytes(content))

    def set_time(self, now_s: float) -> None:
        """The time at which what is sent from here on arrives."""
        self._now_s = now_s

    @property
    def is_open(self) -> bool:
        """Always."""
        return True

    def open(self) -> None:
        """Nothing is to be opened."""

    def close(self) -> None:
        """Nothing is to be closed."""

    def receive(self) -> list[Any]:
        """The messages that came since the last call."""
        found: list[Any] = []
        for content in self._arrived:
            found += self._in.parse_buffer(content) or []
        self._arrived.clear()
        return found

    def send(self, message: Any, system: int, component: int) -> None:
        """Send a message as from a system and a component."""
        if self._front is not None:
            self._front.receive(self.packed(message, system, component), self._now_s)

    def wire(self) -> Wire | None:
        """No other process can send here."""
        return None
