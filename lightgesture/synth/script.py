"""What the diver signs and when: sentences -> words -> pairs -> a timeline of holds and passages, in frames."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lightgesture.fsm import Grammar

Pair = tuple[str, str]
"""Tokens of the diver's left and right hand."""
NUMBERED_WORD = "PARAM"
PAUSE = "/"
"""In a script: both hands lowered between sentences."""


@dataclass(frozen=True, slots=True)
class Timing:
    """Frames of each phase; every hold and passage is drawn uniformly from its range (both ends included).

    hold: a sign. passage: from one sign to the next. pause: hands lowered. lead: lowered before the first sign and
    after the last.
    """

    hold: tuple[int, int] = (22, 34)
    passage: tuple[int, int] = (7, 12)
    pause: tuple[int, int] = (12, 24)
    lead: int = 8


@dataclass(frozen=True, slots=True)
class Hold:
    """Frames `start` to `end` (exclusive) in which `pair` is shown (None: hands lowered), meaning `word`."""

    start: int
    end: int
    pair: Pair | None
    word: str | None


def sentence_words(text: str) -> list[str]:
    """Words of a sentence such as "STOP HOVER 50 GO", digits joined by AND, "PARAM n" kept as one word."""
    words: list[str] = []
    parts = text.split()
    while parts:
        part = parts.pop(0)
        if part == NUMBERED_WORD and parts:
            words.append(f"{part} {parts.pop(0)}")
        elif part.isdigit():
            words += " AND ".join(part).split()
        else:
            words.append(part)
    return words


def word_pairs(grammar: Grammar, words: Sequence[str]) -> list[tuple[Pair, str]]:
    """The pair that signs each word. Raises ValueError for a word that the grammar does not have."""
    inside = {word: pair for pair, word in reversed(list(grammar.sentence_words.items()))}
    idle = {word: pair for pair, word in reversed(list(grammar.idle_words.items()))}
    pairs = []
    for order, word in enumerate(words):
        table = {**inside, **idle} if order == 0 else {**idle, **inside}
        if word not in table:
            known = ", ".join(sorted({*inside, *idle}))
            raise ValueError(f"no sign for the word {word!r}; the grammar has {known}")
        pairs.append((table[word], word))
    return pairs


def make_timeline(
    grammar: Grammar, sentences: Sequence[str], timing: Timing, rng: np.random.Generator
) -> list[Hold]:
    """Holds in order, with gaps between them for the passages; hands are lowered at both ends and between sentences.

    The same pair twice in a row gets a pause between, because one held sign is one word.
    """
    shown: list[tuple[Pair | None, str | None]] = []
    for sentence in sentences:
        for pair, word in word_pairs(grammar, sentence_words(sentence)):
            if shown and shown[-1][0] == pair:
                shown.append((None, None))
            shown.append((pair, word))
        shown.append((None, None))
    if not shown:
        shown = [(None, None)]
    holds, clock = [Hold(0, timing.lead, None, None)], timing.lead
    for order, (signed, meaning) in enumerate(shown):
        clock += int(rng.integers(timing.passage[0], timing.passage[1] + 1))
        low, high = timing.hold if signed is not None else timing.pause
        length = timing.lead if order == len(shown) - 1 else int(rng.integers(low, high + 1))
        holds.append(Hold(clock, clock + length, signed, meaning))
        clock += length
    return holds


@dataclass(frozen=True, slots=True)
class Moment:
    """Where a frame lies: between holds number `before` and `after`, `part` 0..1 of the way (equal: inside)."""

    before: int
    after: int
    part: float


def moment_at(timeline: Sequence[Hold], frame: int) -> Moment:
    """The moment of a frame; frames beyond the end stay in the last hold."""
    for index, hold in enumerate(timeline):
        if frame < hold.start:
            before = timeline[index - 1]
            return Moment(index - 1, index, (frame - before.end + 1) / (hold.start - before.end + 1))
        if frame < hold.end:
            return Moment(index, index, 0.0)
    return Moment(len(timeline) - 1, len(timeline) - 1, 0.0)


SHAPE_LEFT_PART, SHAPE_REACHED_PART = 0.12, 0.9
"""A passage's share before which the old shape, and from which the new shape, is still what a person would call it."""


def tokens_at(timeline: Sequence[Hold], moment: Moment) -> tuple[str | None, str | None]:
    """What each hand shows (left, right); None while it is on its way or lowered."""
    before, after = timeline[moment.before].pair, timeline[moment.after].pair
    tokens: list[str | None] = []
    for hand in range(2):
        old = before[hand] if before is not None else None
        new = after[hand] if after is not None else None
        if old == new or moment.part <= SHAPE_LEFT_PART:
            tokens.append(old)
        else:
            tokens.append(new if moment.part >= SHAPE_REACHED_PART else None)
    return tokens[0], tokens[1]
