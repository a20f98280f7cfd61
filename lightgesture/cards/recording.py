"""A shape of one's own from a clip in which it is drawn once."""

from collections.abc import Iterable
from dataclasses import dataclass

from lightgesture.cards.front import grey_of
from lightgesture.errors import InputError
from lightgesture.features.image import as_bgr8
from lightgesture.features.motion.matching import resampled
from lightgesture.features.motion.segments import Motion, Reason, Segmenter
from lightgesture.features.motion.shapes import Curve
from lightgesture.features.tags.detector import TagDetector
from lightgesture.features.tags.tag import Tag
from lightgesture.frames import Frame
from lightgesture.fsm.language.grammar import MotionWords

POINTS_KEPT = 64
"""Points of a shape in its file."""

REASONS: dict[Reason, str] = {
    "lost": "a card was out of view for too long",
    "endless": "it did not come to rest",
    "elsewhere": "it ended elsewhere than it began",
    "turned": "the cards are upside down, or held at two angles",
    "swapped": "each card is in the other hand",
}


@dataclass(frozen=True, slots=True)
class Recorded:
    """The motions of a clip, and why others could not be read."""

    motions: tuple[Motion, ...]
    reasons: tuple[Reason, ...]
    both_seen: int
    """Frames in which both cards were in view."""


def read_motions(
    frames: Iterable[Frame], words: MotionWords, detector: TagDetector, mirrored: bool = False
) -> Recorded:
    """Cut a clip into motions. mirrored: it is of a selfie camera."""
    segments, motions, reasons, both = Segmenter(), [], [], 0
    last: Motion | None = None
    for frame in frames:
        tags = detector.process(grey_of(as_bgr8(frame.image), mirrored), frame.time_s)
        left, right = (_only(tags, number) for number in (words.left, words.right))
        both += left is not None and right is not None
        moment = segments.process(left, right, frame.time_s)
        if moment.motion is not None and moment.motion is not last:
            motions.append(moment.motion)
        last = moment.motion
        if moment.reason is not None:
            reasons.append(moment.reason)
    return Recorded(tuple(motions), tuple(reasons), both)


def choose_curve(recorded: Recorded, side: str | None, name: str) -> Curve:
    """The one shape of a clip, (POINTS_KEPT, 2), of the hand that moved or of the one that is asked for.

    name: of the clip. InputError: there is not exactly one motion, or it is not clear whose.
    """
    if not recorded.both_seen:
        raise InputError(
            f"{name}: both cards are never in view; hold both before the camera, also the one that rests"
        )
    if len(recorded.motions) != 1:
        why = f" ({REASONS[recorded.reasons[0]]})" if recorded.reasons and not recorded.motions else ""
        remedy = "record one, from rest to rest and back to where it began"
        raise InputError(f"{name}: has {len(recorded.motions)} motions{why}; {remedy}")
    (motion,) = recorded.motions
    drawn = {
        hand: curve for hand, curve in (("left", motion.left), ("right", motion.right)) if curve is not None
    }
    if side is None and len(drawn) != 1:
        raise InputError(f"{name}: both hands moved; choose one with --side left or --side right")
    chosen = next(iter(drawn)) if side is None else side
    if chosen not in drawn:
        raise InputError(f"{name}: the {chosen} hand did not move; choose the other one")
    return resampled(drawn[chosen], POINTS_KEPT)


def _only(tags: tuple[Tag, ...], number: int) -> Tag | None:
    own = [tag for tag in tags if tag.id == number]
    return own[0] if len(own) == 1 else None
