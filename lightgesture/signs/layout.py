"""What stands on the pages: the ten signs, the signs of a sentence, and the card of a grammar."""

import os
from collections.abc import Iterator, Sequence
from typing import Final

from lightgesture.fsm import Grammar, Pair
from lightgesture.fsm.language.forms import is_digit, split_carrier
from lightgesture.fsm.language.load import BUNDLED
from lightgesture.signs.drawings import KINDS, Kind
from lightgesture.signs.sentences import SignedSentence, pairs_by_word
from lightgesture.signs.sheet import CAPITAL, Box, Item, Page, Text, fitting_size, hand_items, wrapped
from lightgesture.signs.text import MIRROR_NOTE, TOKEN_NAMES, form_lines, hold_note

WIDTH, HEIGHT = 148.0, 210.0
"""A5, upright, millimetres."""

MARGIN: Final = 7.0
GAP: Final = 1.6
HEAD: Final = 17.5
"""Height of the band with the title."""

TOP: Final = HEAD + 3.0
BOTTOM: Final = HEIGHT - 5.0
"""Between these stands what is below the title."""

LEAST_LETTER: Final = 2.6
"""Size of the smallest letters, millimetres: at arm's length no smaller ones can be read."""

LINE: Final = LEAST_LETTER * 1.28
"""From one line of these to the next."""

ROUNDING: Final = 0.01
"""Millimetres by which sums of lengths may miss."""

LEAST_LINES: Final = 4
"""Fewest lines that stand below the words."""

SLATE, INK, DIM, PAPER = "#0e3a4f", "#10202a", "#4c5f69", "#ffffff"
START, ACTION, DIGIT, CARRIER = "#b3261e", "#0b6e8f", "#8a5a00", "#5b3f94"
"""Colours of the bands: words that begin, join and end; other words; digits; words that carry a number."""

CARD_COLUMNS: Final = 5
CELL_HEIGHTS: Final = (18.5, 24.0)
"""Least and greatest height of a word on the card."""


