"""What the decoder sees and makes of it, drawn on the frame: for annotated videos and live pictures.

The state of the picture is a frozen value, `advance` leads it over the records of a frame and `render` draws it;
`Overlay` keeps it from frame to frame.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Final, Literal

import cv2
import numpy as np

from lightgesture.console import one_line
from lightgesture.drawing import AMBER, DARK, GREEN, GREY, RED, WHITE, Colour, Pen, letter_for
from lightgesture.features.geometry import turn_box
from lightgesture.features.image import as_bgr8, turned
from lightgesture.features.types import Box, Image
from lightgesture.fsm import Instruction, Notice, Rejected, State
from lightgesture.fsm.events import Growth
from lightgesture.records import CardSign, FrameRecord, Hand, Record, VehicleRecord
from lightgesture.results.words import rejected, unread

Place = Literal["below", "beside", "over"]
"""Where sentence and outcome stand: in a bar under the picture, in one to its right, or on the picture."""

MESSAGE_S: Final = 4.0
"""How long an accepted or rejected instruction stays in view, seconds of the video. 3 to 6 suits readers."""

NOTICE_S: Final = 2.0
"""Likewise for a notice, which never covers an instruction."""

ROWS_BELOW: Final = 4
"""Of the bar under the picture: sentence, hold, outcome, its reason."""

BESIDE_LETTERS: Final = 18
"""Width of the bar beside the picture, heights of a capital letter; about as many letters."""

LOGGED: Final = 12
"""Outcomes that the bar beside the picture may show, the newest first."""


@dataclass(frozen=True, slots=True)
class Message:
    """The line at the top: `text`, why in `detail`, in view until `until_s` of the video's time."""

    text: str
    detail: str
    colour: Colour
    until_s: float
    is_notice: bool


@dataclass(frozen=True, slots=True)
class OverlayState:
    """All that an overlay shows.

    hands, signs: of the latest frame record. sentence: the words so far, empty while idle. dwell: the hold that grows.
    message: None where none is in view. time_s: of the latest record, seconds. log: the last outcomes, newest first.
    """

    hands: tuple[Hand, ...] = ()
    signs: tuple[CardSign, ...] = ()
    sentence: str = ""
    dwell: Growth | None = None
    message: Message | None = None
    time_s: float = 0.0
    log: tuple[Message, ...] = ()


class Overlay:
    """Draws on frame after frame of one stream.

    For boxes and tokens the records of a frame must hold its frame record (`Pipeline(frames=True)`). place: of
    sentence and outcome. rotate: degrees by which the picture is turned clockwise to stand upright, as of `Pipeline`.
    """

    def __init__(self, place: Place = "over", rotate: int = 0) -> None:
        self._place: Place = place
        self._rotate = rotate
        self.state = OverlayState()

    def draw(self, image_bgr: Image, records: Iterable[Record]) -> Image:
        """The frame, any size from 1 × 1, with all that is known after its records; the given picture stays as it is.

        image_bgr: uint8 (height, width, 3), BGR, or what `as_bgr8` makes of it. Gives uint8 (height, width, 3), larger
        by the bar where that stands below or beside.
        """
        self.state = advance(self.state, records)
        return render(image_bgr, self.state, self._place, self._rotate)


def advance(state: OverlayState, records: Iterable[Record]) -> OverlayState:
    """The state after the records of one frame."""
    for record in records:
        time_s = getattr(record, "time_s", None)
        if time_s is not None:
            state = replace(state, time_s=time_s)
        match record:
            case FrameRecord():
                state = replace(state, hands=record.hands, signs=record.signs or ())
            case State():
                state = replace(state, sentence=record.sentence, dwell=record.dwell)
            case Instruction():
                accepted = f"{record.text}  {record.confidence:.0%}"
                state = _say(state, "accepted: " + accepted, "", GREEN)
            case Rejected():
                state = _say(state, "rejected: " + record.text, record.detail or rejected(record.reason), RED)
            case Notice():
                state = _notice(state, record.detail)
            case VehicleRecord():
                state = _say_of_vehicle(state, record)
            case _:
                pass
    message = state.message
    # A clock that was set back must not leave a message in view for ever.
    if message is not None and not message.until_s - MESSAGE_S <= state.time_s < message.until_s:
        return replace(state, message=None)
    return state


def render(image_bgr: Image, state: OverlayState, place: Place = "over", rotate: int = 0) -> Image:
    """A copy of the frame, turned upright, with the state drawn on it and beside it."""
    original = as_bgr8(image_bgr)
    size = original.shape[1], original.shape[0]
    upright = turned(original, rotate)
    height, width = upright.shape[:2]
    letter = letter_for(upright)
    below = ROWS_BELOW * Pen(upright, letter).row if place == "below" else 0
    beside = BESIDE_LETTERS * letter if place == "beside" else 0
    # The copy that is drawn on, with the bar, in one pass.
    whole = cv2.copyMakeBorder(upright, 0, below, 0, beside, cv2.BORDER_CONSTANT, value=DARK)
    canvas = np.asarray(whole, np.uint8)
    pen = Pen(canvas[:height, :width], letter)
    for hand in state.hands:
        draw_hand(pen, hand, turn_box(hand.box, size, rotate))
    for card in state.signs:
        _draw_card(pen, card)
    if place == "over":
        _draw_sentence(pen, state, pen.height - 2 * pen.row)
        if state.message is not None:
            pen.panel(0, 0, pen.width, (2 if state.message.detail else 1) * pen.row)
            _draw_message(pen, state.message, 0)
    elif place == "below":
        _draw_bar_below(Pen(canvas[height:], letter), state)
    else:
        _draw_bar_beside(Pen(canvas[:, width:], letter), state)
    return canvas


