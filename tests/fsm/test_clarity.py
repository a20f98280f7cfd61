"""What counts as shown clearly, and that a number which was clear only for a moment is doubted."""

import numpy as np
import pytest

from lightgesture.fsm import Decoder, Sign, Signs
from lightgesture.fsm.rules.clarity import CLEAR, LIKELY, MOST_RUNS, NEARLY, Clarity
from lightgesture.fsm.rules.readings import Spoken
from lightgesture.fsm.rules.windows import PASSAGE_S

DOUBTED = Signs(Sign("ok", 0.97, {"ok": 0.97}), Sign(None, 0.6, {"none": 0.6, "1": 0.2}))
CONTESTED = Signs(Sign("ok", 0.97, {"ok": 0.97}), Sign(None, 0.5, {"1": 0.5, "0": 0.45}))


def of_pair(pair):
    return Signs(*(Sign(token, 0.97, {token: 0.97}) for token in pair.split(",")))


def outcome(grammar, shown, rate):
    """What is issued and why it is not, of (what is shown, seconds)."""
    decoder, frame, issued, reasons = Decoder(grammar, rule="sentence"), 0, [], []
    for signs, seconds in [*shown, (Signs(), 3.0)]:
        for _ in range(round(seconds * rate)):
            for event in decoder.step(signs, frame / rate, frame):
                issued += [event.text] if event.type == "instruction" else []
                reasons += [(event.reason, event.detail)] if event.type == "rejected" else []
            frame += 1
    return issued, reasons


def sentence(clear_s, doubted_s):
    """STOP HOVER with a digit that is clear for so long between so much doubt, then 3 GO."""
    passage = (Signs(), 0.2)
    return [
        (of_pair("0,0"), 0.8),
        passage,
        (of_pair("5,5"), 0.8),
        (DOUBTED, doubted_s),
        (of_pair("ok,0"), clear_s),
        (DOUBTED, doubted_s),
        (of_pair("pic,ok"), 0.8),
        passage,
        (of_pair("ok,3"), 0.8),
        passage,
        (of_pair("ok,ok"), 0.8),
    ]


@pytest.mark.parametrize("rate", [10, 30, 60])
def test_a_number_that_is_clear_for_a_moment_between_doubt_is_not_believed(grammar, rate):
    """A hand that held 1, seen badly, was read as 0 for 0.4 s: at caution 1 the instruction had another number."""
    issued, reasons = outcome(grammar, sentence(0.4, 0.3), rate)
    assert (issued, reasons) == ([], [("weak_sign", "0 was not seen steadily; sign it again")])


@pytest.mark.parametrize("rate", [10, 30, 60])
def test_the_same_number_without_doubt_around_it_is_issued(grammar, rate):
    assert outcome(grammar, sentence(0.5, 0.1), rate) == (["STOP HOVER 3 GO"], [])


def test_a_number_that_was_clear_for_long_may_have_been_doubted_before_and_after(grammar):
    assert outcome(grammar, sentence(0.8, 0.3), 30) == (["STOP HOVER 3 GO"], [])


@pytest.mark.parametrize("rate", [10, 30, 60])
def test_a_number_that_looked_like_another_one_at_times_is_not_believed(grammar, rate):
    """A hand that held 1 was read as 2 for most of the time and as 1 in between: the instruction had another number."""
    shown = sentence(0.5, 0.1)
    contested = [*shown[:5], (CONTESTED, 0.4), (of_pair("ok,0"), 0.3), *shown[5:]]
    told = [("ambiguous", "0 looked like another number at times; sign it again")]
    assert outcome(grammar, contested, rate) == ([], told)


def spoken(column, began, *, is_again=False):
    return Spoken("A", column, 0, began, 0.0, 0.0, began, began, is_again)


def clear(scores_of, column, seconds, in_view=True):
    """Show a sign, or None, for so long, at ten frames a second."""
    scores = [-9.0] * 4
    if column is not None:
        scores[column] = -0.1
    for _ in range(round(seconds * 10)):
        scores_of(np.array(scores), 0.1, 0.1 if in_view else 0.0)


