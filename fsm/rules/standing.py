"""How the readings of a sentence stand: how sure their words are, and how far they are before and behind others."""

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from lightgesture.fsm.language.forms import spell
from lightgesture.fsm.rules.beam import Beam
from lightgesture.fsm.rules.loop import FreeLoop
from lightgesture.fsm.rules.readings import Reading, Summary
from lightgesture.fsm.rules.windows import NEVER, Windows


class Standing:
    """Looks at the readings of a beam, by slot, and at the free loop; changes nothing."""

    def __init__(self, join: str | None, beam: Beam, windows: Windows, loop: FreeLoop) -> None:
        self._join, self._beam, self._windows, self._loop = join, beam, windows, loop

    def certainty(self, slot: int) -> float:
        """How well the last sign of a reading was seen: `Spoken.sure` of its last word."""
        return math.exp(self._beam.sure[slot] / self._windows.span)

    def certainties(self, slot: int) -> list[float]:
        """The same of all its words."""
        reading = self._beam.readings[slot]
        return [] if reading is None else [*(item.sure for item in reading.spoken[:-1]), self.certainty(slot)]

    def margin(self, slot: int) -> float:
        """How far the best reading with another text is behind this one, in units of score."""
        others = self._beam.best[(self._beam.text != self._beam.text[slot]) & (self._beam.text >= 0)]
        return float(self._beam.best[slot] - others.max()) if len(others) else -NEVER

    def misfit(self, slot: int) -> tuple[float, int]:
        """How far a reading fell behind the free loop within one word and the gap before it, at most, and which."""
        reading = self._beam.readings[slot]
        if reading is None:
            return 0.0, 0
        marks = [*(item.behind for item in reading.spoken), self.behind(slot)]
        steps = [
            after - before - item.fine
            for (before, after), item in zip(pairwise(marks), reading.spoken, strict=True)
        ]
        worst = max(range(len(steps)), key=steps.__getitem__)
        return steps[worst], worst

    def is_over(self, slot: int) -> bool:
        """Whether the last sign of a reading has gone."""
        return bool(self._beam.gap[slot] > self._beam.held[slot])

    def behind(self, slot: int) -> float:
        """How far a reading is behind the free loop, in units of score, without what its last word is still owed."""
        return float(self._loop.score - self._beam.best[slot] - self._beam.credit[slot])

    def near(self, slot: int, margin: float) -> Iterator[Reading]:
        """The readings that are at most `margin` behind this one, it included."""
        for other in np.flatnonzero(self._beam.best >= self._beam.best[slot] - margin).tolist():
            reading = self._beam.readings[other]
            if reading is not None:
                yield reading

    def summaries(self, most: int) -> tuple[Summary, ...]:
        """The best readings, the best first."""
        slots = [
            slot
            for slot in np.argsort(-self._beam.best)[:most].tolist()
            if self._beam.readings[slot] is not None
        ]
        return tuple(self._summary(slot) for slot in slots)

    def _summary(self, slot: int) -> Summary:
        reading = self._beam.readings[slot]
        words = () if reading is None else reading.words
        misfit, place = self.misfit(slot)
        return Summary(
            words=tuple(zip(words, self.certainties(slot), strict=True)),
            behind=self.behind(slot),
            longest_s=float(self._beam.longest[slot]),
            misfit=misfit,
            misfit_at=words[place],
        )

    def rival(self, slot: int) -> str:
        """The text of the best reading with another text than this one; empty where there is none."""
        others = np.where(self._beam.text != self._beam.text[slot], self._beam.best, 2 * NEVER)
        reading = self._beam.readings[int(others.argmax())]
        return "" if reading is None else spell(reading.words, self._join)

    def has_prefix(self, words: tuple[str, ...]) -> bool:
        """Whether some reading begins with these words."""
        count = len(words)
        lead = None if self._beam.lead is None else self._beam.readings[self._beam.lead]
        if lead is not None and lead.words[:count] == words:
            return True
        return any(reading is not None and reading.words[:count] == words for reading in self._beam.readings)
