"""The contour bank made from a data folder: outlines of cut-out hands, class by class, and of other things."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from lightgesture.features.colour import ColourStage
from lightgesture.features.find.bank import OTHER, Bank, DescriptorSettings, describe_outlines
from lightgesture.features.find.proposals import propose
from lightgesture.features.geometry import pairwise_iou
from lightgesture.features.outline.contours import outline
from lightgesture.features.types import Contour, Float
from lightgesture.models import CLASSES, NONE
from lightgesture.sources import read_picture
from lightgesture.training.datasets import Sample, read_landmarks, read_negatives, read_table, read_webcam
from lightgesture.training.pictures.cutouts import cut_out
from lightgesture.training.pool.left_out import LeftOut
from lightgesture.training.regions.region_pictures import NEGATIVE_SETS, NEVER

CENTRES: Final = 16
"""Typical outlines kept of each token."""
HANDS: Final = 120
"""Outlines of each token from which they are found."""
FRAMES: Final = 240
"""Whole frames in which other things are looked for, of people and of water."""
OTHERS: Final = 8
"""Outlines kept of one frame."""
OTHER_TIMES: Final = 4
"""Centres of other things for one of each hand class: they are far more varied than one sign."""
ROUNDS: Final = 30
"""Most rounds of k-means; it settles in fewer."""
OTHER_IOU: Final = 0.2
"""IoU with every labelled hand below which a region is something else."""


def make_bank(data: Path, seed: int = 0, without: LeftOut | None = None) -> Bank:
    """The bank of the ten tokens and `OTHER`; half a minute. The same arguments give the same bank.

    without: sources that are left out, of hands and of frames alike. Raises InputError, or ValueError where nothing is
    left of a class.
    """
    without = without or LeftOut()
    rng = np.random.default_rng(seed)
    outlines = hand_outlines(data, rng, without)
    outlines[OTHER] = other_outlines(data, rng, without)
    return build_bank(outlines, CENTRES, seed)


def hand_outlines(data: Path, rng: np.random.Generator, without: LeftOut) -> dict[str, list[Contour]]:
    """Outlines of hands of `hands/train`, cut out along their landmarks, by token in the order of CLASSES."""
    by_token: dict[str, list[dict[str, str]]] = {token: [] for token in CLASSES if token != NONE}
    for row in read_table(data, "hands/train.csv"):
        kept = row["set"] not in NEVER and not without.covers(row["set"])
        if kept and row["token"] in by_token:
            by_token[row["token"]].append(row)
    found: dict[str, list[Contour]] = {}
    for token, rows in by_token.items():
        found[token] = []
        for row in _source_by_source(rows, rng):
            contour = cut_out_outline(data, row)
            if contour is not None:
                found[token].append(contour)
            if len(found[token]) == HANDS:
                break
    return found


def _source_by_source(rows: Sequence[dict[str, str]], rng: np.random.Generator) -> Iterator[dict[str, str]]:
    """One row of every source, then a second of each, and so on, so that no person rules."""
    by_source: dict[str, list[dict[str, str]]] = {}
    for index in rng.permutation(len(rows)):
        by_source.setdefault(rows[index]["set"], []).append(rows[index])
    for place in range(max(map(len, by_source.values()), default=0)):
        yield from (own[place] for own in by_source.values() if place < len(own))


def cut_out_outline(data: Path, row: dict[str, str]) -> Contour | None:
    image = read_picture(data / "hands" / row["path"])
    # GrabCut starts its clusters by a generator of OpenCV that goes on from call to call.
    cv2.setRNGSeed(0)
    hand = cut_out(image, read_landmarks(row), row["token"], row["set"])
    return None if hand is None else outline((hand.alpha > 0.5).astype(np.uint8))


def other_outlines(data: Path, rng: np.random.Generator, without: LeftOut) -> list[Contour]:
    """Outlines of regions that are no hands: furniture, walls, clothes and faces of `webcam/train`, and what stands
    out under water."""
    rooms = [sample for sample in read_webcam(data, "train") if not without.covers(sample.source)]
    waters = [
        sample
        for sample in read_negatives(data)
        if sample.source in NEGATIVE_SETS and not without.covers(sample.source)
    ]
    colours = ColourStage()
    found: list[Contour] = []
    for samples in (rooms, waters):
        for index in rng.permutation(len(samples))[: FRAMES // 2]:
            others = _regions_beside_hands(samples[index], colours)
            found += [others[place] for place in rng.permutation(len(others))[:OTHERS]]
    return found


def _regions_beside_hands(sample: Sample, colours: ColourStage) -> list[Contour]:
    colour = colours.process(read_picture(sample.path))
    proposals = propose(colour)
    hands = np.array([label.box for label in sample.labels], np.float64).reshape(-1, 4)
    overlap = pairwise_iou(proposals.boxes, hands / np.tile(colour.scale, 2))
    beside = np.flatnonzero((overlap < OTHER_IOU).all(axis=1))
    return [proposals.contours[index] for index in beside]


def build_bank(
    contours_by_class: Mapping[str, Sequence[Contour]],
    per_class: int,
    seed: int,
    settings: DescriptorSettings | None = None,
) -> Bank:
    """A bank of at most `per_class` centres for each class, `OTHER_TIMES` as many for `OTHER`.

    contours_by_class: outlines as `describe_outlines` takes them; their mirror images count too, because either hand
    may make a sign. A class with fewer outlines than centres gives them all. The same arguments give the same bank.
    Raises ValueError for a class without an outline, or no class.
    """
    settings = settings or DescriptorSettings()
    rng = np.random.default_rng(seed)
    centres, owner = [], []
    for index, (name, contours) in enumerate(contours_by_class.items()):
        if not contours or per_class < 1:
            raise ValueError(
                f"class {name!r} has {len(contours)} outlines for {per_class} centres; give one at least"
            )
        described = describe_outlines(contours, settings)
        count = per_class * (OTHER_TIMES if name == OTHER else 1)
        found = k_means(np.concatenate([described, mirrored(described)]), count, rng)
        centres.append(found)
        owner.append(np.full(len(found), index, np.int16))
    if not centres:
        raise ValueError("no classes; give the outlines of one at least")
    return Bank(tuple(contours_by_class), np.concatenate(centres), np.concatenate(owner), settings)


def k_means(points: Float, count: int, rng: np.random.Generator) -> Float:
    """`count` centres of points, float32 (n, d) -> (min(n, count), d).

    Lloyd's rounds from the seeding of Arthur and Vassilvitskii, "k-means++: The Advantages of Careful Seeding", 2007.
    """
    if len(points) <= count:
        return points
    chosen = [int(rng.integers(len(points)))]
    nearest = np.square(points - points[chosen[0]]).sum(axis=1)
    while len(chosen) < count and nearest.sum() > 0.0:
        chosen.append(int(rng.choice(len(points), p=nearest / nearest.sum())))
        nearest = np.minimum(nearest, np.square(points - points[chosen[-1]]).sum(axis=1))
    centres = points[chosen].astype(np.float64)
    assigned = np.full(len(points), -1)
    for _ in range(ROUNDS):
        squares = np.square(centres).sum(axis=1) - 2.0 * points @ centres.T
        before, assigned = assigned, squares.argmin(axis=1)
        if np.array_equal(before, assigned):
            break
        sums = np.zeros_like(centres)
        np.add.at(sums, assigned, points)
        sizes = np.bincount(assigned, minlength=len(centres))[:, None]
        # A centre that lost its last point stays where it was.
        centres = np.where(sizes > 0, sums / np.maximum(sizes, 1), centres)
    return np.asarray(centres, np.float32)


def mirrored(descriptors: Float) -> Float:
    """Descriptors of the same outlines flipped left to right, float32 (n, settings.length)."""
    half = descriptors.shape[1] // 2
    return np.concatenate([-descriptors[:, :half], descriptors[:, half:]], axis=1)