def test_the_share_is_of_the_time_from_sign_to_sign_with_both_hands_in_view():
    clarity = Clarity()
    for column, seconds, in_view in [
        (0, 1.0, True),
        (None, 0.3, True),
        (None, 5.0, False),
        (1, 0.4, True),
        (None, 0.1, True),
        (2, 1.0, True),
    ]:
        clear(clarity.step, column, seconds, in_view)
    words = (spoken(0, 0.0), spoken(1, 6.3), spoken(2, 6.8))
    assert list(clarity.clear(words)) == [pytest.approx((0.4, 0.5))]


def test_a_repeated_sign_counts_from_its_repetition():
    clarity = Clarity()
    for column, seconds in [(0, 1.0), (None, 2.0), (1, 0.5), (2, 1.0)]:
        clear(clarity.step, column, seconds)
    again = (spoken(0, 0.0), spoken(1, 3.0, is_again=True), spoken(2, 3.5))
    assert list(clarity.clear(again)) == [pytest.approx((0.5, 1.0))]


def test_what_other_numbers_led_counts_against_a_number():
    clarity = Clarity([1, 2, 3])
    for column, seconds in [(0, 1.0), (1, 0.6), (2, 0.2), (1, 0.2), (0, 1.0)]:
        clear(clarity.step, column, seconds)
    assert clarity.contested(spoken(1, 1.0), spoken(0, 2.1)) == pytest.approx(0.2)
    assert clarity.contested(spoken(3, 1.0), spoken(0, 2.0)) == pytest.approx(1.0)
    assert clarity.contested(spoken(1, 5.0), spoken(0, 6.0)) == 0.0


def test_a_sign_that_was_never_clear_has_no_share():
    clarity = Clarity()
    for column, seconds in [(0, 1.0), (None, 1.0), (2, 1.0)]:
        clear(clarity.step, column, seconds)
    assert list(clarity.clear((spoken(0, 0.0), spoken(1, 1.2), spoken(2, 2.0)))) == [(0.0, 0.0)]


def test_a_flicker_does_not_fill_the_memory():
    clarity = Clarity()
    for _ in range(MOST_RUNS):
        clear(clarity.step, 1, 0.1)
        clear(clarity.step, None, 0.3)
    clear(clarity.step, 0, 1.0)
    clear(clarity.step, 1, 1.0)
    clear(clarity.step, 2, 1.0)
    start = MOST_RUNS * 0.4
    words = (spoken(0, start), spoken(1, start + 1), spoken(2, start + 2))
    assert list(clarity.clear(words)) == [pytest.approx((1.0, 1.0))]


# Bounds, each by itself


def seen(clarity, score, seconds, column=1, others=-9.0):
    """Show one sign with a score for so long, in one frame."""
    scores = np.full(8, others)
    scores[column] = score
    clarity.step(scores, seconds, seconds)


def clear_seconds(clarity, began, until):
    """Of the sign 1 between signs that were not shown."""
    words = (spoken(6, 0.0), spoken(1, began), spoken(7, until))
    return next(iter(clarity.clear(words)))[0]


@pytest.mark.parametrize(("score", "expected"), [(CLEAR, 0.5), (CLEAR - 1e-9, 0.0)])
def test_a_sign_is_clear_from_a_score_on(score, expected):
    clarity = Clarity()
    seen(clarity, score, 0.5)
    assert clear_seconds(clarity, 0.0, 9.0) == expected


@pytest.mark.parametrize(("passage_s", "expected"), [(0.1, 1.0), (0.1005, 1.0), (0.102, 0.5), (0.5, 0.5)])
def test_a_sign_that_changes_its_mind_for_a_passage_is_one(passage_s, expected):
    """Counted from the end of the first half on, that half counts where both are one."""
    clarity = Clarity()
    for score, seconds in [(-0.1, 0.5), (-9.0, passage_s), (-0.1, 0.5)]:
        seen(clarity, score, seconds)
    assert clear_seconds(clarity, 0.5, 9.0) == pytest.approx(expected)


