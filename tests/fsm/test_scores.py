"""What one frame says for every sign, by the published numbers; and what speaks against a complete sentence."""

import math
from types import SimpleNamespace

import pytest

from lightgesture.fsm import UNSEEN, Sign, Signs
from lightgesture.fsm.rules.doubts import find_doubt, find_weak, is_weak
from lightgesture.fsm.rules.readings import Reading, Spoken
from lightgesture.fsm.rules.scores import SignScores

HIDDEN, UNREAD, LEAST = math.log(0.05), math.log(0.1), math.log(0.01)


@pytest.fixture
def scores(grammar):
    return SignScores(grammar)


def of(scores, signs, pair):
    """The score of a pair, and the left hand's part of it."""
    both, left = scores.of(signs)
    column = scores.column(pair)
    return both[column], left[column]


def test_columns_are_the_pairs_and_then_the_words(scores, grammar):
    tokens = len(grammar.tokens)
    shown = [scores.shown(column) for column in range(scores.size)]
    assert len(set(shown)) == scores.size == tokens**2 + len(scores.words)
    assert [scores.column(what) for what in shown] == list(range(scores.size))
    assert {len(what) for what in shown[: tokens**2]} == {2}
    assert shown[tokens**2 :] == [(word,) for word in sorted(grammar.vocabulary.words)]


def hand(**chances):
    return Sign(None, 0.5, {name.strip("_"): chance for name, chance in chances.items()})


@pytest.mark.parametrize(
    ("left", "expected"),
    [
        (hand(ok=0.6, pic=0.3), math.log(0.6)),
        (hand(ok=1.0), 0.0),
        (hand(ok=0.01), LEAST),
        (hand(ok=0.0101), math.log(0.0101)),
        (hand(pic=0.9), LEAST),
        (hand(ok=math.nan, pic=0.2), LEAST),
        (hand(ok=0.8, pic=0.2), math.log(0.8)),
        (hand(ok=0.81, pic=0.2), math.log(0.81)),  # 1.01 in all is a matter of rounding
        (hand(ok=0.9, pic=0.9), math.log(0.5)),
        (hand(ok=0.9, pic=0.3), math.log(0.75)),
        (hand(ok=3.0, pic=-1.0), 0.0),
        (hand(ok=0.8, pic=math.inf), 0.0),
        (hand(ok=math.inf, pic=0.2), LEAST),
        (hand(ok=math.inf, pic=math.inf), LEAST),
        (Sign("ok", 0.9), math.log(0.9)),
        (Sign("ok", 1.5), 0.0),
        (Sign("ok", 0.0), LEAST),
        (Sign("ok", math.nan), LEAST),
        (Sign("pic", 0.1), math.log(0.9 / 9)),
        (Sign("pic", 0.95), LEAST),
        (Sign("pic", 0.0), math.log(0.99 / 9)),
        (Sign(None, 0.9), UNREAD),
        (UNSEEN, HIDDEN),
    ],
)
def test_what_a_hand_says_for_a_token(scores, grammar, left, expected):
    assert len(grammar.tokens) == 10
    right = Sign("2", 0.7)
    assert of(scores, Signs(left, right), ("ok", "2")) == pytest.approx((expected + math.log(0.7), expected))
    both, of_left = of(scores, Signs(right, left), ("2", "ok"))
    assert (both, both - of_left) == pytest.approx((expected + math.log(0.7), expected))


def test_hands_are_looked_at_anew_when_they_change(scores):
    for chance in (0.9, 0.4, 0.4, 0.7):
        sign = Sign("ok", chance)
        for _ in range(2):
            assert of(scores, Signs(sign, sign), ("ok", "ok"))[0] == pytest.approx(2 * math.log(chance))


def test_without_a_hand_in_view_all_signs_are_alike(scores):
    both, left = scores.of(Signs())
    assert both == pytest.approx(2 * HIDDEN)
    assert left == pytest.approx(HIDDEN)


def test_hands_say_nothing_for_a_word_that_a_card_says(scores):
    both, left = of(scores, Signs.of_tokens("0", "0"), ("STOP",))
    assert (both, left) == (pytest.approx(2 * LEAST), pytest.approx(LEAST))


@pytest.mark.parametrize("confidence", [0.9, 1.0])
def test_a_card_stands_for_two_hands_that_agree(scores, confidence):
    signs = Signs(Sign("GO", confidence, is_word=True))
    both, left = scores.of(signs)
    place = scores.column(("GO",))
    assert both[place] == pytest.approx(2 * math.log(confidence))
    assert left == pytest.approx(both / 2)
    assert sorted(both)[:-1] == pytest.approx([2 * LEAST] * (scores.size - 1))


def test_a_card_with_a_word_that_the_language_lacks_says_nothing(scores):
    both, left = scores.of(Signs(Sign("DANCE", 0.9, is_word=True)))
    assert both == pytest.approx(2 * LEAST)
    assert left == pytest.approx(LEAST)


# Doubts


@pytest.mark.parametrize(
    ("word", "opens", "caution", "least"),
    [
        ("STOP", True, 1.0, 0.6),
        ("STOP", True, 1.2, 0.72),
        ("STOP", True, 9.0, 0.9),
        ("HOVER", False, 1.0, 0.2),
        ("HOVER", False, 2.0, 0.4),
        ("5", False, 1.0, 0.7),
        ("5", False, 1.1, 0.77),
        ("PARAM 3", False, 1.0, 0.7),
        ("5", False, 2.0, 0.9),
        ("5", True, 1.0, 0.6),
    ],
)
def test_how_well_a_word_must_be_seen(word, opens, caution, least):
    assert not is_weak(word, least, caution, opens=opens)
    assert is_weak(word, least - 1e-9, caution, opens=opens)


