"""From options to sinks."""

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.sinks.hook import HookSink
from lightgesture.sinks.mavlink_map import MavlinkMap, load_map
from lightgesture.sinks.outbox import Sink
from lightgesture.sinks.udp import UdpSink

_MAX_PORT = 0xFFFF


def make_sinks(settings: DecodeSettings) -> list[Sink]:
    """Every sink that the options name, besides standard output. UsageError: one of them is wrong."""
    if settings.mavlink_map is not None and not settings.mavlink:
        raise UsageError("--mavlink-map: is of no use without --mavlink; name the link too")
    mapping = None if settings.mavlink_map is None else load_map(settings.mavlink_map)
    return [
        *(UdpSink(*parse_address(text, "--udp")) for text in settings.udp),
        *(_make_mavlink(device, mapping) for device in settings.mavlink),
        *(HookSink(command) for command in settings.hook),
    ]


def parse_address(text: str, option: str) -> tuple[str, int]:
    """Host and port of `HOST:PORT`, where a host of IPv6 may stand in brackets. UsageError: it is none."""
    host, _, port = text.rpartition(":")
    host = host.removeprefix("[").removesuffix("]")
    if not host or not (port.isascii() and port.isdecimal() and 0 < int(port) <= _MAX_PORT):
        raise UsageError(f"{option} {text}: is no HOST:PORT; write for example 127.0.0.1:9000")
    return host, int(port)


def _make_mavlink(device: str, mapping: MavlinkMap | None) -> Sink:
    from lightgesture.sinks.mavlink import MavlinkSink

    return MavlinkSink(device, mapping)
