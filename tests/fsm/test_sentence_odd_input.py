"""The rule "sentence" with odd input: odd probabilities, time that jumps, random signs."""

import math
import random

import pytest

from lightgesture.fsm import Decoder, Sign, Signs
from lightgesture.fsm.rules import beam
from tests.fsm.signing import UNREAD, Diver, issued, likely, rejected, rule_and_timeline


@pytest.fixture(name="diver")
def _diver(grammar):
    return Diver(grammar)


@pytest.mark.parametrize(
    "probabilities",
    [
        {},
        {"ok": math.nan, "0": math.nan},
        {"ok": math.inf},
        {"ok": -1.0, "0": 2.0},
        dict.fromkeys(["0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok"], 0.1),
        dict.fromkeys(["0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok"], 1.0),
        dict.fromkeys(["0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok"], math.nan),
        {"unknown": 1.0},
    ],
)
def test_probabilities_that_say_nothing_issue_nothing_and_break_nothing(diver, probabilities):
    odd = Sign("ok", math.nan, probabilities)
    diver.words("STOP")
    diver.show(Signs(odd, odd), 5.0)
    diver.show(Signs(Sign("no such token", 0.9), Sign(None)), 1.0)
    assert issued(diver.events) == []
    diver.pause(25.0)
    assert issued(diver.words("STOP HOVER GO")) == ["STOP HOVER GO"]


def test_a_reader_that_knows_more_and_fewer_classes(grammar):
    diver = Diver(grammar)
    events = []
    for word in ("STOP", "HOVER", "GO"):
        left, right = diver.pairs[word]
        signs = Signs(Sign(left, 0.9, {left: 0.9, "none": 0.1}), Sign(right, 0.9, {right: 0.9, "fish": 0.1}))
        events += diver.show(signs, 0.8) + diver.show(UNREAD, 0.25)
    assert issued(events) == ["STOP HOVER GO"]


@pytest.mark.parametrize("stamp", [0.0, math.nan, math.inf, -5.0])
def test_time_that_stands_still_makes_no_words(grammar, stamp):
    decoder = Decoder(grammar, rule="sentence")
    events = []
    for word in ("STOP", "HOVER", "GO"):
        for _ in range(50):
            events += decoder.step(Signs.of_tokens(*Diver(grammar).pairs[word]), stamp)
    assert [event.type for event in events if event.type != "state"] == []


def test_time_that_jumps_is_no_hold(grammar):
    decoder = Decoder(grammar, rule="sentence")
    signs = Signs.of_tokens("0", "0")
    events = decoder.step(signs, 0.0) + decoder.step(signs, 1000.0)
    assert [event.type for event in events if event.type == "word"] == []


def test_frames_that_were_dropped_may_have_hidden_a_sign(diver):
    diver.words("STOP HOVER 5")
    diver.frame += 30
    events = diver.words("GO") + diver.pause()
    assert (issued(events), rejected(events)) == ([], ["passed_over"])


@pytest.mark.parametrize("rate", [30, 1000])
def test_memory_is_bounded_whatever_comes(grammar, rate):
    """An hour of one sign, held, and of random signs: no more readings, texts or rows than at the start."""
    rng = random.Random(1)
    rule, timeline = rule_and_timeline(grammar)
    pair = ("0", "0")
    for frame in range(3000):
        if frame % 20 == 0:
            pair = rng.choice(list(grammar.idle_words))
        rule.process(
            Signs(likely(pair[0], 0.5), likely(pair[1], 0.5)), timeline.advance(frame / rate), 1 / rate
        )
        assert sum(reading is not None for reading in rule.search.beam.readings) <= beam.MOST
    assert rule.search.beam.known_texts <= beam.MOST_TEXTS


def test_a_sign_held_for_an_hour_is_one_word(grammar):
    diver = Diver(grammar, rate=5)
    events = diver.show(Signs(*map(likely, diver.pairs["CONTD"])), 3600.0)
    assert [event.type for event in events if event.type == "instruction"] == []
    diver.pause(25.0)
    diver.rate = 30
    diver.frame *= 6
    assert issued(diver.words("STOP HOVER GO")) == ["STOP HOVER GO"]


def test_random_signs_never_make_what_the_table_does_not_accept(grammar):
    rng = random.Random(2)
    for trial in range(20):
        diver = Diver(grammar)
        for _ in range(30):
            left, right = rng.choice(list(grammar.idle_words))
            diver.pair(left, right, chance=rng.uniform(0.3, 0.98), seconds=rng.uniform(0.1, 1.0))
        for event in diver.events:
            if event.type == "instruction":
                state = 0
                for word in event.words:
                    state = grammar.table.transitions[state][word]
                assert state in grammar.table.accepting, trial


def test_two_decoders_agree_and_a_finished_one_is_as_new(grammar):
    one, other = Diver(grammar), Diver(grammar)
    sentence = "STOP HOVER 5 AND 0 GO"
    assert one.words(sentence) == other.words(sentence)
    one.decoder.finish()
    again = Diver(grammar)
    again.decoder = one.decoder.for_stream(None)
    assert again.words(sentence) == other.events


def test_idle_hands_issue_nothing(grammar):
    rng = random.Random(3)
    diver = Diver(grammar)
    for _ in range(300):
        chances = {token: rng.random() for token in rng.sample(grammar.tokens, 3)}
        total = sum(chances.values()) + rng.random()
        hand = [
            Sign(None, 0.3, {token: chance / total for token, chance in chances.items()}) for _ in range(2)
        ]
        diver.show(Signs(*hand), rng.uniform(0.05, 0.6))
    assert issued(diver.events) == []


# Options
