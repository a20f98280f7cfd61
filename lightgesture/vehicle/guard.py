"""What ends a task: pure functions of what is known of the vehicle, of the camera and of the diver."""

from dataclasses import dataclass
from typing import Final

from lightgesture.vehicle.interface import Status
from lightgesture.vehicle.profile import Profile

PILOT_S: Final = 2.0
"""Seconds for which a pilot who moved a stick is taken to steer."""

STICK_S: Final = 1.0
"""Seconds after another's last stick, moved or not, in which we do not hold any: two senders would pull to and fro."""

RIVAL_S: Final = 5.0
"""Seconds for which another companion with our number counts as there."""


@dataclass(frozen=True, slots=True)
class Fault:
    """Why a task ends. is_anothers: whether someone else has taken the vehicle, so that no mode is changed after it."""

    reason: str
    is_anothers: bool = False


@dataclass(frozen=True, slots=True)
class Senses:
    """Times of the steady clock. picture_s: the newest picture; hand_s: the last hand in one; None: never. hole: what
    the decoder says is wrong with the pictures."""

    picture_s: float | None = None
    hand_s: float | None = None
    hole: str | None = None


def is_recent(moment_s: float | None, now_s: float, span_s: float) -> bool:
    """Whether something was at most `span_s` ago."""
    return moment_s is not None and now_s - moment_s <= span_s


def last_of_another(status: Status) -> float | None:
    """When another's stick was last heard, or seen to move; None: never."""
    return max(
        (moment_s for moment_s in (status.stick_s, status.pilot_s) if moment_s is not None), default=None
    )


def obstacle(status: Status, senses: Senses, now_s: float, profile: Profile) -> str | None:
    """Why nothing at all is begun; None: nothing stands against it."""
    safety = profile.safety
    if status.trouble:
        return status.trouble
    if status.heard_s is None:
        return "no vehicle was heard yet; see the link and the system's number"
    if not is_recent(status.heard_s, now_s, profile.link.timeout_s):
        return f"no heartbeat of the vehicle for {now_s - status.heard_s:.1f} s"
    if is_recent(status.rival_s, now_s, RIVAL_S):
        return "another companion with our number is on the link; give this one another [link] component"
    if not is_recent(senses.picture_s, now_s, safety.stale_s):
        return "no fresh picture"
    return None


def obstacle_to_motion(status: Status, now_s: float, profile: Profile, uses_sticks: bool) -> str | None:
    """Why nothing is begun that moves the vehicle; None: nothing stands against it."""
    if profile.safety.needs_armed and not status.is_armed:
        return "the vehicle is not armed, and only its pilot arms it"
    if is_recent(status.pilot_s, now_s, PILOT_S):
        return "the pilot is steering"
    if uses_sticks and is_recent(status.stick_s, now_s, STICK_S):
        return "another's stick is on the link, and the two would pull to and fro; switch the joystick off"
    return None


def fault(
    status: Status,
    begun: Status,
    begun_s: float,
    senses: Senses,
    now_s: float,
    profile: Profile,
    uses_sticks: bool = False,
) -> Fault | None:
    """Why a task that moves the vehicle must end; None: it may go on. begun, begun_s: the status at its beginning, and
    when that was. uses_sticks: whether it holds sticks, which then nobody else may send."""
    if status.pilot_s is not None and status.pilot_s > begun_s:
        return Fault("a pilot moved a stick", is_anothers=True)
    if uses_sticks and status.stick_s is not None and status.stick_s > begun_s:
        return Fault("another's stick is on the link", is_anothers=True)
    if status.foreign_modes != begun.foreign_modes:
        return Fault(f"someone else changed the mode to {status.mode}", is_anothers=True)
    if status.boots != begun.boots:
        return Fault("the vehicle started anew", is_anothers=True)
    if profile.safety.needs_armed and not status.is_armed:
        return Fault("the vehicle was disarmed", is_anothers=True)
    if status.trouble:
        return Fault(status.trouble)
    if not is_recent(status.heard_s, now_s, profile.link.timeout_s):
        return Fault(f"the link is lost: no heartbeat for {profile.link.timeout_s:g} s")
    if is_recent(status.rival_s, now_s, RIVAL_S):
        return Fault("another companion with our number is on the link")
    return _fault_of_senses(senses, begun_s, now_s, profile)


def _fault_of_senses(senses: Senses, begun_s: float, now_s: float, profile: Profile) -> Fault | None:
    safety = profile.safety
    if senses.hole is not None:
        return Fault(f"the pictures have a hole: {senses.hole}")
    if not is_recent(senses.picture_s, now_s, safety.stale_s):
        return Fault(f"no new picture for {safety.stale_s:g} s")
    # The diver was there when the sentence ended.
    seen_s = max(begun_s, senses.hand_s if senses.hand_s is not None else begun_s)
    if safety.lost_diver_s and now_s - seen_s > safety.lost_diver_s:
        return Fault(f"the diver is lost: no hand for {safety.lost_diver_s:g} s")
    return None
