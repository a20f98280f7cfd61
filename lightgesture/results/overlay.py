"""What the decoder sees and makes of it, drawn on the frame: for annotated videos and live pictures.

The state of the picture is a frozen value, `advance` leads it over the records of a frame and `render` draws it;
`Overlay` keeps it from frame to frame.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Final

import cv2
import numpy as np

from lightgesture.console import one_line
from lightgesture.features.image import as_bgr8
from lightgesture.features.types import Image
from lightgesture.fsm import Instruction, Notice, Rejected, State
from lightgesture.fsm.events import Growth
from lightgesture.records import CardSign, FrameRecord, Hand, Record

_Colour = tuple[int, int, int]

_GREEN, _AMBER, _RED = (80, 200, 60), (0, 190, 255), (120, 120, 255)
_WHITE, _GREY, _DARK = (255, 255, 255), (190, 190, 190), (28, 24, 20)

_FONT = cv2.FONT_HERSHEY_SIMPLEX
_MORE = "..."

LETTER_SHARE: Final = 0.032
"""Height of a capital letter as a share of the picture's shorter side; larger hides more."""

LEAST_LETTER: Final = 9
"""Smallest height of a capital letter, pixels; below 8 it cannot be read."""

MESSAGE_S: Final = 4.0
"""How long an accepted or rejected instruction stays in view, seconds of the video. 3 to 6 suits readers."""

NOTICE_S: Final = 2.0
"""Likewise for a notice, which never covers an instruction."""

PANEL_OPACITY: Final = 0.7
"""How much of the picture the panels hide, 0 (nothing) to 1."""


@dataclass(frozen=True, slots=True)
class Message:
    """The line at the top: `text`, why in `detail`, in view until `until_s` of the video's time."""

    text: str
    detail: str
    colour: _Colour
    until_s: float
    is_notice: bool


@dataclass(frozen=True, slots=True)
class OverlayState:
    """All that an overlay shows.

    hands, signs: of the latest frame record. sentence: the words so far, empty while idle. dwell: the hold that grows.
    message: None where none is in view. time_s: of the latest record, seconds.
    """

    hands: tuple[Hand, ...] = ()
    signs: tuple[CardSign, ...] = ()
    sentence: str = ""
    dwell: Growth | None = None
    message: Message | None = None
    time_s: float = 0.0


class Overlay:
    """Draws on frame after frame of one stream.

    For boxes and tokens the records of a frame must hold its frame record (`Pipeline(frames=True)`).
    """

    def __init__(self) -> None:
        self.state = OverlayState()

    def draw(self, image_bgr: Image, records: Iterable[Record]) -> Image:
        """The frame, any size from 1 × 1, with all that is known after its records; the given picture stays as it is.

        image_bgr: uint8 (height, width, 3), BGR, or what `as_bgr8` makes of it. Gives uint8 (height, width, 3).
        """
        self.state = advance(self.state, records)
        return render(image_bgr, self.state)


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
                state = _say(state, "accepted: " + accepted, "", _GREEN)
            case Rejected():
                state = _say(state, "rejected: " + record.text, record.detail, _RED)
            case Notice():
                state = _notice(state, record.detail)
            case _:
                pass
    message = state.message
    # A clock that was set back must not leave a message in view for ever.
    if message is not None and not message.until_s - MESSAGE_S <= state.time_s < message.until_s:
        return replace(state, message=None)
    return state


def render(image_bgr: Image, state: OverlayState) -> Image:
    """A copy of the frame with the state drawn on it."""
    picture = np.array(as_bgr8(image_bgr), copy=True)
    letter = max(LEAST_LETTER, round(min(picture.shape[:2]) * LETTER_SHARE))
    pen = _Pen(picture, letter)
    for hand in state.hands:
        _draw_hand(pen, hand)
    for card in state.signs:
        _draw_card(pen, card)
    _draw_sentence(pen, state)
    if state.message is not None:
        _draw_message(pen, state.message)
    return picture


def _say(state: OverlayState, text: str, detail: str, colour: _Colour) -> OverlayState:
    message = Message(one_line(text), one_line(detail), colour, state.time_s + MESSAGE_S, is_notice=False)
    return replace(state, message=message)


def _notice(state: OverlayState, detail: str) -> OverlayState:
    shown = state.message
    if shown is not None and not shown.is_notice and state.time_s < shown.until_s:
        return state
    message = Message(one_line(detail), "", _AMBER, state.time_s + NOTICE_S, is_notice=True)
    return replace(state, message=message)


