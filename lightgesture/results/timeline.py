"""The timeline picture of a video: signs of both hands, readings, words, instructions and rejections over time."""

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from lightgesture.console import one_line
from lightgesture.fsm import Instruction, Notice, Rejected, State, Word
from lightgesture.models import CLASSES, NONE
from lightgesture.records import FrameRecord, Record
from lightgesture.results.atomic import replacing
from lightgesture.results.ownership import SOFTWARE
from lightgesture.results.readings_panel import draw_readings, has_readings
from lightgesture.results.words import rejected

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NOT_READ = "not read"
TOKENS = (NOT_READ, *(token for token in CLASSES if token != NONE))
"""The first rows of the picture, from the bottom: a hand without a token stands in the lowest, own signs above."""

HEIGHT_IN: Final = 7.0
"""Height of the picture, inches."""

READINGS_IN: Final = 2.0
"""What the readings of the rule sentence add to it, inches."""

LEAST_WIDTH_IN: Final = 10.0
"""Least width of the picture, inches."""

WIDTH_LIMIT_IN: Final = 40.0
"""Largest width of the picture, inches."""

INCHES_PER_S: Final = 0.6
"""Width of a second between these two, enough for two words."""

DOTS_PER_INCH: Final = 100
"""Of the PNG."""

LEAST_SPAN_S: Final = 0.1
"""What the axis shows of a single frame, seconds."""

_HANDS = {"left": ("#1f77b4", 0.15), "right": ("#d95f02", -0.15)}
"""Side to the colour of its dots and how far they stand above the row of their token."""

_CARD = ("#1f77b4", 0.0)
"""The same of cards, which either hand may hold."""

_WORD, _GOOD, _BAD = "#444444", "#2a9d4a", "#c0392b"
_LEVELS = 3

TURN_SHARE: Final = 0.6
"""Share of the picture's time after which a text stands to the left of its place."""


@dataclass(slots=True)
class Timeline:
    """What the picture shows, collected record by record."""

    hands: dict[str, tuple[list[float], list[int]]] = field(
        default_factory=lambda: {side: ([], []) for side in _HANDS}
    )
    words: list[Word] = field(default_factory=list)
    instructions: list[Instruction] = field(default_factory=list)
    rejections: list[Rejected] = field(default_factory=list)
    states: list[State] = field(default_factory=list)
    repeats: list[Notice] = field(default_factory=list)
    end_s: float = 0.0
    rows: list[str] = field(default_factory=lambda: list(TOKENS))

    def write(self, record: Record) -> None:
        """Take in a record."""
        match record:
            case FrameRecord(time_s=float() as time_s):
                self.end_s = max(self.end_s, time_s)
                for hand in record.hands:
                    self._put(hand.side, hand.token or NOT_READ, time_s)
                for card in record.signs or ():
                    self._put(card.side or "", card.word or NOT_READ, time_s)
            case Word():
                self.words.append(record)
            case Instruction():
                self.instructions.append(record)
            case Rejected():
                self.rejections.append(record)
            case State(certainty=certainty) if certainty is not None:
                self.states.append(record)
            case Notice(reason="repeat"):
                self.repeats.append(record)
            case _:
                pass

    def _put(self, side: str, sign: str, time_s: float) -> None:
        """A dot in the row of a sign, which is added where it is new."""
        times, rows = self.hands.setdefault(side, ([], []))
        times.append(time_s)
        if sign not in self.rows:
            self.rows.append(sign)
        rows.append(self.rows.index(sign))


@contextmanager
def open_plot(path: Path, name: str) -> Iterator[Timeline]:
    """Collect records and draw the `.png` file when the block ends well; name: of the video.

    Needs the extra `plots`.
    """
    with replacing(path) as temporary:
        timeline = Timeline()
        yield timeline
        draw_timeline(timeline, name, temporary)


