"""Sums of scores over the last moments: how likely each sign was for the least length that a sign has."""

import math
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.fsm.rules.scores import RATE

Floats = NDArray[np.float64]

PASSAGE_S: Final = 0.1
"""Least seconds of the passage from one sign to the next: a sign that changes its mind for a moment is no second
word."""

RELEASE_SCORE: Final = 1.0
"""How much less likely than another sign or a gap, as a logarithm, a sign must be on average in the passage if it
comes again."""

ROWS: Final = 160
"""Frames that are remembered."""

SPACING_S: Final = 0.008
"""Least seconds between two of them: a faster camera's frames share one, so that ROWS is enough."""

TOLERANCE_S: Final = 0.001
"""Containers round time stamps to milliseconds."""

NEVER: Final = -1e18
"""A score that nothing comes back from, and that arithmetic stays finite with."""


class Windows:
    """A window of `hold_s` seconds that ends now, and the passage before it; rows of a ring, one a frame.

    now: seconds that were looked at so far. row: of this frame; base: of the last frame before the window; earlier:
    of the last one before the passage. window: sums over it, (columns,), None until there was that much; weaker: the
    smaller one of the two hands' parts of them. has_passage: whether there was time for a passage before it.
    """

    def __init__(self, columns: int, hold_s: float) -> None:
        self.hold_s = hold_s
        self.span = hold_s * RATE
        self._spacing_s = max(SPACING_S, (hold_s + PASSAGE_S) * 1.5 / ROWS)
        self.now = 0.0
        self.row = 0
        self.window: Floats | None = None
        self.weaker: Floats = np.full(columns, NEVER)
        self._count = self._broken = 0
        self._base = self._earlier = -1
        self._times = [0.0] * ROWS
        self._stamps = [(0, 0.0)] * ROWS
        self._sum, self._left_sum = np.zeros(columns), np.zeros(columns)
        self._rows, self._left_rows = np.zeros((ROWS, columns)), np.zeros((ROWS, columns))
        self._gap_sum = self._top_sum = 0.0
        self._gap_rows, self._top_rows = [0.0] * ROWS, [0.0] * ROWS

    @property
    def base(self) -> int:
        return self._base % ROWS

    @property
    def earlier(self) -> int:
        return max(self._earlier, self._broken) % ROWS

    @property
    def has_passage(self) -> bool:
        return self._earlier >= self._broken

    @property
    def start_s(self) -> float:
        """When the window began, of `now`."""
        return self._times[self.base]

    @property
    def start_stamp(self) -> tuple[int, float]:
        """Number and time stamp of its first frame."""
        return self._stamps[(self._base + 1) % ROWS]

    def step(
        self, add: Floats, add_left: Floats, gap_add: float, passed_s: float, stamp: tuple[int, float]
    ) -> None:
        """Take in the scores of a frame, the left hand's part of them and those of a gap, times the frame's weight."""
        self.now += passed_s
        self._sum += add
        self._left_sum += add_left
        self._gap_sum += gap_add
        self._top_sum += max(float(add.max()), gap_add)
        # Frames that come too fast share a row.
        if (
            self._count < self._broken + 2
            or self.now - self._times[(self._count - 2) % ROWS] >= self._spacing_s
        ):
            self._count += 1
        row = self.row = (self._count - 1) % ROWS
        self._times[row], self._stamps[row] = self.now, stamp
        self._rows[row], self._left_rows[row] = self._sum, self._left_sum
        self._gap_rows[row], self._top_rows[row] = self._gap_sum, self._top_sum
        self._base = self._follow(self._base, self.now - self.hold_s)
        self._earlier = self._follow(self._earlier, self.now - self.hold_s - PASSAGE_S)
        self.window = None
        if self._base >= self._broken:
            self.window = self._sum - self._rows[self.base]
            of_left = self._left_sum - self._left_rows[self.base]
            self.weaker = np.minimum(of_left, self.window - of_left)

    def _follow(self, place: int, time: float) -> int:
        """The number of the last row not after `time`, counted on from `place`."""
        while place + 1 < self._count - 1 and self._times[(place + 1) % ROWS] <= time + TOLERANCE_S:
            place += 1
        return place

    def break_off(self) -> None:
        """Nothing was looked at for a while: no window goes across it, from the next frame on."""
        self._base = self._earlier = self._count - 1
        self._broken = self._count

    def passed(self, scores: Any) -> Any:
        """From their rows (ROWS, ...), scores after a passage that ends where the window begins."""
        return scores[self.earlier] + (self._gap_rows[self.base] - self._gap_rows[self.earlier])

    def is_released(self, column: int) -> bool:
        """Whether a sign was gone in the passage before the window, so that it may be the next one again."""
        base, earlier = self.base, self.earlier
        of_sign = self._rows[base, column] - self._rows[earlier, column]
        of_top = self._top_rows[base] - self._top_rows[earlier]
        return bool(of_top - of_sign >= RELEASE_SCORE * RATE * PASSAGE_S)

    def likelihood(self, column: int) -> float:
        """Geometric mean probability of the less sure hand over the window, 0 to 1."""
        return math.exp(self.weaker[column] / self.span)
