"""What is sent of the sticks and when: a push with a ramp, and the middle at the end, whatever happens."""

from typing import Final

from lightgesture.vehicle.interface import NEUTRAL, Stick, Vehicle
from lightgesture.vehicle.profile import StickTable

YIELD_S: Final = 0.15
"""Seconds for which the middle is repeated where another holds the sticks: two messages, so that one may get lost,
and then no more that the other's would have to fight."""

QUIET_S: Final = 2.0
"""Seconds without another's stick after which the middle may be sent between tasks."""


def ramped(elapsed_s: float, total_s: float, ramp_s: float) -> float:
    """Share of a push, 0 to 1, `elapsed_s` after its beginning: up and down within `ramp_s` at both ends."""
    if not 0 <= elapsed_s < total_s:
        return 0.0
    if ramp_s <= 0:
        return 1.0
    return max(0.0, min(1.0, elapsed_s / ramp_s, (total_s - elapsed_s) / ramp_s))


class Sticks:
    """Sends where the sticks are, `rate_hz` times a second while they are held and for a while after.

    Nothing is sent before they are first held, nor once the middle was repeated for long enough.
    """

    def __init__(self, vehicle: Vehicle, table: StickTable) -> None:
        self._vehicle, self._table = vehicle, table
        self._stick = NEUTRAL
        self._until_s: float | None = None
        self._sent_s = self._released_s = float("-inf")
        self._is_held = False

    @property
    def is_held(self) -> bool:
        """Whether a task holds them."""
        return self._is_held

    @property
    def is_sent(self) -> bool:
        """Whether they are being sent, the middle after a push included."""
        return self._is_held or self._until_s is not None

    def hold(self, stick: Stick) -> None:
        """From now on they are here; they are sent by `tick`."""
        self._stick, self._is_held, self._until_s = stick, True, None

    def release(self, now_s: float, to_another: bool = False) -> None:
        """To the middle, which is sent at once and repeated; to_another: who holds them now, and so it is brief."""
        if not self._is_held:
            return
        self._stick, self._is_held, self._released_s = NEUTRAL, False, now_s
        self._until_s = now_s + (YIELD_S if to_another else self._table.neutral_s)
        self._send(now_s)

    def tick(self, now_s: float, other_s: float | None = None) -> None:
        """Send them where it is time. other_s: when another's stick was last heard."""
        if self._until_s is not None and other_s is not None and other_s >= self._released_s:
            # Whoever took them since needs no middle of ours in between.
            self._until_s = min(self._until_s, other_s + YIELD_S)
        if self._until_s is not None and now_s > self._until_s:
            self._until_s = None
        if now_s - self._sent_s < 1.0 / self._table.rate_hz - _EARLY_S:
            return
        if self.is_sent or self._is_kept(now_s, other_s):
            self._send(now_s)

    def _is_kept(self, now_s: float, other_s: float | None) -> bool:
        """Whether the middle is sent although nothing is done, which the profile must ask for."""
        return self._table.between and (other_s is None or now_s - other_s > QUIET_S)

    def _send(self, now_s: float) -> None:
        self._sent_s = now_s
        self._vehicle.stick(self._stick, now_s)


_EARLY_S: Final = 0.005
"""By how much a message may come before its time: half of what a thread's sleep is usually off."""
