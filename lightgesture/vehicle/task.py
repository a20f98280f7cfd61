"""An instruction as it is carried out: one step after the other, each told in records."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from lightgesture.fsm import Instruction
from lightgesture.records import VehicleState
from lightgesture.vehicle.bench import Bench
from lightgesture.vehicle.camera_run import CameraRun
from lightgesture.vehicle.guard import Fault
from lightgesture.vehicle.interface import Status
from lightgesture.vehicle.parameter_run import ParameterRun
from lightgesture.vehicle.profile import Profile
from lightgesture.vehicle.runs import (
    HookRun,
    MissionRun,
    Run,
    StickRun,
    WaitRun,
    make_command_run,
    make_mode_run,
    make_value_run,
)
from lightgesture.vehicle.steps import (
    CameraStep,
    CommandStep,
    HookStep,
    MissionStep,
    ModeStep,
    Step,
    StickStep,
    ValueStep,
    WaitStep,
)

PARAMETER: Final = "PARAM"
"""The action that the table of parameters is for, where no instruction of the profile has it."""

Say = Callable[[VehicleState, str | None, str], None]
"""Makes a record of a state, the instruction's text and a detail."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What is to be done for an instruction. runs: its steps. after_pictures: as in the profile."""

    record: Instruction
    runs: tuple[Run, ...]
    after_pictures: bool = False

    @property
    def is_moving(self) -> bool:
        """Whether the vehicle moves by it."""
        return any(run.is_moving for run in self.runs)

    @property
    def uses_sticks(self) -> bool:
        """Whether it holds sticks."""
        return any(run.uses_sticks for run in self.runs)

    @property
    def steers(self) -> bool:
        """Whether it changes where the vehicle goes."""
        return any(run.uses_sticks or run.sets_mode for run in self.runs)

    @property
    def takes_pictures(self) -> bool:
        """Whether pictures are taken by it."""
        return any(isinstance(run, CameraRun) for run in self.runs)


def plan_for(record: Instruction, profile: Profile, mode: str) -> Plan | str:
    """The plan for an instruction, or why there is none. mode: the vehicle's, before it."""
    table = profile.table_for(record)
    if table is not None:
        runs = tuple(_run_for(record, step, profile, mode) for step in table.steps)
        return Plan(record, runs, table.after_pictures)
    if record.action == PARAMETER:
        parameter = profile.parameter_for(record.parameter)
        if parameter is None:
            return f"the profile of {profile.name} has no parameter {record.parameter}"
        return Plan(record, (ParameterRun(record, parameter),))
    number = "" if record.program is None else f" {record.program}"
    return f"the profile of {profile.name} does not say what {record.action}{number} is"


def _run_for(record: Instruction, step: Step, profile: Profile, mode: str) -> Run:
    match step:
        case ModeStep():
            return make_mode_run(record, step, mode)
        case StickStep():
            return StickRun(record, step)
        case WaitStep():
            return WaitRun(record, step)
        case CommandStep():
            return make_command_run(record, step, profile.link.target)
        case ValueStep():
            return make_value_run(record, step)
        case MissionStep():
            return MissionRun(record, step)
        case CameraStep():
            return CameraRun(record, step)
        case HookStep():
            return HookRun(record, step)


class Task:
    """Carries a plan out. begun: what was known of the vehicle, and when, as it began."""

    def __init__(self, plan: Plan, say: Say, begun: Status, begun_s: float) -> None:
        self.plan, self.begun, self.begun_s = plan, begun, begun_s
        self._say = say
        self._index = 0
        self._is_accepted = False
        self._told = ""
        self.is_over = False

    @property
    def text(self) -> str:
        """The sentence."""
        return self.plan.record.text

    @property
    def run(self) -> Run:
        """The step that runs."""
        return self.plan.runs[self._index]

    @property
    def goes_on(self) -> bool:
        """Whether the vehicle would go on by itself."""
        begun = self.plan.runs[: self._index + 1]
        return self._is_accepted and any(run.goes_on for run in begun)

    def begin(self, bench: Bench, now_s: float) -> None:
        """Give the first order."""
        self.run.begin(bench, now_s)
        self._tell("sent", self.run.detail)

    def tick(self, bench: Bench, now_s: float) -> None:
        """Go on as far as can be gone now."""
        while not self.is_over:
            run = self.run
            outcome = run.tick(bench, now_s)
            self._tell_news(run)
            if outcome == "refused":
                run.end(bench, now_s)
                self._finish("aborted" if self._is_accepted else "refused", run.reason)
            elif outcome == "pending":
                return
            else:
                self._accept(run)
                if outcome == "going":
                    self._tell_once(run.detail)
                    return
                self._next(bench, now_s)

    def stop(self, bench: Bench, now_s: float, fault: Fault) -> None:
        """Break it off."""
        if self.is_over:
            return
        self.run.end(bench, now_s, fault.is_anothers)
        self._finish("aborted", fault.reason)

    def conclude(self, bench: Bench, now_s: float) -> None:
        """The step that runs is over, although the vehicle changed its mode by itself."""
        self.run.end(bench, now_s)
        self._finish("done", self.run.detail)

    def _next(self, bench: Bench, now_s: float) -> None:
        done = self.run
        done.end(bench, now_s)
        if self._index + 1 == len(self.plan.runs):
            self._finish("done", done.detail)
            return
        self._index += 1
        self.run.begin(bench, now_s)

    def _accept(self, run: Run) -> None:
        if not self._is_accepted:
            self._is_accepted = True
            self._tell("accepted", run.detail)

    def _tell_once(self, detail: str) -> None:
        if detail != self._told:
            self._told = detail
            self._tell("executing", detail)

    def _tell_news(self, run: Run) -> None:
        news, run.news = run.news, []
        for detail in news:
            self._tell("executing", detail)

    def _finish(self, state: VehicleState, detail: str) -> None:
        self.is_over = True
        self._tell(state, detail)

    def _tell(self, state: VehicleState, detail: str) -> None:
        self._say(state, self.text, detail)
