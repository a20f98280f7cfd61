"""Colour profiles learnt from pictures whose hands are known.

As in Jones and Rehg, "Statistical Color Models with Application to Skin Detection", IJCV 46(1), 2002: one histogram
says how often hands have a colour, another how often other things have it, and the profile is the logarithm of their
ratio.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourStage
from lightgesture.features.find.proposals import propose
from lightgesture.features.geometry import pairwise_iou
from lightgesture.features.profile import UNDECIDED, ColourProfile, Kind, colour_cells
from lightgesture.features.types import Box, Image

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]


BINS: Final = 16
"""Cells of each channel; a file may hold 4 to 24."""
REACH: Final = 3.0
"""Standard deviations that the cells span to either side of a channel's mean."""
SMOOTHING: Final = 0.5
"""Of the histograms, standard deviation in cells: by so much light and shade vary one glove. More lets pale gloves run
into pale water."""
UNSEEN: Final = 0.3
"""Share of the other things that is taken to have any colour at all, 0 to 1: the next place looks different from the
one that was learnt from."""
STEEPNESS: Final = 4.0
"""Natural logarithm of the ratio at which the map ends, at 0 or at 255."""
INSIDE: Final = 0.6
"""Axes of the ellipse within a hand's box that is taken for hand at first, over the box's sides."""
OUTSIDE: Final = 1.3
"""Sides round the box beyond which everything is something else, over the box's."""
FITTING_IOU: Final = 0.5
"""Overlap from which a region fits a hand."""


@dataclass(frozen=True, slots=True, eq=False)
class _Known:
    """One picture: the cell of each pixel, (h, w); which pixels are hand, which surely are not, and which may be."""

    cells: NDArray[np.intp]
    hand: Mask
    other: Mask
    doubtful: Mask


def learn_profile(
    images: Sequence[Image],
    hands: Sequence[Sequence[Box] | Mask],
    kind: Kind,
    origin: str,
) -> ColourProfile:
    """Learn a profile.

    images: uint8 (h, w, 3), BGR; a dozen of the size of the working picture are plenty. hands: for each picture the
    boxes of all its hands, or a mask of them, bool (h, w). A hand that is left out is learnt as something else.
    Raises ValueError, one line, where no picture shows a hand.
    """
    if len(images) != len(hands):
        raise ValueError(f"{len(images)} pictures and hands of {len(hands)}; give the hands of each picture")
    known = [_known(image, shown) for image, shown in zip(images, hands, strict=True)]
    known = [picture for picture in known if picture.hand.any() and picture.other.any()]
    if not known:
        raise ValueError("no picture shows a hand and something else; show open hands at arm's length")
    first = _levels(_counts(known))
    known = [_refined(picture, first) for picture in known]
    levels = _levels(_counts(known))
    return ColourProfile(kind, origin, _separation(known), REACH, levels)


def proposed_share(
    images: Sequence[Image],
    boxes: Sequence[Sequence[Box]],
    profile: ColourProfile | None = None,
) -> float:
    """Share of the hands for which the map has a region that fits, 0 to 1: what a profile is worth, beside None.

    boxes: for each picture those of its hands; without any the share is 0.
    """
    stage = ColourStage(profile=profile)
    fits, hands = 0, 0
    for image, wanted in zip(images, boxes, strict=True):
        colour = stage.process(image)
        truth = np.array(wanted, np.float64).reshape(-1, 4) / np.tile(colour.scale, 2)
        overlap = pairwise_iou(propose(colour).boxes, truth)
        fits += int((overlap >= FITTING_IOU).any(axis=0).sum())
        hands += len(truth)
    return fits / max(hands, 1)


def _known(image: Image, hands: Sequence[Box] | Mask) -> _Known:
    cells = colour_cells(image, BINS, REACH)
    nothing = np.zeros(cells.shape, bool)
    if isinstance(hands, np.ndarray):
        return _Known(cells, hands, ~hands, nothing)
    hand, other, doubtful = nothing, ~nothing, nothing.copy()
    rows, columns = np.ogrid[: cells.shape[0], : cells.shape[1]]
    for x, y, width, height in hands:
        across = np.abs(columns + 0.5 - x - width / 2) / (width / 2)
        down = np.abs(rows + 0.5 - y - height / 2) / (height / 2)
        hand |= np.square(across) + np.square(down) < INSIDE**2
        other &= np.maximum(across, down) > OUTSIDE
        doubtful |= np.maximum(across, down) <= 1.0
    return _Known(cells, hand, other, doubtful)


def _refined(picture: _Known, levels: NDArray[np.uint8]) -> _Known:
    """Fingers lie outside the ellipse and water inside it: what looks like a hand within its box is the hand."""
    alike = levels.ravel()[picture.cells] > UNDECIDED
    hand = np.where(picture.doubtful, alike, picture.hand)
    return _Known(picture.cells, hand, picture.other, picture.doubtful)


def _counts(known: Sequence[_Known]) -> Float:
    """How many pixels of hands and of other things fall into each cell, (2, bins³); every picture counts the same."""
    counts = np.zeros((2, BINS**3))
    for picture in known:
        for row, chosen in zip(counts, (picture.hand, picture.other), strict=True):
            found = np.bincount(picture.cells[chosen], minlength=BINS**3)
            row += found / max(int(found.sum()), 1)
    return counts


def _levels(counts: Float) -> NDArray[np.uint8]:
    """The table of a profile, uint8 (bins, bins, bins)."""
    steps = np.arange(BINS)
    kernel = np.exp(-0.5 * np.square((steps[:, None] - steps) / SMOOTHING))
    kernel /= kernel.sum(axis=0)
    shares = (counts / np.maximum(counts.sum(axis=1, keepdims=True), 1e-12)).reshape(2, BINS, BINS, BINS)
    hand, other = np.einsum("ai,bj,ck,nijk->nabc", kernel, kernel, kernel, shares, optimize=True)
    even = 1.0 / BINS**3
    other = (1.0 - UNSEEN) * other + UNSEEN * even
    # A trace of the even share keeps the logarithm of a colour that hands never had finite.
    ratio = np.log(np.maximum(hand, 1e-3 * even) / other)
    return np.asarray(np.clip(UNDECIDED + ratio * (127.5 / STEEPNESS), 0, 255), np.uint8)


def _separation(known: Sequence[_Known]) -> float:
    """Area under the ROC curve over pixels: each half of the pictures judged by what the other half teaches.

    A single picture is judged by itself, which flatters it.
    """
    halves = (known[::2], known[1::2]) if len(known) > 1 else (known, known)
    counts = [_counts(half) for half in halves]
    areas = []
    for taught, judged in (counts, counts[::-1]):
        levels = _levels(taught).ravel()
        hand, other = (
            np.bincount(levels, weights=row, minlength=256) / max(row.sum(), 1e-12) for row in judged
        )
        areas.append(float(hand @ (np.cumsum(other) - 0.5 * other)))
    return float(np.mean(areas))
