"""The records: exactly the documented keys, in the documented order."""

import dataclasses
import json
import pickle

import pytest

from lightgesture.fsm import Decoder, Instruction, Notice, Rejected, Signs, State, Word

KEYS = {
    "word": "type source frame time_s utc pair word state confidence",
    "instruction": "type source frame time_s utc start_frame start_time_s text kind action duration_s program "
    "parameter change confidence words",
    "rejected": "type source frame time_s utc reason text detail",
    "state": "type source frame time_s utc state sentence dwell",
    "notice": "type source frame time_s utc reason detail",
}


@pytest.fixture
def events(new_diver):
    diver = new_diver(hold=15, gap=3, source="dive.mp4")
    return diver.words("STOP HOVER 5 AND 0 GO STOP EXEC 5 GO") + diver.pairs(["3,left"])


def test_keys_stand_in_the_documented_order(events):
    assert {event.type for event in events} == set(KEYS)
    for event in events:
        assert list(event.to_dict()) == KEYS[event.type].split()


def test_records_are_plain_json(events):
    for event in events:
        assert json.loads(json.dumps(event.to_dict(), allow_nan=False)) == event.to_dict()


def test_events_are_frozen_slotted_and_can_be_sent_between_processes(events):
    for event in events:
        assert pickle.loads(pickle.dumps(event)) == event
        assert not hasattr(event, "__dict__")
        with pytest.raises(dataclasses.FrozenInstanceError):
            event.source = "other"


def test_every_event_names_its_source(events):
    assert {event.source for event in events} == {"dive.mp4"}


def test_instruction_record_in_full(events, pick):
    (instruction,) = pick(events, "instruction")
    assert instruction.to_dict() == {
        "type": "instruction",
        "source": "dive.mp4",
        "frame": 104,
        "time_s": 104 / 30,
        "utc": None,
        "start_frame": 0,
        "start_time_s": 0.0,
        "text": "STOP HOVER 50 GO",
        "kind": "task",
        "action": "HOVER",
        "duration_s": 50,
        "program": None,
        "parameter": None,
        "change": None,
        "confidence": 1.0,
        "words": ["STOP", "HOVER", "5", "AND", "0", "GO"],
    }


def test_word_tells_the_sentence_so_far_and_idle_after_the_end(events, pick):
    assert pick(events, "word", field="state")[:6] == [
        "STOP",
        "STOP HOVER",
        "STOP HOVER 5",
        "STOP HOVER 5 AND",
        "STOP HOVER 50",
        "idle",
    ]
    assert pick(events, "word")[1].to_dict() == {
        "type": "word",
        "source": "dive.mp4",
        "frame": 32,
        "time_s": 32 / 30,
        "utc": None,
        "pair": ["5", "5"],
        "word": "HOVER",
        "state": "STOP HOVER",
        "confidence": 1.0,
    }


def test_state_record_of_a_growing_hold(events, pick):
    growing = next(event for event in pick(events, "state") if event.dwell and event.sentence == "STOP HOVER")
    assert growing.to_dict()["dwell"] == {"pair": ["ok", "5"], "word": "5", "progress": 0.2667}
    assert growing.state == "collecting"


def test_hold_of_no_word_is_shown_as_such(new_diver, pick):
    growing = pick(new_diver(hold=15).show("3,left", 3), "state")[0]
    assert growing.to_dict()["dwell"] == {"pair": ["3", "left"], "word": None, "progress": 0.0667}


def test_start_is_the_first_frame_of_the_hold_that_was_accepted(new_diver, pick):
    diver = new_diver(hold=15, gap=3)
    diver.show("ok,0", 10)  # broken off
    diver.show(None, 7)
    (instruction,) = pick(diver.words("STOP HOVER GO"), "instruction")
    assert (instruction.start_frame, instruction.start_time_s) == (17, 17 / 30)


def test_frames_are_counted_where_none_are_given(grammar, pick):
    decoder = Decoder(grammar, hold=2)
    events = [event for _ in range(3) for event in decoder.step(Signs.of_tokens("ok", "0"), 0.0)]
    assert pick(events, "word", field="frame") == [1]
    decoder.step(Signs.of_tokens("5", "5"), 0.0, frame=40)
    assert pick(decoder.step(Signs.of_tokens("5", "5"), 0.0), "word", field="frame") == [41]


def test_word_confidence_is_the_mean_over_the_hold_of_the_lower_hand(new_diver, pick):
    diver = new_diver(hold=2)
    diver.show("ok,0", 1, 0.9, 0.6)
    (word,) = pick(diver.show("ok,0", 1, 0.8, 1.0), "word")
    assert word.confidence == 0.7


def test_instruction_confidence_is_that_of_its_weakest_word(new_diver, pick):
    diver = new_diver(hold=2)
    events = []
    for pair, confidence in (("ok,0", 0.9), ("5,5", 0.75), ("ok,ok", 0.95)):
        events += diver.show(pair, 2, confidence, 1.0)
    assert pick(events, "instruction", field="confidence") == [0.75]


def test_types_can_be_told_apart_by_class(events):
    classes = {
        Word: "word",
        Instruction: "instruction",
        Rejected: "rejected",
        State: "state",
        Notice: "notice",
    }
    assert all(classes[type(event)] == event.type for event in events)
