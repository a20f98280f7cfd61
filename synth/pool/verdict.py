"""Whether an instruction was done as it was meant, told from the truth of the simulation and not from what was said.

Limits are those of what a diver would call done: a place kept within 0.3 m, a way of at least 0.2 m in the right
direction.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from lightgesture.fsm import Instruction
from lightgesture.synth.pool.autopilot import Mode
from lightgesture.synth.pool.follower import DISTANCE_M
from lightgesture.synth.pool.mission import REACHED_M
from lightgesture.synth.pool.trial import Course, Moment
from lightgesture.vehicle.profile import Profile
from lightgesture.vehicle.steps import MissionStep

KEPT_M: Final = 0.3
"""How far a vehicle that stays may be from its place."""
MOVED_M: Final = 0.2
"""Least way of one that is to move."""
ASIDE_M: Final = 0.3
"""How far it may go in other directions meanwhile, drifting with the water."""
SETTLED_S: Final = 3.0
"""After which a mode that holds a place holds it."""
COAST_S: Final = 1.0
"""For which is still looked once an instruction is done, seconds: water lets a vehicle glide on."""
ENDLESS: Final = ("HOVER", "FOLLOW")
"""Actions that go on until the next instruction where no time is signed."""
EFFECT_M, EFFECT_DEG = 0.05, 3.0
"""Change of place, metres, or of heading, degrees, that a diver sees."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """One instruction of a trial: whether it was issued, accepted by the vehicle, said to be done (None: it has no end
    of its own), and done as meant; seconds from the sentence's first sign to the first effect (None: no effect); why.
    """

    trial: str
    sentence: str
    issued: bool
    accepted: bool
    done: bool | None
    as_meant: bool
    first_effect_s: float | None
    detail: str


def verdicts(course: Course, profile: Profile) -> list[Verdict]:
    """One for each sentence of the trial, in order."""
    issued = {record.text: record for record in course.instructions}
    found = [_verdict(course, text, issued.pop(text, None), profile) for text in course.plan.sentences]
    # What was never signed is the worst that can happen, so it has a row of its own.
    name, why = course.plan.name, "was never signed"
    return found + [Verdict(name, text, True, False, False, False, None, why) for text in issued]


def _verdict(course: Course, sentence: str, record: Instruction | None, profile: Profile) -> Verdict:
    name = course.plan.name
    if record is None:
        rejected = [one for one in course.records if one.type == "rejected"]
        why = "; ".join(f"{one.reason}: {one.text}" for one in rejected) or "not read"
        return Verdict(name, sentence, False, False, False, False, None, why)
    said = [one for one in course.said if one.instruction == sentence]
    is_accepted = any(one.state == "accepted" for one in said)
    is_done = any(one.state == "done" for one in said)
    refusals = "; ".join(one.detail for one in said if one.state in ("refused", "aborted"))
    times_s = [one.time_s for one in said if one.state == "sent"] or [record.time_s]
    ends_s = [one.time_s for one in said if one.state in ("done", "aborted")]
    end_s = ends_s[0] if ends_s else course.moments[-1].time_s
    span = [moment for moment in course.moments if times_s[0] - 0.1 <= moment.time_s <= end_s + COAST_S]
    if not is_accepted or not span:
        return Verdict(name, sentence, True, is_accepted, is_done, False, None, refusals or "not accepted")
    as_meant, detail = CHECKS[record.action](course, record, span, profile)
    effect_s = _first_effect(span)
    since_s = None if effect_s is None else effect_s - record.start_time_s
    detail = f"{detail}; {refusals}" if refusals else detail
    is_endless = record.duration_s is None and record.action in ENDLESS
    return Verdict(name, sentence, True, True, None if is_endless else is_done, as_meant, since_s, detail)


def _first_effect(span: Sequence[Moment]) -> float | None:
    """When something first changed that a diver or a pilot sees: place, heading, mode, a picture, a parameter."""
    begin = span[0]
    for moment in span:
        turned = abs((moment.motion.heading_deg - begin.motion.heading_deg + 180.0) % 360.0 - 180.0)
        is_moved = math.dist(moment.motion.position, begin.motion.position) > EFFECT_M or turned > EFFECT_DEG
        is_other = (moment.mode, moment.pictures) != (begin.mode, begin.pictures)
        if is_moved or is_other or moment.parameters != begin.parameters:
            return moment.time_s
    return None


def _hover(
    _course: Course, record: Instruction, span: Sequence[Moment], _profile: Profile
) -> tuple[bool, str]:
    held = [moment for moment in span if moment.mode is Mode.POSHOLD]
    if not held:
        return False, "never in POSHOLD"
    place = held[0].motion.position
    settled = [moment for moment in held if moment.time_s >= held[0].time_s + SETTLED_S] or held
    off_m = max(math.dist(moment.motion.position, place) for moment in settled)
    lasted_s = held[-1].time_s - held[0].time_s - COAST_S
    is_long = record.duration_s is None or abs(lasted_s - record.duration_s) < 2.0
    return off_m < KEPT_M and is_long, f"POSHOLD for {lasted_s:.1f} s, {off_m:.2f} m off at most"


def _moved(
    _course: Course, record: Instruction, span: Sequence[Moment], _profile: Profile
) -> tuple[bool, str]:
    """UP, DOWN, LEFT, RIGHT: of the vehicle itself."""
    first, last = span[0].motion, span[-1].motion
    north, east, down = (now - then for now, then in zip(last.position, first.position, strict=True))
    yaw = first.attitude[2]
    right, forward = (
        east * math.cos(yaw) - north * math.sin(yaw),
        north * math.cos(yaw) + east * math.sin(yaw),
    )
    ways = {"UP": -down, "DOWN": down, "LEFT": -right, "RIGHT": right}
    way_m = ways[record.action]
    others = (forward, right) if record.action in ("UP", "DOWN") else (forward, down)
    aside_m = math.hypot(*others)
    drift_m = ASIDE_M + 0.03 * (span[-1].time_s - span[0].time_s)
    return (
        way_m > MOVED_M and aside_m < drift_m,
        f"{way_m:.2f} m {record.action.lower()}, {aside_m:.2f} m aside",
    )


def _follow(
    _course: Course, _record: Instruction, span: Sequence[Moment], _profile: Profile
) -> tuple[bool, str]:
    led = [
        moment
        for moment in span
        if moment.mode is Mode.GUIDED and moment.time_s >= span[0].time_s + SETTLED_S
    ]
    if not led:
        return False, "never led by the follower"
    off_m = max(abs(math.dist(moment.motion.position, moment.diver) - DISTANCE_M) for moment in led)
    swum_m = math.dist(led[-1].diver, span[0].diver)
    return off_m < KEPT_M, f"diver swam {swum_m:.2f} m, distance kept within {off_m:.2f} m"


def _exec(course: Course, record: Instruction, span: Sequence[Moment], profile: Profile) -> tuple[bool, str]:
    table = profile.table_for(record)
    steps = () if table is None else table.steps
    step = next((one for one in steps if isinstance(one, MissionStep)), None)
    if step is None:
        return False, "no mission in the profile"
    wanted = list(range(step.mission, (step.last if step.last is not None else step.mission) + 1))
    reached = [number for time_s, number in course.reached if time_s >= span[0].time_s]
    is_there = reached[: len(wanted)] == wanted
    return is_there and any(moment.mode is Mode.AUTO for moment in span), (
        f"items {', '.join(map(str, reached)) or 'none'} reached within {REACHED_M:g} m"
    )


def _param(
    _course: Course, record: Instruction, span: Sequence[Moment], profile: Profile
) -> tuple[bool, str]:
    table = profile.parameter_for(record.parameter)
    if table is None:
        return False, "no such parameter in the profile"
    before, after = span[0].parameters[table.name], span[-1].parameters[table.name]
    steps = {"INCREASE": before + table.step, "DECREASE": before - table.step, "DEFAULT": table.default}
    wanted = min(max(steps[record.change or "DEFAULT"], table.minimum), table.maximum)
    return math.isclose(after, wanted, rel_tol=1e-5), f"{table.name} from {before:g} to {after:g}"


def _snap(
    _course: Course, record: Instruction, span: Sequence[Moment], _profile: Profile
) -> tuple[bool, str]:
    count, wanted = span[-1].pictures - span[0].pictures, record.duration_s or 1
    changed = {moment.mode for moment in span}
    names = ", ".join(sorted(mode.name for mode in changed))
    return abs(count - wanted) <= 1, f"{count} pictures of {wanted}, mode {names}"


Check = Callable[[Course, Instruction, Sequence[Moment], Profile], tuple[bool, str]]
CHECKS: dict[str, Check] = {
    "HOVER": _hover,
    "UP": _moved,
    "DOWN": _moved,
    "LEFT": _moved,
    "RIGHT": _moved,
    "FOLLOW": _follow,
    "EXEC": _exec,
    "PARAM": _param,
    "SNAP": _snap,
}
"""Action to what tells whether it was done as meant, and in what words."""
