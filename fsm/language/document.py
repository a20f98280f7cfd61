"""From a parsed TOML document to a grammar file's content, and to what is wrong with its single values."""

import re
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from lightgesture.fsm.language.grammar import Defect
from lightgesture.fsm.language.schema import TABLES, GrammarFile
from lightgesture.fsm.toml_file import suggest_key

_EXPECTED = {
    "string_type": ("is no text", "write it in quotes"),
    "int_type": ("is no whole number", "write one without quotes and without a point"),
    "float_type": ("is no number", "write one without quotes"),
    "finite_number": ("is no finite number", "write one such as 20"),
    "list_type": ("is no list", "write values in square brackets"),
    "dict_type": ("is no table", "write a table of key = value lines"),
    "model_type": ("is no table", "write a table of key = value lines"),
    "missing": ("is missing", "add it, as in the bundled grammar"),
}


def key_path(*parts: str | int) -> str:
    """`forms[1].sentence`, `pairs."ok,0"`: the path of a key as TOML would write it."""
    path = ""
    for part in parts:
        if isinstance(part, int):
            path += f"[{part}]"
        else:
            key = part if re.fullmatch(r"[A-Za-z0-9_-]+", part) else f'"{part[:80]}"'
            path += f".{key}" if path else key
    return path


def parse_document(document: dict[str, Any]) -> tuple[GrammarFile | None, list[Defect]]:
    """The file's content with every single value checked, and all that is wrong with them.

    What is wrong is left out of the content, so that the rest can be checked further; None where that cannot be.
    """
    try:
        return GrammarFile.model_validate(document), []
    except ValidationError as error:
        details = error.errors(include_url=False)
    defects = [_defect(detail) for detail in details]
    # From the back, so that the numbers of the entries of a list stay what they are.
    for place in sorted({_removable(detail["loc"]) for detail in details}, key=_backwards, reverse=True):
        _remove(document, place)
    try:
        return GrammarFile.model_validate(document), defects
    except ValidationError:
        return None, defects


_Place = tuple[str | int, ...]


def _removable(place: _Place) -> _Place:
    """What is left out for the sake of a wrong value: of a form or a parameter all of it."""
    place = tuple(part for part in place if part != "[key]")
    return place[:2] if place[0] in ("forms", "parameters", "programs") else place


def _backwards(place: _Place) -> list[tuple[int, str]]:
    return [(part, "") if isinstance(part, int) else (-1, part) for part in place]


def _remove(document: dict[str, Any], place: _Place) -> None:
    holder: Any = document
    for part in place[:-1]:
        holder = holder[part]
    last = place[-1]
    if isinstance(last, int):
        del holder[last]
    else:
        holder.pop(last, None)  # what is missing is a defect as well


def _defect(detail: ErrorDetails) -> Defect:
    parts = [part for part in detail["loc"] if part != "[key]"]
    place = key_path(*parts)
    kind = detail["type"]
    if kind == "extra_forbidden":
        return Defect(place, "unknown key", _known_keys(parts))
    if kind in _EXPECTED:
        return Defect(place, *_EXPECTED[kind])
    context = detail.get("ctx", {})
    if kind == "text":
        return Defect(place, context["reason"], context["remedy"])
    shown = repr(detail["input"])[:40]
    reason = detail["msg"].replace("Input should be", "should be")
    return Defect(place, f"{reason}, not {shown}", "change it")


def _known_keys(parts: list[str | int]) -> str:
    table = TABLES[str(parts[0])] if len(parts) > 1 else GrammarFile
    return suggest_key(str(parts[-1]), list(table.model_fields))
