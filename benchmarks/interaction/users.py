"""Simulated users: how long a word takes them, and how often they show another one.

Times are the sum of what the models of the literature give for each step of a word; the constants are those of the
Model Human Processor (Card, Moran and Newell, "The Psychology of Human-Computer Interaction", 1983) where it has one,
and assumed where this says so:

- To choose one of n signs that are known by heart takes a + b log2 n (Hick, "On the rate of gain of information", QJEP
  1952; Hyman, J. Exp. Psychology 1953): a is one round of perceiving, thinking and moving, 0.1 + 0.07 + 0.07 s; b is
  0.15 s a bit, their uncertainty principle.
- To find a card in the book a novice looks at one after the other, as in the menu model of Cockburn, Gutwin and
  Greenberg (CHI 2007), a fixation of the eye each, 0.23 s; practice turns that into the choice above, and its share is
  the user's `practice`. To turn a page takes 0.5 s: assumed.
- To move a card along a stroke of length D that must end within W takes a + b log2(D / W + 1) (Fitts, J. Exp.
  Psychology 1954, in the form of MacKenzie, Human-Computer Interaction 1992). A hand in air takes 0.1 s a bit; with a
  card, in water, 0.2 s and a start of 0.1 s are assumed.
- How long a sign is held, and how long the way to the next one takes, is what the scenario suite assumes, 21 to 31 and
  7 to 12 frames of 1/30 s: there is no recording of people who sign sentences with a clock to measure it on.

Slips are not modelled but taken from the paper: its table of mistakes gives the chance that a word is a wrong one.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

Way = Literal["hands", "tags", "tag-motion"]
WAYS: Final[tuple[Way, ...]] = ("hands", "tags", "tag-motion")
NAMES: Final[dict[Way, str]] = {"hands": "hand signs", "tags": "cards", "tag-motion": "moved cards"}

Kind = Literal["STOP", "CONTD", "complex"]
KINDS: Final[tuple[Kind, ...]] = ("STOP", "CONTD", "complex")
Skill = Literal["beginner", "medium", "expert"]

PEOPLE: Final[dict[Skill, int]] = {"beginner": 2, "medium": 7, "expert": 1}
"""Of the paper's study."""

TASKS: Final[dict[Kind, tuple[tuple[str, ...], ...]]] = {
    "STOP": (("STOP HOVER 50 GO",), ("STOP EXEC 1 GO",)),
    "CONTD": (("CONTD SNAP 20 GO",), ("CONTD PARAM 3 DECREASE GO",)),
    "complex": (("STOP EXEC 2 GO", "CONTD SNAP GO"), ("CONTD SNAP 50 GO", "STOP FOLLOW GO")),
}
"""The paper's four instructions and two scenarios, each as the sentences that say it."""

PAPER_MISTAKES: Final[dict[Skill, dict[Kind, tuple[float, float, float]]]] = {
    "beginner": {"STOP": (2, 1, 3), "CONTD": (0, 0, 1), "complex": (2, 3, 7)},
    "medium": {"STOP": (1, 0, 1), "CONTD": (0, 0, 0), "complex": (2, 2, 3)},
    "expert": {"STOP": (0, 0, 0), "CONTD": (0, 0, 0), "complex": (0, 0, 0)},
}
"""Average mistakes before success over both tasks of a kind, in the order of WAYS (Islam, Ho and Sattar, ICRA 2018)."""

CHOICE_S, CHOICE_BIT_S = 0.24, 0.15
SEARCH_CARD_S = 0.23
PAGE_S: Final = 0.5
"""To turn a page of the book of two cards, seconds: assumed for gloved hands."""
MOVE_S, MOVE_BIT_S = 0.1, 0.2
HOLD_S, CHANGE_S = 26 / 30, 9.5 / 30
"""Mean length of a hold and of the way to the next sign, seconds: assumed, as in the scenario suite."""
CARD_S: Final = 0.8
"""How long a card is shown, seconds: assumed, of which the reader needs 0.3."""
REST_S: Final = 0.9
"""Rest after a motion, seconds: assumed, of which the reader needs 0.6."""
STROKE: Final = 3.0
"""Length of a stroke against how exactly it must end, D / W: assumed; the reader takes shapes that are a third off."""

STROKES: Final = {
    **dict.fromkeys(("up", "down", "left", "right"), 2),
    **dict.fromkeys(("clockwise", "anticlockwise", "square"), 4),
    **dict.fromkeys(("wave", "zigzag"), 5),
    "triangle": 3,
    "still": 0,
}
"""Strokes of a shape; a circle is four quarters."""


@dataclass(frozen=True, slots=True)
class User:
    """One of the people. practice: share of the words that are chosen and not searched, 0 to 1. pace: how much longer
    than the models every step takes."""

    skill: Skill
    practice: float
    pace: float


USERS: Final[dict[Skill, User]] = {
    "beginner": User("beginner", 0.0, 1.3),
    "medium": User("medium", 0.5, 1.1),
    "expert": User("expert", 1.0, 1.0),
}
"""Practice and pace are assumed, not measured; the order of the ways does not hang on them."""


def word_seconds(user: User, way: Way, vocabulary: int, motion: Sequence[str] = ()) -> float:
    """Seconds that one word takes. vocabulary: words to choose from. motion: what the two hands draw."""
    choice = CHOICE_S + CHOICE_BIT_S * math.log2(vocabulary)
    if way == "hands":
        seconds = choice + CHANGE_S + HOLD_S
    elif way == "tags":
        # On average half of the book lies before the card; who knows it opens the book there.
        search = CHOICE_S + SEARCH_CARD_S * vocabulary / 2 + PAGE_S * vocabulary / 4
        known = choice + PAGE_S
        seconds = user.practice * known + (1.0 - user.practice) * search + 2 * CHANGE_S + CARD_S
    else:
        strokes = max((STROKES.get(shape, 4) for shape in motion), default=0)
        seconds = choice + strokes * (MOVE_S + MOVE_BIT_S * math.log2(STROKE + 1.0)) + REST_S
    return user.pace * seconds


def slip_chance(mistakes: float, lengths: Sequence[int]) -> float:
    """The chance that a word is wrong which makes so many mistakes on average before success, over sentences of these
    lengths: with p for a word a sentence of n fails with 1 - (1 - p)^n, and is tried again until it succeeds."""

    def expected(chance: float) -> float:
        right = [(1.0 - chance) ** length for length in lengths]
        return sum((1.0 - one) / one for one in right)

    low, high = 0.0, 0.9
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if expected(middle) < mistakes else (low, middle)
    return 0.5 * (low + high) if mistakes > 0.0 else 0.0
