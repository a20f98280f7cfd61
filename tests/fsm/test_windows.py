"""Windows and the free loop of the rule "sentence" give what sums over all frames, and all cuts into signs, give."""

import math
import random

import numpy as np
import pytest

from lightgesture.fsm.rules.loop import COST, FreeLoop
from lightgesture.fsm.rules.scores import GAP_SCORE, RATE
from lightgesture.fsm.rules.windows import PASSAGE_S, RELEASE_SCORE, Windows

COLUMNS = 3
HOLD = 40
PASSAGE = 10
"""Both in hundredths of a second, so that what lies on a bound is exact here."""


class Frame:
    """A frame, and what it stands for."""

    def __init__(self, rng, number, now, steps):
        self.step = rng.choice(steps)
        self.now = now + self.step
        weight = self.step / 100 * RATE
        self.left = np.array([rng.uniform(-4, 0) for _ in range(COLUMNS)]) * weight
        self.add = self.left + np.array([rng.uniform(-4, 0) for _ in range(COLUMNS)]) * weight
        self.gap = GAP_SCORE * weight
        self.stamp = (number, 1000 + self.now / 100)


def stream(seed, count, steps):
    rng, frames, now = random.Random(seed), [], 0
    for number in range(count):
        frames.append(Frame(rng, number, now, steps))
        now = frames[-1].now
    return frames


def feed(windows, frame):
    windows.step(frame.add, frame.left, frame.gap, frame.step / 100, frame.stamp)


def last_until(frames, time):
    """The place of the last frame that was over at this time; None: there is none."""
    return max((place for place, frame in enumerate(frames) if frame.now <= time), default=None)


def check(windows, frames):
    """What a window says against what all frames since the last break say."""
    now = frames[-1].now
    base = last_until(frames, now - HOLD)
    earlier = last_until(frames, now - HOLD - PASSAGE)
    assert (windows.window is None) == (base is None)
    assert windows.has_passage == (earlier is not None)
    if base is None:
        return
    inside = frames[base + 1 :]
    total, left = sum(frame.add for frame in inside), sum(frame.left for frame in inside)
    assert windows.window == pytest.approx(total)
    assert windows.weaker == pytest.approx(np.minimum(left, total - left))
    assert windows.start_s == pytest.approx(frames[base].now / 100)
    assert windows.start_stamp == inside[0].stamp
    assert windows.likelihood(1) == pytest.approx(
        math.exp(min(left[1], total[1] - left[1]) / (HOLD / 100 * RATE))
    )
    if earlier is None:
        return
    passage = frames[earlier + 1 : base + 1]
    assert windows.passed([7.0] * 160) == pytest.approx(7.0 + sum(frame.gap for frame in passage))
    for column in range(COLUMNS):
        behind = sum(max(*frame.add, frame.gap) - frame.add[column] for frame in passage)
        assert windows.is_released(column) == (behind >= RELEASE_SCORE * RATE * PASSAGE_S)


@pytest.mark.parametrize("steps", [[10], [5], [1], [2, 3, 4], [1, 7, 24], [10, 20, 25]])
def test_a_window_is_the_sum_over_the_least_length_and_the_passage_lies_before_it(steps):
    windows, frames = Windows(COLUMNS, HOLD / 100), stream(3, 260, steps)
    for number, frame in enumerate(frames):
        feed(windows, frame)
        check(windows, frames[: number + 1])


def test_no_window_goes_across_a_break():
    windows, frames, since = Windows(COLUMNS, HOLD / 100), stream(4, 300, [3, 5, 10]), 0
    for number, frame in enumerate(frames):
        if number in (3, 60, 61, 250):
            windows.break_off()
            since = number
        feed(windows, frame)
        check(windows, frames[since : number + 1])


@pytest.mark.parametrize(("hold_s", "spacing_s"), [(0.4, 0.008), (2.0, 0.0197)])
@pytest.mark.parametrize("rate", [130, 500, 900])
def test_frames_that_come_too_fast_share_a_row_and_the_window_is_hardly_longer(hold_s, spacing_s, rate):
    windows = Windows(1, hold_s)
    score = np.array([-1.0 / rate])
    for number in range(6 * rate):
        windows.step(score, score / 2, -2.0 / rate, 1 / rate, (number, number / rate))
        if number / rate > 2 * hold_s + 0.5:
            assert -(hold_s + spacing_s + 2 / rate) <= windows.window[0] <= -hold_s + 0.002
            passage = windows.passed([0.0] * 160) / -2.0
            assert PASSAGE_S - spacing_s - 2 / rate <= passage <= PASSAGE_S + spacing_s + 2 / rate


def best_cut(frames):
    """The best score of all ways to cut the frames up to each into gaps and signs, each with a passage before it, or
    all since the first frame where there is less."""
    best = [0.0]
    for end in range(1, len(frames) + 1):
        found = best[-1] + frames[end - 1].gap
        now = frames[end - 1].now
        for start in range(1, end):
            if now - frames[start - 1].now < HOLD:
                continue
            earlier = last_until(frames, frames[start - 1].now - PASSAGE) or 0
            signs = sum(frame.add for frame in frames[start:end])
            gaps = sum(frame.gap for frame in frames[earlier + 1 : start])
            found = max(found, best[earlier + 1] + gaps + float(signs.max()) - COST)
        best.append(found)
    return best[1:]


@pytest.mark.parametrize(("seed", "step"), [(5, 10), (6, 10), (7, 20), (8, 5), (9, 40)])
def test_the_free_loop_is_the_best_cut_into_signs_and_gaps(seed, step):
    frames = stream(seed, 30, [step])
    for frame in frames[PASSAGE // step + 1 :]:
        frame.add = frame.add * random.Random(frame.now // 60).choice([0.2, 0.5, 1.5])
    windows, loop = Windows(COLUMNS, HOLD / 100), FreeLoop(COLUMNS)
    expected = best_cut(frames)
    for number, frame in enumerate(frames):
        feed(windows, frame)
        loop.step(frame.add, frame.gap, windows)
        assert loop.score == pytest.approx(expected[number]), number
    assert expected[-1] > sum(frame.gap for frame in frames) + 5
