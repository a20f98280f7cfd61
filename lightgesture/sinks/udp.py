"""Records as JSON in UDP datagrams."""

import errno
import socket
from contextlib import suppress
from typing import Any

from lightgesture.errors import reason_of
from lightgesture.records import Record
from lightgesture.results import to_json_line
from lightgesture.sinks.outbox import RecordError, Sink, SinkError


class UdpSink(Sink):
    """One datagram a record: a JSON object in UTF-8, as standard output has it.

    Whether anybody listens is not known.
    """

    def __init__(self, host: str, port: int) -> None:
        self.name = f"udp {host}:{port}"
        self._host, self._port = host, port
        self._socket: socket.socket | None = None
        self._address: Any = None

    def open(self) -> None:
        """Look the host up. SinkError: it has no address."""
        try:
            found = socket.getaddrinfo(self._host, self._port, type=socket.SOCK_DGRAM)
            family, kind, protocol, _, self._address = found[0]
            self._socket = socket.socket(family, kind, protocol)
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        except (OSError, UnicodeError) as error:
            raise SinkError(f"{self.name}: cannot be opened ({reason_of(error)})") from None

    def send(self, record: Record) -> None:
        """Send one datagram. SinkError: the network is down. RecordError: it is too long."""
        assert self._socket is not None
        try:
            # Not connected, for then the absence of a listener would come back as an error.
            self._socket.sendto(to_json_line(record).encode("utf-8", "surrogateescape"), self._address)
        except OSError as error:
            if error.errno == errno.EMSGSIZE:
                raise RecordError(f"{self.name}: a record of type {record.type} is too long") from None
            raise SinkError(f"{self.name}: cannot be reached ({reason_of(error)})") from None

    def close(self) -> None:
        """Close the socket."""
        if self._socket is not None:
            with suppress(OSError):
                self._socket.close()
            self._socket = None
