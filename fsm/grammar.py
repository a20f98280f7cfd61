"""The compiled grammar, and the error of a file that cannot become one."""

from collections.abc import Mapping
from dataclasses import dataclass

from lightgesture.fsm.events import Pair
from lightgesture.fsm.forms import Vocabulary
from lightgesture.fsm.table import Table


class GrammarError(ValueError):
    """A grammar that cannot be used, in one line: file, place, reason; remedy."""

    @classmethod
    def at(cls, file: str, place: str, reason: str, remedy: str) -> "GrammarError":
        """The error at the key path, line or byte `place` of the file; "": the file as a whole."""
        parts = [file, place, f"{reason}; {remedy}"]
        return cls(" ".join(": ".join(part for part in parts if part).split()))


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Bounds of numbers; what lies outside is rejected with reason "limit".

    min_seconds, max_seconds: of a duration, seconds, both allowed. Ten minutes admit any number of
    three digits and refuse a fourth that was misread. max_digits: of any number; one more rejects at once.
    """

    min_seconds: int = 1
    max_seconds: int = 600
    max_digits: int = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class DwellSettings:
    """When a sign counts.

    hold: consecutive frames that a pair must be seen; more gives fewer false words and slower signing.
    release: fraction of the hold, 0 to 1 and at least one frame, that a pair must be absent before it
    counts again; less lets a flicker double a word. timeout_s: seconds without an accepted word that
    drop an open sentence.
    """

    hold: int = 15
    release: float = 0.2
    timeout_s: float = 20.0


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
