"""The compiled grammar, and the error of a file that cannot become one."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

from lightgesture.fsm.language.forms import Vocabulary
from lightgesture.fsm.language.settings import Control, DwellSettings, Limits, Parameter, SentenceSettings
from lightgesture.fsm.language.table import Table
from lightgesture.fsm.signs import Pair

STILL: Final = "still"
"""Names the hand that does not move in a pair of [motions]."""


class Defect(NamedTuple):
    """One thing that is wrong: its full key path, why, and what to do.

    is_fatal: the grammar cannot be used; else it can, but not everything in it.
    """

    place: str
    reason: str
    remedy: str
    is_fatal: bool = True

    def __str__(self) -> str:
        return " ".join(f"{self.place}: {self.reason}; {self.remedy}".split())


class GrammarError(ValueError):
    """A grammar that cannot be used, in one line: file, place, reason; remedy."""

    @classmethod
    def at(cls, file: str, place: str, reason: str, remedy: str) -> "GrammarError":
        """The error at the key path, line or byte `place` of the file; "": the file as a whole."""
        parts = [file, place, f"{reason}; {remedy}"]
        return cls(" ".join(": ".join(part for part in parts if part).split()))


@dataclass(frozen=True, slots=True)
class CardWords:
    """[tags]: a card says its word. family: of AprilTag. hold_seconds: how long it is shown. words: id -> word."""

    family: str
    hold_seconds: float
    words: Mapping[int, str]


@dataclass(frozen=True, slots=True)
class MotionWords:
    """[motions]: two cards say a word by how they are moved.

    left, right: ids of the tags in the diver's own hands. hold_seconds: how long they rest after a motion. words: what
    the left hand's and the right hand's tag draw -> word.
    """

    family: str
    left: int
    right: int
    hold_seconds: float
    words: Mapping[Pair, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class Grammar:
    """A language, checked and compiled.

    file: where it was read. tokens: names of the hand shapes. idle_words, sentence_words, menu_words: pair -> word
    while no sentence is open, inside one, and in the menu. table: what may follow what. end: the word that closes a
    sentence. programs, parameters: number -> those that the robot knows. tags, motions: the words of cards and of moved
    cards, None where the file has no such table.
    """

    file: str
    tokens: tuple[str, ...]
    idle_words: Mapping[Pair, str]
    sentence_words: Mapping[Pair, str]
    menu_words: Mapping[Pair, str]
    vocabulary: Vocabulary
    table: Table
    end: str
    programs: Mapping[int, str]
    parameters: Mapping[int, Parameter]
    limits: Limits
    dwell: DwellSettings
    sentence: SentenceSettings
    control: Control
    tags: CardWords | None = None
    motions: MotionWords | None = None
