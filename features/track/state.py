"""The life of one track: tentative, confirmed, lost; and its side. Pure functions from a track to the next.

A region under observation is a tentative track: it has a filter and counts, but no number and no side, and nobody is
told of it. It is confirmed once the evidence suffices, and gets its number. A confirmed track that misses its region is
lost: remembered with number and side, and confirmed again when the region returns in time.

A diver faces the camera, so in an unmirrored picture the right hand is at image left when both are seen and first
believed. From then on a side stays with its track, wherever the hand goes. A lone hand is on the side of the axis of
the body or face on which it is seen, or else of the picture's middle: a guess, which its partner puts right.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Final, Literal

from lightgesture.features.find.settings import ALONE_CONFIDENCE
from lightgesture.features.track.kalman import BoxState, box_of, meets, start_box, stop, update_box
from lightgesture.features.types import Box, HandRegion, Side

MEMORY_S: Final = 0.2
"""Time constant of the mean scores, seconds."""
TENTATIVE_S: Final = 0.15
"""Seconds after which the observation of a region ends that is gone or no longer scores like a hand."""
COAST_S: Final = 0.1
"""For so many seconds an unseen hand is taken to go on as it moved, then to rest."""
MEET_S: Final = 0.35
"""The same for a hand that meets the other one and may pass behind it, seconds."""
SETTLE_S: Final = 0.5
"""Seconds for which a pair must have been believed before its sides outlive it."""
AXIS_CERTAINTY: Final = 0.9
"""Certainty of the side of a lone hand that is told by the body's axis, 0 to 1."""


@dataclass(frozen=True, slots=True, eq=False)
class Match:
    """What a track found: the region that has the number `index` among the candidates. extent: which of the region's
    extents is nearest to what was expected, 0 its box, then its alternatives; squared: its squared Mahalanobis
    distance; leap: whether it is beyond the gate."""

    index: int
    region: HandRegion
    extent: int
    squared: float
    leap: bool


@dataclass(frozen=True, slots=True)
class Track:
    """One hand followed through the frames, or, without a number, a region under observation.

    Times are seconds of the tracker's own clock.
    """

    key: int
    """Names the track, tentative ones too; never used twice."""
    motion: BoxState
    """Filtered centre and size."""
    box: Box
    """Position and size, source pixels: the region's own where it was seen, predicted where not."""
    region: int | None
    """Number of its region among the candidates of this frame, None where it was missed."""
    confidence: float
    """The selector's confidence in its last region, 0 to 1."""
    level: float
    """Mean of that confidence, the last frames counting most."""
    seen_x: float
    """x of the centre of its last region, source pixels."""
    since_s: float
    """When its first region was seen."""
    seen_s: float
    """When its last region was seen."""
    proved_s: float
    """When it was last believed by its own or its pair's score, or, while tentative, worth observing."""
    alternatives: tuple[Box, ...] = ()
    """Other extents of the region that was seen now, else none."""
    missed: int = 0
    """Frames since its last region, 0 when seen now. Where it is above 0 there may be anything in the box, and no hand
    may be read from it."""
    hits: int = 1
    """Frames in which it was worth observing while tentative."""
    number: int = 0
    """Grows by one at each birth, never used twice in a stream; 0 while tentative."""
    side: Side = "right"
    """The diver's own side, kept for the life of the track; only a guess is put right."""
    basis: Literal["none", "middle", "axis", "pair"] = "none"
    """What the side rests on: nothing yet, the picture's middle, the body's axis, both hands seen together."""
    certainty: float = 1.0
    """How sure the side is, 0 to 1: 1 where both hands were seen together, less for a lone hand. A factor on the
    confidence of what is read."""
    side_level: float = 0.0
    """Mean score of the pair on which the side rests."""


def begin(key: int, index: int, region: HandRegion, now: float) -> Track:
    """A tentative track of a region seen at `now` seconds."""
    return Track(
        key=key,
        motion=start_box(region.box),
        box=region.box,
        region=index,
        confidence=region.confidence,
        level=region.confidence,
        seen_x=region.box[0] + region.box[2] / 2,
        since_s=now,
        seen_s=now,
        proved_s=now,
        alternatives=region.alternatives,
    )


