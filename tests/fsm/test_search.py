"""The search of the rule "sentence" finds, of each reading, the best of all ways to cut the frames into its signs."""

import random

import pytest

from lightgesture.fsm import Sign, Signs, load_grammar
from lightgesture.fsm.language.forms import is_digit
from lightgesture.fsm.rules.beam import SHORT_COST, SHORT_S
from lightgesture.fsm.rules.loop import COST
from lightgesture.fsm.rules.scores import GAP_SCORE, RATE
from lightgesture.fsm.rules.search import JOIN_COST, REACTION_S, Search

STEP_S = 0.1
HOLD, PASSAGE = 4, 1
"""Frames of the least length of a sign, and of the passage before it."""
UNREAD = Signs(Sign(None, 0.9), Sign(None, 0.9))


class Trial:
    """A search and all that it was shown, a frame each STEP_S seconds."""

    def __init__(self, grammar):
        self.grammar = grammar
        self.search = Search(grammar, HOLD * STEP_S)
        self.adds, self.loop, self.best = [], [], []
        self.pairs = {word: pair for pair, word in grammar.sentence_words.items()}
        self.pairs |= {word: pair for pair, word in grammar.idle_words.items() if word not in self.pairs}

    def show(self, signs, in_view_s=STEP_S):
        number = len(self.adds)
        scores = self.search.step(signs, STEP_S, in_view_s, number, number * STEP_S)
        self.adds.append(scores * (STEP_S * RATE))
        self.loop.append(self.search.loop.score)
        self.best.append({said: score for said, (score, _) in self.readings().items()})

    def sign(self, word, frames, left=0.95, right=0.95):
        pair = self.pairs[word]
        for _ in range(frames):
            self.show(Signs(*(Sign(t, p, {t: p}) for t, p in zip(pair, (left, right), strict=True))))

    def rest(self, frames=3, signs=UNREAD):
        for _ in range(frames):
            self.show(signs)

    def readings(self):
        """What each reading says: its score, and what lay within its signs."""
        beam, found = self.search.beam, {}
        for (words, _), slot in beam.slots.items():
            score = float(beam.best[slot])
            if words not in found or score > found[words][0]:
                found[words] = score, beam.readings[slot]
        return found

    def columns(self, word, is_first):
        """Of the pairs that say a word at the beginning of a sentence or inside."""
        pairs = self.grammar.idle_words if is_first else self.grammar.sentence_words | self.grammar.menu_words
        return [self.search.scores.column(pair) for pair, said in pairs.items() if said == word]

    def best_cut(self, words):
        """The best score of these words over all ways to cut the frames, the free loop being what was before them."""
        gap, nothing = GAP_SCORE * STEP_S * RATE, float("-inf")
        before, fine = self.loop, 0.0
        for place, word in enumerate(words):
            is_unjoined = place and is_digit(word) and is_digit(words[place - 1]) and word != words[place - 1]
            cost, fine = (JOIN_COST, JOIN_COST) if is_unjoined and not fine else (0.0, fine)
            over, best, held = nothing, [], {}
            for end, add in enumerate(self.adds):
                over = max(over, best[-1] if best else nothing) + gap
                held = {(start, column): score + add[column] for (start, column), score in held.items()}
                start = end + 1 - HOLD
                if start - 1 >= (PASSAGE if place else 0):
                    earlier = max(start - 1 - PASSAGE, 0)
                    entered = before[earlier] + (start - 1 - earlier) * gap - COST - SHORT_COST - cost
                    for column in self.columns(word, not place):
                        signs = sum(one[column] for one in self.adds[start : end + 1])
                        held[start, column] = entered + signs
                given = {key: (end + 1 - HOLD - key[0]) * STEP_S * SHORT_COST / SHORT_S for key in held}
                best.append(max([over, *(held[key] + min(SHORT_COST, given[key]) for key in held)]))
            before = best
        return before[-1]


@pytest.fixture
def trial(grammar):
    return Trial(grammar)


