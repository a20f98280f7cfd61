"""Words and sentence forms as a grammar file writes them."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

NUMBER_SLOTS = ("seconds", "program", "times")
"""Arguments that are signed digit by digit."""

MENU, SELECT = "MENU", "SELECT"
"""The words of the menu: MENU, then SELECT and the number of the entry."""

MAX_ITEMS = 64
"""Most places of a form, so that a hostile file takes neither long nor much memory."""

CACHED_WORDS = 1024
"""Words of which it is kept what they are: a few grammars' worth."""

_CARRIED = "n"
_DIGIT = re.compile(r"[0-9]")
_CARRIER = re.compile(r"([A-Z][A-Z0-9_]*) ([0-9]+)")


class FormError(ValueError):
    """A form that cannot be read or compiled; `remedy` says what to do."""

    def __init__(self, reason: str, remedy: str) -> None:
        super().__init__(f"{reason}; {remedy}")
        self.reason = reason
        self.remedy = remedy


class Item(NamedTuple):
    """One place of a form: one of `words`, or the number `slot` of one or more digits."""

    words: frozenset[str]
    slot: str | None
    optional: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Vocabulary:
    """All words that signs can say.

    digits: those that are 0 to 9. carriers: "PARAM" -> {"PARAM 0", "PARAM 1"}, for words that carry a
    number. join: the word between digits, or None.
    """

    words: frozenset[str]
    digits: frozenset[str]
    carriers: Mapping[str, frozenset[str]]
    join: str | None

    @classmethod
    def of(cls, words: Iterable[str], join: str | None) -> "Vocabulary":
        """Sort the words into digits and carriers."""
        every = frozenset(words)
        carriers: dict[str, set[str]] = {}
        for word in every:
            name, number = split_carrier(word)
            if number is not None:
                carriers.setdefault(name, set()).add(word)
        return cls(
            words=every,
            digits=frozenset(filter(is_digit, every)),
            carriers={name: frozenset(family) for name, family in carriers.items()},
            join=join,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Form:
    """A sentence form: its kind, its text as written and its places in order.

    repeated: the places that may come again, from the first up to but not including the second number, or None.
    confirm: whether its sentences need the end word a second time.
    """

    kind: str
    sentence: str
    items: tuple[Item, ...]
    repeated: tuple[int, int] | None = None
    confirm: bool = False

    def is_repeated(self, item: int) -> bool:
        """Whether the place with this number may come again."""
        return self.repeated is not None and self.repeated[0] <= item < self.repeated[1]


@lru_cache(maxsize=CACHED_WORDS)
def is_digit(word: str) -> bool:
    """Whether the word is one of "0" to "9"."""
    return _DIGIT.fullmatch(word) is not None


@lru_cache(maxsize=CACHED_WORDS)
def split_carrier(word: str) -> tuple[str, int | None]:
    """("PARAM", 3) for a word that carries a number, such as "PARAM 3"; (word, None) for any other."""
    match = _CARRIER.fullmatch(word)
    return (match[1], int(match[2])) if match else (word, None)


def is_number(word: str) -> bool:
    """Whether the word is a digit or carries a number."""
    return is_digit(word) or split_carrier(word)[1] is not None


def parse_form(kind: str, sentence: str, vocabulary: Vocabulary, confirm: bool = False) -> Form:
    """Read `A|B`, `[x]`, `{...}`, number slots and `NAME n`; FormError names the symbol that is wrong."""
    symbols = sentence.replace("{", " { ").replace("}", " } ").split()
    items: list[Item] = []
    braces: list[int] = []
    for index, symbol in enumerate(symbols):
        if symbol in ("{", "}"):
            if symbol != "{}"[len(braces) % 2] or len(braces) == 2:
                raise FormError(f"'{symbol}' is odd or nested", "write {...} once for what may come again")
            braces.append(len(items))
            continue
        if symbol == _CARRIED:
            if index == 0 or symbols[index - 1] not in vocabulary.carriers:
                raise FormError("'n' follows no word that carries a number", "write it after such a word")
            continue
        carried = index + 1 < len(symbols) and symbols[index + 1] == _CARRIED
        items.append(_parse_symbol(symbol, carried, vocabulary))
    if len(items) > MAX_ITEMS:
        raise FormError(f"the form has over {MAX_ITEMS} places", "write several shorter forms")
    slots = [item.slot for item in items if item.slot]
    for slot in slots:
        if slots.count(slot) > 1:
            raise FormError(f"'{slot}' stands twice", "keep one")
    return Form(
        kind=kind, sentence=sentence, items=tuple(items), repeated=_repeated(braces, items), confirm=confirm
    )


def _repeated(braces: list[int], items: list[Item]) -> tuple[int, int] | None:
    if not braces:
        return None
    if len(braces) == 1:
        raise FormError("'{' has no '}'", "write {...} for what may come again")
    start, end = braces
    if all(item.optional for item in items[start:end]):
        raise FormError("'{...}' may be empty", "put a word into it that is not optional")
    return start, end


def _parse_symbol(symbol: str, carried: bool, vocabulary: Vocabulary) -> Item:
    optional = symbol.startswith("[") and symbol.endswith("]")
    body = symbol[1:-1] if optional else symbol
    if not body or "[" in body or "]" in body:
        raise FormError(f"'{symbol}' has an odd bracket", "write [x] for a part that may be left out")
    if body in NUMBER_SLOTS:
        if not vocabulary.digits:
            raise FormError(f"'{body}' needs digits", "give [pairs] the words 0 to 9 that may be signed")
        return Item(frozenset(), body, optional)
    if carried and body in vocabulary.carriers:
        return Item(vocabulary.carriers[body], None, optional)
    words = body.split("|")
    for word in words:
        if word not in vocabulary.words:
            raise FormError(f"unknown word '{word}'", _unknown_word_remedy(word, vocabulary))
    return Item(frozenset(words), None, optional)


def _unknown_word_remedy(word: str, vocabulary: Vocabulary) -> str:
    if word in vocabulary.carriers:
        return f"write '{word} n'"
    return "give it a sign in [pairs], or use a word that has one, or a slot: " + ", ".join(NUMBER_SLOTS)


def spell(words: Iterable[str], join: str | None) -> str:
    """The words as a text with digits joined: STOP HOVER 5 AND 0 GO is "STOP HOVER 50 GO"."""
    parts: list[str] = []
    for word in words:
        if not is_digit(word):
            parts.append(word)
            continue
        if parts and parts[-1] == join:  # the table lets it stand between digits alone
            parts.pop()
        if parts and parts[-1].isdigit():
            word = parts.pop() + word
        parts.append(word.lstrip("0") or "0")
    return " ".join(parts)
