"""The compiled grammar, and the error of a file that cannot become one."""

from collections.abc import Mapping
from dataclasses import dataclass

from lightgesture.fsm.events import Pair
from lightgesture.fsm.forms import Vocabulary
from lightgesture.fsm.settings import DwellSettings, Limits
from lightgesture.fsm.table import Table


class GrammarError(ValueError):
    """A grammar that cannot be used, in one line: file, place, reason; remedy."""

    @classmethod
    def at(cls, file: str, place: str, reason: str, remedy: str) -> "GrammarError":
        """The error at the key path, line or byte `place` of the file; "": the file as a whole."""
        parts = [file, place, f"{reason}; {remedy}"]
        return cls(" ".join(": ".join(part for part in parts if part).split()))


@dataclass(frozen=True, slots=True, kw_only=True)
class Grammar:
    """A language, checked and compiled.

    file: where it was read. tokens: names of the hand shapes. idle_words, sentence_words: pair -> word
    while no sentence is open, and inside one. table: what may follow what. programs, parameters:
    number -> name of those that the robot knows.
    """

    file: str
    tokens: tuple[str, ...]
    idle_words: Mapping[Pair, str]
    sentence_words: Mapping[Pair, str]
    vocabulary: Vocabulary
    table: Table
    programs: Mapping[int, str]
    parameters: Mapping[int, str]
    limits: Limits
    dwell: DwellSettings
