"""The outline of the hand inside its patch, and the contour numbers of the paper's region selection.

The outline is found by colour, without a model of skin (`likeness`); Otsu's threshold cuts along it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.outline.likeness import Regions, hand_likeness, make_regions
from lightgesture.features.types import Contour, Float

Mask = NDArray[np.uint8]
Moments = dict[str, float]
"""What `cv2.moments` gives."""


@dataclass(frozen=True, slots=True)
class ContourSettings:
    """How the outline is found and measured."""

    size: int = 32
    """Side in pixels to which a patch is reduced first, 16 to 64."""
    middle_width: float = 0.45
    """Half axis along x of the ellipse that is taken for hand, a share of half the side, 0.2 to 1."""
    middle_height: float = 0.6
    """Its half axis along y."""
    rim: float = 0.1
    """Width of the border that is taken for background, a share of the side, 0 to 0.25; without the lower quarter,
    where the wrist leaves the patch."""
    evenness: float = 1e-3
    """Added to the scatter of the square-root colours (0 to 1), so that a flat patch divides by something."""
    prior: float = 0.4
    """Weight of a bump in the middle against the colour difference, both in standard deviations."""
    deep: float = 0.08
    """Smallest depth of a convexity defect that counts as the gap between two fingers, a share of the side."""
    directions: int = 24
    """Of the radial signature; each is a number of the vector."""


DEFECTS: Final = 4
"""Depths of convexity defects in the vector: five fingers have four gaps."""

SHAPE_NUMBERS: Final = 6
"""Area, solidity, extent, aspect, circularity, number of deep defects."""

HU_COUNT: Final = 7
"""Number of Hu's invariants."""

SMALLEST: Final = 1e-12
"""Moments nearer to zero than this count as this: a symmetric outline has several that are rounding errors."""

LOG_SMALLEST: Final = math.log10(SMALLEST)
"""Of it the logarithm is 0 in the vector."""

DEPTH_UNIT: Final = 256.0
"""OpenCV gives the depth of a convexity defect as an integer, in this share of a pixel."""


def contour_length(settings: ContourSettings | None = None) -> int:
    """Numbers that one patch gives."""
    settings = settings or ContourSettings()
    return SHAPE_NUMBERS + DEFECTS + HU_COUNT + settings.directions


def contour_vectors(patches: NDArray[np.uint8], settings: ContourSettings | None = None) -> Float:
    """Contour numbers of patches, uint8 (n, size, size, 3), as float32 (n, `contour_length`).

    All patches go through together: for two hands NumPy's calls take longer than what they compute.
    """
    settings = settings or ContourSettings()
    vectors = np.zeros((len(patches), contour_length(settings)), np.float32)
    contours = {
        index: contour
        for index, levels in enumerate(hand_likeness(_reduced(patches, settings.size), _regions(settings)))
        if (contour := _hand_outline(levels, settings)) is not None
    }
    if contours:
        vectors[list(contours)] = _numbers(list(contours.values()), settings)
    return vectors


def segment(patch: NDArray[np.uint8], settings: ContourSettings | None = None) -> Mask:
    """Mask of the hand, uint8 (settings.size, settings.size), 255 on one connected region or nowhere."""
    return segments(patch[None], settings or ContourSettings())[0]


def segments(patches: NDArray[np.uint8], settings: ContourSettings) -> list[Mask]:
    """The mask of each patch, uint8 (n, size, size, 3); see `segment`."""
    likeness = hand_likeness(_reduced(patches, settings.size), _regions(settings))
    return [_middle_region(_cut(levels), settings) for levels in likeness]


@lru_cache(maxsize=4)
def _regions(settings: ContourSettings) -> Regions:
    axes = settings.middle_width, settings.middle_height
    return make_regions(settings.size, axes, settings.rim, settings.evenness, settings.prior)


def _reduced(patches: NDArray[np.uint8], size: int) -> NDArray[np.uint8]:
    """The patches, uint8 (n, size, size, 3)."""
    if not len(patches) or patches.shape[1:3] == (size, size):
        return patches
    reduced = [cv2.resize(patch, (size, size), interpolation=cv2.INTER_AREA) for patch in patches]
    return np.stack([np.asarray(patch, np.uint8) for patch in reduced])


def _cut(levels: NDArray[np.uint8]) -> Mask:
    """What Otsu's threshold keeps."""
    return np.asarray(cv2.threshold(levels, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)[1], np.uint8)


