"""Steps as they run. Each begins, is asked in every tick how it stands, and is ended, whatever became of it."""

from abc import ABC, abstractmethod
from concurrent.futures import Future
from typing import Any, Literal

from lightgesture.fsm import Instruction
from lightgesture.sinks.mavlink_map import CAMERA_COMMANDS, CAMERA_COMPONENT, COMMANDS, Value, padded
from lightgesture.vehicle.bench import Bench, seconds_of
from lightgesture.vehicle.interface import (
    Order,
    Reply,
    SendCommand,
    SendValue,
    SetMode,
    StartMission,
    Status,
)
from lightgesture.vehicle.steps import (
    PREVIOUS,
    CommandStep,
    HookStep,
    MissionStep,
    ModeStep,
    StickStep,
    ValueStep,
    WaitStep,
)
from lightgesture.vehicle.sticks import ramped

Outcome = Literal["pending", "going", "done", "refused"]
"""pending: not answered yet. going: taken, and not at its end. refused: `reason` tells why."""


class Run(ABC):
    """One step of one instruction.

    detail: what it does, in words. reason: why it is refused. news: what is worth a record; whoever tells it takes it
    away. is_moving: whether the vehicle moves by it, and so must be armed and watched. uses_sticks: whether it
    holds sticks. sets_mode: whether it changes the mode.
    goes_on: whether the vehicle goes on by itself where we stop, as in a mission, so that only a mode ends it.
    """

    is_moving = True
    uses_sticks = False
    sets_mode = False
    goes_on = False

    def __init__(self, record: Instruction) -> None:
        self.record = record
        self.detail = self.reason = ""
        self.news: list[str] = []

    @abstractmethod
    def begin(self, bench: Bench, now_s: float) -> None:
        """Give the first order."""

    @abstractmethod
    def tick(self, bench: Bench, now_s: float) -> Outcome:
        """How it stands."""

    def end(self, bench: Bench, now_s: float, to_another: bool = False) -> None:  # noqa: B027 - some need nothing
        """Leave nothing behind; called once, at the end or when it is broken off. to_another: who holds the sticks
        now."""

    def is_over(self, status: Status) -> bool:  # noqa: ARG002 - most go by nothing of it
        """Whether its purpose is reached although the vehicle has changed its mode by itself."""
        return False

    def refuse(self, reason: str) -> Outcome:
        """It cannot be."""
        self.reason = reason
        return "refused"


class OrderRun(Run):
    """A step that is one order, done when that is accepted."""

    def __init__(self, record: Instruction, detail: str, order: Order, goes_on: bool = False) -> None:
        super().__init__(record)
        self.detail, self._order, self.goes_on = detail, order, goes_on
        self.sets_mode = isinstance(order, SetMode | StartMission)
        self.is_moving = not (isinstance(order, SendCommand) and order.name in CAMERA_COMMANDS)
        self._reply = Reply()

    def begin(self, bench: Bench, now_s: float) -> None:
        """Give the order."""
        self._reply = bench.vehicle.order(self._order, now_s)

    def tick(self, bench: Bench, now_s: float) -> Outcome:  # noqa: ARG002 - those of its base
        """As the vehicle answered."""
        if self._reply.state == "pending":
            if self._reply.progress is not None:
                self.news = [f"{self.detail}: {self._reply.progress} %"]
                self._reply.progress = None
                return "going"
            return "pending"
        if self._reply.state == "refused":
            return self.refuse(f"{self.detail}: {self._reply.detail}")
        self.detail = self._reply.detail or self.detail
        return "done"


class StickRun(Run):
    """The sticks held for a while."""

    uses_sticks = True

    def __init__(self, record: Instruction, step: StickStep) -> None:
        super().__init__(record)
        self._where = step.where
        self._total_s = min(seconds_of(step.seconds, step.missing, record), step.most)
        self._begun_s = 0.0

    def begin(self, bench: Bench, now_s: float) -> None:
        """Begin in the middle."""
        self._begun_s = now_s
        where = self._where.scaled(bench.cap)
        moved = [f"{name} {getattr(where, name):+.2f}" for name in "xyzr" if getattr(where, name)]
        self.detail = f"sticks {' '.join(moved) or 'in the middle'} for {self._total_s:g} s"

    def tick(self, bench: Bench, now_s: float) -> Outcome:
        """Up and down the ramps."""
        elapsed_s = now_s - self._begun_s
        if elapsed_s >= self._total_s:
            return "done"
        share = ramped(elapsed_s, self._total_s, bench.profile.stick.ramp_s)
        bench.sticks.hold(self._where.scaled(share * bench.cap))
        return "going"

    def end(self, bench: Bench, now_s: float, to_another: bool = False) -> None:
        """To the middle, at once."""
        bench.sticks.release(now_s, to_another)


