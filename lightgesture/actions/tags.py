"""What `tags` does: the book of cards is written, or read back.

grammar: path of a grammar file, None for the bundled one. UsageError: it cannot be read, or has no cards.
"""

from pathlib import Path

from lightgesture.cards.book import LEAST_SIDE_MM, MOST_SIDE_MM, Card, cards_of, write_book
from lightgesture.cards.proof import complaints, read_pages
from lightgesture.console import native_messages_muted, print_line, say
from lightgesture.errors import ExitStatus, UsageError, reason_of
from lightgesture.features.tags.detector import DetectorName
from lightgesture.fsm import GrammarError, load_grammar


def print_book(grammar: str | None, out: str, side_mm: float) -> ExitStatus:
    """Write the book as PDF. side_mm: of the black square of a tag. UsageError: also where `out` is no place for it."""
    if not LEAST_SIDE_MM <= side_mm <= MOST_SIDE_MM:
        bounds = f"{LEAST_SIDE_MM:g} to {MOST_SIDE_MM:g} mm"
        raise UsageError(f"--side {side_mm:g}: a tag on an A6 card is {bounds} wide; choose one of these")
    if not out.lower().endswith(".pdf"):
        raise UsageError(f"--out {out}: the book is a PDF; name a file that ends in .pdf")
    family, cards = _cards(grammar)
    try:
        pages = write_book(Path(out), family, cards, side_mm)
    except OSError as error:
        raise UsageError(f"{out}: cannot be written ({reason_of(error)}); name another place") from None
    print_line(
        f"{out}: {pages} pages, {len(cards)} cards of {side_mm:g} mm; print at 100 %, do not fit to the page"
    )
    return ExitStatus.OK


def check_book(grammar: str | None, file: str, detector: DetectorName) -> ExitStatus:
    """Print what is on every page, and what is wrong; SOME_FAILED where something is."""
    family, cards = _cards(grammar)
    titles = {card.id: card.title for card in cards}
    try:
        with native_messages_muted():
            pages = list(read_pages(Path(file), family, detector))
    except ValueError as error:
        raise UsageError(str(error)) from None
    for page in pages:
        for place, tag in enumerate(page.tags):
            size = "" if page.side_mm is None else f", {page.side_mm[place]:.1f} mm"
            print_line(f"page {page.page}: tag {tag.id}  {titles.get(tag.id, 'no word')}{size}")
    found = complaints(pages, cards)
    for line in found:
        say(f"{file}: {line}")
    if not found:
        print_line(f"{file}: all {len(cards)} cards are read from {len(pages)} pages")
    return ExitStatus.SOME_FAILED if found else ExitStatus.OK


def _cards(grammar: str | None) -> tuple[str, list[Card]]:
    try:
        return cards_of(load_grammar(grammar))
    except (GrammarError, ValueError) as error:
        raise UsageError(str(error)) from None
