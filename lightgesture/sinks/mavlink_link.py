"""A link of MAVLink 2 in both directions, of which no call waits."""

import os
import time
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Final

from lightgesture.errors import UsageError, reason_of
from lightgesture.sinks.outbox import SinkError

RECEIVED_READS: Final = 500
"""How often at most is read at a time: enough for a second of a busy link."""

EXPECTED: Final = frozenset(
    {
        *("HEARTBEAT", "COMMAND_ACK", "PARAM_VALUE", "PARAM_ERROR", "CAMERA_IMAGE_CAPTURED"),
        *("MISSION_COUNT", "MISSION_CURRENT", "MISSION_ITEM_REACHED"),
        *("MANUAL_CONTROL", "RC_CHANNELS", "RC_CHANNELS_OVERRIDE"),
        *("SYSTEM_TIME", "ATTITUDE", "GLOBAL_POSITION_INT", "LOCAL_POSITION_NED"),
    }
)
"""Messages that anything is done with; all others, and damaged ones, are dropped as they come."""

MOST_CLIENTS: Final = 8
"""Addresses that a server on UDP sends to; whoever sends a datagram becomes one."""

CLIENT_S: Final = 30.0
"""Seconds of silence after which an address is forgotten where there are more."""

_READ_BYTES: Final = 4096
_SCHEMES = ("udpout", "udpin", "udpbcast", "tcp", "tcpin")


@dataclass(frozen=True, slots=True)
class Wire:
    """What another process needs to send on the same link.

    descriptor: of the socket or the serial device. addresses: where datagrams go; none where the descriptor is
    connected.
    """

    descriptor: int
    addresses: tuple[tuple[str, int], ...] = ()


class Link:
    """Sends and receives messages.

    device: `udpout:HOST:PORT`, `udpin:`, `udpbcast:`, `tcp:`, `tcpin:`, or a serial device and its rate,
    `/dev/ttyAMA0,57600`. dialect: pymavlink's module of messages and their numbers.
    UsageError when made: another device, or pymavlink is not installed.
    """

    def __init__(self, device: str) -> None:
        self.name = f"mavlink {device}"
        self._device = _check_device(device)
        self._mavutil, self.dialect = _import_pymavlink()
        self._connection: Any = None
        self._packers: dict[tuple[int, int], Any] = {}
        self._parser: Any = None

    @property
    def is_open(self) -> bool:
        """Whether messages can be sent."""
        return self._connection is not None

    def open(self) -> None:
        """Open the link. SinkError: it cannot be."""
        self.close()
        try:
            self._connection = self._mavutil.mavlink_connection(self._device, retries=1)
        except Exception as error:  # pyserial and sockets have their own, and pymavlink adds plain ones
            raise SinkError(f"{self.name}: cannot be opened ({reason_of(error)})") from None
        # By itself the link would only print that it is dead, and go on.
        self._connection.handle_eof = self._connection.handle_disconnect = _fail_closed
        self._packers.clear()
        self._parser = self.dialect.MAVLink(None)
        self._parser.robust_parsing = True  # noise on a serial line is passed over

    def close(self) -> None:
        """Close the link."""
        if self._connection is not None:
            with suppress(Exception):  # a device that is gone may complain of anything
                self._connection.close()
            self._connection = None

    def receive(self) -> list[Any]:
        """The messages that are `EXPECTED` and came since the last call. SinkError: the link is dead.

        A server learns so who listens, and a closed link shows itself.
        """
        found: list[Any] = []
        try:
            for _ in range(RECEIVED_READS):
                content = self._connection.recv(_READ_BYTES)
                if not content:
                    break
                found += self._parser.parse_buffer(content) or []
        except OSError as error:
            raise SinkError(f"{self.name}: broke off ({reason_of(error)})") from None
        self._bound_clients()
        self._check()
        return [message for message in found if message.get_type() in EXPECTED]

    def send(self, message: Any, system: int, component: int) -> None:
        """Send a message as from a system and a component. SinkError: the link is dead."""
        try:
            self._connection.write(self.packed(message, system, component))
        except OSError as error:
            raise SinkError(f"{self.name}: broke off ({reason_of(error)})") from None
        self._check()

    def packed(self, message: Any, system: int, component: int) -> bytes:
        """The bytes of a message, with the next number of the sender."""
        key = system, component
        if key not in self._packers:
            self._packers[key] = self.dialect.MAVLink(None, system, component)
        packer = self._packers[key]
        content = bytes(message.pack(packer))
        packer.seq = (packer.seq + 1) % 256
        return content

    def wire(self) -> Wire | None:
        """What another process needs to send here too; None where nobody can be reached yet."""
        if self._connection is None:
            return None
        scheme = self._device.partition(":")[0]
        if scheme == "udpin":
            clients = tuple(self._connection.clients)
            return Wire(self._connection.fd, clients) if clients else None
        if scheme in ("udpout", "udpbcast"):
            return Wire(self._connection.fd, (self._connection.destination_addr,))
        if scheme == "tcpin":
            return None if self._connection.port is None else Wire(self._connection.port.fileno())
        return Wire(self._connection.fd)

    def _bound_clients(self) -> None:
        """Forget addresses beyond the first few that are heard: others would fill the memory, and be sent to."""
        clients = getattr(self._connection, "clients", None)
        if not isinstance(clients, set) or len(clients) <= MOST_CLIENTS:
            return
        alive, now_s = self._connection.clients_last_alive, time.time()
        heard = [address for address, seen_s in alive.items() if now_s - seen_s <= CLIENT_S]
        kept = set(heard[:MOST_CLIENTS])
        clients.intersection_update(kept)
        for address in [address for address in alive if address not in kept]:
            del alive[address]

    def _check(self) -> None:
        if self._connection.portdead:
            raise SinkError(f"{self.name}: broke off (the serial device is gone)")


def _check_device(device: str) -> str:
    """Only links: pymavlink itself would also open logs and run programs."""
    scheme, _, rest = device.partition(":")
    host, _, port = rest.rpartition(":")
    is_address = scheme in _SCHEMES and host and ":" not in host and port.isdecimal() and int(port) <= 0xFFFF
    if not is_address and not device.startswith(("/dev/", "COM")):
        raise UsageError(
            f"--mavlink {device}: is no link; write {', '.join(_SCHEMES)}:HOST:PORT or a device such as "
            "/dev/ttyAMA0,57600"
        )
    return device


def _import_pymavlink() -> tuple[Any, Any]:
    # pymavlink loads the dialect that the environment names, and sets one itself where it names none: the largest.
    os.environ.setdefault("MAVLINK_DIALECT", "common")
    os.environ.setdefault("MAVLINK20", "1")
    try:
        from pymavlink import mavutil
        from pymavlink.dialects.v20 import common
    except ImportError as error:
        raise UsageError(
            f"--mavlink: pymavlink is not installed ({error}); install lightgesture[mavlink]"
        ) from None
    # It prints its troubles on standard output, which belongs to the records.
    module: Any = mavutil
    module.print = _print_nothing
    return module, common


def _print_nothing(*_words: object, **_options: object) -> None:
    """In place of `print`."""


def _fail_closed() -> None:
    raise ConnectionError("closed by the other side")
