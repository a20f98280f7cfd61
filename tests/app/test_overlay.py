"""The overlay: what it shows, for how long, and that no picture is too small for it."""

import numpy as np
import pytest

from lightgesture.fsm import Notice, Rejected, State
from lightgesture.fsm.events import Growth
from lightgesture.records import FrameRecord, Hand
from lightgesture.results.overlay import Overlay, OverlayState, advance, render
from lightgesture.results.words import rejected as rejected_words
from lightgesture.results.words import unread
from tests.makers import hover

HAND = Hand(side="left", token="ok", confidence=0.93, box=(40, 60, 50, 40), track=1, reason=None)
REFUSED = Hand(side="right", token=None, confidence=0.3, box=(-9, -5, 80, 70), track=2, reason="partial")


def frame(time_s, *hands):
    return FrameRecord(source="a", frame=0, time_s=time_s, hands=hands)


def state(time_s, sentence="STOP HOVER", dwell=None):
    return State(source="a", frame=0, time_s=time_s, state="collecting", sentence=sentence, dwell=dwell)


def instruction(time_s, text="STOP HOVER 50 GO"):
    return hover(time_s=time_s, text=text)


def rejected(time_s, detail="program 5 is not in [programs]"):
    return Rejected(source="a", frame=0, time_s=time_s, reason="limit", text="STOP EXEC 5 GO", detail=detail)


def notice(time_s):
    return Notice(source="a", frame=0, time_s=time_s, reason="unknown_pair", detail="3,left is no word")


DWELL = Growth(pair=("ok", "5"), word="5", progress=0.4)


def test_state_follows_the_records():
    after = advance(OverlayState(), [frame(1.5, HAND), state(1.5, dwell=DWELL)])
    assert (after.hands, after.sentence, after.dwell, after.time_s) == ((HAND,), "STOP HOVER", DWELL, 1.5)
    assert advance(after, [frame(1.6)]).hands == ()
    assert advance(after, [frame(1.6)]).sentence == "STOP HOVER"


def test_message_is_in_view_for_a_while():
    after = advance(OverlayState(), [instruction(10.0)])
    assert after.message.text == "accepted: STOP HOVER 50 GO  95%"
    assert advance(after, [frame(13.9)]).message == after.message
    assert advance(after, [frame(14.0)]).message is None
    assert advance(after, [frame(2.0)]).message is None, "the clock was set back"


def test_a_notice_covers_no_instruction():
    after = advance(OverlayState(), [rejected(1.0), notice(2.0)])
    assert after.message.text == "rejected: STOP EXEC 5 GO"
    assert advance(after, [notice(5.5)]).message.text == "3,left is no word"


@pytest.mark.parametrize("size", [(1, 1), (7, 5), (48, 64), (240, 320), (1080, 1920)])
@pytest.mark.parametrize("hands", [(), (HAND, REFUSED)])
def test_any_size(size, hands):
    image = np.full((*size, 3), 120, np.uint8)
    drawn = Overlay().draw(image, [frame(0.0, *hands), state(0.0, dwell=DWELL), rejected(0.0)])
    assert (drawn.shape, drawn.dtype) == (image.shape, np.uint8)
    assert (image == 120).all()
    assert (drawn != image).any()


def test_grey_pictures_and_views_are_drawn_in_colours():
    assert render(np.zeros((50, 60), np.uint8), OverlayState()).shape == (50, 60, 3)
    assert render(np.zeros((50, 60, 3), np.uint8)[::-1, ::-1], OverlayState()).shape == (50, 60, 3)


def test_longest_texts_stay_in_the_picture_and_hostile_ones_do_no_harm():
    image = np.zeros((240, 320, 3), np.uint8)
    overlay = Overlay()
    text = "STOP \n\x00 %s {} ダイバー " * 30
    dwell = Growth(pair=("ok", "5"), word=text, progress=7.0)
    drawn = overlay.draw(image, [state(1.0, text, dwell), instruction(1.0, text), rejected(1.0, text)])
    assert drawn[:, -2:].max() < 100, "letters run out of the picture"


def test_what_is_seen_of_the_hold_grows():
    image = np.zeros((240, 320, 3), np.uint8)
    shares = []
    for progress in (0.0, 0.5, 1.0):
        growth = Growth(pair=("ok", "5"), word="5", progress=progress)
        bar = render(image, OverlayState(dwell=growth))[-8:-4]
        shares.append(float((bar[..., 1] > bar[..., 2] + 60).mean()))
    assert shares[0] < 0.05 < shares[1] < 0.6 < shares[2]


@pytest.mark.parametrize("size", [(1, 1), (48, 64), (240, 320), (1080, 1920)])
@pytest.mark.parametrize("place", ["below", "beside"])
def test_a_bar_covers_nothing(size, place):
    image = np.full((*size, 3), 120, np.uint8)
    overlay = Overlay(place)
    drawn = overlay.draw(image, [state(0.0, "STOP HOVER 5", DWELL), rejected(0.0), instruction(0.5)])
    assert (drawn[: size[0], : size[1]] == image).all()
    grown = drawn.shape[0] > size[0] if place == "below" else drawn.shape[1] > size[1]
    assert grown
    again = overlay.draw(image, [state(9.0, ""), notice(9.0)])
    assert again.shape == drawn.shape, "a video keeps its size"


def test_hands_stand_where_the_picture_was_turned_to():
    image = np.zeros((100, 200, 3), np.uint8)
    hand = Hand(side="left", token="ok", confidence=0.9, box=(150, 10, 40, 30), track=1, reason=None)
    drawn = Overlay(rotate=90).draw(image, [frame(0.0, hand)])
    assert drawn.shape == (200, 100, 3)
    assert drawn[150:190, 60].max() > 150, "the left edge of the box"


def test_reasons_stand_in_words():
    assert unread("low_confidence", is_short=True) == "unsure"
    assert unread("of_my_own") == "of my own"
    assert rejected_words("unread_sign") == "a sign was not read"
    after = advance(OverlayState(), [rejected(1.0, detail="")])
    assert after.message.detail == "too long or too large"
