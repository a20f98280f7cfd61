"""What is written to be quick does the same as the plain way that stands here beside it."""

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from lightgesture.fsm.dwell import Dwell, Hold
from lightgesture.fsm.forms import spell
from lightgesture.fsm.reporter import shorten
from lightgesture.fsm.sentence import Sentence


class PlainDwell(Dwell):
    """The rules of dwell as they are told, without a look at what may be left out where nothing changes."""

    def process(self, pair, confidence, frame, time_s, now_s):
        if self.timed:
            self._keep_time(now_s)
        if self.spent is not None and self.is_unreleased(pair, confidence):
            return None
        if pair is None:
            self._weaken(1.0)
            return None
        if pair == self.pair:
            self._extent += self.step * confidence if self._weighed else self.step
            self._frames += 1
            self._confidence_sum += confidence
        else:
            self._weaken(confidence)
            if self.pair is not None:
                return None
            self._begin(pair, confidence, frame, time_s)
        if self._extent < self._need:
            return None
        self._spend(pair)
        mean = self._confidence_sum / self._frames
        return Hold(
            pair=pair,
            frames=self._frames,
            confidence=mean,
            first_frame=self._first_frame,
            first_time_s=self._first_time_s,
        )

    def is_unreleased(self, pair, confidence):
        if pair == self.spent:
            self._absent = max(0.0, self._absent - self.step * confidence) if self._weighed else 0.0
            self._is_absent = self._absent > 0.0
            self._weaken(confidence)
            return True
        self._absent += self.step if self._is_absent or self._weighed else self._start
        self._is_absent = True
        if self._absent >= self.release:
            self.spent = None
        return False


DWELLS = {
    "frames": (5, 2, {}),
    "seconds": (0.16, 0.06, {"timed": True}),
    "evidence": (0.13, 0.06, {"timed": True, "weighed": True}),
}
SHOWN = st.lists(
    st.tuples(
        st.sampled_from([None, ("a", "a"), ("b", "b"), ("a", "b")]),
        st.integers(1, 9),
        st.floats(0.3, 1.0),
        st.sampled_from([0.0, 1 / 30, 0.1]),
    ),
    max_size=30,
)


@pytest.mark.parametrize("rule", sorted(DWELLS))
@given(SHOWN)
@settings(max_examples=80, deadline=None)
def test_dwell_holds_what_the_plain_rules_hold(rule, shown):
    need, release, options = DWELLS[rule]
    dwell, plain = Dwell(need, release, **options), PlainDwell(need, release, **options)
    frame, now_s = 0, 0.0
    for pair, count, confidence, pause_s in shown:
        for _ in range(count):
            given_frame = (pair, confidence, frame, now_s, now_s)
            assert dwell.process(*given_frame) == plain.process(*given_frame)
            seen = [(one.pair, one.spent, one.step, one.progress * bool(one.pair)) for one in (dwell, plain)]
            assert seen[0] == seen[1]
            frame, now_s = frame + 1, now_s + 1 / 30
        now_s += pause_s


HOLD = Hold(pair=("a", "a"), frames=3, confidence=0.9, first_frame=4, first_time_s=0.1)
SIGNED = st.lists(st.sampled_from(["0", "1", "5", "AND", "STOP", "PARAM 3", "SNAP"]), max_size=12)


@given(SIGNED, st.sampled_from(["AND", None]))
@example(["5", "AND", "0", "0"], "AND")
@example(["0", "AND", "5"], "AND")
@example(["0", "0", "SNAP", "0", "1"], "AND")
@example(["PARAM 3", "5"], "AND")
@settings(max_examples=200, deadline=None)
def test_a_sentence_grows_to_what_its_words_spell(signed, join):
    sentence = Sentence(start_frame=0, start_time_s=0.0, touched_s=0.0)
    words = ["STOP", "HOVER"]
    # The table lets the joining word stand between digits alone.
    for word, after in zip(signed, [*signed, ""][1:], strict=True):
        is_between = words[-1].isdigit() and after.isdigit()
        if word != "AND" or (join and is_between):
            words.append(word)
    for count, word in enumerate(words, 1):
        sentence.add(word, HOLD, 0, 0.0, join)
        assert sentence.text == spell(words[:count], join)


@given(st.floats(0.0, 1.0))
@settings(max_examples=100, deadline=None)
def test_shares_are_shortened_to_four_decimals(share):
    short = shorten(share)
    assert short == round(short, 4)
    assert abs(short - share) <= 0.00005 + 1e-12


@pytest.mark.parametrize(
    ("share", "short"),
    [(0.0, 0.0), (1.0, 1.0), (2 / 3, 0.6667), (0.03125, 0.0313), (-0.123449, -0.1234), (1.23456, 1.2346)],
)
def test_short_shares(share, short):
    assert shorten(share) == short


def test_what_is_no_number_is_endured():
    assert str(shorten(float("nan"))) == "nan"
