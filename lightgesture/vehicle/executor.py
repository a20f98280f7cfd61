"""Carries instructions out, one task at a time, within the limits of the profile, and ends them at the first fault."""

import time
from collections.abc import Callable, Sequence
from typing import Final

from lightgesture.features.types import Image
from lightgesture.fsm import Instruction
from lightgesture.records import Record, VehicleRecord, VehicleState
from lightgesture.vehicle.bench import Bench
from lightgesture.vehicle.beside import Beside
from lightgesture.vehicle.guard import (
    PILOT_S,
    Fault,
    Senses,
    fault,
    is_recent,
    last_of_another,
    obstacle,
    obstacle_to_motion,
)
from lightgesture.vehicle.intake import MAX_AGE_S, Intake
from lightgesture.vehicle.interface import Reply, SetMode, Status, Vehicle
from lightgesture.vehicle.motion import Motion, Word
from lightgesture.vehicle.profile import Profile
from lightgesture.vehicle.sticks import Sticks
from lightgesture.vehicle.task import Plan, Task, plan_for

HELD_UP_S: Final = 0.25
"""Seconds between two ticks that end a push or a mission: the watchdog has ended it meanwhile, and it is not taken up
again by itself. Where nothing is held, as in HOVER, the watchdog had nothing to end."""

CONTINUE: Final = "CONTD"
"""First word of a sentence that leaves the running task alone."""

_SIDE_KINDS = ("parameter", "snapshot")
_KILL = "kill"

Publish = Callable[[VehicleRecord], None]
"""Takes a record, at once."""


