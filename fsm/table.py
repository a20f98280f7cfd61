"""The deterministic transition table of all sentence forms, and what a complete sentence says."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from lightgesture.fsm.forms import Form, FormError, Vocabulary, split_carrier

MAX_TRANSITIONS = 65536
"""Most transitions of a table, so that a hostile file takes neither long nor much memory."""


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
