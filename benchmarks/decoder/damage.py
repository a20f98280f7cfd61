"""Sentences damaged on purpose: recorded signs cut apart and put together otherwise.

A diver forgets a sign, puts one in, shows another one, swaps the hands or takes a sign away too soon. What an
instruction may then say is what the grammar makes of the signs that are left; of a sign that was too short, what was
meant. Everything else that is issued is wrong, and so it is told how often a decoder corrects what it should reject.
"""

import random
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from lightgesture.fsm import Decoder, Grammar, Pair, Signs

DROP, ADD, EXCHANGE, SWAP, SHORT = KINDS = "drop", "add", "exchange", "swap", "short"
"""What is done: a sign left out, one of another sentence put in, one shown in place of another, one shown with the
hands swapped, one held for SHORT_FRAMES alone."""

SHORT_FRAMES = (3, 9)
"""Least and most frames of a sign that is too short, at 30 a second: 0.1 to 0.3 s."""

LEAD_FRAMES = 15
"""Frames before the first sign in which hands already form it."""

SIDE_FRAMES = 4
"""Frames around the first and the last sign that belong to them."""

FLICKER = 6
"""Frames for which something may hide a hand inside one sign."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """A clip as its reader saw it. times_s, signs: by frame. held: the pair that is shown in each frame, or None.
    sentences: those that are signed in it."""

    name: str
    suite: str
    sentences: tuple[str, ...]
    times_s: tuple[float, ...]
    signs: tuple[Signs, ...]
    held: tuple[Pair | None, ...]


@dataclass(frozen=True, slots=True)
class Piece:
    """One sign of a clip: the frames on the way to it, in which it is held, and on the way from it."""

    pair: Pair
    before: tuple[Signs, ...]
    held: tuple[Signs, ...]
    after: tuple[Signs, ...]

    @property
    def frames(self) -> tuple[Signs, ...]:
        return (*self.before, *self.held, *self.after)


@dataclass(frozen=True, slots=True)
class Damaged:
    """A damaged sentence. shown: the signs that are left. allowed: what may be issued. frames: what the reader saw."""

    name: str
    kind: str
    shown: tuple[Pair, ...]
    allowed: tuple[str, ...]
    frames: tuple[Signs, ...]


def pieces(clip: Recorded) -> list[Piece]:
    """The signs of a clip, cut in the middle of each passage."""
    runs: list[tuple[Pair, int, int]] = []
    for frame, pair in enumerate(clip.held):
        if pair is None:
            continue
        if runs and runs[-1][0] == pair and frame - runs[-1][2] < FLICKER:
            runs[-1] = pair, runs[-1][1], frame + 1
        else:
            runs.append((pair, frame, frame + 1))
    if not runs:
        return []
    middles = [(one[2] + other[1]) // 2 for one, other in pairwise(runs)]
    starts = [max(0, runs[0][1] - SIDE_FRAMES), *middles]
    ends = [*middles, min(len(clip.signs), runs[-1][2] + SIDE_FRAMES)]
    return [
        Piece(pair, clip.signs[start:first], clip.signs[first:last], clip.signs[last:end])
        for (pair, first, last), start, end in zip(runs, starts, ends, strict=True)
    ]


def damage(clips: Sequence[Recorded], count: int, grammar: Grammar, seed: int) -> list[Damaged]:
    """So many damaged sentences, each kind as often, with signs of the clip's own suite put in.

    What shows the same sign twice in a row is left out, for the cut shows no release between them.
    """
    rng = random.Random(seed)
    signed = [(clip, found) for clip in clips if (found := pieces(clip))]
    pool = {
        clip.suite: [piece for other, found in signed if other.suite == clip.suite for piece in found]
        for clip in clips
    }
    made: list[Damaged] = []
    while len(made) < count:
        clip, found = rng.choice(signed)
        kind = KINDS[len(made) % len(KINDS)]
        changed = _change(kind, found, pool[clip.suite], rng)
        pairs = tuple(piece.pair for piece in changed)
        if any(one == other for one, other in pairwise(pairs)) or not pairs:
            continue
        start = clip.held.index(found[0].pair)
        frames = [*clip.signs[: max(0, start - LEAD_FRAMES)]]
        for piece in changed:
            frames += piece.frames
        frames += clip.signs[len(clip.signs) - 20 :]
        allowed = read_ideally(pairs, grammar)
        made.append(Damaged(clip.name, kind, pairs, allowed, tuple(frames)))
    return made


def _change(kind: str, found: Sequence[Piece], pool: Sequence[Piece], rng: random.Random) -> list[Piece]:
    changed = list(found)
    place = rng.randrange(len(changed))
    piece = changed[place]
    if kind == DROP:
        del changed[place]
    elif kind == ADD:
        changed.insert(rng.randrange(len(changed) + 1), rng.choice(pool))
    elif kind == EXCHANGE:
        changed[place] = rng.choice([other for other in pool if other.pair != piece.pair])
    elif kind == SWAP:
        unlike = [index for index, item in enumerate(changed) if item.pair[0] != item.pair[1]]
        place = rng.choice(unlike)
        changed[place] = _swapped(changed[place])
    else:
        length = min(rng.randint(*SHORT_FRAMES), len(piece.held))
        start = rng.randrange(len(piece.held) - length + 1)
        changed[place] = Piece(piece.pair, piece.before, piece.held[start : start + length], piece.after)
    return changed


def _swapped(piece: Piece) -> Piece:
    before, held, after = (
        tuple(Signs(signs.right, signs.left) for signs in part)
        for part in (piece.before, piece.held, piece.after)
    )
    return Piece((piece.pair[1], piece.pair[0]), before, held, after)


def read_ideally(pairs: Sequence[Pair], grammar: Grammar) -> tuple[str, ...]:
    """The instructions that the grammar makes of signs that are read without doubt."""
    decoder = Decoder(grammar, hold=1)
    events = []
    for left, right in pairs:
        events += decoder.step(Signs.of_tokens(left, right), 0.0) + decoder.step(Signs(), 0.0)
    return tuple(event.text for event in events if event.type == "instruction")
