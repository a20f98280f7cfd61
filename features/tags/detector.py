"""Finds the tags of a picture: OpenCV's own detector, looked after where it misses, or AprilTag's for murky water."""

from collections.abc import Iterable, Sequence
from typing import Final, Literal, Protocol

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from lightgesture.features.tags.apriltag import AprilTags
from lightgesture.features.tags.following import follow_corners
from lightgesture.features.tags.outlines import dark_inside, read_outlines
from lightgesture.features.tags.sampling import OUTLINE_PX, grown
from lightgesture.features.tags.settings import TagSettings
from lightgesture.features.tags.tag import Tag, cells_of, checked, dictionary
from lightgesture.features.types import Float

Grey = NDArray[np.uint8]
"""uint8 (height, width)."""

DetectorName = Literal["aruco", "apriltag"]
"""OpenCV's detector, or AprilTag's own (`pupil-apriltags`)."""

WINDOWS_PX: Final = (15, 7, 23)
"""Windows of the thresholds, pixels, the one that finds most first. OpenCV's own, 3, 13 and 23, lose tags whose cells
are 5 pixels wide where the card is no brighter than what is behind it."""

GROUP_RATE: Final = 0.03
"""How near the corners of two outlines are for the two to be one, as a share of the perimeter. By OpenCV's own, 0.125,
a tag is one with its white edge, and gone with it where it cannot be named; an edge of a cell is 0.044 away."""

ROWS_STEP: Final = 8
"""How busy a picture is, one row of so many tells."""

NEAR_WINDOW_PX: Final = 53
"""Largest window of the thresholds where a tag was lost, pixels; OpenCV's own largest is 23."""


class TagDetector(Protocol):
    """Finds the tags of grey pictures; each is told with an id of the family."""

    def process(self, grey: Grey, time_s: float) -> tuple[Tag, ...]:
        """The tags of the next picture, at `time_s` seconds, the largest first."""
        ...


def make_detector(
    name: DetectorName, family: str, settings: TagSettings | None = None
) -> "ArucoTags | AprilTags":
    """The detector of this name for a family of `tag.DICTIONARIES`.

    ValueError: it does not read the family. ModuleNotFoundError: it is not installed.
    """
    settings = settings or TagSettings()
    return AprilTags(family, settings) if name == "apriltag" else ArucoTags(family, settings)