def draw_timeline(timeline: Timeline, name: str, path: Path) -> None:
    """Draw the picture to `path`, PNG whatever its name. OSError: it cannot be written."""
    from matplotlib.figure import Figure

    span_s = max(timeline.end_s, LEAST_SPAN_S)
    width = min(max(LEAST_WIDTH_IN, span_s * INCHES_PER_S), WIDTH_LIMIT_IN)
    is_sentence = has_readings(timeline.states)
    height = HEIGHT_IN + READINGS_IN * is_sentence
    figure = Figure(figsize=(width, height), layout="constrained")
    ratios = (5, *(2.2,) * is_sentence, 1.6, 1.8)
    signs, *readings, said, issued = figure.subplots(len(ratios), 1, sharex=True, height_ratios=ratios)
    for axes in readings:
        draw_readings(axes, timeline.states, timeline.repeats)
    signs.set_title(one_line(name), parse_math=False, loc="left")
    _draw_signs(signs, timeline)
    _draw_words(said, timeline.words)
    _draw_outcomes(issued, timeline)
    issued.set_xlim(0, span_s * 1.02)
    issued.set_xlabel("time, seconds")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # signs of a name that the font lacks are drawn as boxes
        figure.savefig(path, format="png", dpi=DOTS_PER_INCH, metadata={"Software": SOFTWARE})


def _draw_signs(axes: "Axes", timeline: Timeline) -> None:
    for side, (times, rows) in timeline.hands.items():
        colour, shift = _HANDS.get(side, _CARD)
        heights = [row + shift for row in rows]
        label = f"{side} hand" if side else "cards"
        axes.scatter(times, heights, s=9, c=colour, marker="s", linewidths=0, label=label)
    axes.set_yticks(range(len(timeline.rows)), timeline.rows)
    axes.set_ylim(-0.6, len(timeline.rows) - 0.4)
    axes.grid(axis="y", color="#e5e5e5")
    axes.set_axisbelow(True)
    axes.set_ylabel("sign")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False, markerscale=2)


def _draw_words(axes: "Axes", words: Sequence[Word]) -> None:
    axes.set_ylabel("words")
    _empty(axes)
    for number, word in enumerate(words):
        level = number % _LEVELS
        axes.plot([word.time_s] * 2, [0, level + 0.3], color=_WORD, linewidth=1)
        _text(axes, word.time_s, level + 0.35, word.word, _WORD)


def _draw_outcomes(axes: "Axes", timeline: Timeline) -> None:
    axes.set_ylabel("instructions")
    _empty(axes)
    events: list[Instruction | Rejected] = [*timeline.instructions, *timeline.rejections]
    for number, event in enumerate(sorted(events, key=lambda event: event.time_s)):
        level = number % _LEVELS
        if isinstance(event, Instruction):
            length = max(event.time_s - event.start_time_s, 0.0)
            axes.broken_barh([(event.start_time_s, length)], (level, 0.3), facecolors=_GOOD)
            x, text, colour = event.start_time_s, f"{event.text}  {event.confidence:.0%}", _GOOD
        else:
            axes.plot([event.time_s], [level + 0.15], marker="x", color=_BAD)
            x, text, colour = event.time_s, f"{event.text or 'rejected'}: {rejected(event.reason)}", _BAD
        _text(axes, x, level + 0.35, text, colour, is_late=x > TURN_SHARE * timeline.end_s)


def _empty(axes: "Axes") -> None:
    axes.set_yticks([])
    axes.set_ylim(-0.2, _LEVELS + 0.1)


def _text(axes: "Axes", x: float, y: float, text: str, colour: str, is_late: bool = False) -> None:
    """A text from `x` on; of what is late to its left, so that the picture's end cuts nothing off."""
    style: dict[str, Any] = {"color": colour, "fontsize": 8, "clip_on": True, "parse_math": False}
    axes.text(x, y, one_line(text), ha="right" if is_late else "left", **style)
