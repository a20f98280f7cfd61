"""The life of one track: tentative, confirmed, lost. Pure functions from a state to the next.

A region under observation is a tentative track: it has a filter and counts, but no number and no side, and nobody is
told of it. The stage confirms it once the evidence suffices. A confirmed track that misses its region is lost:
remembered with number and side, and confirmed again when the region returns in time.
"""

from collections.abc import Iterable
from typing import Literal, NamedTuple

from lightgesture.features.track.association import Innovation, expect
from lightgesture.features.track.evidence import blend
from lightgesture.features.track.motion import (
    BoxFilter,
    BoxState,
    Measured,
    box_of,
    hand_size,
    measure,
    meets,
    start_state,
    stop,
)
from lightgesture.features.track.settings import TrackSettings
from lightgesture.features.track.sides import Basis
from lightgesture.features.types import Box, HandRegion, Side, Track

Life = Literal["tentative", "confirmed", "lost"]


class TrackState(NamedTuple):
    """A track as the stage knows it. Times are seconds of the stage's own clock.

    key: names the state, tentative ones too; never used twice. number: that of the track, 0 while tentative.
    side, basis: the diver's own side and what it rests on; side_level: mean score of the pair it rests on.
    motion: the filter's state. box, alternatives, confidence: of the last region. level: mean confidence.
    since_s, seen_s: time of the first and last region; proved_s: when the track was last believed by its own or its
    pair's score, or, while tentative, worth observing; hits: frames in which it was that. missed: frames since the
    last region.

    A named tuple because each frame changes each track a few times, which is done three times as fast as with a
    frozen dataclass.
    """

    key: int
    number: int
    life: Life
    side: Side
    basis: Basis
    motion: BoxState
    box: Box
    alternatives: tuple[Box, ...]
    confidence: float
    level: float
    since_s: float
    seen_s: float
    proved_s: float
    side_level: float = 0.0
    hits: int = 1
    missed: int = 0

    @property
    def x(self) -> float:
        """Filtered x of the centre, source pixels."""
        return self.motion[0].position

    @property
    def seen_x(self) -> float:
        """x of the centre of the last region, source pixels."""
        return self.box[0] + self.box[2] / 2


def begin(key: int, region: HandRegion, now: float, settings: TrackSettings) -> TrackState:
    """A tentative track of a region seen at `now` seconds."""
    return TrackState(
        key=key,
        number=0,
        life="tentative",
        side="right",
        basis="none",
        motion=_started(region, settings),
        box=region.box,
        alternatives=region.alternatives,
        confidence=region.confidence,
        level=region.confidence,
        since_s=now,
        seen_s=now,
        proved_s=now,
    )


def _started(region: HandRegion, settings: TrackSettings) -> BoxState:
    measured = measure(region.box)
    area = max(measured[2] * measured[3], 1.0)
    return start_state(
        measured,
        settings.centre_noise**2 * area,
        settings.size_noise**2 * area,
        settings.centre_speed**2 * area,
        settings.size_speed**2 * area,
    )


def predict(motion: BoxState, step: float, box_filter: BoxFilter, settings: TrackSettings) -> BoxState:
    """Where the hand will be `step` seconds later."""
    area = hand_size(motion) ** 2
    return box_filter.predict(motion, step, settings.centre_density * area, settings.size_density * area)


def innovation(motion: BoxState, settings: TrackSettings, leap: bool = False) -> Innovation:
    """Where a predicted hand's region is expected; leap: as wide as for a new sign."""
    area = hand_size(motion) ** 2
    extra = settings.leap_noise**2 if leap else 0.0
    return expect(motion, (settings.centre_noise**2 + extra) * area, (settings.size_noise**2 + extra) * area)


def seen(
    track: TrackState,
    region: HandRegion,
    measured: Measured,
    now: float,
    step: float,
    box_filter: BoxFilter,
    settings: TrackSettings,
) -> TrackState:
    """The track after its region was seen in the extent `measured`."""
    area = hand_size(track.motion) ** 2
    motion = box_filter.update(
        track.motion, measured, settings.centre_noise**2 * area, settings.size_noise**2 * area
    )
    return _with_region(track, region, motion, now, step, settings)


def leapt(
    track: TrackState, region: HandRegion, now: float, step: float, settings: TrackSettings
) -> TrackState:
    """The track after its hand was found beyond the gate: what was known of its motion is void."""
    return _with_region(track, region, _started(region, settings), now, step, settings)


def _with_region(
    track: TrackState, region: HandRegion, motion: BoxState, now: float, step: float, settings: TrackSettings
) -> TrackState:
    return track._replace(
        life="tentative" if track.life == "tentative" else "confirmed",
        motion=motion,
        box=region.box,
        alternatives=region.alternatives,
        confidence=region.confidence,
        level=blend(track.level, region.confidence, step, settings.memory_s),
        seen_s=now,
        missed=0,
    )


def unseen(
    track: TrackState, others: Iterable[TrackState], now: float, step: float, settings: TrackSettings
) -> TrackState:
    """The track after a frame without its region. Its speed is believed for a moment only: a hand that goes on being
    unseen has more likely stopped or turned than flown away; for longer where it meets another hand, behind which it
    may pass. To what is under observation a frame without it counts as one that scores nothing."""
    motion = track.motion
    is_met = any(meets(motion, other.motion) for other in others)
    if now - track.seen_s > (settings.meet_s if is_met else settings.coast_s):
        motion = stop(motion)
    if track.life == "tentative":
        level = blend(track.level, 0.0, step, settings.memory_s)
        return track._replace(motion=motion, level=level, missed=track.missed + 1)
    return track._replace(life="lost", motion=motion, missed=track.missed + 1)


def trust_s(track: TrackState, longest: float, settings: TrackSettings) -> float:
    """For how many seconds a track is trusted without proof: as long as it has been proved so far and a moment, at
    most `longest`. What was believed in a single frame ends soon, so that an error stays one."""
    return min(longest, settings.tentative_s + track.proved_s - track.since_s)


def is_over(track: TrackState, now: float, settings: TrackSettings) -> bool:
    """Whether the track ends: unseen or unproved for too long."""
    if track.life == "tentative":
        return now - track.proved_s > settings.tentative_s
    is_lost = now - track.seen_s > trust_s(track, settings.lost_s, settings)
    return is_lost or now - track.proved_s > trust_s(track, settings.doubt_s, settings)


def to_track(track: TrackState, picture: tuple[int, int], certainty: float) -> Track:
    """What others are told of a confirmed or lost track; picture: (width, height), pixels."""
    box, alternatives = track.box, track.alternatives
    if track.missed:
        box, alternatives = box_of(track.motion, picture), ()
    return Track(track.number, track.side, box, track.confidence, track.missed, alternatives, certainty)
