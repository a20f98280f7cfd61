"""Dwell: a pair counts once it was shown for long enough, and once per hold.

Three rules tell when that is (`DwellSettings.rule`). "frames": an unbroken run of frames, as in the paper. "seconds":
an unbroken run of time, so that the camera's rate and dropped frames do not matter. "evidence": a sequential test, the
cumulative sum of Page ("Continuous inspection schemes", Biometrika 1954) over the classifier's probabilities: each
frame of the pair adds its time, weighed by its probability, and each other frame takes as much away, so that a few
wrong frames delay a sign and do not break it.
"""

import math
from dataclasses import dataclass
from typing import Final

from lightgesture.fsm.language.settings import DwellSettings, Rule
from lightgesture.fsm.signs import Shown

FRAMES: Final = "frames"
EVIDENCE: Final = "evidence"
"""Rules that are asked for by name here; what is neither is "seconds"."""

TOLERANCE_S = 0.001
"""Containers round time stamps to milliseconds, so that half a second may seem to be 0.4995."""

LONGEST_GAP = 0.5
"""Share of a timed hold that may lie between two frames: what was not watched for longer was not held."""

DOUBT = 1.0
"""What a frame without a pair takes from the evidence, as a probability: hands that left speak for no sign at all."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Hold:
    """A pair that was held. frames: sightings of it; confidence: their mean, 0 to 1; first_*: the first one's."""

    pair: Shown
    frames: int
    confidence: float
    first_frame: int
    first_time_s: float


def release_frames(hold: int, fraction: float) -> int:
    """Frames of absence that end a hold of `hold` frames: `fraction` of it, rounded, at least one."""
    return max(1, round(hold * fraction))


class Dwell:
    """Turns one pair (or None) per frame into held pairs.

    need: how long makes a held pair, in frames or, if `timed`, in seconds. release: how long a held pair must be absent
    before the same pair counts again, in the same unit, at most `need`: then any other held pair has released it too,
    and one pair is all there is to remember. weighed: the rule of evidence.

    A run of frames counts its first one too; a run of time goes from its first to its last frame. As evidence a frame
    stands for the time since the one before it.
    """

    def __init__(self, need: float, release: float, *, timed: bool = False, weighed: bool = False) -> None:
        tolerance = TOLERANCE_S if timed else 0.0
        self.need = need
        self._need = need - tolerance
        self.release = min(release, need) - tolerance
        self.timed = timed
        self._weighed = weighed
        self._start = 0.0 if timed else 1.0
        self._longest_step = need * LONGEST_GAP
        self.reset()

    def reset(self) -> None:
        """Forget everything, as at the start of a stream.

        pair: the one whose hold has begun and is not yet long enough. spent: the one that was read and not released.
        step: what the last frame stands for, in frames or seconds.
        """
        self.pair: Shown | None = None
        self.spent: Shown | None = None
        self.step = 1.0
        self._absent = 0.0
        self._is_absent = False
        self._extent = 0.0
        self._now_s: float | None = None

    @property
    def progress(self) -> float:
        """How far the hold that is growing has grown, 0 to 1."""
        return self._extent / self.need

    def process(
        self, pair: Shown | None, confidence: float, frame: int, time_s: float, now_s: float
    ) -> Hold | None:
        """The hold that became long enough in this frame, else None. now_s: seconds that never run back."""
        if self.timed:
            self._keep_time(now_s)
        if self.spent is not None:
            if pair == self.spent:
                self._hold_on(confidence)
                return None
            self._be_absent()
        if pair is None:
            self._weaken(DOUBT)
            return None
        if pair == self.pair:
            self._extent += self.step * confidence if self._weighed else self.step
            self._frames += 1
            self._confidence_sum += confidence
        else:
            self._weaken(confidence)
            if self.pair is not None:
                return None
            self._begin(pair, confidence, frame, time_s)
        if self._extent < self._need:
            return None
        hold = Hold(
            pair=pair,
            frames=self._frames,
            confidence=self._confidence_sum / self._frames,
            first_frame=self._first_frame,
            first_time_s=self._first_time_s,
        )
        self._spend(pair)
        return hold

    def discard(self) -> None:
        """Let the growing hold come to nothing: its pair needs a release like one that was read.

        A pair that is still unreleased keeps its place: the other one has then only just begun.
        """
        if self.pair is not None and self.spent is None:
            self._spend(self.pair)
        self.pair = None

    def _keep_time(self, now_s: float) -> None:
        step = 0.0 if self._now_s is None else now_s - self._now_s
        self._now_s = now_s
        if step > self._longest_step:
            self.pair = None
            step = 0.0
        self.step = step

    def _hold_on(self, confidence: float) -> None:
        """The pair that was read is still there. In a run its absence must be unbroken; evidence weighs."""
        self._absent = max(0.0, self._absent - self.step * confidence) if self._weighed else 0.0
        self._is_absent = self._absent > 0.0
        self._weaken(confidence)

    def _be_absent(self) -> None:
        """The pair that was read is not there; for long enough, and it may be read again."""
        self._absent += self.step if self._is_absent or self._weighed else self._start
        self._is_absent = True
        if self._absent >= self.release:
            self.spent = None

    def _weaken(self, confidence: float) -> None:
        """A frame speaks against the growing hold."""
        self._extent -= self.step * confidence
        if not self._weighed or self._extent <= 0.0:
            self.pair = None

    def _begin(self, pair: Shown, confidence: float, frame: int, time_s: float) -> None:
        self.pair = pair
        self._extent = self.step * confidence if self._weighed else self._start
        self._frames = 1
        self._confidence_sum = confidence
        self._first_frame = frame
        self._first_time_s = time_s

    def _spend(self, pair: Shown) -> None:
        self.pair = None
        self.spent = pair
        self._absent = 0.0
        self._is_absent = False


def make_dwell(
    settings: DwellSettings, hold: int | None, hold_seconds: float | None, rule: Rule | None = None
) -> Dwell:
    """The dwell of a grammar's settings, or of the rule, the frames or the seconds that take their place.

    Seconds make a timed hold, and of the rule of evidence the evidence that it needs. ValueError: a hold out of range,
    or both.
    """
    if hold is not None and hold_seconds is not None:
        raise ValueError("hold and hold_seconds exclude each other; give one of them")
    if hold is not None and hold < 1:
        raise ValueError(f"hold is {hold} frames; use a whole number from 1, such as 15")
    if hold_seconds is not None and not 0.0 < hold_seconds < math.inf:
        raise ValueError(f"hold_seconds is {hold_seconds:g}; use a number above 0, such as 0.5")
    if rule == FRAMES and hold_seconds is not None:
        raise ValueError("hold_seconds: the rule frames goes by frames; use hold")
    rule = rule or (FRAMES if hold is not None else settings.rule)
    if hold is not None and rule != FRAMES:
        raise ValueError(f"hold: the rule {rule} goes by seconds; use hold_seconds")
    if rule == FRAMES and hold_seconds is None:
        frames = settings.hold if hold is None else hold
        return Dwell(frames, release_frames(frames, settings.release))
    seconds = settings.hold_seconds if hold_seconds is None else hold_seconds
    return Dwell(seconds, seconds * settings.release, timed=True, weighed=rule == EVIDENCE)
