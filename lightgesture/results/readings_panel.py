"""What the rule "sentence" thought, as part of the timeline picture: its best reading and how sure it was."""

from collections.abc import Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any, Final

from lightgesture.console import one_line
from lightgesture.fsm import Notice, State

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LEAST, NEWEST, DOUBT = "#444444", "#7a5ba8", "#c0392b"
"""Colours of the least sure word, of the last word, and of a word that is asked for again."""

BREAK_S: Final = 2.0
"""Seconds without a reading after which the line is broken."""

LEVELS: Final = (0.06, 0.2, 0.34)
"""Heights of the words' names, which take turns so that neighbours do not cover each other."""


def has_readings(states: Sequence[State]) -> bool:
    """Whether there is anything to draw: only the rule "sentence" tells how sure its words are."""
    return any(state.certainty is not None for state in states)


def draw_readings(axes: "Axes", states: Sequence[State], repeats: Sequence[Notice]) -> None:
    """How sure the best reading was of its least sure and of its last word, the words as they joined it, and where one
    was asked for again."""
    told = [(state.time_s, state.certainty.words) for state in states if state.certainty is not None]
    points = [(time_s, min(sure for _, sure in words), words[-1][1]) for time_s, words in told if words]
    for run in _runs(points):
        times, least, newest = (list(column) for column in zip(*run, strict=True))
        axes.step(times, least, where="post", color=LEAST, linewidth=1.2)
        axes.scatter(times, newest, s=10, c=NEWEST, linewidths=0)
    axes.plot([], [], color=LEAST, linewidth=1.2, label="least sure word")
    axes.scatter([], [], s=10, c=NEWEST, label="last word")
    for number, (time_s, name) in enumerate(_joined(told)):
        _name(axes, time_s, LEVELS[number % len(LEVELS)], name, NEWEST)
    for notice in repeats:
        axes.axvline(notice.time_s, color=DOUBT, linewidth=0.8, linestyle=":")
        _name(axes, notice.time_s, 0.9, notice.detail, DOUBT)
    axes.set_ylim(0.0, 1.05)
    axes.set_ylabel("best reading")
    axes.grid(axis="y", color="#e5e5e5")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False)


def _runs(points: Sequence[tuple[float, float, float]]) -> Iterator[list[tuple[float, float, float]]]:
    """The points cut where no reading was told for a while."""
    run: list[tuple[float, float, float]] = []
    for point in points:
        if run and point[0] - run[-1][0] > BREAK_S:
            yield run
            run = []
        run.append(point)
    if run:
        yield run


def _joined(told: Sequence[tuple[float, tuple[tuple[str, float], ...]]]) -> Iterator[tuple[float, str]]:
    """When the best reading changed: by the word that joined it, or by all from the first one that is another."""
    before: tuple[str, ...] = ()
    for time_s, pairs in told:
        words = tuple(word for word, _ in pairs)
        if words == before:
            continue
        same = 0
        for one, other in zip(before, words, strict=False):
            if one != other:
                break
            same += 1
        changed = words[same:] if len(words) > same else words[-1:]
        yield time_s, " ".join(chain(["…"] * (same < len(before)), changed))
        before = words


def _name(axes: "Axes", x: float, y: float, text: str, colour: str) -> None:
    style: dict[str, Any] = {"color": colour, "fontsize": 8, "clip_on": True, "parse_math": False}
    axes.text(x, y, one_line(text), **style)