class _Pen:
    """Draws texts and panels at one size of letters on one picture.

    letter: height of a capital, pixels. A row is as high as a line of text with its margins.
    """

    def __init__(self, picture: Image, letter: int) -> None:
        self.picture = picture
        self.height, self.width = picture.shape[:2]
        self.letter = letter
        self.margin = max(2, letter // 2)
        self.row = letter + 2 * self.margin
        self._stroke = max(1, round(letter / 9))
        unit = cv2.getTextSize("X", _FONT, 1.0, 1)[0][1]
        self._scale = letter / unit

    def measure(self, text: str) -> int:
        """Width of a text, pixels."""
        return int(cv2.getTextSize(text, _FONT, self._scale, self._stroke)[0][0])

    def fit(self, text: str, width: int, keep_end: bool = False) -> str:
        """As much of the text as `width` pixels hold, with dots where something is left out."""
        if self.measure(text) <= width:
            return text
        for count in range(len(text) - 1, 0, -1):
            short = _MORE + text[-count:] if keep_end else text[:count] + _MORE
            if self.measure(short) <= width:
                return short
        return ""

    def write(self, text: str, x: int, top: int, colour: _Colour) -> None:
        """A text in the row that begins at `top`."""
        baseline = top + self.margin + self.letter
        cv2.putText(self.picture, text, (x, baseline), _FONT, self._scale, colour, self._stroke, cv2.LINE_AA)

    def panel(self, x: int, y: int, width: int, height: int, colour: _Colour = _DARK) -> None:
        """A rectangle through which the picture is dimly seen, cut at the picture's edges."""
        part = self.picture[max(y, 0) : max(y + height, 0), max(x, 0) : max(x + width, 0)]
        if part.size:
            plain = np.full_like(part, colour)
            part[...] = cv2.addWeighted(part, 1.0 - PANEL_OPACITY, plain, PANEL_OPACITY, 0.0)


def _draw_hand(pen: _Pen, hand: Hand) -> None:
    x, y, width, height = hand.box
    colour = _GREEN if hand.token is not None else _AMBER
    cv2.rectangle(pen.picture, (x, y), (x + width, y + height), colour, max(1, round(pen.letter / 6)))
    what = f"{hand.token} {hand.confidence:.0%}" if hand.token is not None else f"? {hand.reason}"
    _label(pen, f"{hand.side[0].upper()}: {what}", (x, y), colour)


def _draw_card(pen: _Pen, card: CardSign) -> None:
    outline = np.rint(np.array(card.corners)).astype(np.int32)
    colour = _GREEN if card.word is not None else _AMBER
    width = max(1, round(pen.letter / 6))
    cv2.polylines(pen.picture, [outline.reshape(-1, 1, 2)], True, colour, width, cv2.LINE_AA)
    x, y = outline.min(axis=0).tolist()
    side = "" if card.side is None else f"{card.side[0].upper()}: "
    _label(pen, f"{side}{card.word or f'tag {card.id}'}", (x, y), colour)


def _label(pen: _Pen, text: str, corner: tuple[int, int], colour: _Colour) -> None:
    """A text above what has its upper left corner there, or inside where the picture ends; never out of the picture at
    the sides."""
    x, y = corner
    label = pen.fit(one_line(text), pen.width - 2 * pen.margin)
    wide = pen.measure(label) + 2 * pen.margin
    left = max(0, min(x, pen.width - wide))
    top = y - pen.row if y >= pen.row else y
    pen.panel(left, top, wide, pen.row)
    pen.write(label, left + pen.margin, top, colour)


def _draw_sentence(pen: _Pen, state: OverlayState) -> None:
    """The lowest two rows: the sentence so far with the time, and the hold that grows."""
    top = pen.height - 2 * pen.row
    pen.panel(0, top, pen.width, 2 * pen.row)
    clock = f"{state.time_s:.1f} s"
    clock_x = pen.width - pen.margin - pen.measure(clock)
    pen.write(clock, clock_x, top, _GREY)
    text = pen.fit(one_line(state.sentence) or "idle", clock_x - 3 * pen.margin, keep_end=True)
    pen.write(text, pen.margin, top, _WHITE if state.sentence else _GREY)
    _draw_dwell(pen, state.dwell, top + pen.row)


def _draw_dwell(pen: _Pen, dwell: Growth | None, top: int) -> None:
    left, right = pen.margin, pen.width - pen.margin
    low, high = top + pen.margin // 2, top + pen.row - pen.margin // 2
    colour = _GREEN if dwell is not None and dwell.word is not None else _AMBER
    if dwell is not None and right > left:
        end = left + round((right - left) * min(max(dwell.progress, 0.0), 1.0))
        pen.panel(left, low, end - left, high - low, colour)
    cv2.rectangle(pen.picture, (left, low), (right, high), _GREY, 1)
    if dwell is not None:
        meaning = dwell.word if dwell.word is not None else "no word"
        label = pen.fit(one_line(f"{','.join(dwell.pair)}: {meaning}"), right - left - 2 * pen.margin)
        pen.write(label, left + pen.margin, top, _WHITE)


def _draw_message(pen: _Pen, message: Message) -> None:
    """The highest row, two where there is a reason: what was accepted or rejected last."""
    rows = 2 if message.detail else 1
    pen.panel(0, 0, pen.width, rows * pen.row)
    bar = max(2, pen.margin)
    cv2.rectangle(pen.picture, (0, 0), (bar - 1, rows * pen.row - 1), message.colour, -1)
    room = pen.width - bar - 2 * pen.margin
    pen.write(pen.fit(message.text, room), bar + pen.margin, 0, message.colour)
    if message.detail:
        pen.write(pen.fit(message.detail, room), bar + pen.margin, pen.row, _WHITE)
