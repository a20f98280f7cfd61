"""What the diver signs and when: sentences -> words -> pairs -> a timeline of holds and passages, in frames.

Between sentences the hands rest or are busy: wave, point, swim, adjust the mask, hold on, fold the arms. Where they are
then is given for the left hand in the body frame, millimetres; the right one is mirrored. Turns are yaw, pitch and roll
in degrees, as in `diver.ArmState`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lightgesture.fsm import Grammar

Pair = tuple[str, str]
"""Tokens of the diver's left and right hand."""
NUMBERED_WORD = "PARAM"
BUSY = (45, 90)
"""Fewest and most frames of an activity."""
LEAD = 8
"""Frames with lowered hands before the first sign and after the last."""

Vector = tuple[float, float, float]
NO_SWAY: Vector = (0.0, 0.0, 0.0)
LOWERED_WRIST: Vector = (330.0, -400.0, 120.0)
LOWERED_TURN: Vector = (60.0, 15.0, 150.0)
"""Edge to the camera, fingers down."""


@dataclass(frozen=True, slots=True)
class HandActivity:
    """One hand: `shape` (a token or a name of poses.OTHER_SHAPES) held at `wrist` and `turn`, swaying by `sway` (mm,
    amplitude) at `hz`. token: what a reader of single hands would rightly call it, None for no token.
    """

    shape: str
    wrist: Vector
    turn: Vector
    sway: Vector = NO_SWAY
    hz: float = 1.0
    token: str | None = None


REST = HandActivity("relaxed", LOWERED_WRIST, LOWERED_TURN)
ACTIVITIES: dict[str, tuple[HandActivity, HandActivity]] = {
    "rest": (REST, REST),
    "wave": (REST, HandActivity("5", (330.0, 190.0, 180.0), (0.0, 0.0, 0.0), (90.0, 15.0, 0.0), 1.3, "5")),
    "point": (REST, HandActivity("1", (260.0, -20.0, 380.0), (75.0, 65.0, 20.0))),
    "mask": (
        HandActivity("pinch", (75.0, 150.0, 170.0), (60.0, 0.0, 35.0), (6.0, 8.0, 0.0), 0.8),
        HandActivity("pinch", (75.0, 150.0, 170.0), (60.0, 0.0, 35.0), (6.0, 8.0, 0.0), 0.8),
    ),
    "swim": (
        HandActivity("relaxed", (330.0, 0.0, 240.0), (85.0, 30.0, 60.0), (140.0, 40.0, 120.0), 0.5),
        HandActivity("relaxed", (330.0, 0.0, 240.0), (85.0, 30.0, 60.0), (140.0, 40.0, 120.0), 0.5),
    ),
    "grip": (REST, HandActivity("grip", (170.0, -150.0, 260.0), (70.0, 20.0, -60.0))),
    "fold": (
        HandActivity("relaxed", (-120.0, -170.0, 170.0), (120.0, 0.0, -70.0)),
        HandActivity("relaxed", (-120.0, -230.0, 150.0), (120.0, 0.0, -70.0)),
    ),
}
MARK = "~"
"""A script names an activity by this sign and its name, e.g. "~wave"."""


@dataclass(frozen=True, slots=True)
class Timing:
    """Frames of each phase; every hold and passage is drawn uniformly from its range (both ends included).

    hold: a sign. passage: from one sign to the next. pause: hands lowered.
    """

    hold: tuple[int, int] = (22, 34)
    passage: tuple[int, int] = (7, 12)
    pause: tuple[int, int] = (12, 24)


@dataclass(frozen=True, slots=True)
class Hold:
    """Frames `start` to `end` (exclusive) in which `pair` is shown, meaning `word`.

    Without a pair the hands are busy with `activity` (a key of ACTIVITIES).
    """

    start: int
    end: int
    pair: Pair | None
    word: str | None
    activity: str = "rest"

    def tokens(self) -> tuple[str | None, str | None]:
        """What each hand, left and right, shows."""
        if self.pair is not None:
            return self.pair
        left, right = ACTIVITIES[self.activity]
        return left.token, right.token


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

    A sentence that begins with ~ is an activity. The same pair twice in a row gets a pause between, because one held
    sign is one word. Raises ValueError for a word or activity that does not exist.
    """
    rest = Hold(0, 0, None, None)
    shown: list[Hold] = []
    for sentence in sentences:
        if sentence.startswith(MARK):
            shown.append(_activity(sentence))
            continue
        for pair, word in word_pairs(grammar, sentence_words(sentence)):
            if shown and shown[-1].pair == pair:
                shown.append(rest)
            shown.append(Hold(0, 0, pair, word))
        shown.append(rest)
    if not shown or shown[-1] != rest:
        shown.append(rest)
    holds, clock = [replace(rest, end=LEAD)], LEAD
    for order, hold in enumerate(shown):
        clock += int(rng.integers(timing.passage[0], timing.passage[1] + 1))
        length = LEAD if order == len(shown) - 1 else _length(hold, timing, rng)
        holds.append(replace(hold, start=clock, end=clock + length))
        clock += length
    return holds


def _activity(name: str) -> Hold:
    activity = name.removeprefix(MARK)
    if activity not in ACTIVITIES:
        raise ValueError(
            f"no activity {name!r}; choose one of {', '.join(MARK + known for known in ACTIVITIES)}"
        )
    return Hold(0, 0, None, None, activity)


def _length(hold: Hold, timing: Timing, rng: np.random.Generator) -> int:
    if hold.pair is not None:
        low, high = timing.hold
    else:
        low, high = timing.pause if hold.activity == "rest" else BUSY
    return int(rng.integers(low, high + 1))


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
    tokens: list[str | None] = []
    for old, new in zip(timeline[moment.before].tokens(), timeline[moment.after].tokens(), strict=True):
        if old == new or moment.part <= SHAPE_LEFT_PART:
            tokens.append(old)
        else:
            tokens.append(new if moment.part >= SHAPE_REACHED_PART else None)
    return tokens[0], tokens[1]
