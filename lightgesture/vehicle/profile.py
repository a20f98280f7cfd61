"""`vehicle.toml`: what each instruction does, in the vehicle's own terms, and within which limits.

Every key stands here, or in `steps.py`, once with its unit, its range and its effect; docs/vehicle.md shows a file.
Unknown keys are refused.
"""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field, model_validator

from lightgesture.fsm import Instruction
from lightgesture.sinks.mavlink_map import Number
from lightgesture.vehicle.steps import PREVIOUS, MissionStep, ModeStep, Seconds, Share, Step, Table


class LinkTable(Table):
    """`[link]`: who is who on the link, and how long it is waited for.

    component: our own number, 1 to 255; another one where two companions run. target: the autopilot's component.
    timeout_s: seconds without a heartbeat of the vehicle after which the link is lost. answer_s: seconds until an
    unanswered command is sent again; tries: how often at most, the first included. progress_s: seconds after which
    a command that is "in progress" without further word has failed.
    """

    component: int = Field(default=191, ge=1, le=255)
    target: int = Field(default=1, ge=1, le=255)
    timeout_s: float = Field(default=3.0, ge=1.5, le=30)
    answer_s: float = Field(default=0.7, ge=0.1, le=5)
    tries: int = Field(default=4, ge=1, le=10)
    progress_s: float = Field(default=10.0, ge=1, le=120)


class StickTable(Table):
    """`[stick]`: how MANUAL_CONTROL is sent.

    system: the number that sticks are sent from; ArduSub takes them from that of the ground station alone
    (SYSID_MYGCS). rate_hz: times a second; vehicles want 5 or more. cap: the furthest that any stick goes, 0 to 1;
    more is faster. ramp_s: seconds from the middle to the end of a stick's way, and back. neutral_s: seconds for
    which the middle is repeated at the end. z_neutral, z_range: the middle of z in the message and its way to
    either side; 500 and 500 is the usual 0 to 1000. between: whether the middle is sent between tasks too, while
    nobody else's stick is on the link, for vehicles that disarm where sticks fall silent.
    """

    system: int = Field(default=255, ge=1, le=255)
    rate_hz: float = Field(default=10.0, ge=5, le=50)
    cap: float = Field(default=0.4, gt=0, le=1)
    ramp_s: float = Field(default=0.5, ge=0, le=5)
    neutral_s: float = Field(default=1.0, ge=0.3, le=10)
    z_neutral: int = Field(default=500, ge=-1000, le=1000)
    z_range: int = Field(default=500, ge=1, le=1000)
    between: bool = False


class SafetyTable(Table):
    """`[safety]`: what ends a task, and what is done then. What is not listed here cannot be switched off.

    needs_armed: whether what moves the vehicle is refused while it is not armed. stale_s: seconds without a new
    picture that end a task, at most 1. lost_diver_s: seconds without a hand in the picture that end a task; 0: the
    diver may be out of view. fault_modes: entered after a fault, the first that is taken, unless a pilot or another
    changed the mode; none: the mode stays. deadband: how far another's stick is from its middle to count as moved,
    0 to 1. pilot_channels: channels of RC_CHANNELS with the pilot's sticks, looked at while we hold none; some
    vehicles tell of a pilot in no other way.
    """

    needs_armed: bool = True
    stale_s: float = Field(default=1.0, ge=0.2, le=1.0)
    lost_diver_s: Seconds = 0.0
    fault_modes: list[str] = Field(default_factory=list, max_length=4)
    deadband: float = Field(default=0.1, ge=0.02, le=0.5)
    pilot_channels: list[Annotated[int, Field(ge=1, le=18)]] = Field(default_factory=list)


class InstructionTable(Table):
    """`[[instruction]]`: what one instruction does. action, program, change: which instruction it is.

    steps: what is done, one after the other. after_pictures: whether it begins only when pictures that are being taken
    are taken, as in "take pictures for 50 seconds, then follow"; what it replaces ends at once in any case.
    """

    action: str = Field(min_length=1)
    program: int | None = None
    change: str | None = None
    steps: list[Step] = Field(min_length=1, max_length=20)
    after_pictures: bool = False

    def fits(self, record: Instruction) -> bool:
        """Whether the instruction is one that this table is for."""
        return record.action == self.action and all(
            wanted is None or wanted == found
            for wanted, found in ((self.program, record.program), (self.change, record.change))
        )


