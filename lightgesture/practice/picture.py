"""The picture of a practice: seconds of each word, and which hand shape was read as which."""

from collections import defaultdict
from statistics import fmean
from typing import Any, Final

from lightgesture.practice.summary import tell_summary
from lightgesture.signs.layout import DIM, INK, MARGIN, PAPER, SLATE
from lightgesture.signs.sheet import CAPITAL, Box, Item, Page, Text, fitting_size

WIDTH, HEIGHT = 210.0, 148.0
"""A5 on its side, millimetres."""

TOP: Final = 28.0
SPLIT: Final = 100.0
"""Where the right half begins."""

MOST_ROW: Final = 7.0
"""Greatest height of a row."""

BAR, RIGHT, WRONG = "#0b6e8f", "#11663a", "#a01c1c"


def summary_page(content: dict[str, Any]) -> Page:
    """The page of a summary, as `practice.summary.summary` makes it."""
    title = "Practice" if content["person"] is None else f"Practice of {content['person']}"
    line = next(iter(tell_summary(content)))
    items: list[Item] = [
        Box(0.0, 0.0, WIDTH, HEIGHT, "#f3f7f8"),
        Box(3.0, 3.0, WIDTH - 6.0, 17.0, SLATE, None, 2.5),
        Text(MARGIN, 10.6, title, fitting_size(title, 6.5, WIDTH - 20.0, True), PAPER, True),
        Text(MARGIN, 16.6, line, fitting_size(line, 3.4, WIDTH - 20.0), "#cfe3ea"),
    ]
    return Page(WIDTH, HEIGHT, (*items, *_times(content), *_matrix(content)))


def _times(content: dict[str, Any]) -> list[Item]:
    """A bar a word: mean seconds from the sign before until it was read."""
    seconds: dict[str, list[float]] = defaultdict(list)
    for sentence in content["sentences"]:
        for sign in sentence["signs"]:
            if sign["seconds"] is not None:
                seconds[sign["word"]].append(sign["seconds"])
    items: list[Item] = [Text(MARGIN, TOP - 2.0, "Seconds a sign", 3.6, INK, True)]
    if not seconds:
        return [*items, Text(MARGIN, TOP + 6.0, "no sign was read", 3.2, DIM)]
    row = min((HEIGHT - MARGIN - TOP) / len(seconds), MOST_ROW)
    most = max(map(fmean, seconds.values()))
    room = SPLIT - MARGIN - 36.0
    for number, (word, times) in enumerate(seconds.items()):
        mean, y = fmean(times), TOP + number * row
        size = fitting_size(word, row * 0.62, 22.0)
        base = y + row * 0.5 + size * CAPITAL / 2
        wide = max(room * mean / most, 0.5) if most else 0.5
        items.append(Text(MARGIN + 23.0, base, word, size, INK, align="right"))
        items.append(Box(MARGIN + 24.0, y + row * 0.15, wide, row * 0.7, BAR))
        items.append(Text(MARGIN + 25.0 + wide, base, f"{mean:.1f}", row * 0.55, DIM))
    return items


def _matrix(content: dict[str, Any]) -> list[Item]:
    """Rows: the shape asked for; columns: the shape read, shaded by its share of the row."""
    readings: dict[str, int] = content["readings"]
    wrong = {(item["asked"], item["read"]): item["times"] for item in content["confusions"]}
    items: list[Item] = [Text(SPLIT + 8.0, TOP - 2.0, "Asked for (rows), read (columns)", 3.6, INK, True)]
    if not readings:
        return [*items, Text(SPLIT + 8.0, TOP + 6.0, "no hand was read", 3.2, DIM)]
    columns = list(dict.fromkeys([*readings, *(read for _, read in wrong)]))
    left, top = SPLIT + 8.0 + 14.0, TOP + 7.0
    cell = min((WIDTH - MARGIN - left) / len(columns), (HEIGHT - MARGIN - top) / len(readings), 11.0)
    letter = min(cell * 0.45, 3.4)
    for number, name in enumerate(columns):
        size = fitting_size(name, letter, cell * 0.96)
        items.append(Text(left + (number + 0.5) * cell, top - 1.5, name, size, INK, align="middle"))
    for line, asked in enumerate(readings):
        y = top + line * cell
        size = fitting_size(asked, letter, 13.0)
        items.append(Text(left - 1.5, y + cell / 2 + size * CAPITAL / 2, asked, size, INK, True, "right"))
        missed = sum(times for (wanted, _), times in wrong.items() if wanted == asked)
        for number, read in enumerate(columns):
            times = readings[asked] - missed if read == asked else wrong.get((asked, read), 0)
            colour = _shade(RIGHT if read == asked else WRONG, times / readings[asked])
            x = left + number * cell
            items.append(Box(x, y, cell, cell, colour, "#d5dfe4", 0.0, 0.2))
            if times:
                ink = PAPER if times / readings[asked] > 0.4 else INK
                base = y + cell / 2 + letter * CAPITAL / 2
                items.append(Text(x + cell / 2, base, str(times), letter, ink, align="middle"))
    return items


def _shade(colour: str, share: float) -> str:
    """White to the colour, by a share of 0 to 1."""
    parts = (int(colour[place : place + 2], 16) for place in (1, 3, 5))
    return "#" + "".join(f"{round(255 - (255 - part) * share):02x}" for part in parts)
