"""One person says one task in one way until it is understood: every try is rendered and read by the real chain."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import cv2
import numpy as np

from lightgesture import Pipeline
from lightgesture.benchmarks.cards.scenes import distance_for_motions
from lightgesture.benchmarks.interaction.users import (
    PAPER_MISTAKES,
    TASKS,
    USERS,
    WAYS,
    Kind,
    Skill,
    Way,
    slip_chance,
    word_seconds,
)
from lightgesture.fsm import Grammar, load_grammar
from lightgesture.synth.scene import Scene
from lightgesture.synth.script import sentence_words
from lightgesture.synth.spec import SceneSpec
from lightgesture.synth.variety import draw_spec

SIZE: Final = (400, 300)
DISTANCE_MM: Final = (1000.0, 1200.0)
ROOM_MM: Final = 100.0
"""From moved cards to the picture's edges: who moves cards stays so far away that they do not leave the picture."""

DIFFICULTY: Final = 0.15
"""Of a pool, as the study was in calm water."""

TIMING: Final[dict[Way, dict[str, Any]]] = {
    "hands": {"fps": 15.0, "hold": (11, 16), "passage": (4, 6), "pause": (4, 6)},
    "tags": {"fps": 10.0, "hold": (7, 9), "passage": (2, 3), "pause": (2, 3)},
    "tag-motion": {"fps": 12.0, "hold": (13, 19), "passage": (4, 5), "pause": (4, 5)},
}
"""Frames a second and of each phase. The search for a card is not rendered: nothing is in view then."""

HOLD_S: Final = 0.5
"""Seconds that a hand sign is held to count, as in `live`."""

MOST_TRIES: Final = 8
"""Tries of one sentence, after which the person gives up."""

SEED: Final = 77_000
"""Of the people; a person's dives follow."""


@dataclass(frozen=True, slots=True)
class TrialKey:
    """Who does what how."""

    skill: Skill
    person: int
    way: Way
    kind: Kind
    task: int


@dataclass(frozen=True, slots=True)
class Trial:
    """What one task cost. seconds: all tries, by the users' models. slips: tries with a wrong word; misread: tries
    whose words were all right and that did not become the instruction. wrong_slips, wrong_misread: instructions issued
    that were not meant, by a slip and by misreading. is_done: whether it was understood in the end."""

    skill: Skill
    person: int
    way: Way
    kind: Kind
    task: int
    tries: int
    seconds: float
    slips: int
    misread: int
    wrong_slips: int
    wrong_misread: int
    is_done: bool

    @property
    def key(self) -> TrialKey:
        """Whose trial it is."""
        return TrialKey(self.skill, self.person, self.way, self.kind, self.task)


def run_trial(key: TrialKey, is_rendered: bool = True) -> Trial:
    """Every sentence of the task until each was issued, or given up.

    is_rendered: else nothing is drawn and read, and a try is understood if it has no slip: the users' models alone.
    """
    cv2.setNumThreads(1)
    grammar, user = load_grammar(), USERS[key.skill]
    place = SEED + 1000 * key.person + 10 * [*TASKS].index(key.kind) + key.task
    rng = np.random.default_rng([place, WAYS.index(key.way), [*USERS].index(key.skill)])
    lengths = [len(sentence_words(one)) for task in TASKS[key.kind] for one in task]
    chance = slip_chance(PAPER_MISTAKES[key.skill][key.kind][WAYS.index(key.way)], lengths)
    counts = dict.fromkeys(("tries", "slips", "misread", "wrong_slips", "wrong_misread"), 0)
    seconds, is_done = 0.0, True
    for sentence in TASKS[key.kind][key.task]:
        for attempt in range(MOST_TRIES + 1):
            if attempt == MOST_TRIES:
                is_done = False
                break
            words = with_slips(sentence_words(sentence), chance, vocabulary_of(grammar), rng)
            is_slip = words != sentence_words(sentence)
            seconds += sum(
                word_seconds(user, key.way, len(vocabulary_of(grammar)), _motion(grammar, word))
                for word in words
            )
            seed = int(rng.integers(2**31))
            understood = [] if is_slip else [sentence]
            issued = read_words(words, key.way, seed, place) if is_rendered else understood
            counts["tries"] += 1
            counts["wrong_slips" if is_slip else "wrong_misread"] += sum(text != sentence for text in issued)
            if sentence in issued:
                break
            counts["slips" if is_slip else "misread"] += 1
    return Trial(
        key.skill, key.person, key.way, key.kind, key.task, seconds=seconds, is_done=is_done, **counts
    )


def with_slips(
    words: Sequence[str], chance: float, vocabulary: Sequence[str], rng: np.random.Generator
) -> list[str]:
    """The words, each with a chance of being another of the vocabulary."""
    shown = []
    for word in words:
        others = [other for other in vocabulary if other != word]
        shown.append(str(rng.choice(others)) if rng.uniform() < chance else word)
    return shown


def read_words(words: Sequence[str], way: Way, seed: int, person: int) -> list[str]:
    """Render a diver who says these words and read the pictures; the instructions that came of it."""
    scene = Scene(scene_of(words, way, seed, person))
    options: dict[str, Any] = {"hold_seconds": HOLD_S} if way == "hands" else {}
    with Pipeline(front_end=way, frames=False, **options) as pipeline:
        records = [
            record
            for frame in scene.frames()
            for record in pipeline.process(frame.image, float(frame.record.time_s or 0.0))
        ]
    return [record.text for record in records if record.type == "instruction"]


def scene_of(words: Sequence[str], way: Way, seed: int, person: int) -> SceneSpec:
    """A dive in a pool: the person's own looks, another moment."""
    spec = draw_spec(person, "suite", "water", (" ".join(words),), DIFFICULTY)
    parts = spec.model_dump() | {"size": SIZE, "signing": way, **TIMING[way]}
    low, high = DISTANCE_MM
    parts["diver"] |= {"glove": None, "distance_mm": float(np.clip(parts["diver"]["distance_mm"], low, high))}
    parts["water"] |= {"kind": "IB", "turbidity": 0.15}
    parts["backdrop"] |= {"surface_m": 0.0, "bubbles": 0.0}
    parts["motion"] |= {"approach_mm": 0.0}
    parts["camera"] |= {"focal": min(parts["camera"]["focal"], 0.9)}
    if way == "tag-motion":
        nearest = distance_for_motions(parts, ROOM_MM)
        parts["diver"]["distance_mm"] = max(parts["diver"]["distance_mm"], nearest)
    return SceneSpec.model_validate(parts | {"seed": seed})


@cache
def _vocabulary(file: str) -> tuple[str, ...]:
    grammar = load_grammar(file)
    return tuple(sorted({*grammar.sentence_words.values(), *grammar.idle_words.values()}))


def vocabulary_of(grammar: Grammar) -> tuple[str, ...]:
    """The words that can be said in every way."""
    return _vocabulary(grammar.file)


def _motion(grammar: Grammar, word: str) -> tuple[str, ...]:
    if grammar.motions is None:
        return ()
    return next((pair for pair, said in grammar.motions.words.items() if said == word), ())
