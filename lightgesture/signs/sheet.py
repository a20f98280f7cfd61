"""Pages of boxes, texts and hands, in millimetres, and the files that they are written to.

What a page shows is told once; `svg.py`, `png.py` and `pdf.py` draw it. No font is asked for: SVG and PDF name the
sans-serif one that every reader has, and PNG is drawn with OpenCV's strokes.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

from lightgesture.errors import UsageError
from lightgesture.results.atomic import replacing
from lightgesture.signs.drawings import Kind, load_drawing

CAPITAL: Final = 0.72
"""Height of a capital letter as a share of the size of the letters."""

_NARROW, _WIDE = frozenset("ijlItfr.,;:'|!()[] "), frozenset("mwMW@%")


@dataclass(frozen=True, slots=True)
class Text:
    """A line of text on its baseline. size: of the letters, millimetres. colours are `#rrggbb`."""

    x: float
    y: float
    text: str
    size: float
    colour: str = "#10202a"
    bold: bool = False
    align: Literal["left", "middle", "right"] = "left"


@dataclass(frozen=True, slots=True)
class Box:
    """A rectangle with round corners; fill, stroke: colours, None for none."""

    x: float
    y: float
    width: float
    height: float
    fill: str | None = None
    stroke: str | None = None
    radius: float = 0.0
    line: float = 0.3


@dataclass(frozen=True, slots=True)
class HandPicture:
    """A drawn hand in a square, its upper left corner at x, y. side: "left" or "right"."""

    x: float
    y: float
    size: float
    token: str
    side: str
    kind: Kind = "bare"


Item = Text | Box | HandPicture


@dataclass(frozen=True, slots=True)
class Page:
    """width, height: millimetres. Items lie one over the other in their order."""

    width: float
    height: float
    items: tuple[Item, ...]


def text_width(text: str, size: float, bold: bool = False) -> float:
    """About how wide a line is in a sans-serif font, millimetres, rather more than less."""
    ems = sum(
        0.32 if sign in _NARROW else 0.9 if sign in _WIDE else 0.7 if sign.isupper() else 0.57
        for sign in text
    )
    return ems * size * (1.06 if bold else 1.0)


def fitting_size(text: str, size: float, room: float, bold: bool = False) -> float:
    """Size of letters, at most `size`, at which a line is no wider than `room` millimetres."""
    width = text_width(text, size, bold)
    return size if width <= room else size * room / width


def wrapped(text: str, size: float, room: float) -> list[str]:
    """The text in lines of at most `room` millimetres, parted at spaces and, where a word is too long, behind bars."""
    lines = [""]
    for word in text.replace("|", "| ").split(" "):
        glue = "" if not lines[-1] or lines[-1].endswith("|") else " "
        if lines[-1] and text_width(lines[-1] + glue + word, size) > room:
            lines.append(word)
        else:
            lines[-1] += glue + word
    return lines


def hand_items(x: float, y: float, size: float, token: str, side: str, kind: Kind) -> list[Item]:
    """A drawn hand, or the name of a token that has no drawing, in a square."""
    if load_drawing(token, side, kind) is not None:
        return [HandPicture(x, y, size, token, side, kind)]
    letters = fitting_size(token, size * 0.4, size * 0.8, bold=True)
    return [
        Box(x + size * 0.06, y + size * 0.06, size * 0.88, size * 0.88, stroke="#5a6b75", radius=size * 0.1),
        Text(x + size / 2, y + size / 2 + letters * CAPITAL / 2, token, letters, bold=True, align="middle"),
    ]


def _writers() -> dict[str, Callable[[Sequence[Page]], list[bytes]]]:
    from lightgesture.signs.pdf import to_pdf
    from lightgesture.signs.png import to_png
    from lightgesture.signs.svg import to_svg

    return {
        ".svg": lambda pages: [to_svg(page) for page in pages],
        ".png": lambda pages: [to_png(page) for page in pages],
        ".pdf": lambda pages: [to_pdf(pages)],
    }


def write_pages(pages: Sequence[Page], out: str) -> list[str]:
    """Write the pages to one PDF file, or to a picture each: `card.svg`, `card-2.svg`; the names that were written.

    UsageError: the suffix is another, or the place cannot be written. ModuleNotFoundError: PDF needs the extra `print`.
    """
    path = Path(out)
    writers = _writers()
    if path.suffix.lower() not in writers:
        raise UsageError(f"{out}: unknown kind of file; end the name with {', '.join(writers)}")
    names = []
    for number, content in enumerate(writers[path.suffix.lower()](pages), 1):
        file = path if number == 1 else path.with_name(f"{path.stem}-{number}{path.suffix}")
        with replacing(file) as temporary:
            temporary.write_bytes(content)
        names.append(str(file))
    return names
