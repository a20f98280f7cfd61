"""The bank of hand contours of the paper's region selection: Hu moments and the class they stand for.

The bank is built in memory from `hands/train` whenever it is needed and never stored. Contours come from the
source `massey`, whose hands are cut out on black (Barczak et al., "A new 2D static hand gesture colour image
dataset for ASL gestures", 2011). It has no thumb gestures: their contours are drawn from the landmarks of
other sources.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.sources import read_picture
from lightgesture.training.datasets import read_landmarks, read_table
from lightgesture.training.pictures.cutouts import draw_hand

Moments = NDArray[np.float64]
Contour = NDArray[np.int32]

HU_FLOOR = 1e-5
"""Hu moments below this are left out of the distance, as `cv2.matchShapes` does."""


CUT_OUT_SET: Final = "massey"
"""Source whose pictures are black around the hand."""

LEFT_OUT: Final = frozenset({"emre_drone"})
"""Sources that show the people of scored frames, those of `frames/drone`."""

BLACK_LEVEL: Final = 16
"""Grey level, 0 to 255, above which a pixel of cut-out pictures belongs to the hand; higher eats shadows."""

PER_CLASS: Final = 30
"""Contours a class; more cost time and gain little, neighbours being of the same five subjects."""

FINGER_WIDTH: Final = 0.28
"""Width of a drawn finger over the palm's length (wrist to middle knuckle)."""

ACCEPTED_SHARE: Final = 0.95
"""Share of the bank's hands that must lie within the accepted distance of another subject's; higher accepts more shapes
that are no hands."""


@dataclass(frozen=True, slots=True, eq=False)
class HandBank:
    """Hu moments of hand contours.

    moments: float64 (n, 7), seen as a left hand. tokens: the class of each.
    accepted_distance: above it a contour is no hand.
    """

    moments: Moments
    tokens: tuple[str, ...]
    accepted_distance: float

    def nearest(self, contour: Contour, mirrored: bool = False) -> tuple[str, float]:
        """Class of the nearest contour and its distance; `mirrored` compares the contour's mirror image."""
        distances = hu_distances(hu_moments(contour, mirrored), self.moments)
        index = int(np.argmin(distances))
        return self.tokens[index], float(distances[index])


def hu_moments(contour: Contour, mirrored: bool = False) -> Moments:
    """The seven Hu moments of a contour, float64 (7,) (Hu, IRE Trans. Information Theory 8, 1962).

    A mirror image changes the sign of the seventh alone.
    """
    moments = np.asarray(cv2.HuMoments(cv2.moments(contour)), dtype=np.float64).reshape(7)
    if mirrored:
        moments[6] = -moments[6]
    return moments


def hu_distances(moments: Moments, bank: Moments) -> Moments:
    """Distance of Hu moments (7,) to each row of (n, 7), float64 (n,): `cv2.CONTOURS_MATCH_I1`.

    The sum over i of |1/m_i - 1/b_i| with m_i = sign(h_i) log10 |h_i|, moments below `HU_FLOOR` left out.
    """
    valid = (np.abs(moments) > HU_FLOOR) & (np.abs(bank) > HU_FLOOR)
    difference = np.abs(_reciprocal_log(bank) - _reciprocal_log(moments))
    return np.asarray(np.where(valid, difference, 0.0).sum(axis=1))


def _reciprocal_log(moments: Moments) -> Moments:
    magnitude = np.maximum(np.abs(moments), HU_FLOOR)
    return np.asarray(1.0 / (np.sign(moments + (moments == 0)) * np.log10(magnitude)))


def largest_contour(mask: NDArray[np.uint8]) -> Contour | None:
    """Outer contour of the largest region of a mask, int32 (n, 2), None for an empty mask."""
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    if not contours:
        return None
    return np.asarray(max(contours, key=cv2.contourArea), dtype=np.int32).reshape(-1, 2)


def drawn_contour(landmarks: NDArray[np.float32]) -> Contour | None:
    """Contour of a hand drawn as thick strokes along its 21 landmarks, float32 (21, 2) pixels."""
    low = landmarks.min(axis=0)
    reach = landmarks.max(axis=0) - low
    margin = float(reach.max()) / 2  # more than half of any stroke
    columns, rows = np.ceil(reach + 2 * margin).astype(int).tolist()
    return largest_contour(draw_hand((rows, columns), landmarks - low + margin, FINGER_WIDTH))


def build_bank(data: Path) -> HandBank:
    """Build the bank from `hands/train` of a data folder."""
    rows = [
        row
        for row in read_table(data, "hands/train.csv")
        if row["token"] != "none" and row["set"] not in LEFT_OUT
    ]
    cut_out = {row["token"] for row in rows if row["set"] == CUT_OUT_SET}
    moments: list[Moments] = []
    tokens: list[str] = []
    subjects: list[str] = []
    for token in sorted({row["token"] for row in rows}):
        is_cut_out = token in cut_out
        members = [row for row in rows if row["token"] == token]
        if is_cut_out:
            members = [row for row in members if row["set"] == CUT_OUT_SET]
        for row in _evenly(members, PER_CLASS):
            contour = _cut_out_contour(data, row) if is_cut_out else drawn_contour(read_landmarks(row))
            if contour is not None:
                moments.append(hu_moments(contour))
                tokens.append(token)
                subjects.append(f"{row['set']} {row['subject']}")
    bank = np.stack(moments)
    return HandBank(bank, tuple(tokens), _accepted_distance(bank, subjects))


def _cut_out_contour(data: Path, row: dict[str, str]) -> Contour | None:
    image = read_picture(data / "hands" / row["path"])
    return largest_contour((image.max(axis=2) > BLACK_LEVEL).astype(np.uint8))


def _evenly(rows: Sequence[dict[str, str]], count: int) -> list[dict[str, str]]:
    count = min(count, len(rows))
    return [rows[index * len(rows) // count] for index in range(count)]


def _accepted_distance(bank: Moments, subjects: Sequence[str]) -> float:
    """Distance within which ACCEPTED_SHARE of the contours find one of another subject."""
    names = np.asarray(subjects)
    nearest = []
    for moments, subject in zip(bank, subjects, strict=True):
        others = bank[names != subject]
        if len(others):
            nearest.append(hu_distances(moments, others).min())
    return float(np.quantile(nearest, ACCEPTED_SHARE)) if nearest else float("inf")
