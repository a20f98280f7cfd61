"""Holes in the stream: no hold and no sentence spans one."""

import pytest

from lightgesture.fsm import Decoder, Signs


def test_an_open_sentence_is_dropped(diver, pick):
    diver.words("STOP HOVER")
    events = diver.decoder.interrupt("no frame from 1 to 9 s", 9.0, 270)
    notice, rejected, state = events
    assert (notice.type, notice.reason, notice.detail) == ("notice", "gap", "no frame from 1 to 9 s")
    assert (rejected.reason, rejected.text) == ("timeout", "STOP HOVER")
    assert (rejected.frame, rejected.time_s) == (270, 9.0)
    assert "no frame from 1 to 9 s" in rejected.detail
    assert (state.state, diver.decoder.state) == ("idle", "idle")
    diver.frame = 270
    assert pick(diver.words("5 GO"), "instruction") == []
    assert pick(diver.words("STOP HOVER GO"), "instruction", field="text") == ["STOP HOVER GO"]


def test_without_a_sentence_it_is_only_told(diver, pick):
    events = diver.decoder.interrupt("a hole", 2.0)
    assert [event.type for event in events] == ["notice"]
    diver.frame = 60
    assert pick(diver.words("STOP HOVER GO"), "instruction", field="text") == ["STOP HOVER GO"]


@pytest.mark.parametrize("hold", [{"hold": 4}, {"rule": "seconds", "hold_seconds": 0.1}])
def test_a_hold_does_not_span_it(grammar, pick, hold):
    decoder = Decoder(grammar, **hold)
    stop = Signs.of_tokens("ok", "0")
    events = [event for frame in range(3) for event in decoder.step(stop, frame / 30, frame)]
    events += decoder.interrupt("a hole", 1.0, 30)
    events += [event for frame in range(30, 33) for event in decoder.step(stop, frame / 30, frame)]
    assert pick(events, "word") == []
    assert pick(decoder.step(stop, 33 / 30, 33), "word", field="word") == ["STOP"]


def test_a_sign_half_held_inside_a_sentence_needs_a_release(diver, pick):
    """Outside the sentence it may mean something else."""
    diver.words("STOP HOVER")
    diver.show("ok,0", 2)
    diver.decoder.interrupt("a hole", 3.0, 90)
    diver.frame = 90
    assert pick(diver.show("ok,0", 9), "word") == []
