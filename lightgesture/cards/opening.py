"""Which front end reads cards, and how long they are shown to count."""

from dataclasses import replace
from functools import partial
from typing import Final, Literal

from lightgesture.cards.front import CardReader
from lightgesture.features.tags.detector import DetectorName, make_detector
from lightgesture.front_end import FrontEnd
from lightgesture.fsm import Grammar, GrammarError

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
    grammar: Grammar, name: FrontEndName, *, detector: DetectorName = "aruco", mirrored: bool = False
) -> FrontEnd:
    """The front end of a grammar that `language_of_cards` gave. ValueError: the detector does not read the family."""
    if name != "tags" or grammar.tags is None:
        raise ValueError(f"{name}: reads no cards of {grammar.file}")
    make = partial(make_detector, detector, grammar.tags.family)
    return CardReader(grammar.tags, make, mirrored=mirrored)
