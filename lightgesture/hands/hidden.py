"""Hands that something hides where they are held: a hand on the lens, a lamp, a cloud of bubbles.

A diver who lowers the hands is seen to lower them. Where both are gone from one frame to the next without having moved,
they are still there, and a sign that they make meanwhile is shown and not read: a sentence that went on after it would
lack a word.
"""

import math
from collections.abc import Sequence
from typing import Final

from lightgesture.features.track.state import Track

STILL: Final = 2.0
"""Sizes of the hand a second (the root of its area) up to which it counts as held where it is. Between two signs hands
move by less, and lowered ones by three or more."""


class HiddenHands:
    """Looks at the tracks of one stream, frame after frame."""

    def __init__(self) -> None:
        self._still: dict[int, bool] = {}

    def process(self, tracks: Sequence[Track]) -> bool:
        """Whether both hands of this frame are hidden: neither is seen, both are remembered, and both were still when
        they were seen last.
        """
        still = {}
        for track in tracks:
            still[track.key] = self._still.get(track.key, False) if track.missed else _is_still(track)
        self._still = still
        return len(tracks) == 2 and all(track.missed and still[track.key] for track in tracks)


def _is_still(track: Track) -> bool:
    across, down, width, height = track.motion
    size = math.sqrt(max(width.position * height.position, 1.0))
    return math.hypot(across.velocity, down.velocity) <= STILL * size
