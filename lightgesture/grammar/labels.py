"""What stands at the arrows of a state graph: words, and the signs that say them."""

from typing import Final, NamedTuple

from lightgesture.fsm import Grammar
from lightgesture.fsm.language.forms import is_digit, split_carrier
from lightgesture.fsm.signs import Pair
from lightgesture.grammar.report import merge_words
from lightgesture.signs.sentences import pairs_by_word

ANY: Final = "n"
"""Stands for the number that a word carries, and for the hand that says it."""


class Row(NamedTuple):
    """A line of a label: a word, or several in short, with what says it.

    text: empty where the hands say it all. pair: tokens of the left and the right hand, or what stands for several;
    None: no pair says it.
    """

    text: str
    pair: Pair | None


Label = tuple[Row, ...]


def labels_of(grammar: Grammar) -> list[dict[int, Label]]:
    """For each state the states that follow, with what leads there."""
    pairs = {word: found[0] for word, found in pairs_by_word(grammar).items()}
    result: list[dict[int, Label]] = []
    for row in grammar.table.transitions:
        words: dict[int, list[str]] = {}
        for word, target in row.items():
            words.setdefault(target, []).append(word)
        result.append({target: _label(found, pairs) for target, found in sorted(words.items())})
    return result


def shapes_of(row: Row) -> tuple[tuple[str, str], ...]:
    """Token and side of the hands that a line shows, the left one first."""
    return () if row.pair is None else ((row.pair[0], "left"), (row.pair[1], "right"))


def _label(words: list[str], pairs: dict[str, Pair]) -> Label:
    return tuple(
        _row(text, [pairs[word] for word in words if word in pairs and _is_part(word, text)])
        for text in merge_words(words)
    )


def _row(text: str, pairs: list[Pair]) -> Row:
    """A line for a word, or for several in short whose pairs differ in one hand."""
    if not pairs:
        return Row(text, None)
    left, right = ({pair[place] for pair in pairs} for place in (0, 1))
    if len(left) == len(right) == 1:
        return Row(text, pairs[0])
    digits = _is_run(text)
    several = text if digits else ANY
    pair = (left.pop() if len(left) == 1 else several, right.pop() if len(right) == 1 else several)
    return Row("" if digits and len(pairs) > 1 else text, pair)


def _is_run(text: str) -> bool:
    return ".." in text


def _is_part(word: str, text: str) -> bool:
    """Whether a word is among those that a short text stands for."""
    if text.endswith(f" {ANY}"):
        name, number = split_carrier(word)
        return number is not None and name == text.removesuffix(f" {ANY}")
    if _is_run(text) and is_digit(word):
        low, _, high = text.partition("..")
        return int(low) <= int(word) <= int(high)
    return word == text
