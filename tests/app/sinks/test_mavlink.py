"""MAVLink over loopback, read by pymavlink's own parser."""

import itertools
import socket
import time

import pytest
from pymavlink.dialects.v20 import common

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.sinks import SinkError, make_sinks
from lightgesture.sinks.mavlink import MavlinkSink
from lightgesture.sinks.mavlink_link import EXPECTED, MOST_CLIENTS, Link
from lightgesture.sinks.mavlink_texts import text_chunks
from tests.app.sinks.mavlink_station import send


def test_heartbeat_of_a_companion_that_is_not_armed(station, heartbeat):
    send(station.link, heartbeat(), heartbeat())
    first, second = station.messages()
    assert (first.get_srcSystem(), first.get_srcComponent()) == (1, common.MAV_COMP_ID_ONBOARD_COMPUTER)
    assert first.type == common.MAV_TYPE_ONBOARD_CONTROLLER
    assert first.autopilot == common.MAV_AUTOPILOT_INVALID
    assert (first.base_mode, first.system_status) == (0, common.MAV_STATE_ACTIVE)
    assert second.get_seq() == first.get_seq() + 1


def test_an_instruction_is_a_text_and_nothing_else(station, instruction):
    send(station.link, instruction())
    (message,) = station.messages()
    assert (message.get_type(), message.severity) == ("STATUSTEXT", common.MAV_SEVERITY_NOTICE)
    assert (message.text, message.id, message.chunk_seq) == ("Diver: STOP HOVER 50 GO", 0, 0)


def test_long_texts_come_in_chunks_that_belong_together(station, instruction):
    texts = ["STOP " + " ".join(["HOVER 50"] * 12) + " GO", "X" * 93]
    send(station.link, *(instruction(text=text) for text in texts))
    groups = [list(group) for _, group in itertools.groupby(station.messages(), lambda message: message.id)]
    assert ["".join(message.text for message in group) for group in groups] == [
        "Diver: " + text for text in texts
    ]
    assert [[message.chunk_seq for message in group] for group in groups] == [[0, 1, 2], [0, 1, 2]]
    assert len({group[0].id for group in groups} - {0}) == 2


def test_chunks():
    assert text_chunks("") == [b""]
    assert text_chunks("a" * 50) == [b"a" * 50]
    assert text_chunks("a" * 51) == [b"a" * 50, b"a"]
    assert text_chunks("a" * 100) == [b"a" * 50, b"a" * 50, b""]


def test_a_station_that_must_speak_first(heartbeat, station, capsys):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as unused:
        unused.bind(("127.0.0.1", 0))
        port = unused.getsockname()[1]
    sink = MavlinkSink(f"udpin:127.0.0.1:{port}")
    sink.open()
    sink.send(heartbeat())
    assert station.messages() == []
    station.socket.sendto(b"anything", ("127.0.0.1", port))
    sink.send(heartbeat())
    assert [message.get_type() for message in station.messages()] == ["HEARTBEAT"]
    sink.close()
    assert capsys.readouterr().out == ""


def send_until_it_fails(sink, record):
    """A peer that has left is known once its answer to the last message is here."""
    for _ in range(200):
        sink.send(record)
        time.sleep(0.01)


def test_tcp_that_is_refused_and_that_is_closed(heartbeat, capsys):
    with socket.create_server(("127.0.0.1", 0)) as server:
        sink = MavlinkSink(f"tcp:127.0.0.1:{server.getsockname()[1]}")
        sink.open()
        peer, _ = server.accept()
        sink.send(heartbeat())
        assert peer.recv(1) == b"\xfd"
        peer.close()
        with pytest.raises(SinkError, match=r"^mavlink tcp:127.*: broke off \("):
            send_until_it_fails(sink, heartbeat())
        sink.close()
    with pytest.raises(SinkError, match=r"cannot be opened \(Connection refused\)"):
        sink.open()
    sink.close()
    assert capsys.readouterr().out == ""  # the records' own place


def test_a_udp_port_in_use(station):
    port = station.link.rpartition(":")[2]
    with pytest.raises(SinkError, match=r"^mavlink udpin:.*: cannot be opened \(Address already in use\)"):
        MavlinkSink(f"udpin:127.0.0.1:{port}").open()


def test_a_serial_device_that_is_not_there():
    with pytest.raises(SinkError, match=r"^mavlink /dev/no-such-tty,57600: cannot be opened"):
        MavlinkSink("/dev/no-such-tty,57600").open()


@pytest.mark.parametrize(
    "device",
    [
        "",
        "udpout:host",
        "udpout::14550",
        "udpout:host:99999",
        "csv:a.csv",
        "dive.tlog",
        "/bin/true",
        "tcp:a:b:1",
    ],
)
def test_only_links_are_opened(device):
    with pytest.raises(UsageError, match="is no link; write udpout, udpin"):
        MavlinkSink(device)


def test_without_the_extra(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pymavlink", None)
    with pytest.raises(UsageError, match=r"install lightgesture\[mavlink\]"):
        MavlinkSink("udpout:127.0.0.1:14550")


def test_a_number_without_a_link():
    with pytest.raises(UsageError, match="--mavlink-system: is of no use without --mavlink"):
        make_sinks(DecodeSettings(mavlink_system=2))


@pytest.fixture
def server():
    """An open link that listens at a port, and what sends to it as from a system."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    link = Link(f"udpin:127.0.0.1:{port}")
    link.open()
    yield link, ("127.0.0.1", port)
    link.close()


def test_messages_that_nobody_expects_are_dropped_as_they_come(server):
    link, address = server
    packer = common.MAVLink(None, 1, 1)
    sent = [
        common.MAVLink_heartbeat_message(12, 3, 128, 19, 4, 3),
        common.MAVLink_statustext_message(6, b"x" * 50),
        common.MAVLink_file_transfer_protocol_message(0, 1, 191, [0] * 251),
        common.MAVLink_command_long_message(1, 191, 400, 0, 1, 0, 0, 0, 0, 0, 0),
        common.MAVLink_set_mode_message(1, 1, 19),
        common.MAVLink_command_ack_message(2000, 0),
    ]
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as peer:
        for message in sent:
            peer.sendto(message.pack(packer), address)
        peer.sendto(bytes(range(256)) * 8, address)
        time.sleep(0.1)
    kinds = [message.get_type() for message in link.receive()]
    assert kinds == ["HEARTBEAT", "COMMAND_ACK"]
    assert set(kinds) <= EXPECTED


def test_only_a_few_addresses_are_sent_to(server):
    link, address = server
    packer = common.MAVLink(None, 1, 1)
    beat = common.MAVLink_heartbeat_message(12, 3, 128, 19, 4, 3).pack(packer)
    peers = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(3 * MOST_CLIENTS)]
    for peer in peers:
        peer.sendto(beat, address)
    time.sleep(0.1)
    link.receive()
    wire = link.wire()
    assert wire is not None
    first = {("127.0.0.1", peer.getsockname()[1]) for peer in peers[:MOST_CLIENTS]}
    assert set(wire.addresses) == first
    for peer in peers:
        peer.close()
