"""What cameras, cables and clocks do to frames, by every rule: what was signed is issued, or nothing, with a reason."""

import random

import pytest

from lightgesture.fsm import Instruction
from tests.app.faults.streams import FAULTS, Shown, half_decoded

SIGNED = "STOP HOVER 50 GO"
MILD = ("doubled", "reordered")
"""What leaves a sentence that can be read."""

DIGIT, END = 108, 222
"""Frames of the clip: the first digit is held, and the hands are on their way to the end word."""

QUICK, WHOLE = 397, 47
"""Every so many places of a fault are tried."""


def check(events):
    """Nothing but what was signed is issued, and where a sentence comes to nothing the reason is told; how many are."""
    issued = [event.text for event in events if isinstance(event, Instruction)]
    told = [event for event in events if event.type in ("rejected", "notice")]
    assert set(issued) <= {SIGNED}, told
    assert all(one.reason and one.detail for one in told)
    # A sentence that was begun never vanishes without a word.
    assert issued or told or not any(event.type == "word" for event in events)
    return len(issued)


def check_all(reader, fault, step):
    counts = [check(reader.events(shown)) for shown in FAULTS[fault](reader.frames, step)]
    print(
        f"{fault}, {reader.pipeline.decoder.rule}: issued in {sum(map(bool, counts))} of {len(counts)} streams"
    )
    assert fault not in MILD or all(counts)


def test_the_clip_as_it_is_is_read(reader):
    assert check(reader.events(reader.frames)) == 1


@pytest.mark.parametrize("fault", FAULTS)
def test_nothing_is_issued_that_was_not_signed(reader, fault):
    check_all(reader, fault, QUICK)


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
def test_nothing_is_issued_that_was_not_signed_wherever_it_happens(reader, fault):
    check_all(reader, fault, WHOLE)


def test_a_picture_that_stands_still_over_the_number_drops_the_sentence(reader):
    """From the first digit to the end word: what is left reads as STOP HOVER 5 GO."""
    held = reader.frames[DIGIT]
    shown = [
        Shown(frame.time_s, held.image.copy(), held.signs) if DIGIT <= place < END else frame
        for place, frame in enumerate(reader.frames)
    ]
    events = reader.events(shown)
    assert check(events) == 0
    details = [event.detail for event in events if event.type == "notice" and event.reason == "gap"]
    assert "the picture stands still" in details[0]
    assert "no new picture" in details[1]


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.05, 0.3, 1.0])
def test_half_decoded_pictures(reader, share):
    """By their pixels: the lower part of some pictures is grey, or one row again and again."""
    rng = random.Random(f"{share}")
    shown = [
        (frame.time_s, half_decoded(frame.image, rng) if rng.random() < share else frame.image)
        for frame in reader.whole
    ]
    count = check(reader.records(shown))
    assert count == 1 or share > 0.05


@pytest.mark.slow
@pytest.mark.parametrize("fault", ["black", "frozen", "dropped"])
def test_pictures_that_are_read_anew_give_the_same(reader, fault):
    """By their pixels: so that what follows hands over such frames takes part."""
    for shown in list(FAULTS[fault](reader.whole, 400))[-4:]:
        check(reader.records([(frame.time_s, frame.image) for frame in shown]))
