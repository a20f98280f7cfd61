"""Records to a vehicle and its ground station by MAVLink 2."""

import os
from contextlib import suppress
from typing import Any, Final

from lightgesture.errors import UsageError, reason_of
from lightgesture.fsm import Instruction
from lightgesture.records import HeartbeatRecord, Record
from lightgesture.sinks.mavlink_map import MavlinkMap
from lightgesture.sinks.outbox import Sink, SinkError

TEXT_BYTES = 50
"""Bytes of text in one STATUSTEXT."""

_SCHEMES = ("udpout", "udpin", "udpbcast", "tcp", "tcpin")
_MILLISECONDS, _UINT32, _INT32 = 1000.0, 0xFFFFFFFF, 0x7FFFFFFF


SOURCE_SYSTEM: Final = 1
"""Number of the vehicle, 1 to 255, as it is set in the autopilot."""

SOURCE_COMPONENT: Final = 191
"""Our own number in it: the first on-board computer."""

PREFIX: Final = "Diver: "
"""Begins each text, so that who hears it knows where it is from."""

RECEIVED_READS: Final = 500
"""How often at most what others send is read away before a message is sent: enough for a second of a busy link."""


class MavlinkSink(Sink):
    """HEARTBEAT with each heartbeat record, STATUSTEXT for each accepted instruction, and what the map says.

    device: `udpout:HOST:PORT`, `udpin:`, `udpbcast:`, `tcp:`, `tcpin:`, or a serial device and its rate,
    `/dev/ttyAMA0,57600`. Without a map no value and no command is sent, with one only commands that it permits.
    UsageError when made: another device, or pymavlink is not installed.
    """

    def __init__(self, device: str, mapping: MavlinkMap | None = None) -> None:
        self.name = f"mavlink {device}"
        self._device = _check_device(device)
        self._mapping = mapping or MavlinkMap()
        self._mavutil, self._dialect = _import_pymavlink()
        self._connection: Any = None
        self._packer: Any = None
        self._texts = 0

    def wants(self, record: Record) -> bool:
        """Heartbeats and accepted instructions."""
        return isinstance(record, HeartbeatRecord | Instruction)

    def open(self) -> None:
        """Open the link. SinkError: it cannot be."""
        try:
            self._connection = self._mavutil.mavlink_connection(
                self._device,
                source_system=SOURCE_SYSTEM,
                source_component=SOURCE_COMPONENT,
                retries=1,
            )
        except Exception as error:  # pyserial and sockets have their own, and pymavlink adds plain ones
            raise SinkError(f"{self.name}: cannot be opened ({reason_of(error)})") from None
        # By itself the link would only print that it is dead, and go on.
        self._connection.handle_eof = self._connection.handle_disconnect = _fail_closed
        self._packer = self._dialect.MAVLink(self._connection, SOURCE_SYSTEM, SOURCE_COMPONENT)

    def send(self, record: Record) -> None:
        """Send the messages of one record. SinkError: the link is dead."""
        try:
            self._read_away()
            if isinstance(record, Instruction):
                self._send_instruction(record)
            else:
                self._send_heartbeat()
        except OSError as error:
            raise SinkError(f"{self.name}: broke off ({reason_of(error)})") from None
        if self._connection.portdead:
            raise SinkError(f"{self.name}: broke off (the serial device is gone)")

    def close(self) -> None:
        """Close the link."""
        if self._connection is not None:
            with suppress(Exception):  # a device that is gone may complain of anything
                self._connection.close()
            self._connection = None

    def _read_away(self) -> None:
        """Receive and forget: a server learns so who listens, and a closed link shows itself."""
        for _ in range(RECEIVED_READS):
            if not self._connection.recv(4096):
                break

    def _send_heartbeat(self) -> None:
        dialect = self._dialect
        self._packer.heartbeat_send(
            dialect.MAV_TYPE_ONBOARD_CONTROLLER,
            dialect.MAV_AUTOPILOT_INVALID,
            0,  # base mode: no flag, and so never the one that says "armed"
            0,
            dialect.MAV_STATE_ACTIVE,
        )

    def _send_instruction(self, record: Instruction) -> None:
        self._send_text(PREFIX + record.text)
        time_ms = int(record.time_s * _MILLISECONDS) & _UINT32
        for rule, number in self._mapping.values(record):
            name = rule.name.encode("ascii")
            if rule.is_float:
                self._packer.named_value_float_send(time_ms, name, number)
            else:
                self._packer.named_value_int_send(time_ms, name, max(-_INT32, min(_INT32, round(number))))
        for command, params in self._mapping.commands(record):
            self._packer.command_long_send(
                self._mapping.target_system, self._mapping.target_component, command, 0, *params
            )

    def _send_text(self, text: str) -> None:
        chunks = text_chunks(text)
        if len(chunks) > 1:  # 0 marks a text of one chunk
            self._texts = self._texts % 0xFFFF + 1
        number = self._texts if len(chunks) > 1 else 0
        for place, chunk in enumerate(chunks):
            self._packer.statustext_send(self._dialect.MAV_SEVERITY_NOTICE, chunk, number, place)


def text_chunks(text: str) -> list[bytes]:
    """UTF-8 in pieces of at most 50 bytes; where the last would be full, an empty one follows to mark the end."""
    content = text.encode("utf-8", "replace")
    chunks = [content[start : start + TEXT_BYTES] for start in range(0, len(content), TEXT_BYTES)]
    if len(chunks) > 1 and len(chunks[-1]) == TEXT_BYTES:
        chunks.append(b"")
    return chunks or [b""]


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
