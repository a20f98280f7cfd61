"""What a frame says to the decoder: a pair of signs, whoever read them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Self

Pair = tuple[str, str]
"""Tokens of the diver's left and right hand."""

Shown = tuple[str, ...]
"""What is held: the tokens of the diver's left and right hand, or one word that says itself, as a card does."""


@dataclass(frozen=True, slots=True)
class Sign:
    """What one hand shows in one frame.

    token: one of the grammar's tokens, or None where it was not read. With `is_word` it is a word of the grammar that
    says itself, without another hand: a card. confidence: 0 to 1, of what was read. probabilities: of every class that
    the reader knows, 0 to 1; empty where it tells none. seen: whether the hand is in view, read or not. reason: why it
    was not read, for the user.
    """

    token: str | None = None
    confidence: float = 1.0
    probabilities: Mapping[str, float] = field(default_factory=dict)
    seen: bool = True
    reason: str | None = None
    is_word: bool = False


UNSEEN: Final = Sign(seen=False)
"""A hand that is not in view."""


BETWEEN_CARDS: Final = " and "
"""Stands between the words of two cards that are shown at once; no word of a grammar has small letters."""


def two_cards(one: str, other: str) -> Sign:
    """What two cards with two words say: no word, and the diver is told so."""
    return Sign(BETWEEN_CARDS.join(sorted((one, other))), is_word=True)


def are_two_cards(shown: Shown) -> bool:
    """Whether this is what `two_cards` says."""
    return len(shown) == 1 and BETWEEN_CARDS in shown[0]


@dataclass(frozen=True, slots=True)
class Signs:
    """What the diver's own left and right hand show in one frame."""

    left: Sign = UNSEEN
    right: Sign = UNSEEN

    @classmethod
    def of_tokens(cls, left: str | None, right: str | None) -> Self:
        """Two hands that were read without doubt; None: not in view."""
        return cls(
            UNSEEN if left is None else Sign(left),
            UNSEEN if right is None else Sign(right),
        )

    @property
    def shown(self) -> Shown | None:
        """The pair, or the word of the one card in view; None where a hand was not read, or two cards say two words."""
        left, right = self.left, self.right
        if left.is_word or right.is_word:
            words = {sign.token for sign in (left, right) if sign.is_word and sign.token is not None}
            return (words.pop(),) if len(words) == 1 else None
        if left.token is None or right.token is None:
            return None
        return left.token, right.token

    @property
    def confidence(self) -> float:
        """How sure what is shown is, 0 to 1: the less sure hand decides, and of a card the card alone."""
        left, right = self.left, self.right
        if left.is_word != right.is_word:
            return left.confidence if left.is_word else right.confidence
        return min(left.confidence, right.confidence)
