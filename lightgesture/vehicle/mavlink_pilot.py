"""Whether another holds the sticks: from messages on the link, and from the channels that the vehicle says it gets."""

from collections.abc import Iterator
from typing import Any, Final

from lightgesture.sinks.mavlink_peer import Peer
from lightgesture.vehicle.profile import Profile

ECHO_S: Final = 1.5
"""Seconds after our own push in which the vehicle's channels may still show it."""

_MIDDLE_US, _WAY_US, _LEAST_US, _GREATEST_US = 1500, 400, 800, 2200
"""A channel's pulse, microseconds: middle, way to either side, and what is no pulse at all."""

_WAY: Final = 1000
_FIRST_CHANNELS: Final = tuple(range(1, 9))


class PilotWatch:
    """Takes messages; stick_s: the last stick of another; pilot_s: the last that was away from its middle."""

    def __init__(self, profile: Profile, peer: Peer) -> None:
        self._stick, self._safety, self._peer = profile.stick, profile.safety, peer
        self.stick_s: float | None = None
        self.pilot_s: float | None = None
        self._pushed_s = float("-inf")
        self._rest: dict[int, int] = {}

    def note_own(self, is_middle: bool, now_s: float) -> None:
        """We have sent sticks."""
        if not is_middle:
            self._pushed_s = now_s

    def note(self, message: Any, now_s: float) -> None:
        """Look at a message of anyone."""
        kind = message.get_type()
        if kind == "MANUAL_CONTROL" and message.target in (0, self._peer.system):
            self._note_stick(message, now_s)
        elif kind == "RC_CHANNELS_OVERRIDE" and message.target_system in (0, self._peer.system):
            self.stick_s = now_s
            if any(self._is_away(pulse, _MIDDLE_US) for _, pulse in self._pulses(message)):
                self.pilot_s = now_s
        elif (
            kind == "RC_CHANNELS"
            and self._safety.pilot_channels
            and message.get_srcSystem() == self._peer.system
        ):
            self._note_channels(message, now_s)

    def _note_stick(self, message: Any, now_s: float) -> None:
        own = self._stick.system, self._peer.component
        if (message.get_srcSystem(), message.get_srcComponent()) == own:
            return
        self.stick_s = now_s
        z = (message.z - self._stick.z_neutral) / self._stick.z_range
        ways = [message.x / _WAY, message.y / _WAY, message.r / _WAY, z]
        # An axis that a joystick does not have is sent as the largest negative number.
        if any(self._safety.deadband < abs(way) <= 1.5 for way in ways):
            self.pilot_s = now_s

    def _note_channels(self, message: Any, now_s: float) -> None:
        """A channel is moved where it is neither in the middle nor where it was at first: without a pilot it rests
        in one of these."""
        for channel, pulse in self._pulses(message):
            rest = self._rest.setdefault(channel, pulse)
            is_moved = self._is_away(pulse, _MIDDLE_US) and self._is_away(pulse, rest)
            if is_moved and now_s - self._pushed_s > ECHO_S:
                self.pilot_s = now_s

    def _pulses(self, message: Any) -> Iterator[tuple[int, int]]:
        """The pilot's channels and their pulses, microseconds; those without a pulse are left out."""
        for channel in self._safety.pilot_channels or _FIRST_CHANNELS:
            pulse = getattr(message, f"chan{channel}_raw", 0)
            if _LEAST_US <= pulse <= _GREATEST_US:
                yield channel, pulse

    def _is_away(self, pulse: int, place: int) -> bool:
        return abs(pulse - place) > self._safety.deadband * _WAY_US
