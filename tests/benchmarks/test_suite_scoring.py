"""Arithmetic of the suite: words in their places, instructions, delays, identities."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lightgesture.benchmarks.scorer import Reading, Score
from lightgesture.benchmarks.suite.scoring import (
    SuiteScore,
    TimedWord,
    accept_delays,
    align,
    count_switches,
    score_hands,
    score_instructions,
)
from lightgesture.training.datasets import Label

LEFT, RIGHT = (100, 20, 20, 20), (10, 20, 20, 20)
WORDS = st.lists(st.sampled_from(["STOP", "5", "AND", "GO"]), max_size=8)


def test_words_are_matched_in_their_order():
    signed = ["STOP", "HOVER", "5", "AND", "0", "GO"]
    assert align(signed, ["STOP", "5", "0", "GO"]) == [(0, 0), (2, 1), (4, 2), (5, 3)]
    assert align(signed, ["GO", "STOP"]) in ([(0, 1)], [(5, 0)])
    assert align(signed, []) == []
    assert align(["5", "5"], ["5"]) == [(0, 0)]


@given(WORDS, WORDS)
def test_alignment_is_a_longest_common_subsequence(signed, accepted):
    pairs = align(signed, accepted)
    assert all(signed[row] == accepted[column] for row, column in pairs)
    assert pairs == sorted(pairs)
    assert len({row for row, _ in pairs}) == len({column for _, column in pairs}) == len(pairs)
    assert len(pairs) == len(align(accepted, signed))
    assert len(align(signed, [*accepted, *signed])) == len(signed)


def test_instructions_are_right_wrong_or_missed():
    assert score_instructions(["STOP UP GO"], ["STOP UP GO"]) == (1, 0, 0)
    assert score_instructions(["STOP UP GO"], ["STOP DOWN GO"]) == (0, 1, 1)
    assert score_instructions(["STOP UP GO"], ["STOP UP GO", "STOP UP GO"]) == (1, 1, 0)
    assert score_instructions(["STOP UP GO"], []) == (0, 0, 1)
    assert score_instructions([], ["STOP UP GO"]) == (0, 1, 0)


def test_delay_counts_from_the_first_frame_of_the_sign():
    shown = [TimedWord("STOP", 1.5), TimedWord("UP", 3.0), TimedWord("GO", 4.0)]
    accepted = [TimedWord("STOP", 1.6), TimedWord("GO", 4.5)]
    assert accept_delays(shown, accepted, 0.5) == pytest.approx([0.6, 1.0])


def test_identity_switches_are_counted_per_hand():
    labels = [Label(LEFT, "left", "5"), Label(RIGHT, "right", "5")]

    def frame(left, right):
        numbers = ((LEFT, "left", left), (RIGHT, "right", right))
        return labels, [Reading(box, side, "5", number) for box, side, number in numbers if number]

    steady = [frame(1, 2), frame(1, 2)]
    assert count_switches(steady) == 0
    assert count_switches([*steady, frame(3, 2)]) == 1
    assert count_switches([*steady, frame(2, 1)]) == 2
    assert count_switches([frame(1, 2), frame(None, 2), frame(1, 2)]) == 0
    assert count_switches([frame(1, 2), frame(None, 2), frame(4, 2)]) == 1


def test_without_tracks_the_side_is_the_identity():
    labels = [Label(LEFT, "left", "5")]
    frames = [(labels, [Reading(LEFT, side, "5")]) for side in ("left", "right", "right", "left")]
    assert count_switches(frames) == 2


def test_boxes_beside_the_labels_do_not_count_against_a_method():
    score = score_hands(
        [([Label(LEFT, "left", "5")], [Reading(LEFT, "left", "5"), Reading(RIGHT, "right", "0")])]
    )
    assert (score.hands, score.found, score.read, score.extra) == (1, 1, 1, 0)


def test_scores_add_up():
    first = SuiteScore(clips=1, right=1, hands=Score(hands=4, found=3), delays=(0.5, 0.7))
    second = SuiteScore(clips=1, missed=1, hands=Score(hands=2, found=1), delays=(0.9,))
    both = first + second
    assert (both.clips, both.right, both.missed, both.hands.hands, both.hands.found) == (2, 1, 1, 6, 4)
    assert both.median_delay == pytest.approx(0.7)
    assert SuiteScore().median_delay is None
