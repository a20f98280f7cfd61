"""Which MAVLink messages an instruction leads to: a TOML file that the user writes, and nothing without it.

[[value]]                            # NAMED_VALUE_INT or NAMED_VALUE_FLOAT
action = "HOVER"
name = "LG_HOVER"
value = "duration_s"
missing = 0

[[command]]                          # COMMAND_LONG
action = "SNAP"
command = "MAV_CMD_IMAGE_START_CAPTURE"
params = [0, 0, 1]
"""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator
from pydantic_core import ErrorDetails

from lightgesture.errors import UsageError
from lightgesture.fsm import Instruction
from lightgesture.fsm.toml_file import TomlError, read_toml, suggest_key

COMMANDS = {
    "MAV_CMD_NAV_LOITER_UNLIM": 17,
    "MAV_CMD_NAV_LOITER_TIME": 19,
    "MAV_CMD_CONDITION_YAW": 115,
    "MAV_CMD_DO_CHANGE_SPEED": 178,
    "MAV_CMD_DO_PAUSE_CONTINUE": 193,
    "MAV_CMD_DO_DIGICAM_CONTROL": 203,
    "MAV_CMD_DO_MOUNT_CONTROL": 205,
    "MAV_CMD_IMAGE_START_CAPTURE": 2000,
    "MAV_CMD_IMAGE_STOP_CAPTURE": 2001,
    "MAV_CMD_VIDEO_START_CAPTURE": 2500,
    "MAV_CMD_VIDEO_STOP_CAPTURE": 2501,
    "MAV_CMD_USER_1": 31010,
    "MAV_CMD_USER_2": 31011,
    "MAV_CMD_USER_3": 31012,
    "MAV_CMD_USER_4": 31013,
    "MAV_CMD_USER_5": 31014,
}
"""The commands that may be sent.

None of them arms or disarms, lands, starts a mission, changes the mode by its number, works a switch of the radio,
reboots or ends the flight. Whatever else somebody needs goes through a USER command, which the vehicle's own program
decides upon.
"""

CAMERA_COMMANDS = frozenset(name for name in COMMANDS if "_IMAGE_" in name or "_VIDEO_" in name)
"""Commands for a camera, which is a component of its own: the autopilot does not hand them on."""

CAMERA_COMPONENT, AUTOPILOT_COMPONENT = 100, 1
"""Whom commands are for, unless the file says otherwise."""

NAME_BYTES = 10
"""Longest name of a named value."""

PARAMS = 7
"""Parameters of a command."""

Number = Annotated[float, Field(allow_inf_nan=False)]
Value = Number | Literal["duration_s", "program", "parameter", "confidence"]
"""A number, or the field of the instruction that holds it."""


class _Rule(BaseModel):
    """When a message is sent: fields of the instruction that must be equal; None fits any.

    missing: what is sent where the instruction has null in a field that is named.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    action: str = Field(min_length=1)
    program: int | None = None
    parameter: int | None = None
    change: str | None = None
    missing: Number = 0.0

    def fits(self, record: Instruction) -> bool:
        """Whether the instruction is one that this rule is for."""
        return record.action == self.action and all(
            wanted is None or wanted == found
            for wanted, found in (
                (self.program, record.program),
                (self.parameter, record.parameter),
                (self.change, record.change),
            )
        )

    def number(self, value: Value, record: Instruction) -> float:
        """The number that a value stands for."""
        if not isinstance(value, str):
            return value
        found = getattr(record, value)
        return self.missing if found is None else float(found)


class ValueRule(_Rule):
    """A NAMED_VALUE_INT, or with `is_float` a NAMED_VALUE_FLOAT; name: at most ten ASCII characters."""

    name: str = Field(min_length=1, max_length=NAME_BYTES, pattern=r"^[\x21-\x7e]+$")
    value: Value
    is_float: bool = False


class CommandRule(_Rule):
    """A COMMAND_LONG; command: a name in `COMMANDS`. params: the first of its seven parameters, the others are 0.

    component: whom it is for; None: the file's, or else a camera for what cameras do and the autopilot for the rest.
    """

    command: str
    params: list[Value] = Field(default_factory=list, max_length=PARAMS)
    component: int | None = Field(default=None, ge=0, le=255)

    @field_validator("command")
    @classmethod
    def _check_command(cls, name: str) -> str:
        if name not in COMMANDS:
            raise ValueError(f"{name} is not permitted; permitted are {', '.join(COMMANDS)}")
        return name


class MavlinkMap(BaseModel):
    """The whole file; target_system: number of the vehicle; None: learnt. target_component: whom commands are for."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    target_system: int | None = Field(default=None, ge=1, le=255)
    target_component: int | None = Field(default=None, ge=0, le=255)
    value: list[ValueRule] = Field(default_factory=list)
    command: list[CommandRule] = Field(default_factory=list)

    def values(self, record: Instruction) -> Iterator[tuple[ValueRule, float]]:
        """The named values that an instruction leads to, with their numbers."""
        for rule in self.value:
            if rule.fits(record):
                yield rule, rule.number(rule.value, record)

    def commands(self, record: Instruction) -> Iterator[tuple[str, int, int, list[float]]]:
        """The commands that an instruction leads to: name, number, component, and the seven parameters."""
        for rule in self.command:
            if rule.fits(record):
                numbers = [rule.number(value, record) for value in rule.params]
                component = component_for(rule.command, rule.component, self.target_component)
                yield rule.command, COMMANDS[rule.command], component, padded(numbers)


def padded(params: list[float]) -> list[float]:
    """All seven parameters of a command, those that are not given being 0."""
    return params + [0.0] * (PARAMS - len(params))


def component_for(command: str, *chosen: int | None) -> int:
    """Whom a command is for: the first of `chosen` that is not None, else whoever such commands are for."""
    usual = CAMERA_COMPONENT if command in CAMERA_COMMANDS else AUTOPILOT_COMPONENT
    return next((component for component in chosen if component is not None), usual)


def load_map(path: str) -> MavlinkMap:
    """Read and check a map. UsageError: it cannot be read, is no TOML, or has a wrong key or value."""
    try:
        return MavlinkMap.model_validate(read_toml(path, "map", "docs/live.md"))
    except TomlError as error:
        raise UsageError(f"{path}: {error}") from None
    except ValidationError as error:
        raise UsageError(f"{path}: {_explain(error.errors(include_url=False)[0])}") from None


def _explain(detail: ErrorDetails) -> str:
    place, key = ".".join(map(str, detail["loc"])), detail["loc"][-1]
    if detail["type"] != "extra_forbidden":
        return f"{place}: {detail['msg']}; see docs/live.md"
    rules: dict[str | int, type[BaseModel]] = {"value": ValueRule, "command": CommandRule}
    table = rules.get(detail["loc"][0], MavlinkMap) if len(detail["loc"]) > 1 else MavlinkMap
    return f"{place}: unknown key; {suggest_key(str(key), list(table.model_fields))}"