@pytest.mark.parametrize(
    ("sentence", "seed"),
    [
        ("STOP HOVER 5 AND 0 GO", 1),
        ("STOP HOVER 5 2 0 GO", 2),
        ("STOP HOVER 3 3 GO", 3),
        ("CONTD SNAP 2 GO", 4),
    ],
)
def test_a_reading_has_the_score_of_the_best_cut_into_its_signs(trial, sentence, seed):
    rng, words = random.Random(seed), tuple(sentence.split())
    trial.rest(4, Signs())
    for word in words:
        trial.sign(word, rng.choice([7, 8, 10]), rng.uniform(0.7, 0.98), rng.uniform(0.7, 0.98))
        trial.rest(rng.choice([2, 3]))
    readings = trial.readings()
    assert max(readings, key=lambda said: readings[said][0]) == words
    assert readings[words][0] == pytest.approx(trial.best_cut(words))
    for said, (score, _) in readings.items():
        assert score <= trial.best_cut(said) + 1e-9, said


def spoken_after(trial, sentence, frames=8):
    trial.rest(4, Signs())
    for word in sentence.split():
        trial.sign(word, frames)
        trial.rest(3)
    return trial.readings()[tuple(sentence.split())][1]


def test_a_reading_knows_when_its_signs_began_and_how_well_they_were_seen(trial):
    reading = spoken_after(trial, "STOP HOVER 5 GO")
    began = [4, 15, 26, 37]
    assert [item.frame for item in reading.spoken] == began
    assert [item.time_s for item in reading.spoken] == pytest.approx([STEP_S * frame for frame in began])
    assert [item.began for item in reading.spoken] == pytest.approx([STEP_S * frame for frame in began])
    assert [item.seen for item in reading.spoken] == pytest.approx([STEP_S * frame for frame in began])
    assert (reading.began, reading.touched) == (pytest.approx(0.4), pytest.approx(4.1))
    assert [item.sure for item in reading.spoken[:-1]] == pytest.approx([0.95] * 3)
    assert [item.word for item in reading.spoken] == ["STOP", "HOVER", "5", "GO"] == list(reading.words)
    assert [item.fine for item in reading.spoken] == [0.0] * 4
    assert reading.longest == pytest.approx(0.2)  # of the three frames one is the passage
    transitions = trial.grammar.table.transitions
    assert transitions[reading.before]["GO"] == reading.state
    assert trial.grammar.table.accepting[reading.state]


def test_what_a_word_costs_for_its_place_is_kept_with_it(trial):
    reading = spoken_after(trial, "STOP HOVER 5 2 1 GO")
    assert [item.fine for item in reading.spoken] == [0.0, 0.0, 0.0, JOIN_COST, 0.0, 0.0]
    assert [item.fine for item in spoken_after(Trial(trial.grammar), "STOP HOVER 5 5 GO").spoken] == [0.0] * 5


def test_a_word_is_behind_by_what_its_reading_had_lost_before_the_passage_to_it(trial):
    trial.rest(4, Signs())
    for word, frames in (("STOP", 8), ("HOVER", 5), ("UP", 8), ("GO", 8)):  # of the reading HOVER is no part
        trial.sign(word, frames)
        trial.rest(3)
    words = "STOP", "UP", "GO"
    spoken = trial.readings()[words][1].spoken
    for place in (1, 2):
        earlier = spoken[place].frame - 1 - PASSAGE
        lost = trial.loop[earlier] - trial.best[earlier][words[:place]]
        assert spoken[place].behind == pytest.approx(lost, abs=1e-6)
    assert spoken[1].behind > 2


def test_a_sign_goes_on_as_the_same_word_until_it_was_gone(trial):
    trial.rest(4, Signs())
    for word in ("STOP", "HOVER", "3"):
        trial.sign(word, 8)
        trial.rest(3)
    trial.rest(1, Signs())
    assert ("STOP", "HOVER", "3", "3") not in trial.readings()
    trial.sign("3", 8)
    assert ("STOP", "HOVER", "3", "3") in trial.readings()
    other = Trial(trial.grammar)
    other.rest(4, Signs())
    for word, frames in (("STOP", 8), ("HOVER", 8), ("3", 30)):
        other.sign(word, frames)
        other.rest(2)
    assert ("STOP", "HOVER", "3", "3") not in other.readings()