def _hand_outline(levels: NDArray[np.uint8], settings: ContourSettings) -> Contour | None:
    """`outline` of the region that `segment` gives: where all that is kept hangs together, there is no choice."""
    binary = _cut(levels)
    # An outline for each region, also for one in a hole of another, the first one's before those of its holes.
    contours, tree = cv2.findContours(binary, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    if not contours:
        return None
    is_one_region = tree[0, 0, 0] < 0
    half = settings.size // 2
    # The pixel in the very middle mostly answers for all.
    if is_one_region and (binary[half, half] or binary.reshape(-1)[_regions(settings).middle].any()):
        return _with_area(np.asarray(contours[0], np.int32))
    return outline(_middle_region(binary, settings))


def _middle_region(binary: Mask, settings: ContourSettings) -> Mask:
    """Of what a mask keeps, the connected region that fills most of the middle."""
    count, labels = cv2.connectedComponents(binary, ltype=cv2.CV_16U)
    in_the_middle = np.bincount(np.asarray(labels).reshape(-1)[_regions(settings).middle], minlength=2)
    in_the_middle[0] = 0
    chosen = int(in_the_middle.argmax())
    if not in_the_middle[chosen]:
        return np.zeros_like(binary)
    return binary if count == 2 else np.asarray(cv2.inRange(labels, chosen, chosen), np.uint8)


def outline(mask: Mask) -> Contour | None:
    """Outer outline of the largest region of a mask, int32 (n, 2); None without one that has an area."""
    contours = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
    largest = max(contours, key=cv2.contourArea, default=None)
    return None if largest is None else _with_area(np.asarray(largest, np.int32))


def _with_area(contour: Contour) -> Contour | None:
    return contour.reshape(-1, 2) if cv2.contourArea(contour) > 0.0 else None


def contour_numbers(contour: Contour, settings: ContourSettings | None = None) -> Float:
    """Numbers of one outline, int32 (n, 2) in pixels of a picture `settings.size` wide, as float32.

    In order: area (share of the patch), solidity (area over the hull's), extent (area over the box's), aspect
    (width over height), circularity (4 pi area / perimeter²), number of deep convexity defects; the four deepest
    defects as shares of the side; the log-signed Hu moments over 10; the radial signature.
    """
    return np.asarray(_numbers([contour], settings or ContourSettings())[0], np.float32)


def _numbers(contours: Sequence[Contour], settings: ContourSettings) -> Float:
    """`contour_numbers` of several outlines, float32 (n, `contour_length`)."""
    moments = [cv2.moments(contour.reshape(-1, 1, 2)) for contour in contours]
    shapes = [_shape(contour, one["m00"], settings) for contour, one in zip(contours, moments, strict=True)]
    invariants = np.array([_hu_of(one) for one in moments])
    signatures = _signatures(contours, moments, settings.directions)
    return np.concatenate([shapes, log_signed(invariants) / 10.0, signatures], axis=1).astype(np.float32)


def _shape(contour: Contour, area: float, settings: ContourSettings) -> list[float]:
    """The numbers before the moments, of an outline with so many square pixels inside."""
    area = max(area, 1.0)
    hull = _hull(contour)
    hull_area = max(float(cv2.contourArea(contour[hull])), area)
    perimeter = max(float(cv2.arcLength(contour, True)), 1.0)
    _, _, width, height = cv2.boundingRect(contour)
    # Outlines in a triangle count as whole: the shipped classifiers learnt from numbers in which they do.
    depths = sorted(_depths(contour, hull), reverse=True) if len(hull) > 3 else []
    shares = [depth / settings.size for depth in depths]
    return [
        area / settings.size**2,
        area / hull_area,
        area / (width * height),
        width / height,
        4.0 * np.pi * area / perimeter**2,
        float(sum(share > settings.deep for share in shares)) / DEFECTS,
        *(shares + [0.0] * DEFECTS)[:DEFECTS],
    ]


def hu_moments(contour: Contour) -> NDArray[np.float64]:
    """Hu's seven invariants of the area inside a closed outline, int32 (n, 2), as float64 (7,); zeros without area.

    Hu, "Visual Pattern Recognition by Moment Invariants", IRE Transactions on Information Theory 8, 1962. They do not
    change when the outline is moved, turned or enlarged; its mirror image changes the sign of the seventh.
    """
    return np.array(_hu_of(cv2.moments(contour.reshape(-1, 1, 2))))


def _hu_of(moments: Moments) -> list[float]:
    """Of `cv2.moments`. OpenCV's own function takes four times as long, most of it to look into the dictionary."""
    if moments["m00"] == 0.0:
        return [0.0] * HU_COUNT
    n20, n11, n02 = moments["nu20"], moments["nu11"], moments["nu02"]
    n30, n21, n12, n03 = moments["nu30"], moments["nu21"], moments["nu12"], moments["nu03"]
    across, down, cross = n30 + n12, n21 + n03, 4.0 * n11
    squared_x, squared_y, difference = across * across, down * down, n20 - n02
    third_x, third_y = n30 - 3.0 * n12, 3.0 * n21 - n03
    cubed_x, cubed_y = across * (squared_x - 3.0 * squared_y), down * (3.0 * squared_x - squared_y)
    return [
        n20 + n02,
        difference * difference + cross * n11,
        third_x * third_x + third_y * third_y,
        squared_x + squared_y,
        third_x * cubed_x + third_y * cubed_y,
        difference * (squared_x - squared_y) + cross * across * down,
        third_y * cubed_x - third_x * cubed_y,
    ]


def log_signed(moments: NDArray[np.float64]) -> NDArray[np.float64]:
    """sign(h) (12 + log10 |h|), float64 of any shape: comparable sizes, the sign of a mirror image kept.

    Small moments go to 0 from both signs, so that a sign that is only noise does not matter.
    """
    size = np.maximum(np.abs(moments), SMALLEST)
    return np.asarray(np.sign(moments) * (np.log10(size) - LOG_SMALLEST))


def defect_depths(contour: Contour) -> NDArray[np.float64]:
    """Depths in pixels of the dents of a closed outline, int32 (n, 2), as float64 (k,), in its order: how far the
    outline's farthest point lies from the hull between two places where it meets it.

    Turned, mirrored: the same. Enlarged: with the outline. Homma and Takenaka, "An image processing method for feature
    extraction of space-occupying lesions", 1985.
    """
    return np.array(_depths(contour, _hull(contour)), np.float64)


def _hull(contour: Contour) -> NDArray[np.int32]:
    """Numbers of the points where the outline meets its hull, int32 (k,), falling."""
    hull = np.asarray(cv2.convexHull(contour.reshape(-1, 1, 2), returnPoints=False)).reshape(-1)
    # OpenCV refuses a hull whose indices are not monotonous, which rounding makes of outlines that touch themselves.
    hull.sort()
    return np.ascontiguousarray(hull[::-1], np.int32)


def _depths(contour: Contour, hull: NDArray[np.int32]) -> list[float]:
    if len(contour) < 4 or len(hull) < 3:
        return []
    defects = cv2.convexityDefects(contour.reshape(-1, 1, 2), hull.reshape(-1, 1))
    if defects is None:
        return []
    return [depth / DEPTH_UNIT for depth in defects.reshape(-1, 4)[:, 3].tolist()]


def radial_signature(contour: Contour, directions: int) -> NDArray[np.float64]:
    """Farthest reach of the outline from its centroid in each direction, float64 (directions,).

    In units of the square root of the area; direction 0 is along x, the next turn towards y (down). Directions
    without a point take the smaller of their neighbours, else 0.
    """
    return np.asarray(_signatures([contour], [cv2.moments(contour.reshape(-1, 1, 2))], directions)[0])


def _signatures(
    contours: Sequence[Contour], moments: Sequence[Moments], directions: int
) -> NDArray[np.float64]:
    """`radial_signature` of several outlines, float64 (n, directions), given their moments."""
    # A column for each direction from half a turn back to half a turn on, which are the same one, and one before them.
    half, columns = directions // 2, directions + 2
    origins = np.array([(*_centre(one), half + 1.5 + number * columns) for number, one in enumerate(moments)])
    x, y, _, begins = origins.repeat([len(contour) for contour in contours], axis=0).T
    across, down = np.concatenate(contours).T
    across, down = across - x, down - y
    places = np.arctan2(down, across)
    places *= directions / (2 * np.pi)
    places += begins
    across *= across
    down *= down
    across += down
    around = np.zeros((len(contours), columns))
    # With one row of numbers for places NumPy takes a third of the time that it takes with two.
    np.maximum.at(around.reshape(-1), places.astype(np.intp), across)
    np.maximum(around[:, 1], around[:, -1], out=around[:, 1])
    around[:, 0], around[:, -1] = around[:, -2], around[:, 1]
    around = np.sqrt(around, out=around)
    around /= origins[:, 2:3]
    found = around[:, 1:-1]
    signatures = np.where(found > 0, found, np.minimum(around[:, :-2], around[:, 2:]))
    return np.concatenate([signatures[:, half:], signatures[:, :half]], axis=1)


def _centre(moments: Moments) -> tuple[float, float, float]:
    """x and y of the centroid and the square root of the area."""
    area = max(moments["m00"], 1.0)
    return moments["m10"] / area, moments["m01"] / area, area**0.5
