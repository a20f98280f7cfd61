"""The layout of a grammar file and the checks of single values.

Imported only when a file is read: pydantic takes longer to import than the rest of the package.
"""

import difflib
import re
from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError
from pydantic_core import ErrorDetails, PydanticCustomError

from lightgesture.fsm.settings import DwellSettings, Limits, Rule

MAX_HOLD = 1000
"""Longest hold that a file may ask for, frames: 16 s at 60 frames a second."""

MIN_HOLD_S, MAX_HOLD_S = 0.05, 60.0
"""Shortest and longest hold that a file may ask for, seconds."""

MAX_UNREAD = 100.0
"""Longest unread signing, holds: no time-out is later, so that this much turns the rule off."""

MAX_TIMEOUT_S = 3600.0
"""Longest time-out, seconds."""

MAX_SECONDS = 86400
"""Longest duration that a file may allow, seconds: a day."""

MAX_DIGITS = 9
"""Most digits of a number that a file may allow."""

MAX_TOKENS = 64
"""Most hand shapes; the square of it bounds the pairs, and so the words."""

MAX_FORMS = 256
"""Most sentence forms."""

MAX_TEXT = 1000
"""Longest text in a file, characters."""


_LIMITS = Limits()
_DWELL = DwellSettings()


class Defect(NamedTuple):
    """One thing that is wrong: its full key path, why, and what to do."""

    place: str
    reason: str
    remedy: str


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


def _matching(pattern: str, noun: str, remedy: str) -> Callable[[str], str]:
    expression = re.compile(pattern)

    def check(text: str) -> str:
        if expression.fullmatch(text) is None:
            shown = repr(text[:40])
            raise PydanticCustomError(
                "text", "{reason}; {remedy}", {"reason": f"{shown} is no {noun}", "remedy": remedy}
            )
        return text

    return check


Text = Annotated[str, Field(max_length=MAX_TEXT)]
Token = Annotated[
    Text, AfterValidator(_matching(r"[A-Za-z0-9_]{1,32}", "token", "use letters, digits and _, at most 32"))
]
Word = Annotated[
    Text,
    AfterValidator(
        _matching(
            r"[A-Z][A-Z0-9_]{0,31}( [0-9]{1,9})?|[0-9]",
            "word",
            "use capitals as in HOVER, a carried number as in PARAM 3, or one digit",
        )
    ),
]
Kind = Annotated[
    Text, AfterValidator(_matching(r"[a-z][a-z0-9_]{0,31}", "kind", "use small letters, digits and _"))
]
Number = Annotated[
    Text, AfterValidator(_matching(r"0|[1-9][0-9]{0,8}", "number", "use a whole number from 0, such as 12"))
]
Name = Annotated[
    Text, AfterValidator(_matching(r"[^\x00-\x1f\x7f]{1,100}", "name", "use 1 to 100 characters"))
]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class SentinelsTable(_Table):
    """[sentinels]"""

    start: list[Word] = Field(min_length=1)
    end: Word
    join: Word | None = None


class FormTable(_Table):
    """[[forms]]"""

    kind: Kind
    sentence: Text


class LimitsTable(_Table):
    """[limits]"""

    min_seconds: int = Field(default=_LIMITS.min_seconds, ge=0, le=MAX_SECONDS)
    max_seconds: int = Field(default=_LIMITS.max_seconds, ge=0, le=MAX_SECONDS)
    max_digits: int = Field(default=_LIMITS.max_digits, ge=1, le=MAX_DIGITS)


class DwellTable(_Table):
    """[dwell]"""

    rule: Rule = _DWELL.rule
    hold: int = Field(default=_DWELL.hold, ge=1, le=MAX_HOLD)
    hold_seconds: float = Field(
        default=_DWELL.hold_seconds, ge=MIN_HOLD_S, le=MAX_HOLD_S, allow_inf_nan=False
    )
    release: float = Field(default=_DWELL.release, gt=0, le=1, allow_inf_nan=False)
    unread: float = Field(default=_DWELL.unread, gt=0, le=MAX_UNREAD, allow_inf_nan=False)
    timeout_s: float = Field(default=_DWELL.timeout_s, gt=0, le=MAX_TIMEOUT_S, allow_inf_nan=False)


class GrammarFile(_Table):
    """The whole file."""

    tokens: list[Token] = Field(min_length=1, max_length=MAX_TOKENS)
    sentinels: SentinelsTable
    idle_pairs: dict[Text, Word] = Field(default_factory=dict)
    pairs: dict[Text, Word]
    forms: list[FormTable] = Field(min_length=1, max_length=MAX_FORMS)
    programs: dict[Number, Name] = Field(default_factory=dict)
    parameters: dict[Number, Name] = Field(default_factory=dict)
    limits: LimitsTable = Field(default_factory=LimitsTable)
    dwell: DwellTable = Field(default_factory=DwellTable)


_TABLES: dict[str, type[BaseModel]] = {
    "sentinels": SentinelsTable,
    "forms": FormTable,
    "limits": LimitsTable,
    "dwell": DwellTable,
}

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


def parse_document(document: dict[str, Any]) -> GrammarFile | list[Defect]:
    """The file's content with every single value checked, or all that is wrong with them."""
    try:
        return GrammarFile.model_validate(document)
    except ValidationError as error:
        return [_defect(detail) for detail in error.errors(include_url=False)]


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
    table = _TABLES[str(parts[0])] if len(parts) > 1 else GrammarFile
    keys = list(table.model_fields)
    close = difflib.get_close_matches(str(parts[-1]), keys, n=1)
    return f"did you mean '{close[0]}'?" if close else "use " + ", ".join(keys)
