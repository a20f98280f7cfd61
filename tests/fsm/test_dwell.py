"""Holds and releases: one held sign is one word."""

import pytest

from lightgesture.fsm import Decoder, Signs
from lightgesture.fsm.rules.dwell import Dwell, release_frames


def held(dwell: Dwell, pattern: str) -> list[int]:
    """Frames at which a hold was long enough; a letter is a pair, a dot none."""
    pairs = [None if letter == "." else (letter, letter) for letter in pattern]
    return [
        frame for frame, pair in enumerate(pairs) if dwell.process(pair, 1.0, frame, 0.0, 0.0) is not None
    ]


@pytest.mark.parametrize(
    ("hold", "frames"), [(1, 1), (2, 1), (3, 1), (7, 1), (8, 2), (15, 3), (20, 4), (30, 6), (1000, 200)]
)
def test_release_is_a_fifth_of_the_hold_and_at_least_one_frame(hold, frames):
    assert release_frames(hold, 0.2) == frames


@pytest.mark.parametrize(
    ("pattern", "expected"),
    [
        ("aaaa", []),
        ("aaaaa", [4]),
        ("aaaaaaaaaaaaaaa", [4]),  # held on: still one word
        ("aaaa.aaaa", []),  # four and four are not five in a row
        ("aaaabaaaa", []),
        ("aaaa.aaaaa", [9]),
        ("aaaaa.aaaaaaaa", [4]),  # absent for one frame, two are needed
        ("aaaaabaaaaaaaa", [4]),
        ("aaaaa..aaaaa", [4, 11]),
        ("aaaaa.baaaaa", [4, 11]),
        ("aaaaa.a.a.a.aaaaa", [4]),  # never absent for two frames together
        ("aaaaabbbbb", [4, 9]),  # another pair needs no gap
        ("aaaaabbbbbaaaaa", [4, 9, 14]),
        ("aaaaabaaaabbbbb", [4, 14]),
    ],
)
def test_hold_of_five_and_release_of_two(pattern, expected):
    assert held(Dwell(5, 2), pattern) == expected


def test_hold_of_one_frame_still_needs_a_release():
    assert held(Dwell(1, 1), "aaab.aa") == [0, 3, 5]


def test_release_is_never_longer_than_the_hold():
    assert held(Dwell(2, 9), "aabbaa..aa") == [1, 3, 5, 9]


def test_a_hold_counts_its_sightings_and_keeps_the_first():
    dwell = Dwell(2, 1)
    dwell.process(("5", "1"), 0.2, 6, 0.6, 0.6)
    dwell.process(("5", "5"), 0.8, 7, 0.7, 0.7)
    hold = dwell.process(("5", "5"), 0.4, 8, 0.8, 0.8)
    assert (hold.pair, hold.frames, hold.first_frame, hold.first_time_s) == (("5", "5"), 2, 7, 0.7)
    assert hold.confidence == pytest.approx(0.6)


def test_discarded_hold_needs_a_release():
    dwell = Dwell(5, 2)
    held(dwell, "aaa")
    dwell.discard()
    assert held(dwell, "aaaaaaa..aaaaa") == [13]


def test_discard_keeps_an_unreleased_pair():
    dwell = Dwell(5, 2)
    held(dwell, "aaaaab")
    dwell.discard()
    assert held(dwell, "aaaaaaa") == []


def test_discard_of_nothing_changes_nothing():
    dwell = Dwell(2, 1)
    dwell.discard()
    assert held(dwell, "aa") == [1]


def test_default_hold_is_fifteen_frames(grammar):
    decoder = Decoder(grammar, rule="frames")
    types = [[event.type for event in decoder.step(Signs.of_tokens("ok", "0"), 0.0)] for _ in range(16)]
    assert [frame for frame, seen in enumerate(types) if "word" in seen] == [14]


def test_hold_comes_from_the_grammar_unless_given(write_grammar):
    from lightgesture.fsm import load_grammar

    language = load_grammar(write_grammar(("hold = 15", "hold = 4"), ("release = 0.2", "release = 0.5")))
    for hold, first in ((None, 3), (6, 5)):
        decoder = Decoder(language, rule="frames", hold=hold)
        seen = [decoder.step(Signs.of_tokens("ok", "0"), 0.0) for _ in range(8)]
        accepted = [i for i, events in enumerate(seen) if any(event.type == "word" for event in events)]
        assert accepted == [first]


@pytest.mark.parametrize("hold", [0, -1])
def test_hold_below_one_is_refused(grammar, hold):
    with pytest.raises(ValueError, match=f"hold is {hold} frames; use a whole number from 1"):
        Decoder(grammar, hold=hold)


def test_repeated_digit_needs_a_release(new_diver, pick):
    diver = new_diver(hold=15, gap=3)
    diver.words("STOP HOVER")
    assert pick(diver.show("ok,5", 60), "word", field="word") == ["5"]
    diver.show(None, 2)
    assert not pick(diver.show("ok,5", 60), "word")
    diver.show(None, 3)
    assert pick(diver.show("ok,5", 60), "word", field="word") == ["5"]
    assert diver.decoder.sentence == "STOP HOVER 55"


def test_start_sign_held_on_is_not_read_as_the_digit_it_also_is(diver, pick):
    events = diver.show("ok,0", 200)
    assert pick(events, "word", field="word") == ["STOP"]
    assert not pick(events, "rejected", "notice")


def test_unknown_pair_is_reported_once_a_hold(diver, pick):
    assert len(pick(diver.show("3,left", 50), "notice")) == 1
    diver.show(None, 1)
    assert len(pick(diver.show("3,left", 50), "notice")) == 1