@pytest.mark.parametrize(("chance", "is_open"), [(0.07, True), (0.05, False)])
def test_how_likely_a_sign_must_be_to_open_a_sentence(grammar, chance, is_open):
    trial = Trial(grammar)
    hand = Sign(None, 0.1, dict.fromkeys(grammar.tokens, chance))
    for _ in range(9):
        trial.show(Signs(hand, hand))
    assert bool(trial.readings()) == is_open


def test_a_spent_sign_opens_nothing_and_a_wary_search_none_that_means_something_inside(trial):
    trial.search.spent = trial.search.scores.column(trial.pairs["CONTD"])
    trial.rest(4, Signs())
    trial.sign("CONTD", 8)
    assert trial.readings() == {}
    trial.rest(4, Signs())
    trial.search.spent = None
    trial.search.is_wary = True
    start = trial.pairs["STOP"]
    means_a_word_inside = start in trial.grammar.sentence_words
    trial.sign("STOP", 8)
    assert (("STOP",) in trial.readings()) != means_a_word_inside


def test_after_a_sentence_what_is_still_shown_opens_one_only_after_the_least_length_anew(trial):
    trial.rest(4, Signs())
    trial.sign("STOP", 6)
    trial.search.clear()
    assert trial.readings() == {}
    assert trial.search.lead is None
    trial.sign("STOP", 3)
    assert trial.readings() == {}
    trial.sign("STOP", 1)
    assert set(trial.readings()) == {("STOP",)}


def asked(trial, pause_frames, frames):
    """STOP HOVER 3, asked for again, and after a pause 2 for so long: the readings."""
    trial.rest(4, Signs())
    for word in ("STOP", "HOVER", "3"):
        trial.sign(word, 8)
        trial.rest(3)
    trial.search.beam.ask(3, frozenset({"3", "2"}))
    trial.rest(pause_frames)
    trial.sign("2", frames)
    trial.rest(3)
    return trial.readings()


def test_a_sign_that_was_asked_for_replaces_the_last_one_once_a_diver_may_have_reacted(trial):
    readings = asked(trial, round(REACTION_S / STEP_S), 8)
    score, reading = readings["STOP", "HOVER", "2"]
    assert score > max(other for words, (other, _) in readings.items() if words[:3] == ("STOP", "HOVER", "3"))
    assert [item.is_again for item in reading.spoken] == [False, False, True]
    assert trial.grammar.table.transitions[reading.before]["2"] == reading.state
    assert reading.spoken[-1].fine == 0.0
    assert reading.longest == pytest.approx(0.2)


def test_what_comes_sooner_is_the_next_word(trial):
    readings = asked(trial, 0, 6)
    assert not readings["STOP", "HOVER", "3", "2"][1].spoken[-1].is_again
    assert ("STOP", "HOVER", "2") not in readings


def test_what_was_asked_for_stays_so_where_a_better_way_to_the_same_words_is_found(trial):
    trial.rest(4, Signs())
    for word in ("STOP", "HOVER"):
        trial.sign(word, 8)
        trial.rest(3)
    trial.sign("3", 5, 0.12, 0.12)
    trial.search.beam.ask(3, frozenset({"3", "2"}))
    before = trial.readings()["STOP", "HOVER", "3"][1]
    trial.sign("3", 6)
    after = trial.readings()["STOP", "HOVER", "3"][1]
    assert after.spoken[-1].frame > before.spoken[-1].frame
    assert (after.asked, after.asked_s) == (before.asked, before.asked_s) == ({"3", "2"}, before.asked_s)
    assert before.asked_s > 0


def test_no_reading_is_longer_than_a_sentence_may_be(write_grammar):
    trial = Trial(load_grammar(write_grammar(("max_words = 40", "max_words = 4"))))
    trial.rest(4, Signs())
    for word in ("STOP", "HOVER", "5", "0", "1"):
        trial.sign(word, 8)
        trial.rest(3)
    assert max(len(said) for readings in trial.best for said in readings) == 4


def test_a_held_sign_is_told_by_its_window(trial):
    trial.rest(4, Signs())
    trial.sign("HOVER", 6)
    column = trial.search.scores.column(trial.pairs["HOVER"])
    hold = trial.search.hold(column, 0.5)
    assert (hold.pair, hold.frames, hold.confidence) == (trial.pairs["HOVER"], 1, 0.5)
    assert (hold.first_frame, hold.first_time_s) == (6, pytest.approx(0.6))
