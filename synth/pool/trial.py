"""One trial: script, rendered frames, decoder, executor, vehicle, camera, round and round, in simulated seconds.

Nothing here waits for the clock of the machine: a picture is rendered when its time has come, however long that takes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

from lightgesture.features.types import Image
from lightgesture.fsm import Instruction
from lightgesture.pipeline import Pipeline
from lightgesture.records import HeartbeatRecord, Record, VehicleRecord
from lightgesture.synth.diver import DiverState
from lightgesture.synth.pool.autopilot import Mode
from lightgesture.synth.pool.body import BodySpec, Motion
from lightgesture.synth.pool.controller import CONTROL_S
from lightgesture.synth.pool.link import PoolLink
from lightgesture.synth.pool.plans import Plan
from lightgesture.synth.pool.vehicle import START_DEPTH_M, Vehicle
from lightgesture.synth.pool.view import DiverPlace
from lightgesture.synth.scene import Scene
from lightgesture.vehicle.executor import Executor
from lightgesture.vehicle.mavlink_vehicle import MavlinkVehicle
from lightgesture.vehicle.profile import Profile

SETTLE_S: Final = 2.0
"""For which the vehicle lies still before the first picture, seconds."""
TICK_S: Final = 0.05
"""Between two looks of the executor."""
IDLE_FPS: Final = 2.5
"""Pictures a second once the script is over; it saves rendering, and a picture is still never stale."""
AFTER_S: Final = 3.0
"""For which a trial goes on once everything is done."""
UNBOUND_S: Final = 20.0
"""Longest watch over an instruction without an end of its own."""


@dataclass(frozen=True, slots=True)
class Moment:
    """The truth at one time: where the vehicle and the diver are, the mode, pictures taken so far, parameters."""

    time_s: float
    motion: Motion
    mode: Mode
    pictures: int
    diver: tuple[float, float, float]
    parameters: dict[str, float]


@dataclass(frozen=True, slots=True)
class Seen:
    """For who films: the picture, what the decoder said of it, the moment and the track so far."""

    image: Image
    records: Sequence[Record]
    moments: Sequence[Moment]
    said: Sequence[VehicleRecord]


Watch = Callable[[Seen], None]


@dataclass(slots=True)
class Course:
    """What happened in a trial.

    first_sign_s: when the script's first sign was shown. records: instructions and rejections of the decoder.
    said: the executor's records. moments: the truth, each TICK_S. reached: items of the mission, and when.
    """

    plan: Plan
    first_sign_s: float
    program_items: tuple[int, ...]
    records: list[Record] = field(default_factory=list)
    said: list[VehicleRecord] = field(default_factory=list)
    moments: list[Moment] = field(default_factory=list)
    reached: list[tuple[float, int]] = field(default_factory=list)

    @property
    def instructions(self) -> list[Instruction]:
        """What was issued."""
        return [record for record in self.records if isinstance(record, Instruction)]


class Trial:
    """Runs one plan. pipeline: of which a fresh stream is taken."""

    def __init__(self, plan: Plan, pipeline: Pipeline, profile: Profile, body: BodySpec) -> None:
        self._plan = plan
        self._watch: Watch | None = None
        self._scene = Scene(plan.scene)
        self._pipeline = pipeline.for_stream(plan.name)
        self._link = PoolLink()
        self._vehicle = Vehicle(self._link.deliver, body)
        self._link.connect(self._vehicle.front)
        self._told = MavlinkVehicle(self._link, profile, clock=self._clock)
        signed = next(hold for hold in self._scene.timeline if hold.pair is not None)
        self._course = Course(plan, SETTLE_S + signed.start / plan.scene.fps, self._vehicle.program_items)
        self._executor = Executor(profile, self._told, self._note, self._clock)
        self._swims_from_s: float | None = None
        self._diver = self._where(0.0)
        self._vehicle.front.follower.diver = lambda: self._diver
        self._beat_s = 0.0

    @property
    def vehicle(self) -> Vehicle:
        """The vehicle, for who draws it."""
        return self._vehicle

    def run(self, watch: Watch | None = None) -> Course:
        """Run to the end; what happened. watch: is shown every picture."""
        self._watch = watch
        pilot, fps = self._vehicle.pilot, self._plan.scene.fps
        pilot.arm(True)
        pilot.set_mode(Mode.ALT_HOLD)
        self._advance(SETTLE_S)
        script_s = self._scene.frame_count / fps
        index, due_s, end_s = 0, 0.0, None
        while end_s is None or self._clock() < end_s:
            self._look(round(due_s * fps), index)
            index += 1
            is_signing = due_s < script_s
            due_s += 1.0 / (fps if is_signing else IDLE_FPS)
            self._advance(SETTLE_S + due_s)
            if not is_signing and end_s is None:
                end_s = self._end(script_s)
        self._course.records += self._kept(self._pipeline.finish())
        self._course.reached = list(pilot.visited)
        said = list(self._course.said)
        self._executor.close("the trial is over", self._clock())
        self._course.said = said  # that we stop looking is no fault of what goes on
        return self._course

    def _clock(self) -> float:
        return self._vehicle.body.time_s

    def _note(self, record: VehicleRecord) -> None:
        self._course.said.append(record)

    def _end(self, script_s: float) -> float | None:
        """When the trial is over, once that is known."""
        open_texts = {record.text for record in self._course.instructions} - closed_texts(self._course.said)
        if not open_texts:
            return self._clock() + AFTER_S
        longest_s = sum(record.duration_s or UNBOUND_S for record in self._course.instructions)
        is_late = self._clock() > SETTLE_S + script_s + longest_s + UNBOUND_S
        unbound = all(record.duration_s is None for record in self._course.instructions)
        waited_s = self._clock() - SETTLE_S - script_s
        return self._clock() if is_late or (unbound and waited_s > UNBOUND_S + AFTER_S) else None

    def _advance(self, until_s: float) -> None:
        """Let the vehicle go on, with a look of the executor each TICK_S."""
        while self._clock() < until_s - 0.5 * CONTROL_S:
            self._vehicle.advance(min(until_s, self._clock() + TICK_S))
            now_s = self._clock()
            self._link.set_time(now_s)
            self._diver = self._where(now_s)
            self._vehicle.body.place_diver(*self._diver)
            if now_s >= self._beat_s:
                self._beat_s += 1.0
                beat = HeartbeatRecord(
                    source=None, time_s=now_s, frames=0, dropped=0, ms_per_frame=0.0, state="idle"
                )
                self._told.note(beat)
            self._executor.tick(now_s)
            self._course.moments.append(self._moment(now_s))

    def _moment(self, now_s: float) -> Moment:
        pilot, front = self._vehicle.pilot, self._vehicle.front
        return Moment(
            now_s,
            self._vehicle.motion,
            pilot.mode,
            len(front.camera.taken),
            self._diver,
            dict(pilot.parameters),
        )

    def _place(self, now_s: float) -> DiverPlace:
        """Of the script, whose diver swims away once the vehicle follows."""
        if self._swims_from_s is None and self._vehicle.front.follower.is_following:
            self._swims_from_s = now_s
        swum_s = 0.0 if self._swims_from_s is None else now_s - self._swims_from_s
        return DiverPlace(START_DEPTH_M, swum_s * self._plan.swim_mps)

    def _where(self, now_s: float) -> tuple[float, float, float]:
        frame = max(round((now_s - SETTLE_S) * self._plan.scene.fps), 0)
        return self._place(now_s).world(self._scene.diver(frame))

    def _look(self, frame: int, index: int) -> None:
        """Take a picture and decode it."""
        now_s, motion = self._clock(), self._vehicle.motion

        def view(state: DiverState) -> DiverState | None:
            return self._place(now_s).seen(state, motion)

        image = self._scene.frame(frame, view).image
        records = self._pipeline.process(image, now_s, index)
        for record in records:
            self._told.note(record)
        self._executor.show(image, records)
        self._course.records += self._kept(records)
        if self._watch is not None:
            self._watch(Seen(image, records, self._course.moments, self._course.said))

    def _kept(self, records: Sequence[Record]) -> list[Record]:
        return [record for record in records if record.type in ("instruction", "rejected", "notice", "word")]


def closed_texts(said: Sequence[VehicleRecord]) -> set[str | None]:
    """Instructions that are done, refused or broken off."""
    return {record.instruction for record in said if record.state in ("done", "refused", "aborted")}
