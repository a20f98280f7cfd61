"""When a diver is told a word by the rule "sentence", by what the readings that are near say."""

from types import SimpleNamespace

import pytest

from lightgesture.fsm.reader import Reader
from lightgesture.fsm.reporter import Reporter, Timeline
from lightgesture.fsm.rules.doubts import MARGIN, MISFIT
from lightgesture.fsm.rules.readings import Reading, Spoken
from lightgesture.fsm.rules.telling import Telling, common


@pytest.mark.parametrize(
    ("one", "other", "length"),
    [
        ((), (), 0),
        (("A",), (), 0),
        (("A", "B"), ("A",), 1),
        (("A", "B"), ("A", "C"), 1),
        (("A", "B"), ("C", "B"), 0),
        (("A", "B"), ("A", "B"), 2),
    ],
)
def test_how_much_two_readings_share(one, other, length):
    assert common(one, other) == common(other, one) == length


class Trial:
    """Telling with a search that says what a test says."""

    def __init__(self, grammar, caution=1.0):
        timeline = Timeline()
        self.grammar, self.reporter = grammar, Reporter("cam", timeline)
        self.reader = Reader(grammar, self.reporter, timeline)
        self.near, self.certainties, self.behind, self.asked_margin = [], [], 0.0, None
        self.pairs = {word: pair for pair, word in grammar.sentence_words.items()}
        standing = SimpleNamespace(
            certainties=lambda slot: self.certainties, behind=lambda slot: self.behind, near=self._near
        )
        scores = SimpleNamespace(shown=lambda column: (str(column), "5"))
        self.windows = SimpleNamespace(now=9.0)
        search = SimpleNamespace(standing=standing, windows=self.windows, scores=scores)
        self.telling = Telling(grammar, caution, search, self.reader, self.reporter)

    def _near(self, slot, margin):
        self.asked_margin = margin
        return iter(self.near)

    def reading(self, text, began=1.0):
        words, state, transitions = tuple(text.split()), 0, self.grammar.table.transitions
        for word in words:
            state = transitions[state][word]
        spoken = tuple(
            Spoken(word, place, 10 * place, float(place), 0.0, 0.0, float(place), 0.0)
            for place, word in enumerate(words)
        )
        return Reading(spoken, state, 0, began, 0.0, 0, words, 0.0)

    def tell(self, text, *others, sure=0.95, began=1.0, first=None):
        """Tell what a reading says besides others that are near; the doubt, and the words that were told anew."""
        lead = self.reading(text, began)
        self.near = [lead, *(self.reading(other) for other in others)]
        self.certainties = [sure] * len(lead.words)
        if first is not None:
            self.certainties[0] = first
        count = len(self.reporter.events)
        found = self.telling.tell(0, lead, 20.0)
        words = [event.word for event in self.reporter.events[count:] if event.type == "word"]
        return found, words


@pytest.fixture
def trial(grammar):
    return Trial(grammar)


def test_a_word_is_told_once_where_all_near_readings_say_it(trial):
    assert trial.tell("STOP", "CONTD") == (None, [])
    assert trial.tell("STOP") == (None, ["STOP"])
    assert trial.asked_margin == MARGIN
    assert trial.tell("STOP") == (None, [])
    assert trial.tell("STOP HOVER", "STOP FOLLOW") == (None, [])
    assert trial.tell("STOP HOVER", "STOP HOVER 5") == (None, ["HOVER"])
    assert trial.telling.told == ("STOP", "HOVER")
    assert trial.telling.text == "STOP HOVER"
    assert trial.reader.sentence.words == ["STOP", "HOVER"]


def test_several_words_may_be_told_at_once_each_with_the_text_so_far(trial):
    assert trial.tell("STOP HOVER 5 AND 0") == (None, ["STOP", "HOVER", "5", "AND", "0"])
    events = [event for event in trial.reporter.events if event.type == "word"]
    assert [event.state for event in events] == [
        "STOP",
        "STOP HOVER",
        "STOP HOVER 5",
        "STOP HOVER 5 AND",
        "STOP HOVER 50",
    ]
    assert [event.pair for event in events] == [(str(place), "5") for place in range(5)]
    assert trial.reader.sentence.start_frame == 0
    assert trial.reader.sentence.touched_s == 20.0
    assert trial.telling.text == "STOP HOVER 50"