class ArucoTags:
    """OpenCV's detector over the whole picture, and where a tag was lost once more, enlarged and less strict. Outlines
    that it finds and cannot name are read by their cells.

    It remembers where the tags of a stream were; another stream needs another one.
    """

    def __init__(self, family: str, settings: TagSettings) -> None:
        self._family, self._settings = family, settings
        near = self._parameters(settings.near_threshold, (WINDOWS_PX[1], NEAR_WINDOW_PX))
        near.minOtsuStdDev = settings.least_margin / 2
        low, high = min(WINDOWS_PX), max(WINDOWS_PX)
        whole = self._parameters(settings.threshold, (low, high), (high - low) // (len(WINDOWS_PX) - 1))
        single = [self._parameters(settings.threshold, (side, side)) for side in WINDOWS_PX]
        codes = dictionary(family)
        self._near, self._whole, *self._single = (
            cv2.aruco.ArucoDetector(codes, one) for one in (near, whole, *single)
        )
        self._turn = -1
        self._last: dict[int, tuple[Tag, float]] = {}
        self._before: Grey | None = None
        self._before_s = 0.0

    def _parameters(
        self, threshold: int, windows: tuple[int, int], step: int | None = None
    ) -> cv2.aruco.DetectorParameters:
        """OpenCV's own but for the thresholds. windows: the least and the largest, pixels."""
        parameters = cv2.aruco.DetectorParameters()
        parameters.adaptiveThreshConstant = threshold
        parameters.adaptiveThreshWinSizeMin, parameters.adaptiveThreshWinSizeMax = windows
        if step is not None:
            parameters.adaptiveThreshWinSizeStep = step
        # A card may be held so that its white edge is cut by the picture's.
        parameters.minDistanceToBorder = 0
        parameters.minMarkerDistanceRate = GROUP_RATE
        parameters.minMarkerPerimeterRate = self._settings.least_perimeter
        return parameters

    def process(self, grey: Grey, time_s: float) -> tuple[Tag, ...]:
        """See TagDetector."""
        named, read = self._detect(self._choose(grey), grey, grey, 1.0, (0, 0))
        found = _distinct([*named, *(tag for tag in read if self._is_sure(tag, time_s))])
        found += self._follow(grey, time_s, {tag.id for tag in found})
        for tag in found:
            self._last[tag.id] = tag, time_s
        self._before, self._before_s = grey, time_s
        return tuple(sorted(found, key=lambda tag: -tag.side))

    def _is_sure(self, tag: Tag, time_s: float) -> bool:
        """Whether a tag that only its cells tell is all but flawless, or where it was shortly before."""
        if tag.agreement >= self._settings.alone_agreement:
            return True
        last, last_s = self._last.get(tag.id, (None, 0.0))
        if last is None or not 0.0 <= time_s - last_s <= self._settings.follow_s:
            return False
        return _apart(tag, last) <= (1.0 + self._settings.follow_reach) * last.side

    def _choose(self, grey: Grey) -> cv2.aruco.ArucoDetector:
        """All windows; one of them in turn where the picture is busy and no tag was lost that is still looked for."""
        is_lost = self._before is None or any(at_s != self._before_s for _, at_s in self._last.values())
        if is_lost or busyness(grey, self._settings.threshold) < self._settings.busy:
            return self._whole
        self._turn = (self._turn + 1) % len(self._single)
        return self._single[self._turn]

    def _follow(self, grey: Grey, time_s: float, found: set[int]) -> list[Tag]:
        """Tags that were seen shortly before and not found now, from where they were."""
        tags: list[Tag] = []
        for number, (tag, last_s) in list(self._last.items()):
            if not 0.0 <= time_s - last_s <= self._settings.follow_s:
                del self._last[number]
            elif number not in found:
                again = self._look_near(grey, tag) or self._flow(grey, tag, last_s)
                tags += [] if again is None else [again]
        return tags

    def _look_near(self, grey: Grey, tag: Tag) -> Tag | None:
        """A lost tag by a closer look at where it was."""
        window, corner = _window(grey, tag, self._settings.follow_reach)
        if min(window.shape) == 0:
            return None
        scale = 2.0 if tag.side < self._settings.small_side else 1.0
        named, read = self._detect(self._near, window, grey, scale, corner)
        own = [other for other in (*named, *read) if other.id == tag.id]
        return max(own, key=lambda other: other.agreement, default=None)

    def _flow(self, grey: Grey, tag: Tag, last_s: float) -> Tag | None:
        """A tag of the frame before by how its cells moved."""
        before = self._before
        if before is None or last_s != self._before_s or before.shape != grey.shape:
            return None
        corners = follow_corners(before, grey, tag.corners, len(cells_of(self._family, tag.id)))
        return None if corners is None else checked(grey, self._family, tag.id, corners, self._settings)

    def _detect(
        self,
        detector: cv2.aruco.ArucoDetector,
        window: Grey,
        grey: Grey,
        scale: float,
        corner: tuple[int, int],
    ) -> tuple[list[Tag], list[Tag]]:
        """Tags of a window of the picture, whose upper left corner is at `corner`, looked at `scale` times as large:
        those that OpenCV names, and those whose outline it found and that only their cells tell."""
        if scale != 1.0:
            larger = cv2.resize(window, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
            window = np.asarray(larger, np.uint8)
        corners, ids, others = detector.detectMarkers(window)
        numbers = [] if ids is None else [int(number) for number in ids.ravel()]
        named = zip(numbers, self._placed(_stacked(corners), scale, corner), strict=True)
        margin = self._settings.least_margin
        rejected = dark_inside(window, _stacked(others), self._family, margin)
        outlines = grown(self._placed(rejected, scale, corner), OUTLINE_PX / scale)
        read = read_outlines(grey, outlines, self._family, margin)
        return self._checked(grey, named), self._checked(grey, read)

    def _placed(self, outlines: Float, scale: float, corner: tuple[int, int]) -> Float:
        """Outlines of a window, (k, 4, 2), where they are in the picture."""
        half, origin = np.float32(0.5), np.array(corner, np.float32)
        return np.asarray((outlines + half) / np.float32(scale) - half + origin, np.float32)

    def _checked(self, grey: Grey, read: Iterable[tuple[int, Float]]) -> list[Tag]:
        """Those whose cells bear them out."""
        tags = (checked(grey, self._family, number, corners, self._settings) for number, corners in read)
        return [tag for tag in tags if tag is not None]


def _stacked(outlines: Sequence[ArrayLike]) -> Float:
    """Outlines as OpenCV gives them, each (1, 4, 2), as (k, 4, 2)."""
    return np.array(outlines, np.float32).reshape(-1, 4, 2)


def _apart(one: Tag, other: Tag) -> float:
    """Distance of the centres, pixels."""
    return float(np.hypot(*np.subtract(one.centre, other.centre)))


def _distinct(tags: Iterable[Tag]) -> list[Tag]:
    """The tags without those that are one seen twice; the first counts."""
    found: list[Tag] = []
    for tag in tags:
        if all(tag.id != other.id or _apart(tag, other) > 0.5 * other.side for other in found):
            found.append(tag)
    return found


def busyness(grey: Grey, threshold: int) -> float:
    """Share of pixels, 0 to 1, that differ by more than `threshold` grey levels from the second one beside them."""
    rows = grey[::ROWS_STEP]
    if rows.shape[1] <= 2:
        return 0.0
    apart = cv2.absdiff(rows[:, 2:], rows[:, :-2])
    return float(np.count_nonzero(apart > threshold) / apart.size)


def _window(picture: Grey, tag: Tag, reach: float) -> tuple[Grey, tuple[int, int]]:
    """The part of a picture round a tag, and its upper left corner."""
    margin = max(reach * tag.side, 8.0)
    left, top = (max(int(low - margin), 0) for low in tag.corners.min(axis=0))
    right, bottom = (int(high + margin) + 1 for high in tag.corners.max(axis=0))
    return picture[top:bottom, left:right], (left, top)
