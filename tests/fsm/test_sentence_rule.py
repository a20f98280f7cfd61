"""The rule "sentence": every sentence at any rate, its limits and its options."""

import math
import random

import pytest

from lightgesture.fsm import Decoder, Signs, load_grammar
from lightgesture.fsm.language.forms import spell
from tests.fsm.signing import UNREAD, Diver, issued, likely, rejected

RATES = (10, 30, 60)


@pytest.fixture(name="diver")
def _diver(grammar):
    return Diver(grammar)


def sentences(grammar, most):
    """Every sentence of up to `most` words that the table accepts, sensible or not."""
    found, waiting = [], [((), 0)]
    while waiting:
        words, state = waiting.pop()
        if state in grammar.table.accepting and words:
            found.append(words)
        elif len(words) < most:
            waiting += [((*words, word), target) for word, target in grammar.table.transitions[state].items()]
    return found


def check_sentences(grammar, most, rate):
    for words in sentences(grammar, most):
        diver = Diver(grammar, rate)
        diver.pause(0.3)
        events = diver.words(words) + diver.decoder.finish()
        by_frames = Decoder(grammar, hold=1)
        expected = []
        for word in words:
            expected += by_frames.step(Signs.of_tokens(*diver.pairs[word]), 0.0) + by_frames.step(
                Signs(), 0.0
            )
        assert issued(events) == issued(expected), words
        assert rejected(events) == rejected(expected), words
        told = [event.word for event in events if event.type == "word"]
        assert told == list(words)


@pytest.mark.parametrize("rate", RATES)
def test_every_short_sentence_is_read_at_any_rate(grammar, rate):
    check_sentences(grammar, 4, rate)


@pytest.mark.slow
@pytest.mark.parametrize("rate", RATES)
def test_every_longer_sentence_is_read_at_any_rate(grammar, rate):
    check_sentences(grammar, 5, rate)


STUDY = (
    "STOP HOVER 5 AND 0 GO",
    "STOP EXEC 1 GO",
    "CONTD SNAP 2 AND 0 GO",
    "CONTD PARAM_3 DECREASE GO",
    "STOP EXEC 2 GO CONTD SNAP GO",
    "CONTD SNAP 5 AND 0 GO STOP FOLLOW GO",
)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("sentence", STUDY)
def test_the_instructions_of_the_study(grammar, rate, sentence):
    diver = Diver(grammar, rate)
    expected = [
        spell([*part.replace("_", " ").strip().split(), "GO"], "AND") for part in sentence.split("GO")[:-1]
    ]
    assert issued(diver.words(sentence)) == [text.replace("PARAM 3", "PARAM 3") for text in expected]


@pytest.mark.parametrize("rate", [120, 500])
def test_a_fast_camera_reads_the_same(grammar, rate):
    """Frames that come faster than they are remembered share a place."""
    assert issued(Diver(grammar, rate).words("STOP HOVER 5 GO")) == ["STOP HOVER 5 GO"]


def test_dropped_frames_do_not_matter(grammar):
    rng = random.Random(5)
    for _ in range(5):
        diver = Diver(grammar, 30)
        step = diver.decoder.step
        diver.decoder.step = lambda *given, step=step: [] if rng.random() < 0.3 else step(*given)
        assert issued(diver.words("STOP HOVER 5 AND 0 GO")) == ["STOP HOVER 50 GO"]


def test_a_word_is_told_and_an_instruction_issued_within_the_limits(diver):
    for number, word in enumerate(["STOP", "HOVER", "5", "GO"]):
        diver.show(UNREAD, 0.25)
        first = diver.frame
        diver.show(Signs(*map(likely, diver.pairs[word])), 0.8)
        told = [event for event in diver.events if event.type in ("word", "instruction")][number:]
        assert (told[0].frame - first) / 30 <= (0.5 if word != "GO" else 0.6)
    assert told[-1].type == "instruction"


def test_the_record_of_an_instruction(diver):
    diver.pause(1.0)
    (event,) = [event for event in diver.words("STOP HOVER 5 GO") if event.type == "instruction"]
    assert (event.text, event.kind, event.action, event.duration_s) == ("STOP HOVER 5 GO", "task", "HOVER", 5)
    assert event.words == ("STOP", "HOVER", "5", "GO")
    assert abs(event.start_time_s - 1.0) <= 0.1
    assert event.confidence == pytest.approx(0.97, abs=0.02)


def test_caution_is_the_grammars_or_the_callers(grammar, write_grammar):
    careful = load_grammar(write_grammar(("caution = 1", "caution = 3")))
    assert careful.sentence.caution == 3
    doubt = likely("3", 0.75, {"2": 0.15})

    def outcome(language, **options):
        diver = Diver(language, **options)
        diver.words("STOP HOVER")
        diver.show(Signs(likely("ok"), doubt), 0.8)
        diver.show(UNREAD, 0.25)
        return issued(diver.words("GO") + diver.pause())

    assert outcome(grammar) == ["STOP HOVER 3 GO"]
    assert outcome(careful) == outcome(grammar, caution=3) == []
    assert outcome(careful, caution=1) == ["STOP HOVER 3 GO"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"hold": 5}, "hold: the rule sentence goes by seconds; use hold_seconds"),
        ({"hold_seconds": 0.0}, "hold_seconds is 0; use a number above 0"),
        ({"caution": math.nan}, "caution is nan; use a number above 0"),
    ],
)
def test_options_that_make_no_sense(grammar, options, message):
    with pytest.raises(ValueError, match=message):
        Decoder(grammar, rule="sentence", **options)


def test_a_rule_of_frames_has_no_seconds_and_a_rule_of_seconds_no_frames(grammar):
    with pytest.raises(ValueError, match="the rule frames goes by frames"):
        Decoder(grammar, rule="frames", hold_seconds=0.5)
    with pytest.raises(ValueError, match="the rule evidence goes by seconds"):
        Decoder(grammar, rule="evidence", hold=5)
    assert Decoder(grammar, rule="seconds").hold_seconds == 0.5


def test_it_is_the_default_and_the_grammar_may_name_another(grammar, write_grammar):
    by_frames = Decoder(load_grammar(write_grammar(('rule = "sentence"', 'rule = "frames"'))))
    assert (by_frames.rule, by_frames.hold_frames) == ("frames", 15)
    assert Decoder(load_grammar(write_grammar(('rule = "sentence"', "")))).rule == "sentence"
    assert Decoder(grammar, hold=9).hold_frames == 9
    diver = Diver(grammar)
    diver.decoder = Decoder(grammar)
    assert (diver.decoder.rule, diver.decoder.hold_seconds, diver.decoder.hold_frames) == (
        "sentence",
        0.4,
        None,
    )
    assert issued(diver.words("STOP HOVER GO")) == ["STOP HOVER GO"]