@pytest.mark.parametrize(
    ("caution", "certainties", "weak"),
    [
        (1.0, (0.6, 0.2, 0.7, 0.6), None),
        (1.0, (0.59, 0.2, 0.7, 0.6), "STOP"),
        (1.0, (0.6, 0.19, 0.7, 0.6), "HOVER"),
        (1.0, (0.6, 0.2, 0.69, 0.6), "5"),
        (1.0, (0.59, 0.2, 0.7, 0.59), "GO"),
        (1.25, (0.75, 0.25, 0.88, 0.75), None),
        (1.25, (0.75, 0.25, 0.88, 0.749), "GO"),
        (2.0, (0.9, 0.4, 0.9, 0.75), None),
        (2.0, (0.9, 0.4, 0.9, 0.74), "GO"),
        (0.5, (0.3, 0.1, 0.35, 0.3), None),
        (0.5, (0.3, 0.1, 0.35, 0.29), "GO"),
    ],
)
def test_the_first_word_that_was_seen_too_badly_is_named_and_the_end_word_before_it(
    caution, certainties, weak
):
    assert find_weak(certainties, ("STOP", "HOVER", "5", "GO"), caution) == weak


@pytest.mark.parametrize(
    ("caution", "first", "second", "weak"),
    [
        (1.0, 0.875, 0.8, None),
        (1.0, 0.87, 0.8, "0"),
        (1.0, 0.8, 0.87, "5"),
        (2.0, 0.95, 0.95, None),
        (2.0, 0.95, 0.94, "0"),
        (0.5, 0.7, 0.5, None),
        (0.5, 0.69, 0.5, "0"),
    ],
)
def test_the_numbers_of_a_sentence_count_together_and_no_other_words(caution, first, second, weak):
    words = ("STOP", "HOVER", "5", "AND", "0", "GO")
    certainties = (0.95, 0.9, first, 0.7, second, 0.8)
    assert find_weak(certainties, words, caution) == weak


WORDS = ("STOP", "HOVER", "5", "GO")
READING = Reading(
    tuple(Spoken(word, 0, 0, 0.0, 0.0, 0.0, 0.0, 0.0) for word in WORDS), 0, 0, 0.0, 0.0, 0, WORDS, 0.0
)


def doubt(caution, margin=50.0, clear=(5.0, 1.0), contested=0.0, passed_s=0.0, misfit=0.0, sure=0.99):
    """Why a sentence with a number in its third place is in doubt, by what the search says of it."""
    standing = SimpleNamespace(
        margin=lambda slot: margin,
        rival=lambda slot: "STOP HOVER 2 GO",
        certainties=lambda slot: [sure] * len(WORDS),
        misfit=lambda slot: (misfit, 1),
    )
    clarity = SimpleNamespace(
        clear=lambda spoken: iter([(0.0, 0.0), clear]), contested=lambda word, after: contested
    )
    search = SimpleNamespace(standing=standing, clarity=clarity, beam=SimpleNamespace(longest=[passed_s]))
    found = find_doubt(search, 0, READING, caution)
    return None if found is None else (found.reason, found.detail.split(";")[0])


LESS = 1e-9
RIVAL = ("ambiguous", "it could as well be STOP HOVER 2 GO")
UNSTEADY = ("weak_sign", "5 was not seen steadily")
ANOTHER = ("ambiguous", "5 looked like another number at times")
MISFIT = ("does_not_fit", "HOVER is not what was shown")


@pytest.mark.parametrize(
    ("caution", "seen", "expected"),
    [
        (1.0, {"margin": 2.5}, None),
        (1.0, {"margin": 2.5 - LESS}, RIVAL),
        (2.0, {"margin": 5.0}, None),
        (2.0, {"margin": 5.0 - LESS}, RIVAL),
        (0.5, {"margin": 1.25}, None),
        (1.0, {"sure": 0.69}, ("weak_sign", "5 was not seen well")),
        # Clear for 0.6 s, or for half of the time.
        (1.0, {"clear": (0.6, 0.1)}, None),
        (1.0, {"clear": (0.6 - LESS, 0.5)}, None),
        (1.0, {"clear": (0.6 - LESS, 0.5 - LESS)}, UNSTEADY),
        (2.0, {"clear": (1.2, 0.1)}, None),
        (2.0, {"clear": (1.2 - LESS, 0.6)}, None),
        (2.0, {"clear": (1.2 - LESS, 0.6 - LESS)}, UNSTEADY),
        (0.5, {"clear": (0.3 - LESS, 0.25)}, None),
        (0.5, {"clear": (0.3 - LESS, 0.25 - LESS)}, UNSTEADY),
        (1.0, {"contested": 0.25}, None),
        (1.0, {"contested": 0.25 + LESS}, ANOTHER),
        (2.0, {"contested": 0.125}, None),
        (2.0, {"contested": 0.125 + LESS}, ANOTHER),
        (1.0, {"passed_s": 0.38}, None),
        (1.0, {"passed_s": 0.38 + LESS}, ("passed_over", "0.4 s between two signs were not read")),
        (2.0, {"passed_s": 0.19 + LESS}, ("passed_over", "0.2 s between two signs were not read")),
        (1.0, {"misfit": 5.0}, None),
        (1.0, {"misfit": 5.0 + LESS}, MISFIT),
        (2.0, {"misfit": 2.5 + LESS}, MISFIT),
        (0.5, {"misfit": 10.0}, None),
    ],
)
def test_each_bound_of_doubt_and_what_caution_makes_of_it(caution, seen, expected):
    assert doubt(caution, **{"clear": (5.0, 1.0), **seen}) == expected
