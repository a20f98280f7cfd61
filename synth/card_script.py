"""What a diver with cards does and when: a timeline of cards that are shown, or of motions of two cards.

The times of a word, of the way between words and of lowered hands are those of `script.Timing`, in frames.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from lightgesture.fsm import Grammar
from lightgesture.fsm.signs import Pair
from lightgesture.synth.script import LEAD, Timing, sentence_words

Kind = Literal["lowered", "card", "ready", "motion"]
"""Hands lowered; a card shown; two cards at rest; two cards in a motion."""

SETTLE: Final = 0.5
"""Seconds of rest before a motion and after it, at least."""


@dataclass(frozen=True, slots=True)
class Step:
    """Frames `start` to `end` (exclusive). id: of the card that is shown. motion: what each hand draws. word: what it
    says, for `ready` that of the motion before."""

    start: int
    end: int
    kind: Kind
    word: str | None = None
    id: int | None = None
    motion: Pair | None = None


def card_steps(
    grammar: Grammar, sentences: Sequence[str], timing: Timing, rng: np.random.Generator
) -> list[Step]:
    """Cards one after the other, each raised from lowered hands and put away again.

    ValueError: the grammar has no cards, or none for a word.
    """
    if grammar.tags is None:
        raise ValueError(f"{grammar.file}: has no [tags]")
    ids = {word: number for number, word in reversed(list(grammar.tags.words.items()))}
    clock = _Clock(timing, rng)
    steps = [clock.step("lowered", (LEAD, LEAD))]
    for word in _words(sentences, ids, "card"):
        steps.append(clock.step("card", timing.hold, timing.passage, word=word, id=ids[word]))
        steps.append(clock.step("lowered", timing.pause, timing.passage))
    return [*steps, clock.step("lowered", (LEAD, LEAD))]


def motion_steps(
    grammar: Grammar, sentences: Sequence[str], timing: Timing, fps: float, rng: np.random.Generator
) -> list[Step]:
    """Two cards are raised, moved once a word with rest in between, and lowered after each sentence.

    timing.hold is how long a motion takes. ValueError: the grammar has no motions, or none for a word.
    """
    if grammar.motions is None:
        raise ValueError(f"{grammar.file}: has no [motions]")
    motions = {word: pair for pair, word in reversed(list(grammar.motions.words.items()))}
    least = round((SETTLE + grammar.motions.hold_seconds) * fps)
    rest = (least, least + round(0.3 * fps))
    clock = _Clock(timing, rng)
    steps = [clock.step("lowered", (LEAD, LEAD))]
    for sentence in sentences:
        steps.append(clock.step("ready", rest, timing.passage))
        for word in _words([sentence], motions, "motion"):
            steps.append(clock.step("motion", timing.hold, word=word, motion=motions[word]))
            steps.append(clock.step("ready", rest, word=word))
        steps.append(clock.step("lowered", timing.pause, timing.passage))
    return [*steps, clock.step("lowered", (LEAD, LEAD))]


class _Clock:
    """Lays steps one after the other."""

    def __init__(self, timing: Timing, rng: np.random.Generator) -> None:
        self._timing, self._rng, self._frame = timing, rng, 0

    def step(
        self,
        kind: Kind,
        length: tuple[int, int],
        passage: tuple[int, int] | None = None,
        *,
        word: str | None = None,
        id: int | None = None,  # noqa: A002 - the step's own field
        motion: Pair | None = None,
    ) -> Step:
        """The next step, after a passage of so many frames, if there is one; lengths are drawn from their ranges."""
        if passage is not None:
            self._frame += int(self._rng.integers(passage[0], passage[1] + 1))
        start = self._frame
        self._frame += int(self._rng.integers(length[0], length[1] + 1))
        return Step(start, self._frame, kind, word, id, motion)


def _words(sentences: Sequence[str], known: dict[str, int] | dict[str, Pair], noun: str) -> Iterator[str]:
    for sentence in sentences:
        for word in sentence_words(sentence):
            if word not in known:
                raise ValueError(
                    f"no {noun} for the word {word!r}; the grammar has {', '.join(sorted(known))}"
                )
            yield word
