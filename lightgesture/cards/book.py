"""The book of cards as PDF: A6 pages with a tag, its id, its word and a drawing, and an index before them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from lightgesture.cards.drawings import strokes_of
from lightgesture.features.tags.tag import cells_of
from lightgesture.fsm import Grammar
from lightgesture.results.atomic import replacing

if TYPE_CHECKING:
    from fpdf import FPDF

PAGE_MM: Final = (105.0, 148.0)
"""Width and height of a card, A6, after it is cut."""

BLEED_MM: Final = 5.0
"""Of paper round a card, with the marks to cut along."""

MARK_MM: Final = 4.0
"""Length of a mark."""

MOST_SIDE_MM: Final = 84.0
"""Largest tag that leaves a white edge of a cell on an A6 card; a tag without one is not found."""

LEAST_SIDE_MM: Final = 20.0
"""Smallest tag that a camera sees beyond arm's length."""

POINTS_PER_MM: Final = 72.0 / 25.4
INDEX_ROWS: Final = 20
"""Words in a column of the index; two columns a page."""

LEFT_HAND, RIGHT_HAND = "left hand", "right hand"


@dataclass(frozen=True, slots=True)
class Card:
    """One card of a book. title: the word that it says, or the hand that holds it. note: printed below it."""

    id: int
    title: str
    note: str = ""


def cards_of(grammar: Grammar) -> tuple[str, list[Card]]:
    """The family of the cards of a grammar, and the cards: those of [tags], then the two that are moved.

    The two are left out where they are of another family or their ids say words. ValueError: it has no cards.
    """
    if grammar.tags is None and grammar.motions is None:
        raise ValueError(
            f"{grammar.file}: has neither [tags] nor [motions]; add one, as in the bundled grammar"
        )
    cards = (
        [] if grammar.tags is None else [Card(number, word) for number, word in grammar.tags.words.items()]
    )
    family = grammar.motions.family if grammar.tags is None and grammar.motions else ""
    family = grammar.tags.family if grammar.tags is not None else family
    if grammar.motions is not None and grammar.motions.family == family:
        taken = {card.id for card in cards}
        hands = ((grammar.motions.left, LEFT_HAND), (grammar.motions.right, RIGHT_HAND))
        cards += [Card(number, hand, "to be moved") for number, hand in hands if number not in taken]
    return family, cards


def write_book(path: Path, family: str, cards: Sequence[Card], side_mm: float) -> int:
    """Write the book, which appears under its name when it is complete; how many pages it has.

    side_mm: of the black square of a tag, LEAST_SIDE_MM to MOST_SIDE_MM. OSError: it cannot be written.
    """
    from fpdf import FPDF

    width, height = (side + 2 * BLEED_MM for side in PAGE_MM)
    document = FPDF(unit="mm", format=(width, height))
    document.set_auto_page_break(False)
    document.set_creator("lightgesture")
    for first in range(0, len(cards), 2 * INDEX_ROWS):
        _add_page(document)
        _draw_index(document, family, cards[first : first + 2 * INDEX_ROWS])
    for card in cards:
        _add_page(document)
        _draw_card(document, family, card, side_mm)
    with replacing(path) as temporary:
        temporary.write_bytes(bytes(document.output()))
    return int(document.pages_count)


def _add_page(document: "FPDF") -> None:
    """A page with its cut marks."""
    document.add_page()
    document.set_draw_color(0)
    document.set_line_width(0.2)
    for x in (BLEED_MM, BLEED_MM + PAGE_MM[0]):
        for top in (0.0, 2 * BLEED_MM + PAGE_MM[1] - MARK_MM):
            document.line(x, top, x, top + MARK_MM)
    for y in (BLEED_MM, BLEED_MM + PAGE_MM[1]):
        for left in (0.0, 2 * BLEED_MM + PAGE_MM[0] - MARK_MM):
            document.line(left, y, left + MARK_MM, y)


def _draw_index(document: "FPDF", family: str, cards: Sequence[Card]) -> None:
    left, top = BLEED_MM + 8.0, BLEED_MM + 12.0
    _text(document, left, top, "Cards", 7.0, bold=True)
    _text(document, left + 26.0, top, f"AprilTag {family}", 3.5)
    for place, card in enumerate(cards):
        column, row = divmod(place, INDEX_ROWS)
        x, y = left + 46.0 * column, top + 9.0 + 6.0 * row
        _draw_strokes(document, card.title, x, y - 4.2, 4.8, 0.25)
        _text(document, x + 7.0, y, card.title, 4.0)
        _text(document, x + 36.0, y, str(card.id), 3.2)


def _draw_card(document: "FPDF", family: str, card: Card, side_mm: float) -> None:
    left = BLEED_MM + (PAGE_MM[0] - side_mm) / 2
    top = BLEED_MM + (PAGE_MM[0] - side_mm) / 2
    cells = cells_of(family, card.id)
    cell = side_mm / len(cells)
    document.set_fill_color(0)
    for row, line in enumerate(cells):
        column = 0
        while column < len(
            line
        ):  # cells that touch are one rectangle, so that no hair line shows between them
            end = column
            while end < len(line) and not line[end]:
                end += 1
            if end > column:
                extra = 0.02 if row + 1 < len(cells) else 0.0
                document.rect(
                    left + column * cell, top + row * cell, (end - column) * cell, cell + extra, "F"
                )
            column = end + 1
    below = BLEED_MM + PAGE_MM[0] + 2.0
    _draw_strokes(document, card.title, BLEED_MM + 8.0, below, 24.0, 0.9)
    _text(document, BLEED_MM + 37.0, below + 13.0, card.title, 11.0, bold=True, most=62.0)
    note = f"{card.note}; " if card.note else ""
    _text(document, BLEED_MM + 37.0, below + 21.0, f"{note}tag {card.id}, {family}, {side_mm:g} mm", 3.5)
    _text(document, BLEED_MM + PAGE_MM[0] / 2 - 5.0, BLEED_MM + PAGE_MM[1] - 4.0, "this side down", 3.0)


def _draw_strokes(document: "FPDF", title: str, x: float, y: float, size: float, line: float) -> None:
    document.set_draw_color(0)
    document.set_line_width(line)
    for stroke in strokes_of(title):
        document.polyline([(x + size * across, y + size * down) for across, down in stroke])


def _text(
    document: "FPDF",
    x: float,
    y: float,
    text: str,
    size: float,
    bold: bool = False,
    most: float | None = None,
) -> None:
    """A line of text, capitals `size` mm of font high, smaller where it would be wider than `most` mm."""
    document.set_font("Helvetica", "B" if bold else "", size * POINTS_PER_MM)
    if most is not None:
        wide = document.get_string_width(text)
        if wide > most:
            document.set_font_size(size * POINTS_PER_MM * most / wide)
    document.text(x, y, text)
