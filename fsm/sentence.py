"""The sentence being signed, and whether a complete one makes sense."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from lightgesture.fsm.dwell import Hold
from lightgesture.fsm.forms import is_digit, spell, split_carrier
from lightgesture.fsm.grammar import Grammar
from lightgesture.fsm.table import Arguments


@dataclass(slots=True, kw_only=True)
class Sentence:
    """An open sentence.

    state: of the grammar's table. touched_s: when its last word was accepted, seconds of the decoder's
    timeline. digits: length of the number that is being signed. confidence: the lowest of its words'.
    """

    start_frame: int
    start_time_s: float
    touched_s: float
    state: int = 0
    digits: int = 0
    confidence: float = 1.0
    words: list[str] = field(default_factory=list)

    def add(self, word: str, hold: Hold, state: int, now_s: float, join: str | None) -> None:
        """Take in a word that has its place."""
        self.words.append(word)
        self.state = state
        self.touched_s = now_s
        self.confidence = min(self.confidence, hold.confidence)
        if is_digit(word):
            self.digits += 1
        elif word != join:
            self.digits = 0

    def text(self, join: str | None) -> str:
        """The sentence so far, digits joined."""
        return spell(self.words, join)


def objection(arguments: Arguments, grammar: Grammar) -> tuple[str, str] | None:
    """Why a complete sentence makes no sense: reason and detail of the rejection; None: it does."""
    program, parameter, seconds = arguments.program, arguments.parameter, arguments.seconds
    limits = grammar.limits
    if program is not None and program not in grammar.programs:
        return "unknown_program", f"program {program} is not in [programs]"
    if parameter is not None and parameter not in grammar.parameters:
        return "unknown_parameter", f"parameter {parameter} is not in [parameters]"
    if seconds is not None and not limits.min_seconds <= seconds <= limits.max_seconds:
        return "limit", f"{seconds} s is outside {limits.min_seconds} to {limits.max_seconds} s"
    return None


def name_expected(words: Iterable[str]) -> str:
    """What may follow, for the diver: "GO or a digit"."""
    names: dict[str, None] = {}  # keeps the order, drops repeats
    for word in sorted(words, key=is_digit):
        name, number = split_carrier(word)
        names["a digit" if is_digit(word) else name if number is None else f"{name} n"] = None
    return " or ".join(names)
