"""Time-outs, stamps that misbehave, and the pace of the display's records."""

import math
from itertools import pairwise

import pytest

from lightgesture.fsm import Decoder, Signs
from lightgesture.fsm.reporter import Timeline


def open_sentence(grammar, time_s=0.0):
    decoder = Decoder(grammar, hold=1)
    decoder.step(Signs.of_tokens("ok", "0"), time_s)
    assert decoder.state == "collecting"
    return decoder


def test_sentence_is_dropped_after_twenty_seconds(grammar, pick):
    decoder = open_sentence(grammar, 5.0)
    assert not pick(decoder.step(Signs(), 24.9), "rejected")
    rejected, state = decoder.step(Signs(), 25.0)
    assert (rejected.reason, rejected.text, rejected.detail) == ("timeout", "STOP", "no word for 20 s")
    assert (state.type, state.state, state.sentence) == ("state", "idle", "")
    assert not decoder.step(Signs(), 60.0)


def test_each_word_starts_the_time_anew(grammar, pick):
    decoder = open_sentence(grammar)
    decoder.step(Signs.of_tokens("5", "5"), 19.0)
    assert not pick(decoder.step(Signs(), 38.9), "rejected")
    assert pick(decoder.step(Signs(), 39.0), "rejected", field="text") == ["STOP HOVER"]


def test_unknown_pair_does_not_start_the_time_anew(grammar, pick):
    decoder = open_sentence(grammar)
    decoder.step(Signs.of_tokens("3", "left"), 19.0)
    assert len(pick(decoder.step(Signs(), 20.0), "rejected")) == 1


def test_nothing_times_out_while_idle(grammar):
    decoder = Decoder(grammar, hold=1)
    decoder.step(Signs(), 0.0)
    assert decoder.step(Signs(), 1e6) == []


def test_sign_half_held_at_the_time_out_does_not_live_on_with_another_meaning(grammar, pick):
    """ok,0 is the digit 0 inside a sentence and STOP outside."""
    decoder = Decoder(grammar, hold=4)
    events = []
    for frame in range(4):
        events += decoder.step(Signs.of_tokens("ok", "0"), frame / 30)
    for frame in range(4, 8):
        events += decoder.step(Signs.of_tokens("5", "5"), frame / 30)
    for _ in range(3):
        decoder.step(Signs.of_tokens("ok", "0"), 20.0)
    later = [event for _ in range(20) for event in decoder.step(Signs.of_tokens("ok", "0"), 21.0)]
    assert pick(later, "rejected", field="reason") == ["timeout"]
    assert not pick(later, "word")


def test_gap_in_the_stream_counts(grammar, pick):
    decoder = open_sentence(grammar)
    events = decoder.step(Signs.of_tokens("5", "5"), 300.0)
    assert pick(events, "rejected", field="reason") == ["timeout"]
    assert pick(events, "notice", field="reason") == ["out_of_order"]  # HOVER on its own


@pytest.mark.parametrize("stamp", [0.0, -5.0, 1e300, -1e300, math.nan, math.inf, -math.inf])
def test_strange_stamp_never_raises_and_never_reaches_a_record(grammar, stamp):
    decoder = Decoder(grammar, hold=1)
    events = []
    for left, right in (("ok", "0"), ("5", "5"), (None, None), ("ok", "ok"), ("3", "left")):
        events += decoder.step(Signs.of_tokens(left, right), stamp)
    events += decoder.finish()
    assert any(event.type == "instruction" for event in events)
    assert all(math.isfinite(event.time_s) for event in events)


def test_stamps_that_run_back_add_no_time(grammar, pick):
    decoder = open_sentence(grammar, 100.0)
    assert not pick(decoder.step(Signs(), 110.0), "rejected")
    assert not pick(decoder.step(Signs(), 3.0), "rejected")  # the source began anew
    assert not pick(decoder.step(Signs(), 12.9), "rejected")
    assert pick(decoder.step(Signs(), 13.0), "rejected", field="reason") == ["timeout"]


def test_stamp_that_is_not_finite_does_not_stop_the_clock(grammar, pick):
    decoder = open_sentence(grammar)
    decoder.step(Signs(), math.inf)
    decoder.step(Signs(), math.nan)
    assert pick(decoder.step(Signs(), 20.0), "rejected", field="reason") == ["timeout"]


def test_time_that_stands_still_never_times_out(grammar):
    decoder = open_sentence(grammar, 7.0)
    for _ in range(2000):
        decoder.step(Signs(), 7.0)
    assert decoder.state == "collecting"


def test_timeline_stands_still_where_stamps_run_back():
    timeline = Timeline()
    assert [timeline.advance(stamp) for stamp in (1.0, 3.0, 2.0, 2.5, 2.5, 4.0)] == [1, 3, 3, 3.5, 3.5, 5]


def test_growing_hold_is_shown_at_most_five_times_a_second(new_diver, pick):
    diver = new_diver(hold=300)
    states = pick(diver.show("ok,0", 299), "state")
    times = [state.time_s for state in states]
    assert min(later - time for time, later in pairwise(times)) >= 0.2 - 1e-9
    assert 45 <= len(times) <= 50
    progress = [state.dwell.progress for state in states]
    assert progress == sorted(progress)
    assert {(state.state, state.dwell.pair, state.dwell.word) for state in states} == {
        ("idle", ("ok", "0"), "STOP")
    }


def test_flickering_hands_are_shown_at_most_five_times_a_second(grammar):
    decoder = Decoder(grammar, rule="frames")
    count = 0
    for frame in range(300):
        left = ("5", None, "ok")[frame % 3]
        count += len(decoder.step(Signs.of_tokens(left, "5"), frame / 30))
    assert 20 <= count <= 51


def test_display_learns_that_a_hold_broke_off(grammar):
    decoder = Decoder(grammar, rule="frames")
    (growing,) = decoder.step(Signs.of_tokens("ok", "0"), 0.0)
    assert growing.dwell.progress == pytest.approx(1 / 15, abs=1e-4)
    assert decoder.step(Signs(), 0.1) == []
    (cleared,) = decoder.step(Signs(), 0.2)
    assert (cleared.state, cleared.dwell) == ("idle", None)
    assert decoder.step(Signs(), 0.5) == []


def test_every_change_of_state_is_shown_even_when_time_stands_still(pick, grammar):
    decoder = Decoder(grammar, hold=1)
    events = []
    for left, right in (("ok", "0"), ("5", "5"), ("ok", "ok")):
        events += decoder.step(Signs.of_tokens(left, right), 0.0)
    shown = [(state.state, state.sentence) for state in pick(events, "state")]
    assert shown == [("collecting", "STOP"), ("collecting", "STOP HOVER"), ("idle", "")]


def test_finish_drops_an_open_sentence_once(grammar):
    decoder = open_sentence(grammar, 2.0)
    rejected, state = decoder.finish()
    assert (rejected.reason, rejected.text) == ("cancelled", "STOP")
    assert rejected.detail == "the input ended inside the sentence"
    assert (rejected.frame, rejected.time_s, state.state) == (0, 2.0, "idle")
    assert decoder.finish() == []


def test_finish_forgets_a_half_held_sign(grammar, pick):
    decoder = Decoder(grammar, hold=4)
    for _ in range(3):
        decoder.step(Signs.of_tokens("ok", "0"), 0.0)
    assert decoder.finish() == []
    assert not pick(
        [event for _ in range(3) for event in decoder.step(Signs.of_tokens("ok", "0"), 0.0)], "word"
    )
    assert pick(decoder.step(Signs.of_tokens("ok", "0"), 0.0), "word", field="word") == ["STOP"]
