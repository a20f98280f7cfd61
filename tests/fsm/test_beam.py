"""The readings that the rule "sentence" keeps: how their scores go on, which are given up, and how they stand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from lightgesture.fsm.rules.beam import BEAM, MOST, MOST_TEXTS, SHORT_COST, SHORT_S, Beam
from lightgesture.fsm.rules.readings import Reading, Spoken
from lightgesture.fsm.rules.standing import Standing
from lightgesture.fsm.rules.windows import NEVER, ROWS

TIMEOUT_S = 10.0


class Trial:
    """A beam over windows and a free loop that say what a test says."""

    def __init__(self):
        self.windows = SimpleNamespace(
            row=0, now=100.0, window=np.zeros(9), weaker=np.full(9, -1.0), span=2.0
        )
        self.loop = SimpleNamespace(score=0.0)
        self.beam = Beam("AND", self.windows, self.loop)
        self.standing = Standing("AND", self.beam, self.windows, self.loop)

    def enter(self, words, score, column=0, touched=100.0, behind=0.0, longest=0.0, fine=(), sure=()):
        """Keep a reading of these words; its slot, or None."""
        words = tuple(words.split())
        text = self.beam.text_number(words)
        marks = range(len(words))
        spoken = tuple(
            Spoken(
                word=word,
                column=column,
                frame=0,
                time_s=0.0,
                behind=behind * place,
                fine=dict(enumerate(fine)).get(place, 0.0),
                began=0.0,
                seen=0.0,
                sure=dict(enumerate(sure)).get(place, 0.0),
            )
            for place, word in zip(marks, words, strict=True)
        )
        self.beam.enter(Reading(spoken, 0, 0, 0.0, touched, text, words, longest), score)
        return self.beam.slots.get((words, column))

    def step(self, add, gap_add=-1.0, passed_s=0.1, in_view_s=0.1):
        self.windows.row = (self.windows.row + 1) % ROWS
        scores = np.full(9, -9.0)
        for column, score in add.items():
            scores[column] = score
        self.beam.step(scores, gap_add, passed_s, in_view_s)

    def of(self, slot):
        """Score in the sign, in the gap after it, and the better of the two."""
        beam = self.beam
        return beam.held[slot], beam.gap[slot], beam.best[slot]


@pytest.fixture
def trial():
    return Trial()


def test_a_reading_goes_on_in_its_sign_or_in_the_gap_whichever_is_better(trial):
    slot = trial.enter("STOP", -2.0, column=3)
    assert trial.of(slot) == (-2.0, NEVER, -2.0)
    trial.step({3: -4.0}, passed_s=0.0)
    assert trial.of(slot) == (-6.0, -3.0, -3.0)
    assert trial.beam.best_row[trial.windows.row, slot] == -3.0
    trial.step({3: -0.5}, passed_s=0.0)
    assert trial.of(slot) == (-6.5, -4.0, -4.0)
    assert trial.standing.is_over(slot)


def test_the_cost_of_a_short_sign_is_given_back_while_it_lasts(trial):
    slot = trial.enter("STOP", -SHORT_COST)
    given = []
    for _ in range(7):
        trial.step({0: 0.0}, gap_add=-5.0, passed_s=SHORT_S / 5)
        given.append(trial.beam.held[slot])
    assert given == pytest.approx([-1.2, -0.9, -0.6, -0.3, 0.0, 0.0, 0.0])
    assert trial.beam.credit[slot] == pytest.approx(0.0)


def test_what_a_short_sign_is_still_owed_is_not_behind(trial):
    trial.loop.score = 1.0
    slot = trial.enter("STOP", 1.0 - SHORT_COST)
    assert trial.standing.behind(slot) == pytest.approx(0.0)
    trial.step({0: 0.0}, gap_add=-5.0, passed_s=SHORT_S / 3)
    assert trial.standing.behind(slot) == pytest.approx(0.0)


def test_how_sure_a_sign_was_is_of_its_best_window_and_not_of_the_gap_after_it(trial):
    slot = trial.enter("STOP", 0.0, column=2)
    assert trial.standing.certainty(slot) == pytest.approx(math.exp(-1.0 / 2.0))
    for weaker, add, expected in [(-0.6, 0.0, -0.6), (-0.8, 0.0, -0.6), (-0.1, -9.0, -0.6)]:
        trial.windows.weaker[2] = weaker
        trial.step({2: add})
        assert trial.standing.certainty(slot) == pytest.approx(math.exp(expected / 2.0))
    trial.windows.window = None
    held = trial.enter("CONTD", 0.0, column=4)
    trial.windows.weaker[4] = -0.2
    trial.step({4: 0.0})
    assert trial.standing.certainty(held) == pytest.approx(math.exp(-1.0 / 2.0))


def test_time_in_view_without_a_sign_is_counted_from_the_sign_on_and_the_longest_is_kept(trial):
    slot = trial.enter("STOP", 0.0, longest=0.25)
    for add, expected in [(0.0, 0.0), (-9.0, 0.1), (-9.0, 0.2), (-9.0, 0.3), (90.0, 0.0), (-99.0, 0.1)]:
        trial.step({0: add})
        assert trial.beam.bridged[slot] == pytest.approx(expected)
    assert trial.beam.longest[slot] == pytest.approx(0.3)
    assert trial.beam.longest_row[trial.windows.row, slot] == pytest.approx(0.3)
    assert trial.enter("STOP", 5.0, longest=0.25) == slot
    assert (trial.beam.bridged[slot], trial.beam.longest[slot]) == (0.0, 0.25)


def test_what_is_far_behind_or_old_is_given_up_and_the_best_leads(trial):
    slots = {
        "STOP": trial.enter("STOP", -BEAM),
        "CONTD": trial.enter("CONTD", -BEAM - 0.001),
        "STOP HOVER": trial.enter("STOP HOVER", -3.0, touched=100.0 - TIMEOUT_S),
        "STOP UP": trial.enter("STOP UP", -1.0, touched=99.9 - TIMEOUT_S),
        "STOP DOWN": trial.enter("STOP DOWN", -2.0),
    }
    trial.beam.prune(TIMEOUT_S)
    kept = {" ".join(words) for words, _ in trial.beam.slots}
    assert kept == {"STOP", "STOP HOVER", "STOP DOWN"}
    assert trial.beam.lead == slots["STOP DOWN"]
    for words, slot in slots.items():
        assert (trial.beam.readings[slot] is not None) == (words in kept)
        assert (trial.beam.text[slot] >= 0) == (words in kept)
        assert trial.beam.best[slot] > NEVER / 2 or words not in kept
    trial.loop.score = 100.0
    trial.beam.prune(TIMEOUT_S)
    assert (trial.beam.slots, trial.beam.lead) == ({}, None)


def test_a_reading_is_worth_keeping_within_the_beam_and_above_itself(trial):
    trial.enter("STOP", -4.0)
    assert not trial.beam.is_better(("CONTD",), 0, -BEAM)
    assert trial.beam.is_better(("CONTD",), 0, -BEAM + 0.001)
    assert not trial.beam.is_better(("STOP",), 0, -4.0)
    assert trial.beam.is_better(("STOP",), 0, -3.999)
    assert trial.beam.is_better(("STOP",), 1, -5.0)


def test_a_better_way_to_the_same_words_takes_the_place_and_keeps_the_gap(trial):
    slot = trial.enter("STOP", -4.0)
    trial.step({0: -9.0}, passed_s=0.0)
    assert trial.enter("STOP", -1.0) == slot
    assert trial.of(slot) == (-1.0, -5.0, -1.0)


def test_where_all_slots_are_taken_the_worst_one_gives_way_to_a_better_one(trial):
    for number in range(MOST):
        trial.enter(f"W{number}", -1.0 - number / 100)
    worst = trial.beam.slots[(f"W{MOST - 1}",), 0]
    assert trial.enter("LATER", float(trial.beam.best[worst])) is None
    assert trial.enter("WORSE", -9.0) is None
    assert len(trial.beam.slots) == MOST
    assert trial.enter("BETTER", -0.5) == worst
    assert len(trial.beam.slots) == MOST
    assert ((f"W{MOST - 1}",), 0) not in trial.beam.slots


def test_a_slot_that_was_given_up_keeps_nothing_for_the_next_reading(trial):
    slot = trial.enter("STOP", -4.0)
    for _ in range(3):
        trial.step({0: -1.0})
    trial.beam.drop(slot)
    trial.beam.drop(slot)
    assert trial.beam.slots == {}
    assert trial.enter("CONTD", -2.0, column=5) == slot
    assert set(trial.beam.best_row[:, slot]) == {NEVER}
    assert trial.of(slot) == (-2.0, NEVER, -2.0)
    trial.step({5: -1.0}, passed_s=0.0)
    assert trial.of(slot)[0] == -3.0
    trial.beam.clear()
    assert set(trial.beam.best_row[:, slot]) == {NEVER}
    assert trial.beam.lead is None


def test_texts_are_told_apart_by_a_number_and_their_count_is_bounded(trial):
    joined = trial.enter("STOP HOVER 5 AND 0", -1.0)
    assert trial.beam.text_number(("STOP", "HOVER", "5", "0")) == trial.beam.text[joined]
    other = trial.enter("STOP", -1.0)
    for number in range(MOST_TEXTS - 2):
        trial.beam.text_number((f"W{number}",))
    assert trial.beam.known_texts == MOST_TEXTS
    trial.beam.text_number(("ONE MORE",))
    assert trial.beam.known_texts == 3
    assert trial.beam.text[joined] == trial.beam.readings[joined].text
    assert trial.beam.text_number(("STOP", "HOVER", "5", "0")) == trial.beam.text[joined]
    assert trial.beam.text_number(("STOP",)) == trial.beam.text[other] != trial.beam.text[joined]


def test_only_readings_of_that_many_words_are_asked_for_their_last_one(trial):
    slots = [trial.enter(words, -1.0) for words in ("STOP HOVER 3", "STOP HOVER 2", "STOP HOVER 1", "STOP 3")]
    trial.beam.ask(3, frozenset({"3", "2"}))
    asked = [trial.beam.readings[slot].asked for slot in slots]
    assert asked == [{"3", "2"}, {"3", "2"}, set(), set()]
    assert trial.beam.readings[slots[0]].asked_s == 100.0


# How readings stand


def test_the_margin_is_to_the_best_reading_with_another_text(trial):
    own = trial.enter("STOP HOVER 5 AND 0", -1.0)
    assert trial.standing.margin(own) == -NEVER
    assert trial.standing.rival(own) == ""
    same = trial.enter("STOP HOVER 5 0", -1.5)
    assert trial.standing.margin(own) == -NEVER
    trial.enter("STOP HOVER 5", -4.0)
    near = trial.enter("STOP HOVER 2", -3.0)
    assert trial.standing.margin(own) == pytest.approx(2.0)
    assert trial.standing.margin(same) == pytest.approx(1.5)
    assert trial.standing.margin(near) == pytest.approx(-2.0)
    assert trial.standing.rival(own) == "STOP HOVER 2"
    assert trial.standing.rival(near) == "STOP HOVER 50"


def test_a_misfit_is_the_most_that_was_lost_within_one_word_without_what_its_place_costs(trial):
    trial.loop.score = 6.0
    slot = trial.enter("STOP HOVER 5 GO", -SHORT_COST, behind=1.0, fine=(0.0, 0.5, 0.0, 0.0))
    assert trial.standing.misfit(slot) == (pytest.approx(3.0), 3)
    trial.loop.score = 3.5
    assert trial.standing.misfit(slot) == (pytest.approx(1.0), 0)
    costly = trial.enter("STOP HOVER 5", 0.0, behind=1.0, fine=(2.0, 0.0, 0.0))
    assert trial.standing.misfit(costly) == (pytest.approx(1.0), 1)
    assert trial.standing.misfit(MOST - 1) == (0.0, 0)


def test_readings_near_one_are_at_most_so_far_behind_it(trial):
    own = trial.enter("STOP", -1.0)
    for words, score in [("CONTD", -3.0), ("STOP HOVER", -3.5), ("STOP UP", -3.501), ("STOP DOWN", 2.0)]:
        trial.enter(words, score)
    near = {" ".join(reading.words) for reading in trial.standing.near(own, 2.5)}
    assert near == {"STOP", "CONTD", "STOP HOVER", "STOP DOWN"}
    assert list(trial.standing.near(own, -NEVER * 2))


def test_a_sign_is_over_once_the_gap_is_better(trial):
    slot = trial.enter("STOP", -1.0)
    assert not trial.standing.is_over(slot)
    trial.beam.gap[slot] = -1.0
    assert not trial.standing.is_over(slot)
    trial.beam.gap[slot] = -0.9
    assert trial.standing.is_over(slot)


def test_whether_some_reading_begins_with_what_was_told(trial):
    assert not trial.standing.has_prefix(("STOP",))
    trial.enter("STOP HOVER 5", -1.0)
    trial.enter("CONTD SNAP", -0.5)
    for _ in range(2):  # before there is a best one, and with it
        assert trial.standing.has_prefix(("STOP", "HOVER"))
        assert trial.standing.has_prefix(("CONTD",))
        assert not trial.standing.has_prefix(("STOP", "UP"))
        assert not trial.standing.has_prefix(("STOP", "HOVER", "5", "GO"))
        trial.beam.prune(TIMEOUT_S)


def test_summaries_are_of_the_best_readings_the_best_first(trial):
    trial.loop.score = 4.0
    slot = trial.enter("STOP HOVER", -1.0, behind=1.0, longest=0.3, sure=(0.8, 0.0))
    trial.enter("STOP", -5.0)
    trial.enter("CONTD", -3.0)
    best, *rest = trial.standing.summaries(2)
    assert [[word for word, _ in summary.words] for summary in rest] == [["CONTD"]]
    assert best.words == (("STOP", 0.8), ("HOVER", pytest.approx(math.exp(-0.5))))
    assert (best.behind, best.longest_s) == (pytest.approx(3.5), pytest.approx(0.3))
    assert (best.misfit, best.misfit_at) == (pytest.approx(2.5), "HOVER")
    assert trial.standing.certainties(slot) == [0.8, pytest.approx(math.exp(-0.5))]
    assert trial.standing.certainties(MOST - 1) == []
    assert len(trial.standing.summaries(MOST)) == 3
