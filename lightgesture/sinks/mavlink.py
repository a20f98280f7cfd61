"""Records to a vehicle and its ground station by MAVLink 2."""

import time
from collections.abc import Callable
from typing import Final

from lightgesture.records import Record
from lightgesture.sinks.mavlink_companion import Companion, Tell
from lightgesture.sinks.mavlink_jobs import Talk
from lightgesture.sinks.mavlink_link import Link
from lightgesture.sinks.mavlink_map import MavlinkMap
from lightgesture.sinks.mavlink_peer import Peer
from lightgesture.sinks.outbox import Sink

POLL_S: Final = 0.1
"""Seconds from one look at what came to the next: a refusal is told so much later at most."""


class MavlinkSink(Sink):
    """HEARTBEAT with each heartbeat record, STATUSTEXT for instructions, rejections and refusals, and what the map
    says.

    device: as of `Link`. Without a map no value and no command is sent, with one only commands that it permits. system:
    number of the vehicle; None: learnt from its heartbeat. tell: takes what the vehicle answers to the map's commands.
    clock: seconds that never jump. UsageError when made: as of `Link`.
    """

    poll_s = POLL_S

    def __init__(
        self,
        device: str,
        mapping: MavlinkMap | None = None,
        *,
        system: int | None = None,
        tell: Tell | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._link = Link(device)
        self.name = self._link.name
        target = None if mapping is None else mapping.target_system
        self._peer = Peer(system if system is not None else target)
        self._companion = Companion(Talk(self._link, self._peer), mapping, tell)
        self._clock = clock

    def wants(self, record: Record) -> bool:
        """Heartbeats, and records that are worth a text."""
        return self._companion.wants(record)

    def open(self) -> None:
        """Open the link. SinkError: it cannot be."""
        self._link.open()

    def send(self, record: Record) -> None:
        """Send the messages of one record. SinkError: the link is dead."""
        self.poll()
        self._companion.send(record, self._clock())

    def poll(self) -> None:
        """Take in what others say. SinkError: the link is dead."""
        now_s = self._clock()
        for message in self._link.receive():
            if message.get_type() == "HEARTBEAT":
                self._peer.note(message, now_s)
            self._companion.note(message, now_s)
        self._peer.poll(now_s)
        self._companion.poll(now_s)

    def close(self) -> None:
        """Close the link."""
        self._link.close()
