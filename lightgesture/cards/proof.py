"""A book read back from its own pixels: what a camera would make of each page."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from lightgesture.cards.book import Card
from lightgesture.errors import InputError, reason_of
from lightgesture.features.tags.detector import DetectorName, Grey, make_detector
from lightgesture.features.tags.tag import Tag

DOTS_PER_MM: Final = 4.0
"""Resolution at which pages are drawn, pixels a millimetre: a hundred dots an inch."""

MOST_PAGES: Final = 500
"""Pages that are read of a file."""


@dataclass(frozen=True, slots=True)
class PageProof:
    """The tags of a page, 1-based; side_mm: of each, as printed, None for a picture that has no size."""

    page: int
    tags: tuple[Tag, ...]
    side_mm: tuple[float, ...] | None


def read_pages(path: Path, family: str, detector: DetectorName = "aruco") -> Iterator[PageProof]:
    """The tags of every page of a PDF, or of one picture. InputError: it is neither, or cannot be read."""
    make = make_detector(detector, family)
    if path.suffix.lower() != ".pdf":
        content = _bytes_of(path)
        picture = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_GRAYSCALE) if content else None
        if picture is None:
            raise InputError(
                f"{path}: is neither a PDF nor a picture; name a book of `lightgesture tags print`"
            )
        yield PageProof(1, make.process(np.asarray(picture, np.uint8), 0.0), None)
        return
    for number, picture in enumerate(_draw_pages(path), start=1):
        tags = make_detector(detector, family).process(picture, 0.0)
        yield PageProof(number, tags, tuple(tag.side / DOTS_PER_MM for tag in tags))


def complaints(pages: Sequence[PageProof], cards: Sequence[Card]) -> list[str]:
    """What is wrong with a book that should have these cards, one line each."""
    titles = {card.id: card.title for card in cards}
    counts = Counter(tag.id for page in pages for tag in page.tags)
    lines = [f"tag {number} ({titles[number]}) is missing" for number in titles if number not in counts]
    lines += [
        f"tag {number} is there {count} times; keep one"
        for number, count in sorted(counts.items())
        if count > 1
    ]
    lines += [f"tag {number} is none of the grammar" for number in sorted({*counts} - {*titles})]
    lines += [
        f"page {page.page} has {len(page.tags)} tags; a camera that sees both reads neither"
        for page in pages
        if len(page.tags) > 1
    ]
    return lines


def _draw_pages(path: Path) -> Iterator[Grey]:
    """The pages of a PDF as grey pictures."""
    import pypdfium2

    content = _bytes_of(path)
    try:
        document = pypdfium2.PdfDocument(content)
    except pypdfium2.PdfiumError as error:
        raise InputError(f"{path}: is no PDF that can be read ({reason_of(error)}); print it again") from None
    try:
        if len(document) > MOST_PAGES:
            raise InputError(f"{path}: has {len(document)} pages, at most {MOST_PAGES} are read; split it")
        for page in document:
            # The package calls it a whole number and takes any.
            drawn = page.render(scale=DOTS_PER_MM * 25.4 / 72.0, grayscale=True)  # pyright: ignore[reportArgumentType]
            yield np.ascontiguousarray(drawn.to_numpy().reshape(drawn.height, drawn.width), np.uint8)
    finally:
        document.close()


def _bytes_of(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({reason_of(error)}); name a readable file") from None