class WaitRun(Run):
    """Nothing but time."""

    def __init__(self, record: Instruction, step: WaitStep) -> None:
        super().__init__(record)
        self._total_s: float | None = seconds_of(step.wait, step.missing, record)
        self._until_s: float | None = None

    def begin(self, bench: Bench, now_s: float) -> None:  # noqa: ARG002 - those of its base
        """The time begins."""
        if self._total_s is None:
            self.detail = "stays until the next instruction"
        else:
            self._until_s = now_s + self._total_s
            self.detail = f"stays for {self._total_s:g} s"

    def tick(self, bench: Bench, now_s: float) -> Outcome:  # noqa: ARG002 - those of its base
        """Until it is over."""
        return "going" if self._until_s is None or now_s < self._until_s else "done"


class MissionRun(OrderRun):
    """A part of the loaded mission, to its last item."""

    def __init__(self, record: Instruction, step: MissionStep) -> None:
        to = "its end" if step.last is None else f"item {step.last}"
        order = StartMission(first=step.mission, last=step.last, mode=step.mode)
        super().__init__(record, f"mission from item {step.mission} to {to}", order, goes_on=True)

    def tick(self, bench: Bench, now_s: float) -> Outcome:
        """Until the last item is reached."""
        outcome = super().tick(bench, now_s)
        if outcome != "done":
            return outcome
        return "done" if self.is_over(bench.status) else "going"

    def is_over(self, status: Status) -> bool:
        """Whether the last item is reached; some vehicles then leave the mode of missions by themselves."""
        last = self._reply.value
        return last is not None and status.item is not None and status.item >= last


class HookRun(Run):
    """Another program, which is given the record and answers by its exit status."""

    goes_on = True

    def __init__(self, record: Instruction, step: HookStep) -> None:
        super().__init__(record)
        self._command = step.hook
        self.detail = f"hook {step.hook}"
        self._result: Future[str] | None = None

    def begin(self, bench: Bench, now_s: float) -> None:  # noqa: ARG002 - those of its base
        """Start it."""
        self._result = bench.helper.start(self._run)

    def tick(self, bench: Bench, now_s: float) -> Outcome:  # noqa: ARG002 - those of its base
        """Until it has ended."""
        if self._result is None or not self._result.done():
            return "pending"
        reason = self._result.result()
        return self.refuse(reason) if reason else "done"

    def _run(self) -> str:
        from lightgesture.sinks.hook import HookSink
        from lightgesture.sinks.outbox import RecordError

        try:
            HookSink(self._command).send(self.record)
        except RecordError as error:
            return str(error)
        return ""


def make_mode_run(record: Instruction, step: ModeStep, previous: str) -> Run:
    """Enter a mode. previous: the one of before the task."""
    names = tuple(dict.fromkeys(previous if name == PREVIOUS else name for name in step.mode))
    return OrderRun(record, f"mode {' or '.join(names)}", SetMode(names=names))


def make_command_run(record: Instruction, step: CommandStep, autopilot: int) -> Run:
    """Send a command. autopilot: its component."""
    usual = CAMERA_COMPONENT if step.command in CAMERA_COMMANDS else autopilot
    component = usual if step.component is None else step.component
    params = tuple(padded([number_of(value, step.missing, record) for value in step.params]))
    order = SendCommand(name=step.command, command=COMMANDS[step.command], params=params, component=component)
    return OrderRun(record, step.command, order, goes_on=True)


def make_value_run(record: Instruction, step: ValueStep) -> Run:
    """Send a named value."""
    value = number_of(step.value, step.missing, record)
    return OrderRun(
        record, f"value {step.name} {value:g}", SendValue(name=step.name, value=value), goes_on=True
    )


def number_of(value: Value, missing: float, record: Instruction) -> float:
    """The number that a value of the profile stands for."""
    if not isinstance(value, str):
        return value
    found: Any = getattr(record, value)
    return missing if found is None else float(found)