@pytest.mark.parametrize(("others", "expected"), [(2, 1.0), (3, 1.0), (4, 0.5)])
def test_a_sign_goes_on_past_a_few_others(others, expected):
    clarity = Clarity()
    seen(clarity, -0.1, 0.5)
    for column in range(2, 2 + others):
        seen(clarity, -0.1, 0.02, column)
    seen(clarity, -0.1, 0.5)
    assert clear_seconds(clarity, 0.5, 9.0) == pytest.approx(expected)


def test_only_what_touches_the_time_of_a_word_counts_for_it():
    clarity = Clarity()
    for score in (-9.0, -0.1, -9.0):
        seen(clarity, score, 0.5)
    assert clear_seconds(clarity, 0.99, 9.0) == 0.5
    assert clear_seconds(clarity, 1.0, 9.0) == 0.0
    assert clear_seconds(clarity, 0.0, 0.51) == 0.5
    assert clear_seconds(clarity, 0.0, 0.5) == 0.0


def contested(clarity, began=0.0, until=9.0):
    return clarity.contested(spoken(1, began), spoken(7, until))


@pytest.mark.parametrize(
    ("first", "second", "is_contested"),
    [
        (-0.5, -0.5 + NEARLY, False),
        (-0.5, -0.5 + NEARLY + 1e-9, True),
        (LIKELY + 0.1, LIKELY, False),
        (LIKELY + 0.1, LIKELY + 1e-9, True),
        (LIKELY, LIKELY - 0.1, False),
        (-0.1, -9.0, False),
    ],
)
def test_another_number_contests_one_that_it_is_half_as_likely_as(first, second, is_contested):
    clarity = Clarity([1, 2])
    scores = np.full(8, -9.0)
    scores[1], scores[2], scores[3] = first, second, 0.0  # what is no number contests none
    clarity.step(scores, 0.25, 0.25)
    share = contested(clarity)
    assert (share > 0) == is_contested
    scores[2] = -9.0
    clarity.step(scores, 0.75, 0.75)
    assert 0 < contested(clarity) < share or not is_contested


def test_the_share_is_of_the_time_that_numbers_were_likely():
    """Contested for half of its time, then for all of it, with another number for a third of the time besides."""
    clarity = Clarity([1, 2])
    scores = np.full(8, -9.0)
    for rival, expected in ((-9.0, 0.0), (-0.2, 0.5)):
        scores[1], scores[2] = -0.1, rival
        clarity.step(scores, 0.5, 0.5)
        assert contested(clarity) == pytest.approx(expected)
    scores[1] = -9.0
    clarity.step(scores, 0.5, 0.5)
    assert contested(clarity) == pytest.approx(2 / 3)


@pytest.mark.parametrize(("score", "expected"), [(LIKELY, 1.0), (LIKELY - 1e-9, 0.0)])
def test_a_number_leads_only_where_it_is_likely(score, expected):
    clarity = Clarity([1, 2])
    seen(clarity, score, 0.5, column=2)
    assert contested(clarity) == expected


def test_with_a_single_number_none_is_contested():
    clarity = Clarity([2])
    seen(clarity, -0.1, 0.5, column=2)
    assert contested(clarity) == 0.0


def test_a_number_leads_without_a_break():
    """Two leads of another number: only the second lies in the time of the word."""
    clarity = Clarity([1, 2])
    for score, column in [(-0.1, 2), (-9.0, 2), (-0.1, 2), (-0.1, 1)]:
        seen(clarity, score, 0.5, column)
    assert contested(clarity, began=1.0) == pytest.approx(0.5)
    assert contested(clarity, began=0.0) == pytest.approx(2 / 3)


def test_a_lead_counts_for_the_word_in_whose_time_its_middle_lies():
    clarity = Clarity([1, 2])
    seen(clarity, -0.1, 0.5, column=2)
    seen(clarity, -0.1, 0.5, column=1)
    middle = 0.25 + PASSAGE_S
    assert contested(clarity, began=middle) == pytest.approx(0.5)
    assert contested(clarity, began=middle + 1e-9) == 0.0
    assert contested(clarity, until=middle + 1e-9) == 1.0
    assert contested(clarity, until=middle) == 0.0
