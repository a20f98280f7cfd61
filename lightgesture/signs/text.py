"""The language and its sentences in lines of plain text, as wide as the terminal."""

import shutil
from collections.abc import Iterator
from typing import Final

from lightgesture.fsm import Grammar, Pair
from lightgesture.signs.sentences import SignedSentence, pairs_by_word

TOKEN_NAMES: Final = {
    "0": "fist",
    "1": "index finger",
    "2": "two fingers, a V",
    "3": "three fingers",
    "4": "four, thumb folded",
    "5": "open hand",
    "left": "fist, thumb inward",
    "right": "fist, thumb outward",
    "pic": "L of thumb and index",
    "ok": "ring of thumb and index",
}
"""The tokens of the bundled language to what the hand does."""

MIRROR_NOTE: Final = "as in a mirror, your left hand on the left"

LEAST_WIDTH: Final = 20
MOST_WIDTH: Final = 100
"""Narrower and wider terminals are not heeded, letters."""


def terminal_width() -> int:
    """Letters a line; 80 where there is no terminal."""
    return min(max(shutil.get_terminal_size((80, 24)).columns, LEAST_WIDTH), MOST_WIDTH)


def hold_note(grammar: Grammar) -> str:
    """How long a sign is held, by the grammar's own rule."""
    dwell = grammar.dwell
    if dwell.rule == "frames":
        return f"hold each still for {dwell.hold} frames, {dwell.hold / 30:g} s of a usual camera"
    seconds = grammar.sentence.hold_seconds if dwell.rule == "sentence" else dwell.hold_seconds
    return f"hold each still for {seconds:g} s"


def tell_language(grammar: Grammar, width: int) -> list[str]:
    """The hand shapes, the words with their pairs, and what can be said."""
    shapes = [(token, TOKEN_NAMES.get(token, "")) for token in grammar.tokens]
    words = [(word, " or ".join(map(_pair, pairs))) for word, pairs in pairs_by_word(grammar).items()]
    lines = [
        "Hands",
        *_columns(shapes, width),
        "",
        "Words: left hand,right hand",
        *_columns(words, width),
        "",
    ]
    return [part for line in [*lines, *form_lines(grammar)] for part in _wrap(line, width)]


def tell_sentence(sentence: SignedSentence, width: int) -> list[str]:
    """The pairs to sign, in order."""
    rows = [(f"{number}.", *sign.pair, sign.word) for number, sign in enumerate(sentence.signs, 1)]
    rows.insert(0, ("", "left", "right", "word"))
    wide = [max(len(row[place]) for row in rows) for place in range(3)]
    lines = [sentence.text]
    for place, row in enumerate(rows):
        line = (
            "  " + "  ".join(part.ljust(room) for part, room in zip(row, wide, strict=False)) + "  " + row[3]
        )
        if place and (others := sentence.signs[place - 1].others):
            line += f" (or {' or '.join(map(_pair, others))})"
        lines.append(line.rstrip())
    if any(
        first.pair == second.pair for first, second in zip(sentence.signs, sentence.signs[1:], strict=False)
    ):
        lines.append("  let go between two equal signs")
    return [part for line in lines for part in _wrap(line, width)]


def form_lines(grammar: Grammar) -> Iterator[str]:
    """The sentences of a grammar, its programs and its parameters; headings are not indented."""
    yield "Sentences"
    for form in grammar.table.walks:
        yield f"  {form}"
    for title, entries in (
        ("Programs", grammar.programs),
        ("Parameters", {number: parameter.name for number, parameter in grammar.parameters.items()}),
    ):
        if entries:
            yield title
            yield "  " + ", ".join(f"{number} {name}" for number, name in sorted(entries.items()))


def _pair(pair: Pair) -> str:
    return ",".join(pair)


def _columns(rows: list[tuple[str, str]], width: int) -> list[str]:
    """Names and what they are, in as many columns as fit, read downwards."""
    name = max(len(first) for first, _ in rows)
    cells = [f"{first:<{name}}  {second}".rstrip() for first, second in rows]
    wide = max(map(len, cells))
    count = max(1, (width - 2) // (wide + 3))
    tall = -(-len(cells) // count)
    lines = ["   ".join(cell.ljust(wide) for cell in cells[row::tall]) for row in range(tall)]
    return [f"  {line}".rstrip() for line in lines]


def _wrap(line: str, width: int) -> list[str]:
    """A line in parts of at most `width` letters, broken at spaces and, as the choices of a sentence, behind bars."""
    if len(line) <= width:
        return [line]
    indent = " " * (len(line) - len(line.lstrip()))
    lines = [indent]
    for part in line.strip().replace("|", "|\0").replace(" ", " \0").split("\0"):
        if len(lines[-1]) + len(part.rstrip()) > width and lines[-1].strip():
            lines[-1] = lines[-1].rstrip()
            lines.append(f"{indent}  ")
        lines[-1] += part
    return lines
