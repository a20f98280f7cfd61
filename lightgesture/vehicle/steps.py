"""The steps of an instruction in `vehicle.toml`: each is one thing that the vehicle does."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, field_validator, model_validator

from lightgesture.sinks.mavlink_map import COMMANDS, NAME_BYTES, PARAMS, Number, Value
from lightgesture.vehicle.interface import Stick

Seconds = Annotated[float, Field(ge=0, le=3600, allow_inf_nan=False)]
Share = Annotated[float, Field(ge=-1, le=1, allow_inf_nan=False)]
Component = Annotated[int, Field(ge=0, le=255)]
Modes = Annotated[list[str], Field(min_length=1, max_length=4)]


class Table(BaseModel):
    """A table of the file: unknown keys and values of another type are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


PREVIOUS = "previous"
"""In the place of a mode: that of before the task."""


class ModeStep(Table):
    """Enter the first of the modes that the vehicle takes; "previous" is that of before the task."""

    mode: Modes


class StickStep(Table):
    """Hold the sticks, each -1 to 1 before the cap, for `seconds`; missing: where the instruction tells none; most: at
    most so long, whatever was signed."""

    stick: dict[Literal["x", "y", "z", "r"], Share] = Field(min_length=1)
    seconds: Annotated[float, Field(gt=0, le=600, allow_inf_nan=False)] | Literal["duration_s"] = "duration_s"
    missing: float = Field(default=3.0, gt=0, le=600)
    most: float = Field(default=60.0, gt=0, le=600)

    @property
    def where(self) -> Stick:
        """The sticks."""
        return Stick(**self.stick)


class WaitStep(Table):
    """Stay in this step for seconds; missing: where the instruction tells none; absent: until the next instruction."""

    wait: Annotated[float, Field(gt=0, le=3600, allow_inf_nan=False)] | Literal["duration_s"]
    missing: float | None = Field(default=None, gt=0, le=3600)


class CommandStep(Table):
    """A command that `--mavlink-map` may send too, its first parameters, the others 0; component: whom it is for;
    missing: where the instruction has null in a field that `params` names."""

    command: str
    params: list[Value] = Field(default_factory=list, max_length=PARAMS)
    missing: Number = 0.0
    component: Component | None = None

    @field_validator("command")
    @classmethod
    def _check(cls, name: str) -> str:
        if name not in COMMANDS:
            raise ValueError(f"{name} is not permitted; permitted are {', '.join(COMMANDS)}")
        return name


class ValueStep(Table):
    """A named value for the vehicle's own program: name, at most ten ASCII characters, and number."""

    value: Value
    name: str = Field(min_length=1, max_length=NAME_BYTES, pattern=r"^[\x21-\x7e]+$")
    missing: Number = 0.0


class MissionStep(Table):
    """Run the loaded mission from item `mission` to `last` (absent: to its end) in the mode `mode`."""

    mission: int = Field(ge=0, le=65535)
    last: int | None = Field(default=None, ge=0, le=65535)
    mode: str = "AUTO"

    @model_validator(mode="after")
    def _check(self) -> "MissionStep":
        if self.last is not None and self.last < self.mission:
            raise ValueError(
                f"last {self.last} comes before mission {self.mission}; write the later one as last"
            )
        return self


class CameraStep(Table):
    """Pictures, one each `interval_s` seconds, for `seconds` (missing: where the instruction tells none; 0: one
    picture).

    camera: the camera's component, 0: none. folder: where our own frames go as JPEG where the camera takes none; "":
    nowhere.
    """

    camera: Component = 100
    interval_s: float = Field(default=1.0, ge=0.1, le=60)
    seconds: Annotated[float, Field(ge=0, le=3600, allow_inf_nan=False)] | Literal["duration_s"] = (
        "duration_s"
    )
    missing: Seconds = 0.0
    folder: str = ""

    @model_validator(mode="after")
    def _check(self) -> "CameraStep":
        if not self.camera and not self.folder:
            raise ValueError(
                "camera is 0 and folder is empty, so no picture would be taken; name one of them"
            )
        return self


class HookStep(Table):
    """Run a command, without a shell, with the instruction's record as JSON on its standard input; status 0:
    accepted."""

    hook: str = Field(min_length=1)


STEPS: dict[str, type[Table]] = {
    "mode": ModeStep,
    "stick": StickStep,
    "wait": WaitStep,
    "command": CommandStep,
    "value": ValueStep,
    "mission": MissionStep,
    "camera": CameraStep,
    "hook": HookStep,
}
"""The key that says what a step is, to its table."""


def _kind_of(step: Any) -> str | None:
    """The key that says what a step is; `mode` may also be one of a mission."""
    if isinstance(step, Table):
        return next(name for name, kind in STEPS.items() if isinstance(step, kind))
    found = [name for name in STEPS if isinstance(step, dict) and name in step]
    if "mission" in found and "mode" in found:
        found.remove("mode")
    return found[0] if len(found) == 1 else None


Step = Annotated[
    Annotated[ModeStep, Tag("mode")]
    | Annotated[StickStep, Tag("stick")]
    | Annotated[WaitStep, Tag("wait")]
    | Annotated[CommandStep, Tag("command")]
    | Annotated[ValueStep, Tag("value")]
    | Annotated[MissionStep, Tag("mission")]
    | Annotated[CameraStep, Tag("camera")]
    | Annotated[HookStep, Tag("hook")],
    Discriminator(
        _kind_of,
        custom_error_type="step",
        custom_error_message=f"a step has exactly one of {', '.join(STEPS)}",
    ),
]
"""One thing that the vehicle does; the steps of an instruction follow each other."""
