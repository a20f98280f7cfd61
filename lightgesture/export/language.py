"""The compiled grammar as one JSON file, and pair sequences with the events that the decoder makes of them."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import Any, Final

from lightgesture.export.files import FlatFiles
from lightgesture.fsm import Decoder, Grammar, Signs
from lightgesture.fsm.language.forms import MENU, Form
from lightgesture.fsm.language.settings import SENTENCE, Rule
from lightgesture.fsm.signs import Pair

FPS: Final = 30
"""Frames a second of the test sequences."""
MOST_SENTENCES: Final = 24
"""Of a grammar with very many."""
FRAMES: Final[Rule] = "frames"
"""The rule of the test sequences where the grammar's is "sentence"."""
SPARE: Final = 2
"""Frames by which a test sequence holds a pair longer than a word takes."""

Frames = list[tuple[str | None, str | None]]


def export_language(files: FlatFiles, grammar: Grammar) -> None:
    """Write grammar.json and decoder_vectors.json."""
    table = grammar.table
    forms = {form.sentence: form for form in table.accepting.values()}
    control = asdict(grammar.control)
    control["confirm"] = sorted(grammar.control.confirm)
    content = {
        "tokens": list(grammar.tokens),
        "pairs": {
            "idle": _pairs(grammar.idle_words),
            "sentence": _pairs(grammar.sentence_words),
            "menu": _pairs(grammar.menu_words),
        },
        "join": grammar.vocabulary.join,
        "end": grammar.end,
        "transitions": [
            [state, word, target]
            for state, row in enumerate(table.transitions)
            for word, target in row.items()
        ],
        "accepting": {str(state): form.sentence for state, form in table.accepting.items()},
        "forms": [_form(form) for form in forms.values()],
        "programs": {str(number): name for number, name in grammar.programs.items()},
        "parameters": {str(number): asdict(one) for number, one in grammar.parameters.items()},
        "limits": asdict(grammar.limits),
        "dwell": {**asdict(grammar.dwell), "rule": _rule(grammar)},
        "control": control,
    }
    files.add_json("grammar.json", content)
    sequences = [_sequence(grammar, *one) for one in _test_sequences(grammar)]
    files.add_json("decoder_vectors.json", {"frames_per_second": FPS, "sequences": sequences})


def decode(grammar: Grammar, frames: Frames) -> list[dict[str, Any]]:
    """Events, without those for displays alone, of pairs that come one a frame."""
    decoder = Decoder(grammar, rule=_rule(grammar))
    events = [
        event
        for frame, (left, right) in enumerate(frames)
        for event in decoder.step(Signs.of_tokens(left, right), frame / FPS, frame=frame)
    ]
    return [event.to_dict() for event in [*events, *decoder.finish()] if event.type != "state"]


def _rule(grammar: Grammar) -> Rule:
    """The grammar's rule, where it goes sign by sign: the search of "sentence" is code and no table."""
    return FRAMES if grammar.dwell.rule == SENTENCE else grammar.dwell.rule


def _pairs(words: Mapping[Pair, str]) -> list[list[str]]:
    return [[left, right, word] for (left, right), word in words.items()]


def _form(form: Form) -> dict[str, Any]:
    return {
        "kind": form.kind,
        "sentence": form.sentence,
        "items": [
            {"words": sorted(item.words), "slot": item.slot, "optional": item.optional} for item in form.items
        ],
        "repeated": form.repeated,
        "confirm": form.confirm,
    }


def _sequence(grammar: Grammar, name: str, frames: Frames) -> dict[str, Any]:
    return {"name": name, "frames": frames, "events": decode(grammar, frames)}


def _test_sequences(grammar: Grammar) -> Iterator[tuple[str, Frames]]:
    """The shortest sentence to each end of the table, and what goes wrong.

    A word out of order, a pair that is no word, a sign that was held too briefly, a sentence that breaks off.
    """
    sentences = _sentences(grammar)[:MOST_SENTENCES]
    for words in sentences:
        pairs = _signed(grammar, words)
        # A sentence that is to be confirmed wants its end word twice; to all others that is a word out of order.
        yield " ".join(words), _held(grammar, [*pairs, pairs[-1]])
    first = _signed(grammar, sentences[0])
    yield "start word twice", _held(grammar, [first[0], first[0], first[-1]])
    yield "broken off", _held(grammar, first[:-1])
    known = {*grammar.idle_words, *grammar.sentence_words, *grammar.menu_words}
    every = ((left, right) for left in grammar.tokens for right in grammar.tokens)
    if unknown := next((pair for pair in every if pair not in known), None):
        yield "a pair that is no word", _held(grammar, [first[0], unknown, *first[1:]])
    hold, release = _frames_of(grammar)
    yield "held too briefly", [*[first[0]] * (hold - SPARE - 1), *[(None, None)] * release]


def _sentences(grammar: Grammar) -> list[tuple[str, ...]]:
    """The shortest word sequence to each state in which a sentence is complete."""
    table = grammar.table
    paths: dict[int, tuple[str, ...]] = {0: ()}
    queue = [0]
    for state in queue:  # grows while it is walked
        for word, target in table.transitions[state].items():
            if target not in paths:
                paths[target] = (*paths[state], word)
                queue.append(target)
    return [paths[state] for state in queue if state in table.accepting]


def _signed(grammar: Grammar, words: tuple[str, ...]) -> list[Pair]:
    """A pair for each word, as it is signed in its place."""
    pairs = []
    for number, word in enumerate(words):
        if number == 0:
            tables = [grammar.idle_words, grammar.sentence_words]
        else:
            tables = [grammar.menu_words] * (words[0] == MENU) + [grammar.sentence_words]
        pairs.append(next(pair for table in tables for pair, known in table.items() if known == word))
    return pairs


def _held(grammar: Grammar, pairs: list[Pair]) -> Frames:
    """Each pair for as long as a word takes, and the hands away for as long as a release takes."""
    hold, release = _frames_of(grammar)
    return [frame for pair in pairs for frame in [*[pair] * hold, *[(None, None)] * release]]


def _frames_of(grammar: Grammar) -> tuple[int, int]:
    """Frames of a hold and of a release, with some to spare."""
    dwell = grammar.dwell
    need = dwell.hold if _rule(grammar) == FRAMES else math.ceil(dwell.hold_seconds * FPS)
    return need + SPARE, math.ceil(need * dwell.release) + 1
