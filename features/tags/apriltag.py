"""Tags by AprilTag's own detector."""

import threading
from functools import cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.tags.settings import TagSettings
from lightgesture.features.tags.tag import Tag, checked

APRILTAG_FAMILIES: Final = {"25h9": "tag25h9", "36h11": "tag36h11"}
"""Families that AprilTag's own library reads, by its names."""


class AprilTags:
    """AprilTag's own detector, by `pupil-apriltags`: slower, and reads more where water blurs (the extra `tags`)."""

    def __init__(self, family: str, settings: TagSettings) -> None:
        if family not in APRILTAG_FAMILIES:
            known = ", ".join(APRILTAG_FAMILIES)
            raise ValueError(f"'{family}' is no family that apriltag reads; use one of {known}, or aruco")
        self._family, self._settings = family, settings
        self._detector, self._lock = _apriltag(APRILTAG_FAMILIES[family])

    def process(self, grey: NDArray[np.uint8], time_s: float) -> tuple[Tag, ...]:  # noqa: ARG002 - as TagDetector has it
        """The tags of the next picture, see `detector.TagDetector`; each picture is looked at on its own."""
        with self._lock:
            seen = self._detector.detect(np.ascontiguousarray(grey))
        found = [
            # It has the tags of OpenCV upside down, goes round the other way, and counts from the corners of pixels.
            checked(grey, self._family, int(one.tag_id), one.corners[[1, 0, 3, 2]] - 0.5, self._settings)
            for one in seen
        ]
        return tuple(sorted((tag for tag in found if tag is not None), key=lambda tag: -tag.side))


@cache
def _apriltag(families: str) -> tuple[Any, threading.Lock]:
    """The package's detector, one for the whole process and never given back, and what keeps threads apart: where the
    package frees one it may free memory twice, which ends the process."""
    from pupil_apriltags import Detector

    return Detector(families=families, nthreads=1, quad_decimate=1.0), threading.Lock()
