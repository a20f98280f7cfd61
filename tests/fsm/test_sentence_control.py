"""The rule "sentence": stopping by hand, loops, and words by themselves."""

from pathlib import Path

import pytest

from lightgesture.fsm import UNSEEN, Sign, Signs, load_grammar
from tests.fsm.signing import Diver, issued, likely, rejected

GRAMMARS = Path(__file__).parents[2] / "docs" / "grammars"


class TestControl:
    @pytest.fixture
    def diver(self):
        return Diver(load_grammar(GRAMMARS / "sonar.toml"))

    def test_kill_acts_at_once_in_every_state(self, diver):
        assert issued(diver.show(Signs(*map(likely, diver.pairs["ABORT"])), 0.5)) == ["ABORT"]
        diver.pause()
        diver.words("STOP HOVER")
        events = diver.show(Signs(*map(likely, diver.pairs["ABORT"])), 0.5)
        assert (issued(events), rejected(events)) == (["ABORT"], ["cancelled"])

    def test_a_kill_that_is_held_is_issued_once(self, diver):
        assert issued(diver.show(Signs(*map(likely, diver.pairs["ABORT"])), 60.0)) == ["ABORT"]

    def test_cancel_drops_the_open_sentence(self, diver):
        diver.words("STOP HOVER")
        assert rejected(diver.words("CANCEL")) == ["cancelled"]
        assert diver.decoder.state == "idle"

    def test_confirmation_wants_the_end_word_twice(self, diver):
        events = diver.words("STOP SONAR 3 GO")
        assert issued(events) == []
        assert diver.decoder.state == "confirming"
        assert issued(diver.words("GO")) == ["STOP SONAR 3 GO"]

    def test_another_word_does_not_confirm(self, diver):
        diver.words("STOP SONAR 3 GO")
        assert rejected(diver.words("HOVER")) == ["unconfirmed"]

    def test_an_end_word_that_is_held_on_does_not_confirm(self, diver):
        diver.words("STOP SONAR 3 GO", seconds=0.8)
        assert diver.decoder.state == "confirming"
        diver = Diver(diver.decoder.grammar)
        diver.words("STOP SONAR 3")
        assert issued(diver.show(Signs(likely("ok"), likely("ok")), 10.0)) == []

    def test_the_menu(self, diver):
        diver.pause()
        events = diver.words(["MENU", "SELECT 2"])
        assert [(event.kind, event.program) for event in events if event.type == "instruction"] == [
            ("menu", 2)
        ]


def test_loops(grammar):
    diver = Diver(load_grammar(GRAMMARS / "repeat.toml"))
    events = diver.words("STOP REPEAT 3 HOVER 5 SNAP END GO")
    assert issued(events) == ["STOP REPEAT 3 HOVER 5 SNAP END GO"]


def test_cards_are_words_by_themselves(grammar):
    diver = Diver(grammar)
    events = []
    for word in ("STOP", "HOVER", "0", "GO"):
        events += diver.show(Signs(UNSEEN, Sign(word, 0.99, is_word=True)), 0.6)
        events += diver.show(Signs(), 0.3)
    assert rejected(events) == ["limit"]  # the card 0 is the digit, though its pair would be STOP
    two = Signs(Sign("STOP", is_word=True), Sign("GO", is_word=True))
    assert not diver.decoder.step(two, 100.0)


# Bad input