def seen(track: Track, match: Match, now: float, step: float) -> Track:
    """The predicted track after it found its region; after a leap what was known of its motion is void."""
    region = match.region
    nearest = (region.box, *region.alternatives)[match.extent]
    return replace(
        track,
        motion=start_box(region.box) if match.leap else update_box(track.motion, nearest),
        box=region.box,
        region=match.index,
        confidence=region.confidence,
        level=blend(track.level, region.confidence, step),
        seen_x=region.box[0] + region.box[2] / 2,
        seen_s=now,
        alternatives=region.alternatives,
        missed=0,
    )


def unseen(track: Track, others: Iterable[Track], now: float, step: float, picture: tuple[int, int]) -> Track:
    """The predicted track after a frame of `picture` (width, height) without its region. Its speed is believed for a
    moment only: a hand that goes on being unseen has more likely stopped or turned than flown away; for longer where it
    meets one of the others, behind which it may pass. To what is under observation a frame without it counts as one
    that scores nothing."""
    motion = track.motion
    is_met = any(meets(motion, other.motion) for other in others)
    if now - track.seen_s > (MEET_S if is_met else COAST_S):
        motion = stop(motion)
    return replace(
        track,
        motion=motion,
        box=box_of(motion, picture),
        region=None,
        level=track.level if track.number else blend(track.level, 0.0, step),
        alternatives=(),
        missed=track.missed + 1,
    )


def blend(level: float, value: float, step: float) -> float:
    """The mean `level` after `value` was seen for `step` seconds."""
    return value + (level - value) * math.exp(-step / MEMORY_S)


def trust_s(track: Track, longest: float) -> float:
    """For how many seconds a track is trusted without proof: as long as it has been proved so far and a moment, at
    most `longest`. What was believed in a single frame ends soon, so that an error stays one."""
    return min(longest, TENTATIVE_S + track.proved_s - track.since_s)


def is_over(track: Track, now: float, lost_s: float, doubt_s: float) -> bool:
    """Whether the track ends: unseen for `lost_s` or unproved for `doubt_s` seconds, or sooner if it is young."""
    if not track.number:
        return now - track.proved_s > TENTATIVE_S
    return now - track.seen_s > trust_s(track, lost_s) or now - track.proved_s > trust_s(track, doubt_s)


def with_pair_sides(first: Track, second: Track, level: float, margin: float) -> tuple[Track, Track]:
    """Both tracks with the sides of two hands seen together, `level` being their mean score.

    A side stays that a hand has had for a while from as good a pair as this, which has not more than `margin` above
    it. One from a guess gives way, and one from a worse pair or a short one, which may have been a hand and another
    thing.
    """

    def stays(track: Track) -> bool:
        is_old = track.proved_s - track.since_s >= SETTLE_S
        return track.basis == "pair" and is_old and track.side_level >= level - margin

    if stays(first):
        side = first.side
    elif stays(second):
        side = _opposite(second.side)
    else:
        side = "right" if first.motion[0].position <= second.motion[0].position else "left"
    return (
        replace(first, side=side, basis="pair", certainty=1.0, side_level=level),
        replace(second, side=_opposite(side), basis="pair", certainty=1.0, side_level=level),
    )


def _opposite(side: Side) -> Side:
    return "left" if side == "right" else "right"


def with_lone_side(track: Track, axis: float | None, width: int) -> Track:
    """The track with a better guess of its side, if its side is a guess: made at its birth, by the picture's middle
    if need be, and once more when the body's axis is first seen. It does not change as the hand moves on.

    axis: x of the body's axis where it is seen; width: that of the picture, pixels.
    """
    if track.basis in ("pair", "axis") or (track.basis == "middle" and axis is None):
        return track
    x = track.motion[0].position
    if axis is None:
        side: Side = "right" if x < width / 2 else "left"
        return replace(track, side=side, basis="middle", certainty=ALONE_CONFIDENCE)
    return replace(track, side="right" if x < axis else "left", basis="axis", certainty=AXIS_CERTAINTY)
