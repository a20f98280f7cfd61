"""The free loop: the best score of any signs in any order, words or not, against which readings are held."""

from typing import Final

import numpy as np

from lightgesture.fsm.rules.windows import NEVER, ROWS, Floats, Windows

COST: Final = 0.5
"""What every word costs, in units of score: against readings that change their mind for a moment."""


class FreeLoop:
    """The best of all signs in any order, each as long as a word at least, with gaps between them.

    score: of the best way through all frames so far. row: the scores of the last frames, where the windows' rows are.
    """

    def __init__(self, columns: int) -> None:
        self.score = 0.0
        self.row = [0.0] * ROWS
        self._signs, self._gap = np.full(columns, NEVER), 0.0

    def step(self, add: Floats, gap_add: float, windows: Windows) -> None:
        """Take in the scores of a frame, which the windows know already."""
        self._gap = max(self._gap, float(self._signs.max())) + gap_add
        self._signs += add
        if windows.window is not None:
            entered = windows.window + (windows.passed(self.row) - COST)
            np.maximum(self._signs, entered, out=self._signs)
        self.score = max(self._gap, float(self._signs.max()))
        self.row[windows.row] = self.score
