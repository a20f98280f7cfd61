"""What may become of frames and of their stamps on the way from a camera; each gives streams made of a good one."""

import random
from dataclasses import dataclass, replace

import numpy as np

from lightgesture.features.types import Image
from lightgesture.fsm import Signs

FPS = 30
FIRST, LAST = 60, 250
"""Frames of the clip between which a sentence is open."""

LENGTHS = (15, 29, 45, 60, 88, 115, 132)
"""Frames for which something lasts: up to all three signs of the number."""


@dataclass(frozen=True)
class Shown:
    """A frame: its stamp, its picture, and the signs that are read in it."""

    time_s: float
    image: Image
    signs: Signs


def windows(step, lengths=LENGTHS):
    """First and last frame of what lasts for a while, all over the sentence."""
    places = [(first, first + length) for length in lengths for first in range(FIRST, LAST - 10)]
    return places[::step]


def dropped(frames, step):
    """Frames that never come: some here and there, or all for a while."""
    for share in (0.1, 0.3, 0.5, 0.7):
        rng = random.Random(f"{share}")
        yield [frame for frame in frames if rng.random() > share]
    for first, last in windows(step):
        yield frames[:first] + frames[last:]


def doubled(frames, step):
    """Each frame twice, with the same stamp or with one of its own, and some three times."""
    yield [frame for frame in frames for _ in range(2)]
    yield [replace(frame, time_s=frame.time_s + half / (2 * FPS)) for frame in frames for half in range(2)]
    rng = random.Random(1)
    yield [frame for frame in frames for _ in range(rng.choice((1, 1, 2, 3)))]


def reordered(frames, step):
    """Frames that overtake each other, with their stamps or with those of their places."""
    for most in (2, 4, 6):
        rng = random.Random(most)
        mixed = sorted(range(len(frames)), key=lambda place: place + rng.uniform(0, most))
        yield [frames[place] for place in mixed]
        yield [
            replace(frames[place], time_s=frame.time_s) for place, frame in zip(mixed, frames, strict=True)
        ]


def black(frames, step):
    """Frames of nothing for a while."""
    nothing = np.zeros_like(frames[0].image)
    for first, last in windows(step):
        yield [
            replace(frame, image=nothing, signs=Signs()) if first <= place < last else frame
            for place, frame in enumerate(frames)
        ]


def frozen(frames, step):
    """One frame again and again for a while, with stamps that go on."""
    for first, last in windows(step):
        yield [
            replace(frames[first], time_s=frame.time_s, image=frames[first].image.copy())
            if first <= place < last
            else frame
            for place, frame in enumerate(frames)
        ]


def jumping(frames, step):
    """A clock that is set forward or back in the middle."""
    for jump_s in (-1000.0, -2.0, -0.5, 0.5, 1.2, 10.0, 1e9):
        for first in range(FIRST, LAST)[:: 4 * step]:
            yield [
                replace(frame, time_s=frame.time_s + (jump_s if place >= first else 0))
                for place, frame in enumerate(frames)
            ]


def standing(frames, step):
    """A clock that stands still for a while and then goes on: from where it stood, or with what was missed."""
    for first, last in windows(step):
        stood_s = frames[min(last, len(frames) - 1)].time_s - frames[first].time_s
        for is_lost in (True, False):
            yield [
                replace(frame, time_s=frames[first].time_s)
                if first <= place < last
                else replace(frame, time_s=frame.time_s - (stood_s if is_lost and place >= last else 0))
                for place, frame in enumerate(frames)
            ]


def slowed(frames, step):
    """From 30 to 7 frames a second in the middle."""
    for first in range(LAST)[:: 2 * step]:
        yield [
            frame
            for place, frame in enumerate(frames)
            if place < first or (place * 7) // FPS != ((place - 1) * 7) // FPS
        ]


def gone(frames, step):
    """No frame for ten seconds: the diver waits meanwhile, or signs on and again."""
    long = [replace(frame, time_s=frame.time_s + 9.5 * turn) for turn in range(3) for frame in frames]
    for first in range(3, len(frames))[:: 2 * step]:
        yield frames[:first] + [replace(frame, time_s=frame.time_s + 10) for frame in frames[first:]]
        yield long[:first] + long[first + 10 * FPS :]


FAULTS = {
    make.__name__: make
    for make in (dropped, doubled, reordered, black, frozen, jumping, standing, slowed, gone)
}
"""Name to what makes the streams, of frames and a step: every so many places are tried."""


def half_decoded(image, rng):
    """A picture whose lower part did not come: grey, as decoders of JPEG fill it, or the first rows again."""
    broken, row = image.copy(), rng.randrange(image.shape[0] // 4, image.shape[0])
    broken[row:] = 128 if rng.random() < 0.5 else image[row - 1]
    return broken