class Executor:
    """A listener of the live loop that obeys.

    profile: what instructions mean. vehicle: who is told. publish: takes the records. clock: the seconds of every time
    here, which never jump. `show` may be called from any thread and does not wait; all else is called from one thread.
    `tick` does what is to be done now and comes back at once: 20 times a second, or as a simulation likes.
    """

    def __init__(
        self,
        profile: Profile,
        vehicle: Vehicle,
        publish: Publish,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._profile, self._vehicle, self._publish, self._clock = profile, vehicle, publish, clock
        self._sticks = Sticks(vehicle, profile.stick)
        self._bench = Bench(vehicle, profile, self._sticks, profile.stick.cap)
        self._intake = Intake(clock)
        self._task: Task | None = None
        self._waiting: Plan | None = None
        self._beside = Beside(self._bench, self._say)
        self._motion = Motion(self._bench)
        self._now_s: float | None = None
        self._is_watched = True
        self._holding: Reply | None = None

    @property
    def task(self) -> Task | None:
        """What is being done, apart from what runs beside it."""
        return self._task

    @property
    def holds_sticks(self) -> bool:
        """Whether sticks are being sent, the middle after a push included."""
        return self._sticks.is_sent

    @property
    def goes_on(self) -> bool:
        """Whether the vehicle does something for us that it would go on with by itself, such as a mission."""
        return self._task is not None and self._task.goes_on

    @property
    def status(self) -> Status:
        """What was known of the vehicle at the last tick."""
        return self._bench.status

    def show(self, image_bgr: Image | None, records: Sequence[Record]) -> None:
        """Take note of a picture and its records; from any thread, at once."""
        self._intake.show(image_bgr, records)

    def answer(self, word: Word) -> None:
        """Have the vehicle nod or shake, where nothing stands against it; called in the thread of `tick`."""
        if self._task is None:
            self._motion.ask(word)

    def tick(self, now_s: float, is_watched: bool = True) -> None:
        """Do what is to be done at `now_s`. is_watched: whether somebody lets go of the vehicle if this is the last
        tick; else nothing is begun that moves it."""
        self._is_watched = is_watched
        taken = self._intake.take(now_s)
        senses, self._bench.frame = taken.senses, taken.frame
        self._bench.status = self._vehicle.poll(now_s)
        gap_s = 0.0 if self._now_s is None else now_s - self._now_s
        self._now_s = now_s
        if self._task is not None and self._task.plan.is_moving:
            self._watch(self._task, senses, now_s, gap_s)
        for record in taken.late:
            self._say("refused", record.text, f"it waited for more than {MAX_AGE_S:g} s; sign it again")
        for record in taken.new:
            self._obey(record, senses, now_s)
        self._tell_hold()
        self._advance(senses, now_s)
        self._sticks.tick(now_s, last_of_another(self._bench.status))

    def settle(self, now_s: float) -> None:
        """After `close`: repeat the middle of the sticks where it is time, for one message may get lost."""
        self._sticks.tick(now_s)

    def close(self, reason: str, now_s: float | None = None) -> None:
        """Sticks to the middle, everything ended, at once."""
        self._stop_all(Fault(reason), self._clock() if now_s is None else now_s)
        self._bench.helper.close()

    def _watch(self, task: Task, senses: Senses, now_s: float, gap_s: float) -> None:
        """End a task that must not go on."""
        status = self._bench.status
        if not self._is_watched:
            found: Fault | None = Fault("the watchdog has ended")
        elif gap_s > HELD_UP_S and (self._sticks.is_held or self.goes_on):
            found = Fault(f"the program was held up for {gap_s:.2f} s")
        else:
            found = fault(
                status, task.begun, task.begun_s, senses, now_s, self._profile, task.plan.uses_sticks
            )
        if found is None:
            return
        has_left = found.is_anothers and status.boots == task.begun.boots
        if has_left and task.run.is_over(status):
            task.conclude(self._bench, now_s)
            self._task = None
        else:
            self._stop(found, now_s)

    def _obey(self, record: Instruction, senses: Senses, now_s: float) -> None:
        if record.kind == _KILL:
            self._kill(record, now_s)
            return
        plan = plan_for(record, self._profile, self._bench.status.mode)
        reason = plan if isinstance(plan, str) else self._obstacle(plan, senses, now_s)
        if record.kind in _SIDE_KINDS or record.words[:1] == (CONTINUE,):
            if isinstance(plan, str) or reason is not None:
                self._say("refused", record.text, str(reason))
            elif plan.steers:
                self._say("refused", record.text, f"it steers the vehicle, which {CONTINUE} leaves alone")
            else:
                self._beside.add(plan, now_s)
            return
        # The diver said that what is done shall end, whatever becomes of the rest.
        goes_on = self.goes_on
        self._stop(Fault(f"replaced by {record.text}"), now_s, is_held=False)
        self._motion.is_allowed = True
        if not isinstance(plan, str) and reason is None and not self._must_wait(plan):
            self._begin(plan, now_s)
            return
        if goes_on:
            self._hold(now_s)
        if isinstance(plan, str) or reason is not None:
            self._say("refused", record.text, str(reason))
        else:
            self._waiting = plan
            self._say("accepted", record.text, "begins when the pictures are taken")

    def _must_wait(self, plan: Plan) -> bool:
        return plan.after_pictures and self._beside.takes_pictures

    def _obstacle(self, plan: Plan, senses: Senses, now_s: float) -> str | None:
        status = self._bench.status
        reason = obstacle(status, senses, now_s, self._profile)
        if reason is None and plan.is_moving and not self._is_watched:
            reason = "the watchdog does not watch yet"
        if reason is None and plan.is_moving:
            reason = obstacle_to_motion(status, now_s, self._profile, plan.uses_sticks)
        return reason

    def _begin(self, plan: Plan, now_s: float) -> None:
        self._motion.stop(now_s)
        self._task = Task(plan, self._say, self._bench.status, now_s)
        self._task.begin(self._bench, now_s)

    def _advance(self, senses: Senses, now_s: float) -> None:
        self._beside.tick(now_s)
        if self._waiting is not None and not self._beside.takes_pictures:
            plan, self._waiting = self._waiting, None
            reason = self._obstacle(plan, senses, now_s)
            if reason is None:
                self._begin(plan, now_s)
            else:
                self._say("aborted", plan.record.text, reason)
        if self._task is None:
            if self._is_watched:
                self._motion.tick(senses, now_s)
            else:
                self._motion.stop(now_s)
            return
        task = self._task
        task.tick(self._bench, now_s)
        if task.is_over:
            self._task = None

    def _kill(self, record: Instruction, now_s: float) -> None:
        is_held = self.goes_on
        self._stop_all(Fault(f"{record.text} was signed"), now_s)
        if not is_held and not is_recent(self._bench.status.pilot_s, now_s, PILOT_S):
            self._hold(now_s)
        self._say("done", record.text, "everything is stopped")

    def _stop_all(self, found: Fault, now_s: float) -> None:
        self._stop(found, now_s)
        self._beside.stop(found, now_s)

    def _stop(self, found: Fault, now_s: float, is_held: bool = True) -> None:
        """Break the task off, and what waits for its turn; is_held: hold the vehicle where it would go on by itself."""
        self._motion.stop(now_s)
        self._motion.is_allowed = False
        if self._waiting is not None:
            self._say("aborted", self._waiting.record.text, found.reason)
        goes_on, task = self.goes_on, self._task
        self._task = self._waiting = None
        if task is not None:
            task.stop(self._bench, now_s, found)
        self._sticks.release(now_s, found.is_anothers)
        if is_held and goes_on and not found.is_anothers:
            self._hold(now_s)

    def _hold(self, now_s: float) -> None:
        if modes := tuple(self._profile.safety.fault_modes):
            self._holding = self._vehicle.order(SetMode(names=modes), now_s)

    def _tell_hold(self) -> None:
        """Whether the vehicle holds, once it is known."""
        reply = self._holding
        if reply is not None and reply.state != "pending":
            self._holding = None
            is_held = reply.state == "accepted"
            self._say("done" if is_held else "refused", None, f"holds: {reply.detail}")

    def _say(self, state: VehicleState, instruction: str | None, detail: str) -> None:
        time_s = round(self._clock(), 3)
        self._publish(VehicleRecord(time_s=time_s, state=state, instruction=instruction, detail=detail))
