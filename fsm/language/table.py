"""The deterministic transition table of all sentence forms, and what a complete sentence says."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from lightgesture.fsm.language.forms import MENU, Form, FormError, Vocabulary, split_carrier

MAX_TRANSITIONS = 65536
"""Most transitions of a table, so that a hostile file takes neither long nor much memory."""


class Place(NamedTuple):
    """Where a sentence stands in one form: before `item`, or inside its number."""

    item: int
    inside: str = "before"  # "before", "digit": after a digit, "join": after the joining word


Walk = Mapping[Place, Mapping[str, Place]]
"""Of one form: place -> word -> the place that it leads to."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Deterministic transitions: state 0 is idle, `transitions[state][word]` the next state.

    accepting: state -> the form that a sentence ending there has. walks: by the sentence of a form, where each word
    leads from each of its places.
    """

    transitions: tuple[Mapping[str, int], ...]
    accepting: Mapping[int, Form]
    walks: Mapping[str, Walk]


@dataclass(frozen=True, slots=True, kw_only=True)
class Arguments:
    """What a complete sentence says; None: the form has no such place or it was left out.

    Of what may come again there can be several, so that it is only in `numbers`: every number that was signed, as
    (slot, value) in order.
    """

    action: str
    change: str | None = None
    seconds: int | None = None
    program: int | None = None
    parameter: int | None = None
    numbers: tuple[tuple[str, int], ...] = ()


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
    for number in _next_items(form, index):
        item = form.items[number]
        if item.slot is not None:
            add(vocabulary.digits, Place(number, "digit"))
        else:
            add(item.words, Place(number + 1))
    return found


def _next_items(form: Form, index: int) -> list[int]:
    """Numbers of the items that may come at place `index`: past optional ones, and back where a repetition begins."""
    found: list[int] = []
    waiting = [index]
    while waiting:
        number = waiting.pop()
        if number in found or number == len(form.items):
            continue
        found.append(number)
        if form.repeated is not None and number == form.repeated[1]:
            waiting.append(form.repeated[0])
        if form.items[number].optional:
            waiting.append(number + 1)
    return found


def walk(form: Form, vocabulary: Vocabulary) -> Walk:
    """All places of a form and where each word leads. FormError: somewhere a word could be read in two ways."""
    found: dict[Place, Mapping[str, Place]] = {}
    waiting = [Place(0)]
    while waiting:
        place = waiting.pop()
        if place not in found:
            found[place] = next_places(form, place, vocabulary)
            waiting += found[place].values()
    return found


def compile_table(
    forms: Sequence[Form], vocabulary: Vocabulary, ambiguous: list[tuple[Form, Form]] | None = None
) -> Table:
    """Merge all forms into one table; states are numbered in breadth-first order of sorted words.

    ambiguous: takes the pairs of forms that read the same sentence, of which the first one counts. FormError: one form
    can be read in two ways, two forms read the same sentence and nothing takes them, or the table grows beyond
    MAX_TRANSITIONS.
    """
    walks = [walk(form, vocabulary) for form in forms]
    start = tuple((index, Place(0)) for index in range(len(forms)))
    numbers = {start: 0}
    queue = [start]
    transitions: list[dict[str, int]] = []
    accepting: dict[int, Form] = {}
    size = 0
    for places in queue:  # grows while it is walked
        complete = [forms[index] for index, place in places if place.item == len(forms[index].items)]
        for other in complete[1:]:
            if ambiguous is None:
                both = f"'{complete[0].sentence}' and '{other.sentence}'"
                raise FormError(f"{both} read the same sentence", "keep one of them")
            if (complete[0], other) not in ambiguous:
                ambiguous.append((complete[0], other))
        if complete:
            accepting[len(transitions)] = complete[0]
        row: dict[str, int] = {}
        for word, key in sorted(_following(walks, places).items()):
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
    return Table(
        transitions=tuple(transitions),
        accepting=accepting,
        walks={form.sentence: steps for form, steps in zip(forms, walks, strict=True)},
    )


_Places = tuple[tuple[int, Place], ...]
"""A state: for every form that still fits, its index and the place in it."""


def _following(walks: Sequence[Walk], places: _Places) -> dict[str, _Places]:
    following: dict[str, list[tuple[int, Place]]] = {}
    for index, place in places:
        for word, target in walks[index][place].items():
            following.setdefault(word, []).append((index, target))
    return {word: tuple(targets) for word, targets in following.items()}


def bind(form: Form, words: Sequence[str], table: Table) -> Arguments:
    """What the complete sentence `words`, accepted with `form`, says."""
    steps = table.walks[form.sentence]
    numbers: list[tuple[int, str]] = []  # item and digits
    plain: list[tuple[int, str]] = []  # item and word
    place = Place(0)
    for word in words:
        before, place = place, steps[place][word]
        if place.inside == "before":
            plain.append((place.item - 1, word))
        elif place.inside == "digit":
            digits = numbers.pop()[1] if before.inside != "before" and before.item == place.item else ""
            numbers.append((place.item, digits + word))
    is_menu = plain[0][1] == MENU
    inner = plain if is_menu else plain[1:-1]  # without the sentinels
    single = [word for item, word in inner if not form.is_repeated(item)]
    carried = [number for _, number in map(split_carrier, single) if number is not None]
    slots = {str(form.items[item].slot): int(text) for item, text in numbers if not form.is_repeated(item)}
    return Arguments(
        action=split_carrier(single[0])[0],
        change=single[1] if len(single) > 1 and form.repeated is None and not is_menu else None,
        seconds=slots.get("seconds"),
        program=carried[0] if is_menu else slots.get("program"),
        parameter=carried[0] if carried and not is_menu else None,
        numbers=tuple((str(form.items[item].slot), int(text)) for item, text in numbers),
    )
