"""Reads `vehicle.toml`, or one of the profiles that come with the package."""

from importlib.resources import files

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from lightgesture.errors import UsageError
from lightgesture.fsm.toml_file import TomlError, read_toml, suggest_key
from lightgesture.vehicle import profile as tables
from lightgesture.vehicle.profile import Profile
from lightgesture.vehicle.steps import STEPS

BUNDLED = ("ardusub", "manual")
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
    """The profile in a file, or a bundled one by its name. UsageError: it cannot be read, or what is wrong in it."""
    path = str(files("lightgesture.vehicle") / "profiles" / f"{name}.toml") if name in BUNDLED else name
    try:
        return Profile.model_validate(read_toml(path, "profile of a vehicle", _WHERE))
    except TomlError as error:
        raise UsageError(f"{name}: {error}") from None
    except ValidationError as error:
        raise UsageError(f"{name}: {_explain(error.errors(include_url=False)[0])}") from None


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
