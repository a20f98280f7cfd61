"""Which cards are shown, over a few frames: one that is missed for a moment is still there."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

KEPT_S: Final = 0.2
"""How long a card that is not found counts as shown, seconds. More: bubbles and shaking break fewer holds, and a card
that was put away counts for longer; it must be less than a hold, for else a glimpse would be one."""


@dataclass(frozen=True, slots=True)
class _Sighting:
    time_s: float
    confidence: float
    is_confirmed: bool


class ShownCards:
    """What the cards of one stream say. A card counts from its second sighting on, so that no single frame says a word.

    A card that is not found is taken to be there for KEPT_S, unless another one is.
    """

    def __init__(self) -> None:
        self._sightings: dict[str, _Sighting] = {}
        self._before_s: float | None = None

    def process(self, found: Mapping[str, float], time_s: float) -> dict[str, float]:
        """Take in what the cards found in the next frame say, each with how sure it is, 0 to 1; what is shown."""
        if self._before_s is not None and time_s < self._before_s:  # the clock was set back
            self._sightings.clear()
        for text, confidence in found.items():
            before = self._sightings.get(text)
            is_known = before is not None and (
                before.time_s == self._before_s or time_s - before.time_s <= KEPT_S
            )
            self._sightings[text] = _Sighting(time_s, confidence, is_known)
        self._before_s = time_s
        confirmed = {text: one for text, one in self._sightings.items() if one.is_confirmed}
        if found:
            return {text: one.confidence for text, one in confirmed.items() if text in found}
        last = max(confirmed, key=lambda text: confirmed[text].time_s, default=None)
        if last is None or time_s - confirmed[last].time_s > KEPT_S:
            return {}
        return {last: confirmed[last].confidence}