class ParameterTable(Table):
    """`[[parameter]]`: what PARAM n changes. number: n. name: the vehicle's parameter, or with own = true one of
    the executor's, "cap" or "interval_s". step: what INCREASE adds and DECREASE takes away, in the parameter's
    unit, above 0. minimum, maximum: limits that it is kept within. default: what DEFAULT sets.
    """

    number: int = Field(ge=0, le=9999)
    name: str = Field(min_length=1, max_length=16, pattern=r"^[\x21-\x7e]+$")
    own: bool = False
    step: float = Field(gt=0, allow_inf_nan=False)
    minimum: Number
    maximum: Number
    default: Number

    @model_validator(mode="after")
    def _check(self) -> "ParameterTable":
        if not self.minimum <= self.default <= self.maximum:
            raise ValueError(
                f"default {self.default:g} is not from minimum {self.minimum:g} to maximum {self.maximum:g}; change one"
            )
        if self.own and self.name not in OWN_PARAMETERS:
            raise ValueError(
                f"{self.name} is no parameter of the executor; use {' or '.join(OWN_PARAMETERS)}"
            )
        least, greatest = OWN_PARAMETERS.get(self.name, (self.minimum, self.maximum))
        if self.own and not least <= self.minimum <= self.maximum <= greatest:
            raise ValueError(f"{self.name} may go from {least:g} to {greatest:g}; change minimum or maximum")
        return self


OWN_PARAMETERS = {"cap": (0.05, 1.0), "interval_s": (0.1, 60.0)}
"""Parameters of the executor that a diver may change, with their widest limits."""


class MotionTable(Table):
    """`[motion]`: how the vehicle answers the diver (`--answer motion`). nod, shake: where the stick goes first,
    then to the other side. beat_s: seconds to a side. times: how often to both sides."""

    nod: dict[Literal["x", "y", "z", "r"], Share] = Field(min_length=1)
    shake: dict[Literal["x", "y", "z", "r"], Share] = Field(min_length=1)
    beat_s: float = Field(default=0.5, ge=0.2, le=3)
    times: int = Field(default=2, ge=1, le=5)


class Profile(Table):
    """The whole file. name: the vehicle, for messages. modes: name = number, as in the vehicle's heartbeat."""

    name: str = Field(min_length=1)
    modes: dict[str, Annotated[int, Field(ge=0, le=0xFFFFFFFF)]] = Field(default_factory=dict)
    link: LinkTable = Field(default_factory=LinkTable)
    stick: StickTable = Field(default_factory=StickTable)
    safety: SafetyTable = Field(default_factory=SafetyTable)
    instruction: list[InstructionTable] = Field(min_length=1)
    parameter: list[ParameterTable] = Field(default_factory=list)
    motion: MotionTable | None = None

    @model_validator(mode="after")
    def _check(self) -> "Profile":
        for place, name in self._named_modes():
            if name not in self.modes:
                raise ValueError(
                    f"{place}: {name} is no mode of this profile; use {', '.join(self.modes) or 'none'}"
                )
        numbers = [table.number for table in self.parameter]
        for number in numbers:
            if numbers.count(number) > 1:
                raise ValueError(f"parameter {number} stands twice; leave one out")
        keys = [(table.action, table.program, table.change) for table in self.instruction]
        for key in keys:
            if keys.count(key) > 1:
                raise ValueError(
                    f"instruction {key[0]} stands twice; leave one out, or name program or change"
                )
        return self

    def _named_modes(self) -> Iterator[tuple[str, str]]:
        yield from (("safety.fault_modes", name) for name in self.safety.fault_modes)
        for table in self.instruction:
            for step in table.steps:
                names = [name for name in step.mode if name != PREVIOUS] if isinstance(step, ModeStep) else []
                names = [step.mode] if isinstance(step, MissionStep) else names
                yield from ((f"instruction {table.action}", name) for name in names)

    def table_for(self, record: Instruction) -> InstructionTable | None:
        """What an instruction does; None where the profile does not say. One that names a program goes before one
        that does not."""
        fitting = [table for table in self.instruction if table.fits(record)]
        return max(
            fitting, key=lambda table: (table.program is not None) + (table.change is not None), default=None
        )

    def parameter_for(self, number: int | None) -> ParameterTable | None:
        """The parameter with a number; None where the profile does not say."""
        return next((table for table in self.parameter if table.number == number), None)
