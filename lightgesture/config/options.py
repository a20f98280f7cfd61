"""Options from the command line and from `--config`: what `settings.DecodeSettings` declares feeds both, and the help.

Precedence: command line, then configuration file, then the grammar's own `[dwell]` (for the hold), then the model's
defaults.
"""

import argparse
import os
from collections.abc import Callable, Mapping
from typing import Any

from pydantic import ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from lightgesture.config.declaring import DECODING
from lightgesture.config.settings import DecodeSettings, change_paths
from lightgesture.errors import UsageError
from lightgesture.fsm.toml_file import TomlError, read_toml, suggest_key
from lightgesture.parser import MayStandAlone

_HOLDS = ("hold", "hold_seconds")
MOST_TOLD = 3
"""Wrong keys and values of a file that are told; each may tell all keys that there are."""
LONGEST_SHOWN = 60
"""Characters of a wrong one that are shown."""


def add_options(parser: argparse.ArgumentParser, *commands: str) -> None:
    """Declare the options of `commands`, and `--config` if one decodes; what is not given stays out of the result."""
    for name, field in DecodeSettings.model_fields.items():
        extra: Any = field.json_schema_extra
        if not set(commands) & set(extra["only"]):
            continue
        key = field.alias or name
        kind: dict[str, Any] = {"metavar": extra["metavar"]}
        if field.annotation is bool:
            kind = {"action": argparse.BooleanOptionalAction}
        elif extra["may_stand_alone"]:
            kind |= {"action": MayStandAlone, "words": extra["metavar"].split("|")}
        elif field.annotation == list[str]:
            kind["action"] = "append"
        parser.add_argument(
            _flag(key), dest=key, default=argparse.SUPPRESS, help=_help(field, extra["metavar"]), **kind
        )
    if set(commands) & set(DECODING):
        text = "TOML file with any of these options; the command line goes first"
        parser.add_argument("--config", metavar="FILE", help=text)


def load_settings(args: argparse.Namespace) -> DecodeSettings:
    """Settings from the parsed options of `add_options` and from the file that `--config` names.

    UsageError: the file cannot be read, or an option or a key is wrong.
    """
    known = {field.alias or name for name, field in DecodeSettings.model_fields.items()}
    given = {key: value for key, value in vars(args).items() if key in known}
    file = getattr(args, "config", None)
    config = {} if file is None else read_config(file)
    _check_holds(given, "", _flag)
    for key, other in zip(_HOLDS, reversed(_HOLDS), strict=True):
        if key in given:
            config.pop(other, None)
    try:
        return DecodeSettings.model_validate({**config, **given})
    except ValidationError as error:
        raise UsageError(explain(error, _flag)) from None


def read_config(path: str) -> dict[str, Any]:
    """The checked content of a configuration file.

    Keys are the options' names, with `_` or `-`; a relative path in it starts at the file's own folder.
    UsageError: it cannot be read, is no TOML, or has a wrong key or value.
    """
    try:
        written = read_toml(path, "configuration", "deploy/lightgesture.toml")
        content = {key.replace("-", "_"): value for key, value in written.items()}
        DecodeSettings.model_validate(content, strict=True)
    except TomlError as error:
        raise UsageError(f"{path}: {error}") from None
    except ValidationError as error:
        raise UsageError(f"{path}: {explain(error, str)}") from None
    _check_holds(content, f"{path}: ", str)
    folder = os.path.dirname(path)
    return content | change_paths(content, lambda name: os.path.join(folder, name))


def _check_holds(given: Mapping[str, Any], place: str, show: Callable[[str], str]) -> None:
    if all(key in given for key in _HOLDS):
        raise UsageError(f"{place}{' and '.join(map(show, _HOLDS))}: exclude each other; give one of them")


def _flag(key: str) -> str:
    return "--" + key.replace("_", "-")


def _help(field: FieldInfo, metavar: str | None) -> str:
    text = (field.description or "").replace("%", "%%")
    is_told = metavar is None or field.default in (None, []) or "(default" in text
    return text if is_told else f"{text} (default: {field.default})"


def explain(error: ValidationError, show: Callable[[str], str]) -> str:
    """What is wrong with which options, the first few, in one line; `show` writes an option's name as its user did."""
    details = error.errors(include_url=False)
    told = [_explain_one(detail, show) for detail in details[:MOST_TOLD]]
    more = [f"and {len(details) - len(told)} more"] if len(details) > len(told) else []
    return "; ".join([*told, *more])


def _explain_one(detail: ErrorDetails, show: Any) -> str:
    key = str(detail["loc"][0])
    if detail["type"] == "extra_forbidden":
        known = [field.alias or name for name, field in DecodeSettings.model_fields.items()]
        return f"{key[:LONGEST_SHOWN]}: unknown key; {suggest_key(key, known)}"
    shown = repr(detail["input"])[:LONGEST_SHOWN]
    if detail["type"] == "string_pattern_mismatch":
        extra: Any = DecodeSettings.model_fields[key].json_schema_extra
        return f"{show(key)}: should be {extra['metavar']}, not {shown}; change it"
    return f"{show(key)}: {detail['msg'].replace('Input should', 'should')}, not {shown}; change it"