def signs_pages(tokens: Sequence[str]) -> list[Page]:
    """The signs of a language, each bare and gloved."""
    columns, room = 2, WIDTH - 2 * MARGIN
    width = (room - GAP) / columns
    rows = -(-len(tokens) // columns)
    height = min((HEIGHT - HEAD - 3 * MARGIN - GAP * rows) / max(rows, 1), 40.0)
    items = _head("The signs", MIRROR_NOTE)
    for number, token in enumerate(tokens):
        x = MARGIN + number % columns * (width + GAP)
        y = HEAD + MARGIN + number // columns * (height + GAP)
        items.append(Box(x, y, width, height, PAPER, "#b9c7ce", 2.0))
        picture = min(height - 7.0, width / 2 - 2.0)
        for order, kind in enumerate(KINDS):
            left = x + width * (1 + 2 * order) / 4 - picture / 2
            items += hand_items(left, y + 1.0, picture, token, "left", kind)
        label = f"{token}  {TOKEN_NAMES.get(token, '')}".strip()
        size = fitting_size(label, 3.6, width - 4.0, bold=True)
        items.append(Text(x + width / 2, y + height - 2.0, label, size, INK, True, "middle"))
    return [Page(WIDTH, HEIGHT, (*items, _foot("your left hand; the right one is its mirror image")))]


def sentence_pages(sentence: SignedSentence, grammar: Grammar, kind: Kind) -> list[Page]:
    """The pairs of a sentence in order, three in a row."""
    columns, rows = 3, 4
    width = (WIDTH - 2 * MARGIN - GAP * (columns - 1)) / columns
    height = min((BOTTOM - TOP) / rows - GAP, 36.0)
    pages, step = [], columns * rows
    parts = [sentence.signs[first : first + step] for first in range(0, len(sentence.signs), step)]
    for page, signs in enumerate(parts):
        items = _head(sentence.text, f"{MIRROR_NOTE}; {hold_note(grammar)}", page, len(parts))
        for number, sign in enumerate(signs):
            x = MARGIN + number % columns * (width + GAP)
            y = TOP + number // columns * (height + GAP)
            colour = _colour(sign.word, grammar)
            items += _cell(
                x, y, width, height, sign.word, [sign.pair], colour, kind, page * step + number + 1
            )
        pages.append(Page(WIDTH, HEIGHT, tuple(items)))
    return pages


def card_pages(grammar: Grammar, kind: Kind) -> list[Page]:
    """The slate of a language: every word with its hands, then what can be said; as many pages as that takes."""
    words = list(pairs_by_word(grammar).items())
    lines = list(_said(grammar))
    height = _cell_height(-(-len(words) // CARD_COLUMNS), len(lines))
    cells = CARD_COLUMNS * int((BOTTOM - TOP + GAP) // (height + GAP))
    parts = [words[first : first + cells] for first in range(0, len(words), cells)]
    starts = [TOP] * (len(parts) - 1) + [TOP + -(-len(parts[-1]) // CARD_COLUMNS) * (height + GAP) + 1.0]
    texts: list[list[tuple[str, bool]]] = [[] for _ in parts[1:]]
    room = int((BOTTOM - starts[-1] + ROUNDING) // LINE)
    # A heading with little below it looks lost: all goes to the next page then.
    texts.append(lines[:room] if room >= min(len(lines), LEAST_LINES) else [])
    rest = lines[len(texts[-1]) :]
    a_page = int((BOTTOM - TOP) // LINE)
    while rest:
        parts.append([])
        starts.append(TOP)
        texts.append(rest[:a_page])
        rest = rest[a_page:]
    pages = []
    for page, (cells_here, start, lines_here) in enumerate(zip(parts, starts, texts, strict=True)):
        items = _head(_name(grammar), f"{MIRROR_NOTE}; {hold_note(grammar)}", page, len(parts))
        items += _grid(cells_here, grammar, kind, height)
        items += [
            Text(MARGIN, start + number * LINE + LEAST_LETTER, text, LEAST_LETTER, INK, bold)
            for number, (text, bold) in enumerate(lines_here)
        ]
        pages.append(Page(WIDTH, HEIGHT, tuple(items)))
    return pages


def _cell_height(rows: int, lines: int) -> float:
    """Of a word, millimetres: the most that lets all stand on one page, where it does at all."""
    height = (BOTTOM - TOP - 1.0 - lines * LINE) / max(rows, 1) - GAP
    return min(height, CELL_HEIGHTS[1]) if height >= CELL_HEIGHTS[0] else CELL_HEIGHTS[1]


def _grid(words: Sequence[tuple[str, list[Pair]]], grammar: Grammar, kind: Kind, height: float) -> list[Item]:
    width = (WIDTH - 2 * MARGIN - GAP * (CARD_COLUMNS - 1)) / CARD_COLUMNS
    items: list[Item] = []
    for number, (word, pairs) in enumerate(words):
        x = MARGIN + number % CARD_COLUMNS * (width + GAP)
        y = TOP + number // CARD_COLUMNS * (height + GAP)
        items += _cell(x, y, width, height, word, pairs, _colour(word, grammar), kind)
    return items


def _cell(
    x: float,
    y: float,
    width: float,
    height: float,
    word: str,
    pairs: Sequence[Pair],
    colour: str,
    kind: Kind,
    number: int | None = None,
) -> list[Item]:
    """Both hands of a word over a band with the word in it."""
    band = min(max(height * 0.2, 4.6), 8.0)
    items: list[Item] = [Box(x, y, width, height, PAPER, "#b9c7ce", 1.6)]
    room = height - band - 3.2
    size = min(room, width / 2 - 0.6)
    top = y + 0.4 + (room - size) / 2
    for order, (token, side) in enumerate(zip(pairs[0], ("left", "right"), strict=True)):
        items += hand_items(x + width * (0.5 + order) / 2 - size / 2, top, size, token, side, kind)
    letters = " or ".join(",".join(pair) for pair in pairs)
    small = fitting_size(letters, 2.5, width - 2.0)
    items.append(Text(x + width / 2, y + height - band - 0.7, letters, small, DIM, align="middle"))
    items.append(Box(x, y + height - band, width, band, colour, None, 1.6))
    size = fitting_size(word, band * 0.78, width - 3.0, bold=True)
    middle = y + height - band / 2 + size * CAPITAL / 2
    items.append(Text(x + width / 2, middle, word, size, PAPER, True, "middle"))
    if number is not None:
        items.append(Text(x + 1.6, y + 4.4, str(number), 4.2, DIM, True))
    return items


def _head(title: str, note: str, page: int = 0, pages: int = 1) -> list[Item]:
    """The white slate with its hole, and the dark band with the title."""
    room = WIDTH - 2 * MARGIN - 20.0
    size = fitting_size(title, 7.0, room, bold=True)
    items: list[Item] = [
        Box(0.0, 0.0, WIDTH, HEIGHT, "#f3f7f8"),
        Box(3.0, 3.0, WIDTH - 6.0, HEAD - 2.0, SLATE, None, 2.5),
        Box(WIDTH - 16.0, 6.0, 8.0, 8.0, PAPER, "#b9c7ce", 4.0, 0.5),
        Text(MARGIN, 10.4, title, size, PAPER, True),
        Text(MARGIN, 15.6, note, fitting_size(note, 3.0, room + 6.0), "#cfe3ea"),
    ]
    if pages > 1:
        items.append(Text(WIDTH - 12.0, 11.1, f"{page + 1}/{pages}", 3.0, SLATE, True, "middle"))
    return items


def _foot(note: str) -> Text:
    return Text(WIDTH / 2, HEIGHT - MARGIN + 1.0, note, 3.0, DIM, align="middle")


def _said(grammar: Grammar) -> Iterator[tuple[str, bool]]:
    """Lines with what can be said, and whether each is bold."""
    for line in form_lines(grammar):
        is_title = not line.startswith(" ")
        for number, part in enumerate(wrapped(line.strip(), LEAST_LETTER, WIDTH - 2 * MARGIN)):
            yield part if number == 0 else f"   {part}", is_title


def _name(grammar: Grammar) -> str:
    return "Diver's signs" if grammar.file == os.fspath(BUNDLED) else os.path.basename(grammar.file)


def _colour(word: str, grammar: Grammar) -> str:
    if is_digit(word):
        return DIGIT
    if split_carrier(word)[1] is not None:
        return CARRIER
    framing = {grammar.end, grammar.vocabulary.join, grammar.control.kill, grammar.control.cancel}
    return START if word in framing or word in grammar.table.transitions[0] else ACTION
