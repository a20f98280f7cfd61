"""From options to sinks."""

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.records import VehicleRecord
from lightgesture.sinks.hook import HookSink
from lightgesture.sinks.mavlink_map import MavlinkMap, load_map
from lightgesture.sinks.outbox import Sink
from lightgesture.sinks.udp import UdpSink

if TYPE_CHECKING:
    from lightgesture.sinks.nod import Mover

_MAX_PORT = 0xFFFF


def make_sinks(
    settings: DecodeSettings,
    tell: Callable[[VehicleRecord], None] | None = None,
    clock: Callable[[], float] = time.monotonic,
) -> list[Sink]:
    """Every sink that the options name, besides standard output. UsageError: one of them is wrong.

    tell: takes what a vehicle answers to commands, from any thread. clock: the seconds of these records. With
    `--obey` the first link is the executor's, and no sink.
    """
    mapping = read_map(settings)
    devices = settings.mavlink if settings.obey is None else settings.mavlink[1:]
    return [
        *(UdpSink(*parse_address(text, "--udp")) for text in settings.udp),
        *(_make_mavlink(device, mapping, settings.mavlink_system, tell, clock) for device in devices),
        *(HookSink(command) for command in settings.hook),
    ]


def make_answers(settings: DecodeSettings, mover: "Mover | None") -> list[Sink]:
    """The sinks of `--answer`. mover: who moves the vehicle, None: nobody. UsageError: one of them is wrong."""
    return [_make_answer(text, mover) for text in settings.answer]


def _make_answer(text: str, mover: "Mover | None") -> Sink:
    kind, _, rest = text.partition(":")
    if kind == "lamp":
        from lightgesture.sinks.lamp import LampSink, parse_pins

        return LampSink(parse_pins(rest), obeys=mover is not None)
    if text == "motion":
        from lightgesture.sinks.nod import MotionSink

        if mover is None:
            raise UsageError("--answer motion: moves nothing without --obey; add it, or leave the motion out")
        return MotionSink(mover)
    raise UsageError(f"--answer {text}: should be lamp:GREEN,ORANGE,RED or motion; change it")


def parse_address(text: str, option: str) -> tuple[str, int]:
    """Host and port of `HOST:PORT`, where a host of IPv6 may stand in brackets. UsageError: it is none."""
    host, _, port = text.rpartition(":")
    host = host.removeprefix("[").removesuffix("]")
    if not host or not (port.isascii() and port.isdecimal() and 0 < int(port) <= _MAX_PORT):
        raise UsageError(f"{option} {text}: is no HOST:PORT; write for example 127.0.0.1:9000")
    return host, int(port)


def read_map(settings: DecodeSettings) -> MavlinkMap | None:
    """The map of values and commands, None where there is none. UsageError: it is wrong, or there is no link for it."""
    for name in ("mavlink_map", "mavlink_system"):
        if getattr(settings, name) is not None and not settings.mavlink:
            raise UsageError(f"--{name.replace('_', '-')}: is of no use without --mavlink; name the link too")
    return None if settings.mavlink_map is None else load_map(settings.mavlink_map)


def _make_mavlink(
    device: str,
    mapping: MavlinkMap | None,
    system: int | None,
    tell: Callable[[VehicleRecord], None] | None,
    clock: Callable[[], float],
) -> Sink:
    from lightgesture.sinks.mavlink import MavlinkSink

    return MavlinkSink(device, mapping, system=system, tell=tell, clock=clock)
