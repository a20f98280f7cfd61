"""The layout of a grammar file and the checks of single values.

Imported only when a file is read: pydantic takes longer to import than the rest of the package.
"""

import re
from collections.abc import Callable
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field
from pydantic_core import PydanticCustomError

from lightgesture.fsm.language.settings import CARD_HOLD_S, DwellSettings, Limits, Rule, SentenceSettings

MAX_HOLD = 1000
"""Longest hold that a file may ask for, frames: 16 s at 60 frames a second."""

MIN_HOLD_S, MAX_HOLD_S = 0.05, 60.0
"""Shortest and longest hold that a file may ask for, seconds."""

MIN_CAUTION, MAX_CAUTION = 0.1, 3.0
"""Least and greatest caution that a file may ask for."""

MAX_UNREAD = 100.0
"""Longest unread signing, holds: no time-out is later, so that this much turns the rule off."""

MAX_PASSAGE_S = 10.0
"""Longest passage from sign to sign, seconds."""

MAX_TIMEOUT_S = 3600.0
"""Longest time-out, seconds."""

MAX_SECONDS = 86400
"""Longest duration that a file may allow, seconds: a day."""

MAX_DIGITS = 9
"""Most digits of a number that a file may allow."""

MAX_TIMES = 10000
"""Most repetitions that a file may allow."""

MAX_WORDS = 1000
"""Longest sentence that a file may allow, words."""

MAX_TOKENS = 64
"""Most hand shapes; the square of it bounds the pairs, and so the words."""

MAX_FORMS = 256
"""Most sentence forms."""

MAX_TEXT = 1000
"""Longest text in a file, characters."""


TOKEN = r"[A-Za-z0-9_]{1,32}"
"""What the name of a token matches, in a grammar and as a class of a model."""

_LIMITS = Limits()
_DWELL = DwellSettings()
_SENTENCE = SentenceSettings()


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
Token = Annotated[Text, AfterValidator(_matching(TOKEN, "token", "use letters, digits and _, at most 32"))]
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
    confirm: bool = False


class ControlTable(_Table):
    """[control]"""

    cancel: Word | None = None
    kill: Word | None = None
    confirm: list[Word] = Field(default_factory=list, max_length=MAX_FORMS)
    confirm_unknown: bool = False


class MenuTable(_Table):
    """[menu]"""

    open: Text
    entries: dict[Text, Annotated[int, Field(ge=0, le=999)]] = Field(min_length=1, max_length=MAX_TOKENS**2)


class ParameterTable(_Table):
    """[parameters.N]"""

    name: Name
    unit: Name | None = None
    step: float | None = Field(default=None, gt=0, allow_inf_nan=False)
    minimum: float | None = Field(default=None, allow_inf_nan=False)
    maximum: float | None = Field(default=None, allow_inf_nan=False)
    default: float | None = Field(default=None, allow_inf_nan=False)


def _named(value: Any) -> Any:
    return {"name": value} if isinstance(value, str) else value


NamedParameter = Annotated[ParameterTable, BeforeValidator(_named)]
"""A table, or the name alone."""


class LimitsTable(_Table):
    """[limits]"""

    min_seconds: int = Field(default=_LIMITS.min_seconds, ge=0, le=MAX_SECONDS)
    max_seconds: int = Field(default=_LIMITS.max_seconds, ge=0, le=MAX_SECONDS)
    max_times: int = Field(default=_LIMITS.max_times, ge=1, le=MAX_TIMES)
    max_digits: int = Field(default=_LIMITS.max_digits, ge=1, le=MAX_DIGITS)
    max_words: int = Field(default=_LIMITS.max_words, ge=3, le=MAX_WORDS)


class DwellTable(_Table):
    """[dwell]"""

    rule: Rule = _DWELL.rule
    hold: int = Field(default=_DWELL.hold, ge=1, le=MAX_HOLD)
    hold_seconds: float = Field(
        default=_DWELL.hold_seconds, ge=MIN_HOLD_S, le=MAX_HOLD_S, allow_inf_nan=False
    )
    release: float = Field(default=_DWELL.release, gt=0, le=1, allow_inf_nan=False)
    unread: float = Field(default=_DWELL.unread, gt=0, le=MAX_UNREAD, allow_inf_nan=False)
    passage_s: float = Field(default=_DWELL.passage_s, ge=0, le=MAX_PASSAGE_S, allow_inf_nan=False)
    count_hidden: bool = _DWELL.count_hidden
    timeout_s: float = Field(default=_DWELL.timeout_s, gt=0, le=MAX_TIMEOUT_S, allow_inf_nan=False)


class SentenceTable(_Table):
    """[sentence]"""

    caution: float = Field(default=_SENTENCE.caution, ge=MIN_CAUTION, le=MAX_CAUTION, allow_inf_nan=False)
    hold_seconds: float = Field(
        default=_SENTENCE.hold_seconds, ge=MIN_HOLD_S, le=MAX_HOLD_S, allow_inf_nan=False
    )


class _WordsTable(BaseModel):
    """A table whose other keys are signs that say words."""

    model_config = ConfigDict(extra="allow", strict=True, frozen=True)
    __pydantic_extra__: dict[str, Word]  # pyright: ignore[reportIncompatibleVariableOverride]

    family: Text = "36h11"
    hold_seconds: float = Field(default=CARD_HOLD_S, ge=MIN_HOLD_S, le=MAX_HOLD_S, allow_inf_nan=False)


class TagsTable(_WordsTable):
    """[tags]: id = word"""


class MotionsTable(_WordsTable):
    """[motions]: "left hand,right hand" = word"""

    left_id: int = Field(default=50, ge=0)
    right_id: int = Field(default=51, ge=0)


class GrammarFile(_Table):
    """The whole file."""

    tokens: list[Token] = Field(min_length=1, max_length=MAX_TOKENS)
    sentinels: SentinelsTable
    idle_pairs: dict[Text, Word] = Field(default_factory=dict)
    pairs: dict[Text, Word]
    forms: list[FormTable] = Field(min_length=1, max_length=MAX_FORMS)
    programs: dict[Number, Name] = Field(default_factory=dict)
    parameters: dict[Number, NamedParameter] = Field(default_factory=dict)
    control: ControlTable = Field(default_factory=ControlTable)
    menu: MenuTable | None = None
    tags: TagsTable | None = None
    motions: MotionsTable | None = None
    limits: LimitsTable = Field(default_factory=LimitsTable)
    dwell: DwellTable = Field(default_factory=DwellTable)
    sentence: SentenceTable = Field(default_factory=SentenceTable)


TABLES: dict[str, type[BaseModel]] = {
    "sentinels": SentinelsTable,
    "forms": FormTable,
    "limits": LimitsTable,
    "dwell": DwellTable,
    "sentence": SentenceTable,
    "control": ControlTable,
    "menu": MenuTable,
    "tags": TagsTable,
    "motions": MotionsTable,
    "parameters": ParameterTable,
}
"""The tables of a file, by their names."""
