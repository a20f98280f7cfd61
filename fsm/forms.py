"""Sentence forms and their deterministic transition table."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

MAX_TRANSITIONS = 65536
"""Most transitions of a table, so that a hostile file takes neither long nor much memory."""

NUMBER_SLOTS = ("seconds", "program")
"""Arguments that are signed digit by digit."""

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
    """A sentence form: its kind, its text as written and its places in order."""

    kind: str
    sentence: str
    items: tuple[Item, ...]


class Place(NamedTuple):
    """Where a sentence stands in one form: before `item`, or inside its number."""

    item: int
    inside: str = "before"  # "before", "digit": after a digit, "join": after the joining word


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Deterministic transitions: state 0 is idle, `transitions[state][word]` the next state.

    accepting: state -> the form that a sentence ending there has.
    """

    transitions: tuple[Mapping[str, int], ...]
    accepting: Mapping[int, Form]


@dataclass(frozen=True, slots=True, kw_only=True)
class Arguments:
    """What a complete sentence says; None: the form has no such place or it was left out."""

    action: str
    change: str | None
    seconds: int | None
    program: int | None
    parameter: int | None


def is_digit(word: str) -> bool:
    """Whether the word is one of "0" to "9"."""
    return _DIGIT.fullmatch(word) is not None


def split_carrier(word: str) -> tuple[str, int | None]:
    """("PARAM", 3) for a word that carries a number, such as "PARAM 3"; (word, None) for any other."""
    match = _CARRIER.fullmatch(word)
    return (match[1], int(match[2])) if match else (word, None)


def parse_form(kind: str, sentence: str, vocabulary: Vocabulary) -> Form:
    """Read `A|B`, `[x]`, number slots and `NAME n`; FormError names the symbol that is wrong."""
    symbols = sentence.split()
    items: list[Item] = []
    for index, symbol in enumerate(symbols):
        if symbol == _CARRIED:
            if index == 0 or symbols[index - 1] not in vocabulary.carriers:
                raise FormError("'n' follows no word that carries a number", "write it after such a word")
            continue
        carried = index + 1 < len(symbols) and symbols[index + 1] == _CARRIED
        items.append(_parse_symbol(symbol, carried, vocabulary))
    slots = [item.slot for item in items if item.slot]
    for slot in slots:
        if slots.count(slot) > 1:
            raise FormError(f"'{slot}' stands twice", "keep one")
    return Form(kind=kind, sentence=sentence, items=tuple(items))


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


def next_places(form: Form, place: Place, vocabulary: Vocabulary) -> dict[str, Place]:
    """The words that may follow at this place and where each leads.

    FormError: a word could be read in two ways, such as a digit after two optional numbers.
    """
    found: dict[str, Place] = {}

    def add(words: Iterable[str], target: Place) -> None:
        for word in sorted(words):  # so that the same defect is named in every run
            if found.setdefault(word, target) != target:
                reason = f"'{word}' could be read in two ways in '{form.sentence}'"
                raise FormError(reason, "put a word that is not optional in between")

    index = place.item
    if place.inside != "before":
        add(vocabulary.digits, Place(index, "digit"))
        if place.inside == "join":
            return found
        if vocabulary.join is not None:
            add([vocabulary.join], Place(index, "join"))
        index += 1
    for number, item in enumerate(form.items[index:], start=index):
        if item.slot is not None:
            add(vocabulary.digits, Place(number, "digit"))
        else:
            add(item.words, Place(number + 1))
        if not item.optional:
            break
    return found


def compile_table(forms: Sequence[Form], vocabulary: Vocabulary) -> Table:
    """Merge all forms into one table; states are numbered in breadth-first order of sorted words.

    FormError: one form can be read in two ways, two forms read the same sentence, or the table grows
    beyond MAX_TRANSITIONS.
    """
    start = tuple((index, Place(0)) for index in range(len(forms)))
    numbers = {start: 0}
    queue = [start]
    transitions: list[dict[str, int]] = []
    accepting: dict[int, Form] = {}
    size = 0
    for places in queue:  # grows while it is walked
        complete = [forms[index] for index, place in places if place.item == len(forms[index].items)]
        if len(complete) > 1:
            both = f"'{complete[0].sentence}' and '{complete[1].sentence}'"
            raise FormError(f"{both} read the same sentence", "keep one of them")
        if complete:
            accepting[len(transitions)] = complete[0]
        row: dict[str, int] = {}
        for word, key in sorted(_following(forms, places, vocabulary).items()):
            if key not in numbers:
                numbers[key] = len(queue)
                queue.append(key)
            row[word] = numbers[key]
        size += len(row)
        if size > MAX_TRANSITIONS:
            raise FormError(
                f"the forms need over {MAX_TRANSITIONS} transitions", "use fewer or shorter forms"
            )
        transitions.append(row)
    return Table(transitions=tuple(transitions), accepting=accepting)


_Places = tuple[tuple[int, Place], ...]
"""A state: for every form that still fits, its index and the place in it."""


def _following(forms: Sequence[Form], places: _Places, vocabulary: Vocabulary) -> dict[str, _Places]:
    following: dict[str, list[tuple[int, Place]]] = {}
    for index, place in places:
        for word, target in next_places(forms[index], place, vocabulary).items():
            following.setdefault(word, []).append((index, target))
    return {word: tuple(targets) for word, targets in following.items()}


def bind(form: Form, words: Sequence[str], vocabulary: Vocabulary) -> Arguments:
    """What the complete sentence `words`, accepted with `form`, says."""
    digits: dict[str, str] = {}
    plain: list[str] = []
    place = Place(0)
    for word in words:
        place = next_places(form, place, vocabulary)[word]
        if place.inside == "before":
            plain.append(word)
        elif place.inside == "digit":
            slot = str(form.items[place.item].slot)
            digits[slot] = digits.get(slot, "") + word
    inner = plain[1:-1]  # without the sentinels
    numbers = {slot: int(text) for slot, text in digits.items()}
    carried = [number for _, number in map(split_carrier, inner) if number is not None]
    return Arguments(
        action=split_carrier(inner[0])[0],
        change=inner[1] if len(inner) > 1 else None,
        seconds=numbers.get("seconds"),
        program=numbers.get("program"),
        parameter=carried[0] if carried else None,
    )


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
