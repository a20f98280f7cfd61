"""Records in plain words, for people."""

import math
from collections.abc import Callable, Sequence

from lightgesture.console import one_line
from lightgesture.fsm import Instruction, Notice, Rejected
from lightgesture.records import CardSign, FrameRecord, Hand, Record, SummaryRecord, VehicleRecord
from lightgesture.results.words import unread


class TextPrinter:
    """Prints the lines of one input through `print_line`, its name before the first."""

    def __init__(self, print_line: Callable[[str], None], name: str) -> None:
        self._print_line = print_line
        self._heading: str | None = one_line(name)

    def write(self, record: Record) -> None:
        """Print the line of a record, if it has one."""
        line = describe(record)
        if line is None:
            return
        if self._heading is not None:
            self._print_line(self._heading)
            self._heading = None
        self._print_line(one_line(line))


def describe(record: Record) -> str | None:
    """The line for a record of a stream; None for records that are for programs and displays only."""
    match record:
        case Instruction():
            return _timed(record.time_s, f"{record.text}  (confidence {record.confidence:.2f})")
        case Rejected():
            return _timed(record.time_s, f"rejected: {record.text}  ({record.detail})")
        case Notice():
            return _timed(record.time_s, f"notice: {record.detail}")
        case VehicleRecord():
            what = " ".join(filter(None, (record.state, record.instruction)))
            return _timed(record.time_s, f"vehicle: {what}  ({record.detail})")
        case SummaryRecord():
            return _summary(record)
        case _:
            return None


def describe_hands(record: FrameRecord) -> list[str]:
    """A line for each hand of a single picture, the diver's own right hand first, or for each card."""
    if record.signs is not None:
        return [_card(card) for card in record.signs] or ["  no card found"]
    hands = sorted(record.hands, key=lambda hand: hand.side, reverse=True)
    return [_hand(hand) for hand in hands] or ["  no hand found"]


def _timed(time_s: float, text: str) -> str:
    return f"{time_s:9.2f} s  {text}"


def _summary(record: SummaryRecord) -> str:
    counts = f"{_count(record.instructions, 'instruction')}, {record.rejected} rejected"
    frames = f"{_count(record.frames, 'frame')} in {record.seconds:.2f} s"
    speed = f"{record.ms_per_frame['median']:.2f} ms a frame" if "median" in record.ms_per_frame else ""
    status = "" if record.status == "ok" else record.status
    return "  " + "; ".join(part for part in (counts, frames, speed, status) if part)


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _card(card: CardSign) -> str:
    side = math.sqrt(abs(_area(card.corners)))
    place = f"{side:.0f} pixels wide, margin {card.margin:.0f}"
    return f"  tag {card.id}: {card.word or 'no word of the grammar'}  ({place})"


def _area(corners: Sequence[tuple[float, float]]) -> float:
    """Of a polygon, by the shoelace formula; its sign tells which way round it goes."""
    following = [*corners[1:], corners[0]]
    return 0.5 * sum(
        x * next_y - next_x * y for (x, y), (next_x, next_y) in zip(corners, following, strict=True)
    )


def _hand(hand: Hand) -> str:
    x, y, width, height = hand.box
    reading = hand.token or f"not read: {unread(hand.reason)}"
    place = f"{width} x {height} pixels at {x}, {y}"
    return f"  {hand.side} hand: {reading}  (confidence {hand.confidence:.2f}; {place})"