def _draw_bar_below(bar: Pen, state: OverlayState) -> None:
    _draw_sentence(bar, state, 0)
    if state.message is not None:
        _draw_message(bar, state.message, 2 * bar.row)


def _draw_bar_beside(bar: Pen, state: OverlayState) -> None:
    room = bar.width - 2 * bar.margin
    bar.write(f"{state.time_s:.1f} s", bar.margin, 0, GREY)
    top = bar.row
    for line in bar.wrap(one_line(state.sentence) or "idle", room, 4):
        bar.write(line, bar.margin, top, WHITE if state.sentence else GREY)
        top += bar.row
    _draw_dwell(bar, state.dwell, top)
    top += 2 * bar.row
    for message in state.log:
        for text, colour in ((message.text, message.colour), (message.detail, WHITE)):
            for line in bar.wrap(text, room, 3):
                bar.write(line, bar.margin, top, colour)
                top += bar.row
        top += bar.margin


def _say(state: OverlayState, text: str, detail: str, colour: Colour) -> OverlayState:
    message = Message(one_line(text), one_line(detail), colour, state.time_s + MESSAGE_S, is_notice=False)
    return replace(state, message=message, log=(message, *state.log)[:LOGGED])


def _say_of_vehicle(state: OverlayState, record: VehicleRecord) -> OverlayState:
    colour = RED if record.state in ("refused", "aborted") else GREEN
    what = " ".join(filter(None, (record.state, record.instruction)))
    return _say(state, f"vehicle: {what}", record.detail, colour)


def _notice(state: OverlayState, detail: str) -> OverlayState:
    shown = state.message
    if shown is not None and not shown.is_notice and state.time_s < shown.until_s:
        return state
    message = Message(one_line(detail), "", AMBER, state.time_s + NOTICE_S, is_notice=True)
    return replace(state, message=message)


def draw_hand(pen: Pen, hand: Hand, box: Box) -> None:
    """A hand with its token, or why it has none; box: where it lies in the pen's picture."""
    is_read = hand.token is not None
    colour = GREEN if is_read else AMBER
    what = f"{hand.token} {hand.confidence:.0%}" if is_read else unread(hand.reason, is_short=True)
    pen.frame(box, colour)
    pen.label(f"{hand.side[0].upper()}: {what}", box, colour)


def _draw_card(pen: Pen, card: CardSign) -> None:
    outline = np.rint(np.array(card.corners)).astype(np.int32)
    colour = GREEN if card.word is not None else AMBER
    width = max(1, round(pen.letter / 6))
    cv2.polylines(pen.picture, [outline.reshape(-1, 1, 2)], True, colour, width, cv2.LINE_AA)
    left, top, wide, tall = cv2.boundingRect(outline)
    side = "" if card.side is None else f"{card.side[0].upper()}: "
    pen.label(one_line(f"{side}{card.word or f'tag {card.id}'}"), (left, top, wide, tall), colour)


def _draw_sentence(pen: Pen, state: OverlayState, top: int) -> None:
    """Two rows from `top` on: the sentence so far with the time, and the hold that grows."""
    pen.panel(0, top, pen.width, 2 * pen.row)
    clock = f"{state.time_s:.1f} s"
    clock_x = pen.width - pen.margin - pen.measure(clock)
    pen.write(clock, clock_x, top, GREY)
    text = pen.fit(one_line(state.sentence) or "idle", clock_x - 3 * pen.margin, keep_end=True)
    pen.write(text, pen.margin, top, WHITE if state.sentence else GREY)
    _draw_dwell(pen, state.dwell, top + pen.row)


def _draw_dwell(pen: Pen, dwell: Growth | None, top: int) -> None:
    left, right = pen.margin, pen.width - pen.margin
    low, high = top + pen.margin // 2, top + pen.row - pen.margin // 2
    colour = GREEN if dwell is not None and dwell.word is not None else AMBER
    if dwell is not None and right > left:
        end = left + round((right - left) * min(max(dwell.progress, 0.0), 1.0))
        pen.panel(left, low, end - left, high - low, colour)
    cv2.rectangle(pen.picture, (left, low), (right, high), GREY, 1)
    if dwell is not None:
        meaning = dwell.word if dwell.word is not None else "no word"
        label = pen.fit(one_line(f"{','.join(dwell.pair)}: {meaning}"), right - left - 2 * pen.margin)
        pen.write(label, left + pen.margin, top, WHITE)


def _draw_message(pen: Pen, message: Message, top: int) -> None:
    """One row from `top` on, two where there is a reason: what was accepted or rejected last."""
    rows = 2 if message.detail else 1
    bar = max(2, pen.margin)
    cv2.rectangle(pen.picture, (0, top), (bar - 1, top + rows * pen.row - 1), message.colour, -1)
    room = pen.width - bar - 2 * pen.margin
    pen.write(pen.fit(message.text, room), bar + pen.margin, top, message.colour)
    if message.detail:
        pen.write(pen.fit(message.detail, room), bar + pen.margin, top + pen.row, WHITE)