def test_the_end_word_comes_with_the_verdict(trial):
    assert trial.tell("STOP HOVER GO") == (None, ["STOP", "HOVER"])
    assert trial.tell("STOP HOVER GO") == (None, [])


@pytest.mark.parametrize(("behind", "is_told"), [(MISFIT, True), (MISFIT + 0.01, False)])
def test_what_fits_badly_is_not_told(trial, behind, is_told):
    trial.behind = behind
    assert trial.tell("STOP") == (None, ["STOP"] if is_told else [])


@pytest.mark.parametrize(
    ("caution", "behind", "is_told"), [(2.0, 2.5, True), (2.0, 2.6, False), (0.5, 10.0, True)]
)
def test_how_badly_goes_by_caution(grammar, caution, behind, is_told):
    trial = Trial(grammar, caution)
    trial.behind = behind
    assert trial.tell("STOP", sure=0.99) == (None, ["STOP"] if is_told else [])


@pytest.mark.parametrize(
    ("sure", "is_told", "is_sure"), [(0.19, False, False), (0.2, True, False), (0.6, True, True)]
)
def test_a_first_word_is_told_before_it_is_sure_enough_to_be_issued(trial, sure, is_told, is_sure):
    assert trial.tell("STOP", sure=sure) == (None, ["STOP"] if is_told else [])
    assert trial.telling.is_sure == is_sure


def test_a_first_word_becomes_sure_when_it_is_seen_better_or_with_the_second(trial):
    trial.tell("STOP", sure=0.3)
    trial.tell("STOP", sure=0.7)
    assert trial.telling.is_sure
    trial.tell("STOP", sure=0.3)
    assert trial.telling.is_sure  # and stays so
    trial.telling.reset()
    assert (trial.telling.told, trial.telling.is_sure, trial.telling.text) == ((), False, "")
    trial.tell("STOP HOVER", first=0.3)
    assert trial.telling.is_sure


def test_a_start_word_in_mid_sentence_is_a_doubt_where_the_first_was_sure(trial):
    trial.tell("STOP", sure=0.95)
    doubt, words = trial.tell("CONTD", began=9.5)
    assert words == []
    assert (doubt.reason, doubt.detail.split(";")[0]) == ("out_of_order", "CONTD cannot follow STOP")
    assert trial.tell("CONTD", began=9.0) == (
        None,
        ["CONTD"],
    )  # as old as what was told: another reading of the same


def test_a_start_word_after_one_in_doubt_takes_its_place(trial):
    trial.tell("STOP", sure=0.3)
    assert trial.tell("CONTD", began=9.5) == (None, ["CONTD"])
    assert trial.telling.told == ("CONTD",)


def test_what_was_told_is_not_taken_back_for_another_sentence(trial):
    trial.tell("STOP HOVER")
    assert trial.tell("CONTD SNAP") == (None, [])
    assert trial.tell("CONTD SNAP", began=9.5) == (None, [])
    assert trial.telling.told == ("STOP", "HOVER")
    assert trial.tell("STOP HOVER 5") == (None, ["5"])


def test_a_word_inside_may_be_corrected_by_what_leads_later(trial):
    trial.tell("STOP HOVER")
    assert trial.tell("STOP FOLLOW") == (None, ["FOLLOW"])
    assert trial.telling.told == ("STOP", "FOLLOW")


def test_a_reading_is_of_another_sentence_where_it_began_after_what_was_told(trial):
    later, earlier = trial.reading("CONTD", 9.5), trial.reading("CONTD", 9.0)
    assert not trial.telling.is_another(later)
    trial.tell("STOP")
    assert trial.telling.is_another(later)
    assert not trial.telling.is_another(earlier)
    trial.telling.is_sure = False
    assert not trial.telling.is_another(later)
