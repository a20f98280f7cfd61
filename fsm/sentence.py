"""The sentence being signed, and whether a complete one makes sense."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from lightgesture.fsm.language.forms import Form, is_digit, split_carrier
from lightgesture.fsm.language.grammar import Grammar
from lightgesture.fsm.language.settings import Control
from lightgesture.fsm.language.table import Arguments
from lightgesture.fsm.rules.dwell import Hold


@dataclass(slots=True, kw_only=True)
class Sentence:
    """An open sentence.

    state: of the grammar's table. touched_s: when its last word was accepted, seconds of the decoder's
    timeline. digits: length of the number that is being signed, 0 outside one. number: that number; before_number:
    the text before it. confidence: the lowest of its words'.
    complete: the form that it has, once it is complete and waits to be confirmed. text: the words so far, digits
    joined, as `spell` gives them. has_unknown: a pair was held in it that is no word.
    """

    start_frame: int
    start_time_s: float
    touched_s: float
    state: int = 0
    digits: int = 0
    confidence: float = 1.0
    words: list[str] = field(default_factory=list)
    complete: Form | None = None
    text: str = ""
    has_unknown: bool = False
    number: str = ""
    before_number: str = ""

    def add(self, word: str, hold: Hold, state: int, now_s: float, join: str | None) -> None:
        """Take in a word that has its place."""
        self.words.append(word)
        self.state = state
        self.touched_s = now_s
        if hold.confidence < self.confidence:
            self.confidence = hold.confidence
        if is_digit(word):
            self._add_digit(word)
            return
        if word != join:
            self.digits = 0
        self.text = f"{self.text} {word}" if self.text else word

    def _add_digit(self, digit: str) -> None:
        """The number that is being signed goes on, whether or not its digits are joined, or begins."""
        if self.digits == 0:
            self.before_number = self.text
            self.number = ""
        self.digits += 1
        self.number = (self.number + digit).lstrip("0") or "0"
        self.text = f"{self.before_number} {self.number}"


def objection(arguments: Arguments, grammar: Grammar) -> tuple[str, str] | None:
    """Why a complete sentence makes no sense: reason and detail of the rejection; None: it does."""
    limits = grammar.limits
    if arguments.parameter is not None and arguments.parameter not in grammar.parameters:
        return "unknown_parameter", f"parameter {arguments.parameter} is not in [parameters]"
    for slot, number in arguments.numbers:
        if slot == "program" and number not in grammar.programs:
            return "unknown_program", f"program {number} is not in [programs]"
        if slot == "seconds" and not limits.min_seconds <= number <= limits.max_seconds:
            return "limit", f"{number} s is outside {limits.min_seconds} to {limits.max_seconds} s"
        if slot == "times" and not 1 <= number <= limits.max_times:
            return "limit", f"{number} times is outside 1 to {limits.max_times} times"
    return None


def needs_confirmation(form: Form, sentence: Sentence, control: Control) -> bool:
    """Whether a complete sentence waits for a second end word."""
    if form.confirm or (sentence.has_unknown and control.confirm_unknown):
        return True
    return bool(control.confirm) and any(
        word in control.confirm or split_carrier(word)[0] in control.confirm for word in sentence.words
    )


def name_expected(words: Iterable[str]) -> str:
    """What may follow, for the diver: "GO or a digit"."""
    names: dict[str, None] = {}  # keeps the order, drops repeats
    for word in sorted(words, key=is_digit):
        name, number = split_carrier(word)
        names["a digit" if is_digit(word) else name if number is None else f"{name} n"] = None
    return " or ".join(names)
