"""The simulated vehicle by itself, in real time on UDP: python -m lightgesture.synth.pool.vehicle

Any ground station may talk to it. It starts disarmed in MANUAL at 2 m of depth, as a real one does, with a mission of
four programs loaded.
"""

from __future__ import annotations

import argparse
import socket
import sys
import time
from collections.abc import Callable, Sequence
from typing import Final

from lightgesture.cli import exit_status
from lightgesture.console import say
from lightgesture.errors import ExitStatus, UsageError, reason_of
from lightgesture.interruption import stop_signals
from lightgesture.sinks.registry import parse_address
from lightgesture.synth.pool.autopilot import Autopilot, Mode
from lightgesture.synth.pool.body import Body, BodySpec, Motion
from lightgesture.synth.pool.controller import CONTROL_S
from lightgesture.synth.pool.mavlink_front import MavlinkFront
from lightgesture.synth.pool.mission import programs

START_DEPTH_M: Final = 2.0
"""Depth at the start, metres."""
PACKET_BYTES: Final = 2048
"""Longest datagram."""


class Vehicle:
    """Body, autopilot and MAVLink, stepped by `advance`. write: takes what it sends."""

    def __init__(
        self,
        write: Callable[[bytes], None],
        spec: BodySpec | None = None,
        system: int = 1,
        has_position: bool = True,
        depth_m: float = START_DEPTH_M,
        diver_m: tuple[float, float, float] = (1.3, 0.0, START_DEPTH_M),
    ) -> None:
        self.body = Body(spec, depth_m, diver_m)
        items, self.program_items = programs(depth_m)
        self.pilot = Autopilot(self.body.spec.thrust_n, items, has_position)
        self.front = MavlinkFront(self.pilot, write, system)
        self._commands = self.pilot.thrusts(0.0, self.motion)

    @property
    def motion(self) -> Motion:
        """Where it is."""
        return self.body.motion()

    def advance(self, until_s: float) -> None:
        """Go on to a time, one step of the autopilot after the other."""
        while self.body.time_s < until_s - 0.5 * CONTROL_S:
            now_s = self.body.time_s + CONTROL_S
            self.body.advance(now_s, self._commands)
            motion = self.motion
            self._commands = self.pilot.thrusts(now_s, motion)
            self.front.tick(now_s, motion)


class UdpPort:
    """A UDP port that answers whoever wrote to it, and hands on what one peer sends to the others, as routers do."""

    def __init__(self, address: tuple[str, int], others: Sequence[tuple[str, int]] = ()) -> None:
        try:
            self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self._socket.bind(address)
        except OSError as error:
            where = f"{address[0]}:{address[1]}"
            raise UsageError(f"--listen {where}: cannot be had ({reason_of(error)}); take another") from None
        self._socket.setblocking(False)
        self._peers = list(others)

    @property
    def number(self) -> int:
        """Of the port."""
        return int(self._socket.getsockname()[1])

    def send(self, content: bytes, without: tuple[str, int] | None = None) -> None:
        """To all peers."""
        for peer in self._peers:
            if peer != without:
                try:
                    self._socket.sendto(content, peer)
                except OSError:  # nobody there now; the next datagram may find somebody
                    continue

    def receive(self) -> bytes | None:
        """The next datagram, None where none is there."""
        while True:
            try:
                content, peer = self._socket.recvfrom(PACKET_BYTES)
            except BlockingIOError:
                return None
            except OSError:  # tells of an earlier datagram that found nobody
                continue
            if peer not in self._peers:
                self._peers.append(peer)
            self.send(content, without=peer)
            return content

    def close(self) -> None:
        """Free the port."""
        self._socket.close()


def main(argv: Sequence[str] | None = None) -> int:
    """Run until a signal comes."""
    parser = argparse.ArgumentParser(prog="python -m lightgesture.synth.pool.vehicle", description=__doc__)
    parser.add_argument(
        "--listen", default="127.0.0.1:14560", metavar="HOST:PORT", help="default: %(default)s"
    )
    parser.add_argument(
        "--to", action="append", default=[], metavar="HOST:PORT", help="whom to send to at once"
    )
    parser.add_argument("--system", type=int, default=1, metavar="N", help="MAVLink system id (default: 1)")
    parser.add_argument("--no-position", action="store_true", help="without a position sensor")
    parser.add_argument("--armed", action="store_true", help="start armed, in ALT_HOLD")
    parser.add_argument(
        "--current", type=float, nargs=2, default=(0.0, 0.0), metavar=("N", "E"), help="of the water, m/s"
    )
    args = parser.parse_args(argv)
    return exit_status(lambda: _run(args), "the vehicle is gone")


def _run(args: argparse.Namespace) -> int:
    others = [parse_address(text, "--to") for text in args.to]
    port = UdpPort(parse_address(args.listen, "--listen"), others)
    spec = BodySpec(current_mps=(args.current[0], args.current[1]))
    vehicle = Vehicle(port.send, spec, args.system, not args.no_position)
    if args.armed:
        vehicle.pilot.arm(True)
        vehicle.pilot.set_mode(Mode.ALT_HOLD)
    say(f"vehicle {args.system} listens on UDP port {port.number}")
    with stop_signals() as stopping:
        start_s = time.monotonic()
        while not stopping.is_set():
            now_s = time.monotonic() - start_s
            while (datagram := port.receive()) is not None:
                vehicle.front.receive(datagram, vehicle.body.time_s)
            vehicle.advance(now_s)
            time.sleep(max(0.0, CONTROL_S - (time.monotonic() - start_s - now_s)))
    port.close()
    return ExitStatus.OK


if __name__ == "__main__":
    sys.exit(main())
