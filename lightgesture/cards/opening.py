"""Which front end reads cards, and how long they are shown to count."""

import os
from dataclasses import replace
from functools import partial
from typing import Final, Literal

from lightgesture.cards.front import CardReader
from lightgesture.cards.motion_front import MotionReader
from lightgesture.features.motion.matching import ShapeBase
from lightgesture.features.motion.shapes import load_shapes
from lightgesture.features.tags.detector import DetectorName, make_detector
from lightgesture.front_end import FrontEnd
from lightgesture.fsm import Grammar, GrammarError
from lightgesture.fsm.language.grammar import STILL, MotionWords

FrontEndName = Literal["hands", "tags", "tag-motion"]
"""Bare hands, cards, or two cards that are moved."""

RELEASE: Final = 1.0
"""Share of the hold that a card is away before it counts again. More than of hands, because a cloud of bubbles hides a
whole card: 0.3 s beyond the 0.2 s for which a card that is not seen is taken to be there."""


def language_of_cards(grammar: Grammar, name: FrontEndName) -> Grammar:
    """The grammar with the dwell of cards: by time, as long as [tags] or [motions] say.

    GrammarError: it lacks the table of that front end, or that table lacks what every sentence needs.
    """
    table, said = ("tags", grammar.tags) if name == "tags" else ("motions", grammar.motions)
    if said is None:
        reason, remedy = (
            f"has no [{table}], which --front-end {name} reads",
            "add it, as in the bundled grammar",
        )
        raise GrammarError.at(grammar.file, "", reason, remedy)
    words = {*said.words.values()}
    if grammar.end not in words or not words & {*grammar.table.transitions[0]}:
        missing = grammar.end if grammar.end not in words else " or ".join(grammar.table.transitions[0])
        raise GrammarError.at(
            grammar.file, table, f"nothing says {missing}", "without it nothing is issued; add it"
        )
    dwell = replace(grammar.dwell, rule="seconds", hold_seconds=said.hold_seconds, release=RELEASE)
    return replace(grammar, dwell=dwell)


def make_card_reader(
    grammar: Grammar,
    name: FrontEndName,
    *,
    detector: DetectorName = "aruco",
    shapes: str | os.PathLike[str] | None = None,
    mirrored: bool = False,
) -> FrontEnd:
    """The front end of a grammar that `language_of_cards` gave. shapes: file of shapes of one's own.

    ValueError, ShapesError: the detector does not read the family, the file is wrong, or the grammar names a shape that
    nobody knows.
    """
    if name == "tags" and grammar.tags is not None:
        make = partial(make_detector, detector, grammar.tags.family)
        return CardReader(grammar.tags, make, mirrored=mirrored)
    if name == "tag-motion" and grammar.motions is not None:
        make = partial(make_detector, detector, grammar.motions.family)
        return MotionReader(grammar.motions, _base(grammar, grammar.motions, shapes), make, mirrored=mirrored)
    raise ValueError(f"{name}: reads no cards of {grammar.file}")


def _base(grammar: Grammar, words: MotionWords, file: str | os.PathLike[str] | None) -> ShapeBase:
    """The shapes that the words of a grammar are made of; what no word needs could only be mistaken."""
    known = load_shapes(file)
    used = dict.fromkeys(name for pair in words.words for name in pair if name != STILL)
    for name in used:
        if name not in known:
            remedy = f"use one of {', '.join(known)}, or record it and give the file with --shapes"
            raise GrammarError.at(grammar.file, "motions", f"'{name[:40]}' is no shape that is known", remedy)
    return ShapeBase({name: known[name] for name in used})
