"""Whether a probability means what it says: shares of right answers by how sure the classifier was.

The bins and the expected calibration error are those of Guo, Pleiss, Sun and Weinberger, "On Calibration of Modern
Neural Networks", ICML 2017.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lightgesture.benchmarks.reading.hands import HandAnswer
from lightgesture.benchmarks.tables import Cell, Table

BINS = 10
"""Bins of equal width between 0 and 1."""


@dataclass(frozen=True, slots=True)
class Bin:
    """Hands whose likeliest class has a probability in a range. confidence: its mean. right: share of right answers."""

    hands: int
    confidence: float
    right: float


def reliability_bins(answers: Sequence[HandAnswer]) -> list[Bin]:
    """The bins that hold a hand, from unsure to sure; `none` is a class like any other here."""
    sure = np.array([float(answer.probabilities.max()) for answer in answers])
    right = np.array([answer.best == answer.truth for answer in answers], bool)
    places = np.minimum((sure * BINS).astype(int), BINS - 1)
    return [
        Bin(
            int((places == place).sum()),
            float(sure[places == place].mean()),
            float(right[places == place].mean()),
        )
        for place in np.unique(places)
    ]


def calibration_error(bins: Sequence[Bin]) -> float | None:
    """Mean difference of confidence and right answers, each hand with the same weight; None without hands."""
    hands = sum(one.hands for one in bins)
    return sum(one.hands * abs(one.confidence - one.right) for one in bins) / hands if hands else None


def reliability_table(answers: Sequence[HandAnswer], model: str) -> Table:
    """One row a bin, and one for all."""
    bins = reliability_bins(answers)
    rows: list[dict[str, Cell]] = [
        {
            "model": model,
            "bin": f"{one.confidence:.2f}",
            "hands": one.hands,
            "confidence": one.confidence,
            "right": one.right,
            "gap": one.confidence - one.right,
        }
        for one in bins
    ]
    rows.append({"model": model, "bin": "all", "hands": len(answers), "gap": calibration_error(bins)})
    note = (
        "confidence: mean probability of the likeliest class; gap: of `all`, the expected calibration error."
    )
    columns = ("model", "bin", "hands", "confidence", "right", "gap")
    return Table("hands_reliability", "Reliability of the probabilities", columns, tuple(rows), note)
