"""What a display shows while a sentence is signed by the rule "sentence", and which sign counts by itself."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from lightgesture.fsm.events import Certainty, Growth
from lightgesture.fsm.rules.display import CLEAR, Display
from lightgesture.fsm.rules.steady import KILL, SteadySign

PAIRS = (("5", "5"), ("ok", "0"), ("0", "0"))
WORDS = ("STOP", "HOVER")


class Shown:
    """A display of a search that says what a test says. records: (growth, certainty) of each state that is shown."""

    def __init__(self, *, is_growth_shown=False, has_lead=True):
        self.records = []
        self.reporter = SimpleNamespace(shown_s=0.0, is_growth_shown=is_growth_shown)
        reading = SimpleNamespace(words=WORDS)
        search = SimpleNamespace(
            hold_s=0.5,
            lead=1 if has_lead else None,
            scores=SimpleNamespace(shown=lambda column: PAIRS[column]),
            beam=SimpleNamespace(readings=[None, reading]),
            standing=SimpleNamespace(certainties=lambda slot: [0.987654, 0.5]),
        )
        reader = SimpleNamespace(
            word_of=lambda pair: {PAIRS[0]: "HOVER"}.get(pair),
            expected="GO or a digit",
            show=lambda growth, certainty: self.records.append((growth, certainty)),
        )
        self.display = Display(search, reader, self.reporter)

    def follow(self, column, seconds, score=-0.1):
        scores = np.full(len(PAIRS), -9.0)
        scores[column] = score
        self.display.follow(scores, seconds)
        return self

    def show(self, *told):
        self.display.show(told)
        return self.records[-1] if self.records else None


CERTAIN = Certainty(words=(("STOP", 0.9877), ("HOVER", 0.5)), expected="GO or a digit")


def test_a_sign_grows_from_its_second_frame_on_until_it_is_long_enough():
    shown, progress = Shown(is_growth_shown=True), []
    for _ in range(6):
        growth, _ = shown.follow(0, 0.125).show()
        progress.append(None if growth is None else growth.progress)
    assert progress == [None, 0.25, 0.5, 0.75, None, None]
    assert shown.follow(1, 0.125).follow(1, 0.0625).show()[0] == Growth(
        pair=PAIRS[1], word=None, progress=0.125
    )


@pytest.mark.parametrize(("score", "expected"), [(CLEAR + 0.001, 0.5), (CLEAR, None), (-5.0, None)])
def test_only_a_clear_sign_grows(score, expected):
    growth, _ = Shown(is_growth_shown=True).follow(0, 0.125).follow(0, 0.25, score).show()
    assert (None if growth is None else growth.progress) == expected


def test_another_sign_begins_anew_and_nothing_is_of_the_sign_before_a_reset():
    shown = Shown(is_growth_shown=True).follow(0, 0.125).follow(0, 0.25).follow(1, 0.25).follow(0, 0.25)
    assert shown.show()[0] is None
    shown.follow(0, 0.25)
    shown.display.reset()
    assert shown.display.top == -1
    assert shown.follow(0, 0.25).show()[0] is None
    assert shown.follow(0, 0.125).show()[0].progress == 0.25


def test_with_words_that_were_told_the_best_reading_is_shown():
    assert Shown().follow(0, 0.1).show("STOP") == (None, CERTAIN)
    growth, certainty = Shown().follow(0, 0.1).follow(0, 0.125).show("STOP")
    assert (growth.word, growth.progress, certainty) == ("HOVER", 0.25, CERTAIN)
    assert Shown(has_lead=False).follow(0, 0.1).show("STOP") == (None, None)
    assert Shown().follow(0, 0.1).follow(0, 0.125).show()[1] is None


def test_without_words_a_display_is_told_once_that_nothing_grows():
    assert Shown().follow(0, 0.1).show() is None
    assert Shown(is_growth_shown=True).follow(0, 0.1).show() == (None, None)


@pytest.mark.parametrize(
    ("seconds", "is_growth_shown", "now_s", "expected"),
    [
        (0.125, False, 0.25, 1),
        (0.125, False, 0.2, 1),
        (0.125, False, 0.19, 0),
        (0.0, False, 0.25, 0),
        (0.0, True, 0.25, 1),
        (0.0, True, 0.19, 0),
    ],
)
def test_growth_is_shown_a_few_times_a_second(seconds, is_growth_shown, now_s, expected):
    shown = Shown(is_growth_shown=is_growth_shown).follow(0, 0.1)
    if seconds:
        shown.follow(0, seconds)
    shown.display.show_growth((), now_s)
    assert len(shown.records) == expected


def test_before_any_frame_nothing_grows():
    shown = Shown()
    shown.display.show_growth(("STOP",), 9.0)
    assert shown.records == []


# Signs that count by themselves


class Held:
    """A search whose window and clock a test sets."""

    def __init__(self, *window, start_s=1.0, likelihood=0.9):
        self.windows = SimpleNamespace(
            window=np.array(window) if window else None,
            start_s=start_s,
            now=start_s + 0.5,
            likelihood=lambda column: likelihood,
        )
        self.spent = None
        self.steady = SteadySign(self)

    def look(self, *scores, seconds=0.0625):
        return self.steady.process(np.array(scores), seconds)


def test_the_likeliest_sign_of_a_whole_window_counts_once():
    held = Held(-3.0, -1.0, -2.0)
    assert held.look(-1.0, 0.0, -1.0) == 1
    held.steady.spend(1)
    held.windows.start_s = held.windows.now
    assert held.look(-1.0, 0.0, -1.0) is None
    assert Held().look(0.0) is None


@pytest.mark.parametrize(("likelihood", "expected"), [(KILL, 1), (KILL - 0.001, None)])
def test_a_sign_that_counts_by_itself_must_be_likely(likelihood, expected):
    assert Held(-3.0, -1.0, likelihood=likelihood).look(-9.0, 0.0) == expected


def test_what_was_shown_before_the_last_word_was_read_does_not_count():
    held = Held(-3.0, -1.0)
    held.steady.spend(0)  # at 1.5 s
    for start_s, expected in [(1.25, None), (1.5, 1), (1.75, 1)]:
        held.windows.start_s = start_s
        assert held.look(-9.0, 0.0) == expected
    held.steady.reset()
    held.windows.start_s = 0.0
    assert held.look(-9.0, 0.0) == 1


def test_a_sign_that_was_read_must_be_gone_for_a_passage():
    """0.1 s without a break; gone is a sign that is less likely by far than another one, or than a gap."""
    held = Held(-1.0, -3.0)
    held.steady.spend(0)
    gone, there = (-2.0, -0.5), (-0.5, -9.0)
    for scores, spent in [(gone, 0), (there, 0), (gone, 0), (gone, None)]:
        held.look(*scores)
        assert held.spent == spent


@pytest.mark.parametrize(
    ("scores", "is_there"),
    [
        ((-1.0, -0.1), True),
        ((-1.0, 0.0), False),
        ((2 * math.log(0.2) - 0.9, -9.0), True),
        ((2 * math.log(0.2) - 1.1, -9.0), False),
    ],
)
def test_when_a_sign_is_gone(scores, is_there):
    held = Held(-1.0, -3.0)
    held.steady.spend(0)
    held.look(*scores, seconds=0.25)
    assert (held.spent == 0) == is_there


def test_whatever_is_shown_may_be_spent():
    held = Held(-1.0, -3.0)
    held.steady.spend_shown()
    assert held.spent == 0
    nothing = Held()
    nothing.steady.spend_shown()
    assert nothing.spent is None
