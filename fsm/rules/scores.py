"""What a frame says for and against every sign, as numbers that add up over time."""

import math
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.fsm.language.grammar import Grammar
from lightgesture.fsm.signs import Sign, Signs

Scores = NDArray[np.float64]
"""Natural logarithms of probabilities, (columns,): one column a sign, both hands together."""

RATE: Final = 6.0
"""Independent looks a second, 1/s: neighbouring frames err alike, so that a frame counts for its share of a second and
the camera's rate does not matter."""

LEAST: Final = 0.01
"""Smallest probability of a token, 0 to 1: no single look may forbid a reading."""

HIDDEN: Final = 0.05
"""Probability of every token of a hand that is not in view, 0 to 1: between doubtful and wrong."""

UNREAD: Final = 0.1
"""The same of a hand that is in view and of which the reader told nothing."""

GAP: Final = 0.2
"""Probability, of one hand, of whatever is shown between two signs, 0 to 1: a sign must be clearer than this."""

GAP_SCORE: Final = 2 * math.log(GAP)
"""The same of both hands, as a score."""

SLACK: Final = 0.01
"""By how much the probabilities of one hand may sum to more than one, rounded as they are."""

_LEAST_SCORE: Final = math.log(LEAST)
_HIDDEN_SCORE: Final = math.log(HIDDEN)


class SignScores:
    """Frames as scores of every sign that a grammar's tokens can form.

    The columns are all pairs of tokens, whether or not they say a word, left hand first, and after them the grammar's
    words, which cards say by themselves.
    """

    def __init__(self, grammar: Grammar) -> None:
        self._tokens = grammar.tokens
        self._places = {token: place for place, token in enumerate(grammar.tokens)}
        self.words = tuple(sorted(grammar.vocabulary.words))
        self._pairs = len(grammar.tokens) ** 2
        self.size = self._pairs + len(self.words)
        self._cards = {word: self._pairs + place for place, word in enumerate(self.words)}
        self._least = np.full(self.size, 2 * _LEAST_SCORE)
        self._half = self._least / 2
        self._hidden = [_HIDDEN_SCORE] * len(grammar.tokens)
        self._last: list[tuple[Sign | None, list[float]]] = [(None, self._hidden), (None, self._hidden)]

    def column(self, shown: Sequence[str]) -> int:
        """The column of a pair, or of one word that says itself."""
        if len(shown) == 1:
            return self._cards[shown[0]]
        return self._places[shown[0]] * len(self._tokens) + self._places[shown[1]]

    def shown(self, column: int) -> tuple[str, ...]:
        """The pair, or the word alone, of a column."""
        if column >= self._pairs:
            return (self.words[column - self._pairs],)
        left, right = divmod(column, len(self._tokens))
        return self._tokens[left], self._tokens[right]

    def of(self, signs: Signs) -> tuple[Scores, Scores]:
        """The scores of one frame, each between 2 log LEAST and 0, and the left hand's part of them.

        A card's score stands for two hands that agree.
        """
        scores = self._least.copy()
        if signs.left.is_word or signs.right.is_word:
            shown = signs.shown
            if shown is not None and shown[0] in self._cards:
                scores[self._cards[shown[0]]] = 2 * _score(signs.confidence)
            return scores, scores / 2
        if not (signs.left.seen or signs.right.seen):
            scores.fill(2 * _HIDDEN_SCORE)
            return scores, scores / 2
        left = np.array(self._hand(0, signs.left)).repeat(len(self._tokens))
        of_left = self._half.copy()
        of_left[: self._pairs] = left
        scores[: self._pairs] = left
        self._square(scores)[...] += self._hand(1, signs.right)
        return scores, of_left

    def _square(self, scores: Scores) -> Scores:
        """The scores of the pairs as they lie, (left tokens, right tokens)."""
        return scores[: self._pairs].reshape(len(self._tokens), -1)

    def _hand(self, hand: int, sign: Sign) -> list[float]:
        """The scores of the tokens of one hand; those of the same sign as in the last frame are kept."""
        before, scores = self._last[hand]
        if sign is before:
            return scores
        if not sign.seen:
            scores = self._hidden
        elif sign.probabilities:
            scores = self._of_probabilities(sign.probabilities)
        elif sign.token is not None:
            scores = self._of_token(sign.token, sign.confidence)
        else:
            scores = [math.log(UNREAD)] * len(self._tokens)
        self._last[hand] = sign, scores
        return scores

    def _of_probabilities(self, probabilities: Mapping[str, float]) -> list[float]:
        """What is no number, or missing, counts as LEAST; more than one in all is brought down to one."""
        get = probabilities.get
        chances = [get(token, 0.0) for token in self._tokens]
        total = sum(chances)
        if total > 1.0 + SLACK:
            finite = [chance if 0.0 < chance < math.inf else 0.0 for chance in chances]
            chances = [chance / sum(finite) for chance in finite] if any(finite) else finite
        return [math.log(chance) if LEAST < chance < 1.0 else _score(chance) for chance in chances]

    def _of_token(self, token: str, confidence: float) -> list[float]:
        """One token and how sure it is; the others share the rest."""
        chance = confidence if confidence > LEAST else LEAST
        others = _score((1.0 - chance) / max(1, len(self._tokens) - 1))
        return [_score(chance) if name == token else others for name in self._tokens]


def _score(chance: float) -> float:
    if chance > LEAST:  # what is no number is not
        return math.log(chance) if chance < 1.0 else 0.0
    return _LEAST_SCORE
