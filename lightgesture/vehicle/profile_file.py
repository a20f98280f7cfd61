"""Reads `vehicle.toml`, or one of the profiles that come with the package."""

import os
from importlib.resources import files

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from lightgesture.config.settings import BUILT_IN_VEHICLES
from lightgesture.errors import UsageError
from lightgesture.fsm.toml_file import TomlError, read_toml, suggest_key
from lightgesture.sinks.hook import HookSink
from lightgesture.vehicle import profile as tables
from lightgesture.vehicle.profile import Profile
from lightgesture.vehicle.steps import STEPS, CameraStep, HookStep, Step

BUNDLED = BUILT_IN_VEHICLES
"""Profiles by name: a vehicle with ArduSub, and one that takes MANUAL_CONTROL and nothing else."""

_WHERE = "docs/vehicle.md"
_TABLES: dict[str, type[BaseModel]] = {
    "link": tables.LinkTable,
    "stick": tables.StickTable,
    "safety": tables.SafetyTable,
    "instruction": tables.InstructionTable,
    "parameter": tables.ParameterTable,
    "motion": tables.MotionTable,
}


def load_vehicle(name: str) -> Profile:
    """The profile in a file, or a bundled one by its name. UsageError: it cannot be read, or what is wrong in it.

    Folders of pictures start at the file's own; those of a bundled profile at the present one.
    """
    is_bundled = name in BUNDLED
    path = str(files("lightgesture.vehicle") / "profiles" / f"{name}.toml") if is_bundled else name
    try:
        profile = Profile.model_validate(read_toml(path, "profile of a vehicle", _WHERE))
    except TomlError as error:
        raise UsageError(f"{name}: {error}") from None
    except ValidationError as error:
        raise UsageError(f"{name}: {_explain(error.errors(include_url=False)[0])}") from None
    _check_hooks(profile, name)
    return profile if is_bundled else _with_folders(profile, os.path.dirname(name))


def _check_hooks(profile: Profile, name: str) -> None:
    for table in profile.instruction:
        for step in table.steps:
            if isinstance(step, HookStep):
                HookSink(step.hook, f"{name}: hook")


def _with_folders(profile: Profile, start: str) -> Profile:
    """The profile with the folders of pictures made to begin at `start`."""
    instructions = [
        table.model_copy(update={"steps": [_with_folder(step, start) for step in table.steps]})
        for table in profile.instruction
    ]
    return profile.model_copy(update={"instruction": instructions})


def _with_folder(step: Step, start: str) -> Step:
    if not isinstance(step, CameraStep) or not step.folder:
        return step
    return step.model_copy(update={"folder": os.path.join(start, step.folder)})


def _explain(detail: ErrorDetails) -> str:
    parts = [str(part) for part in detail["loc"]]
    place, text = ".".join(parts), detail["msg"].removeprefix("Value error, ")
    if detail["type"] == "extra_forbidden":
        return f"{place}: unknown key; {suggest_key(parts[-1], _known_keys(parts[:-1]))}"
    return f"{place}: {text}; see {_WHERE}" if place else f"{text}; see {_WHERE}"


def _known_keys(loc: list[str]) -> list[str]:
    """The keys of the innermost table that a place lies in."""
    if "steps" in loc and loc[-1] in STEPS:
        return list(STEPS[loc[-1]].model_fields)
    for part in reversed(loc):
        if part in _TABLES:
            return list(_TABLES[part].model_fields)
    return list(Profile.model_fields)
