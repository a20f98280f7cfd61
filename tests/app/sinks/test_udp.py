"""JSON datagrams."""

import errno
import json
import socket

import pytest

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.sinks import RecordError, SinkError, make_sinks
from lightgesture.sinks.registry import parse_address
from lightgesture.sinks.udp import UdpSink


@pytest.fixture
def listener():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(5)
        yield receiver


def test_a_datagram_a_record(listener, instruction, heartbeat):
    sink = UdpSink("127.0.0.1", listener.getsockname()[1])
    sink.open()
    for record in (instruction(source="k\udcffm"), heartbeat()):
        assert sink.wants(record)
        sink.send(record)
        assert json.loads(listener.recv(65536).decode("utf-8", "surrogateescape")) == record.to_dict()
    sink.close()


def test_nobody_listening_is_no_failure(instruction):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as unused:
        unused.bind(("127.0.0.1", 0))
        port = unused.getsockname()[1]
    sink = UdpSink("127.0.0.1", port)
    sink.open()
    for _ in range(3):
        sink.send(instruction())
    sink.close()


def test_a_host_that_is_not_known():
    sink = UdpSink("no-such-host.invalid", 9)
    with pytest.raises(SinkError, match=r"^udp no-such-host.invalid:9: cannot be opened \("):
        sink.open()
    sink.close()
    with pytest.raises(SinkError, match="cannot be opened"):
        UdpSink("a" * 70 + ".example", 9).open()


class FailingSocket:
    def __init__(self, number):
        self.number = number

    def setsockopt(self, *option):
        pass

    def sendto(self, content, address):
        raise OSError(self.number, "the reason")


@pytest.mark.parametrize(
    ("number", "kind"),
    [(errno.ENETUNREACH, SinkError), (errno.EMSGSIZE, RecordError), (errno.EPERM, SinkError)],
)
def test_what_cannot_be_sent(instruction, number, kind, monkeypatch):
    monkeypatch.setattr(socket, "socket", lambda *_: FailingSocket(number))
    sink = UdpSink("127.0.0.1", 9)
    sink.open()
    with pytest.raises(kind, match=r"^udp 127"):
        sink.send(instruction())


def test_addresses():
    assert parse_address("rov.local:9000", "--udp") == ("rov.local", 9000)
    assert parse_address("[::1]:9000", "--udp") == ("::1", 9000)


@pytest.mark.parametrize(
    "text", ["", "9000", "host", "host:", ":9000", "host:0", "host:65536", "host:1e3", "host:٣"]
)
def test_no_addresses(text):
    with pytest.raises(UsageError, match=r"is no HOST:PORT; write for example 127.0.0.1:9000"):
        make_sinks(DecodeSettings(udp=[text]))
