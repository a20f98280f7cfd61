"""Which system on a MAVLink link is the vehicle: told, or learnt from its heartbeat."""

from dataclasses import dataclass
from typing import Any, Final

SOURCE_SYSTEM: Final = 1
"""Number of the vehicle, 1 to 255, before it is known: the one that autopilots are delivered with."""

SOURCE_COMPONENT: Final = 191
"""Our own number in it: the first on-board computer."""

TARGET_COMPONENT: Final = 1
"""The autopilot's."""

TIMEOUT_S: Final = 3.0
"""Seconds without a heartbeat after which a system is gone."""

_GROUND_STATION, _NO_AUTOPILOT = 6, 8  # MAV_TYPE_GCS, MAV_AUTOPILOT_INVALID


@dataclass(frozen=True, slots=True)
class Heard:
    """The last heartbeat of the vehicle. number: its mode's."""

    time_s: float
    number: int
    is_armed: bool


class Peer:
    """Takes every heartbeat and knows the vehicle.

    system: its number where the user told it; None: the one autopilot that is heard. component: our own number;
    target: that of the autopilot. A companion has the system's number of its vehicle, so another program with it and
    our component is a rival.
    """

    def __init__(
        self,
        system: int | None = None,
        component: int = SOURCE_COMPONENT,
        target: int = TARGET_COMPONENT,
        timeout_s: float = TIMEOUT_S,
    ) -> None:
        self._told, self.component, self.target, self._timeout_s = system, component, target, timeout_s
        self._seen: dict[int, float] = {}
        self._learnt: int | None = None
        self.heard: Heard | None = None
        self.rival_s: float | None = None

    @property
    def system(self) -> int:
        """The vehicle's number, and so ours; 1 before it is known."""
        return self._told or self._learnt or SOURCE_SYSTEM

    @property
    def trouble(self) -> str:
        """Why nobody can be told anything; "" where one vehicle is known."""
        if self._told is None and len(self._seen) > 1:
            systems = " and ".join(str(system) for system in sorted(self._seen))
            return f"systems {systems} are on the link; name one by --mavlink-system"
        return ""

    def note(self, message: Any, now_s: float) -> None:
        """Take a HEARTBEAT."""
        system, component = message.get_srcSystem(), message.get_srcComponent()
        if (system, component) == (self.system, self.component):
            self.rival_s = now_s
        if component != self.target or not self._is_vehicle(message, system):
            return
        self._seen[system] = now_s
        self.poll(now_s)
        if system == self.system:
            self.heard = Heard(now_s, message.custom_mode, bool(message.base_mode & 128))

    def poll(self, now_s: float) -> None:
        """Let time pass: who is silent is forgotten, and who is left alone is the vehicle."""
        self._seen = {
            system: seen_s for system, seen_s in self._seen.items() if now_s - seen_s <= self._timeout_s
        }
        if len(self._seen) == 1:
            (self._learnt,) = self._seen

    def _is_vehicle(self, message: Any, system: int) -> bool:
        if self._told is not None:
            return system == self._told
        return bool(message.type != _GROUND_STATION and message.autopilot != _NO_AUTOPILOT)
