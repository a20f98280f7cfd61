"""Finds the tags of a picture: OpenCV's own detector, looked after where it misses, or AprilTag's for murky water."""

import threading
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Final, Literal, Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.tags.following import follow_corners
from lightgesture.features.tags.tag import Tag, cells_of, dictionary, examine
from lightgesture.features.types import Float

Grey = NDArray[np.uint8]
"""uint8 (height, width)."""

DetectorName = Literal["aruco", "apriltag"]
"""OpenCV's detector, or AprilTag's own (`pupil-apriltags`)."""

APRILTAG_FAMILIES: Final = {"25h9": "tag25h9", "36h11": "tag36h11"}
"""Families that AprilTag's own library reads, by its names."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TagSettings:
    """What tells a tag from anything else, and what is done for those that are hard to see."""

    least_margin: float = 3.0
    """Least half difference between white and black cells, grey levels, 0 to 127. Less: more is read in murk, and noise
    may be taken for a tag."""
    least_agreement: float = 0.9
    """Least share of cells that are as they should be, 0 to 1. Less: more is read behind fingers and bubbles; the codes
    of 36h11 differ in 11 of 64 cells, so that 0.9 is far from any other."""
    threshold: int = 5
    """How much darker than its surroundings a pixel is to be black, grey levels. Less: more is read in murk and in
    blur, and everything takes longer, for there are more outlines."""
    near_threshold: int = 3
    """The same where a tag was lost."""
    follow_s: float = 1.0
    """How long a tag that is no longer found is looked for where it was last, seconds. More: takes longer."""
    follow_reach: float = 1.0
    """How far round its last place, in sides of the tag. More: quicker cards are followed, which takes longer."""
    small_side: float = 48.0
    """Side below which a tag that is followed is looked at enlarged, pixels."""
    least_perimeter: float = 0.05
    """Least perimeter of a tag as a share of the picture's longer side: 8 pixels a side at 640. OpenCV's own is 0.03.
    Less: reefs, sand and leaves take longer."""
    busy: float = 0.06
    """Share of neighbouring pixels that differ by more than `threshold` from which on a picture is busy, 0 to 1. Then
    one window of WINDOWS_PX is tried a frame, in turn, unless a tag was lost: reefs have thousands of outlines. Less:
    more pictures are quick, and a tag that only one window finds is found a frame or two later."""


WINDOWS_PX: Final = (15, 7, 23)
"""Windows of the thresholds, pixels, the one that finds most first. OpenCV's own, 3, 13 and 23, lose tags whose cells
are 5 pixels wide where the card is no brighter than what is behind it."""

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


def checked(grey: Grey, family: str, number: int, corners: Float, settings: TagSettings) -> Tag | None:
    """The tag with this id and these corners, None where its cells do not bear it out."""
    corners = np.ascontiguousarray(corners, np.float32).reshape(4, 2)
    margin, agreement = examine(grey, corners, cells_of(family, number))
    if margin < settings.least_margin or agreement < settings.least_agreement:
        return None
    return Tag(number, corners, round(margin, 1), round(agreement, 3))


class ArucoTags:
    """OpenCV's detector over the whole picture, and where a tag was lost once more, enlarged and less strict.

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
        # The white edge of a card and its tag are one candidate to OpenCV, and else gone with the edge.
        parameters.minDistanceToBorder = 0
        parameters.minMarkerPerimeterRate = self._settings.least_perimeter
        return parameters

    def process(self, grey: Grey, time_s: float) -> tuple[Tag, ...]:
        """See TagDetector."""
        found = self._detect(self._choose(grey), grey, grey, 1.0, (0, 0))
        found += self._follow(grey, time_s, {tag.id for tag in found})
        for tag in found:
            self._last[tag.id] = tag, time_s
        self._before, self._before_s = grey, time_s
        return tuple(sorted(found, key=lambda tag: -tag.side))

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
        near = self._detect(self._near, window, grey, scale, corner)
        return next((other for other in near if other.id == tag.id), None)

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
    ) -> list[Tag]:
        """Tags of a window of the picture, whose upper left corner is at `corner`, looked at `scale` times as large."""
        if scale != 1.0:
            larger = cv2.resize(window, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
            window = np.asarray(larger, np.uint8)
        corners, ids, _ = detector.detectMarkers(window)
        if ids is None:
            return []
        return _kept(
            [
                checked(
                    grey,
                    self._family,
                    int(number),
                    (outline.reshape(4, 2) + np.float32(0.5)) / np.float32(scale)
                    - np.float32(0.5)
                    + np.array(corner, np.float32),
                    self._settings,
                )
                for number, outline in zip(ids.ravel(), corners, strict=True)
            ]
        )


class AprilTags:
    """AprilTag's own detector, by `pupil-apriltags`: slower, and reads more where water blurs (the extra `tags`)."""

    def __init__(self, family: str, settings: TagSettings) -> None:
        if family not in APRILTAG_FAMILIES:
            known = ", ".join(APRILTAG_FAMILIES)
            raise ValueError(f"'{family}' is no family that apriltag reads; use one of {known}, or aruco")
        self._family, self._settings = family, settings
        self._detector, self._lock = _apriltag(APRILTAG_FAMILIES[family])

    def process(self, grey: Grey, time_s: float) -> tuple[Tag, ...]:  # noqa: ARG002 - as TagDetector has it
        """See TagDetector; each picture is looked at on its own."""
        with self._lock:
            seen = self._detector.detect(np.ascontiguousarray(grey))
        found = [
            # It has the tags of OpenCV upside down, goes round the other way, and counts from the corners of pixels.
            checked(grey, self._family, int(one.tag_id), one.corners[[1, 0, 3, 2]] - 0.5, self._settings)
            for one in seen
        ]
        return tuple(sorted(_kept(found), key=lambda tag: -tag.side))


@cache
def _apriltag(families: str) -> tuple[Any, threading.Lock]:
    """The package's detector, one for the whole process and never given back, and what keeps threads apart: where the
    package frees one it may free memory twice, which ends the process."""
    from pupil_apriltags import Detector

    return Detector(families=families, nthreads=1, quad_decimate=1.0), threading.Lock()


def busyness(grey: Grey, threshold: int) -> float:
    """Share of pixels, 0 to 1, that differ by more than `threshold` grey levels from the second one beside them."""
    rows = grey[::ROWS_STEP]
    if rows.shape[1] <= 2:
        return 0.0
    apart = cv2.absdiff(rows[:, 2:], rows[:, :-2])
    return float(np.count_nonzero(apart > threshold) / apart.size)


def _kept(tags: Sequence[Tag | None]) -> list[Tag]:
    return [tag for tag in tags if tag is not None]


def _window(picture: Grey, tag: Tag, reach: float) -> tuple[Grey, tuple[int, int]]:
    """The part of a picture round a tag, and its upper left corner."""
    margin = max(reach * tag.side, 8.0)
    left, top = (max(int(low - margin), 0) for low in tag.corners.min(axis=0))
    right, bottom = (int(high + margin) + 1 for high in tag.corners.max(axis=0))
    return picture[top:bottom, left:right], (left, top)
