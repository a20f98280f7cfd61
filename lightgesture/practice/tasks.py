"""What is to be signed: sentences of the user's, sentences drawn from the grammar, or those of the paper's study."""

import random
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from lightgesture.errors import UsageError
from lightgesture.fsm import Grammar
from lightgesture.fsm.language.forms import is_digit, spell
from lightgesture.signs.sentences import SignedSentence, read_sentence

STUDY: Final = (
    ("1", "STOP", ("STOP HOVER 50 GO",)),
    ("4", "STOP", ("STOP EXEC 1 GO",)),
    ("2", "CONTD", ("CONTD SNAP 20 GO",)),
    ("3", "CONTD", ("CONTD PARAM 3 DECREASE GO",)),
    ("a", "complex", ("STOP EXEC 2 GO", "CONTD SNAP GO")),
    ("b", "complex", ("CONTD SNAP 50 GO", "STOP FOLLOW GO")),
)
"""Instruction, kind and sentences of Islam, Ho and Sattar's study (ICRA 2018): 10, 10 and 16 gestures a kind."""

MOST_TRIES: Final = 400
"""Random ways through the table after which no further sentence is looked for."""

MOST_SIGNS: Final = 12
"""Signs of the longest sentence that is drawn."""

MORE_DIGITS: Final = 0.35
"""How likely a number goes on where it may also end."""


@dataclass(frozen=True, slots=True)
class Task:
    """A sentence to sign. instruction, kind: of the study, "" outside it."""

    sentence: SignedSentence
    instruction: str = ""
    kind: str = ""


def named_tasks(grammar: Grammar, sentences: Sequence[str]) -> list[Task]:
    """The user's sentences. UsageError: the grammar cannot say one."""
    return [Task(read_sentence(grammar, text)) for text in sentences]


def study_tasks(grammar: Grammar) -> list[Task]:
    """The paper's six instructions. UsageError: the grammar cannot say one of them."""
    try:
        return [
            Task(read_sentence(grammar, text), instruction, kind)
            for instruction, kind, texts in STUDY
            for text in texts
        ]
    except UsageError as error:
        raise UsageError(f"--study: this language does not have the study's sentences ({error})") from None


def drawn_tasks(grammar: Grammar, count: int, seed: int | None) -> list[Task]:
    """`count` different sentences, drawn at random by words, fewer where the language has no more short ones.

    seed: the same gives the same sentences; None: others each time. UsageError: not one was found.
    """
    rng = random.Random(seed)
    found: dict[str, Task] = {}
    for _ in range(MOST_TRIES):
        if len(found) == count:
            break
        words = _drawn_words(grammar, rng)
        if words is None:
            continue
        try:
            sentence = read_sentence(grammar, spell(words, grammar.vocabulary.join))
        except UsageError:  # a program that is not listed, a number out of limits
            continue
        if sentence.signs[0].word != grammar.control.kill:
            found.setdefault(sentence.text, Task(sentence))
    if not found:
        raise UsageError(f"{grammar.file}: no short sentence was found; name some with --sentence")
    return list(found.values())


def _drawn_words(grammar: Grammar, rng: random.Random) -> list[str] | None:
    """A way through the table to its end; None: it is too long."""
    words: list[str] = []
    state = 0
    while state not in grammar.table.accepting:
        row = grammar.table.transitions[state]
        other = [word for word in sorted(row) if not is_digit(word) and word != grammar.vocabulary.join]
        is_number = bool(words) and is_digit(words[-1])
        ends_number = bool(other) and is_number and rng.random() >= MORE_DIGITS
        word = rng.choice(other if ends_number else sorted(row))
        words.append(word)
        state = row[word]
        if len(words) > MOST_SIGNS:
            return None
    return words
