"""Cuts the tracks of two tags into motions: from rest to rest, and from a place back to it.

Lengths are in sides of a tag, so that distance and zoom do not matter. A motion is turned by the angle at which the
tags themselves are held, so that the camera's own does not matter, and moved to its first point.
"""

from collections import deque
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from lightgesture.features.motion.shapes import Curve
from lightgesture.features.tags.tag import Tag

Reason = Literal["lost", "endless", "elsewhere", "turned", "swapped"]
"""Why a motion cannot be read: a tag was out of view, it did not end, it ended elsewhere, the tags are upside down or
held at two angles, or each is in the other hand."""

Phase = Literal["absent", "unsettled", "resting", "moving"]
"""Not both tags in view; in view and not yet at rest; at rest; in a motion."""

LEFT, RIGHT = 0, 1


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentSettings:
    """What is rest and what is motion. Lengths in sides of a tag, times in seconds."""

    window_s: float = 0.2
    """Over which a tag is at rest or not. More: calmer, and every motion takes so much longer."""
    rest: float = 0.3
    """Most that a tag goes in the window at rest: divers drift. More: a slow turn in a motion may seem its end."""
    start: float = 0.4
    """Least that it goes in the window for a motion to begin."""
    rest_s: float = 0.1
    """How long both are at rest, beyond the window, after a motion that is back where it began."""
    give_up_s: float = 0.6
    """The same of one that is not: it may still go on."""
    least: float = 1.0
    """Least size of a motion; what is smaller is drift, and a hand that goes less is still."""
    still_share: float = 0.3
    """Share of the other hand's size below which a hand is still: hands move along a little."""
    open_gap: float = 0.9
    """Farthest that the one card may end from where it began, seen from the other ..."""
    open_share: float = 0.35
    """... or, where that is more, as a share of the size of the motion."""
    drift_gap: float = 1.2
    """Farthest that both may end from where they began: divers drift, and take both cards along ..."""
    drift_share: float = 0.5
    """... or, where that is more, as a share of the size of the motion."""
    longest_s: float = 8.0
    """Longest motion."""
    gap_s: float = 0.25
    """Longest time for which a tag may be unseen."""
    most_turn_deg: float = 50.0
    """Most that the tags may be turned in the picture: beyond it up may be down."""


@dataclass(frozen=True, slots=True)
class Motion:
    """A motion from rest to rest, seen with the diver's eyes: x to the right, y up, in sides of a tag from where it
    began. left, right: what each hand drew, None where it was still."""

    left: Curve | None
    right: Curve | None


@dataclass(frozen=True, slots=True)
class Moment:
    """What is known after a frame. motion: while at rest after one that can be read. reason: in the frame in which it
    turned out that one cannot."""

    phase: Phase
    motion: Motion | None = None
    reason: Reason | None = None


@dataclass(frozen=True, slots=True)
class _Pose:
    """How the tags were held before a motion: their mean side, pixels, and angle in the picture, radians."""

    side: float
    angle: float
    reason: Reason | None


class Segmenter:
    """Follows the two tags of one stream."""

    def __init__(self, settings: SegmentSettings | None = None) -> None:
        self.settings = settings or SegmentSettings()
        self._tracks: tuple[deque[tuple[float, Tag]], deque[tuple[float, Tag]]] = (deque(), deque())
        self._forget()

    def _forget(self) -> None:
        """Nothing is in view."""
        for track in self._tracks:
            track.clear()
        self._phase: Phase = "absent"
        self._motion: Motion | None = None
        self._begun_s = self._rested_s = 0.0
        self._pose: _Pose | None = None

    def process(self, left: Tag | None, right: Tag | None, time_s: float) -> Moment:
        """Take in the next frame; None: a tag is not seen. time_s: seconds."""
        was_moving = self._phase == "moving"
        if any(track and time_s < track[-1][0] for track in self._tracks):  # the clock was set back
            self._forget()
        for track, tag in zip(self._tracks, (left, right), strict=True):
            if tag is not None:
                track.append((time_s, tag))
        if not all(track and time_s - track[-1][0] <= self.settings.gap_s for track in self._tracks):
            if self._phase != "absent":
                self._keep_seen(time_s)
            return Moment("absent", reason="lost" if was_moving else None)
        return self._follow(time_s, left is not None and right is not None)

    def _keep_seen(self, time_s: float) -> None:
        """One tag is gone; the other may stay until it comes again."""
        kept = [[item for item in track if time_s - item[0] <= self.settings.gap_s] for track in self._tracks]
        self._forget()
        for track, items in zip(self._tracks, kept, strict=True):
            track.extend(items)

    def _follow(self, time_s: float, is_whole: bool) -> Moment:
        """Both tags are in view, or were a moment ago. is_whole: they are."""
        extent = max(self._extent(track, time_s - self.settings.window_s) for track in self._tracks)
        is_long_enough = all(time_s - track[0][0] >= self.settings.window_s for track in self._tracks)
        if self._phase == "moving":
            # A tag that is not seen just now is not at rest because of that.
            return self._go_on(extent, time_s) if is_whole else Moment(self._phase)
        if self._phase == "resting" and extent > self.settings.start:
            return self._begin(time_s)
        if extent <= self.settings.rest and is_long_enough:
            if self._phase != "resting":
                self._motion = None
            self._phase = "resting"
        elif self._phase != "resting":
            self._phase = "unsettled"
        if self._phase == "resting":
            self._settle(time_s)
        self._drop_before(time_s - 3 * self.settings.window_s)
        return Moment(self._phase, self._motion)

    def _begin(self, time_s: float) -> Moment:
        """A motion begins; it did so in the window that was looked at."""
        self._phase, self._motion = "moving", None
        self._begun_s = time_s - 1.5 * self.settings.window_s
        self._rested_s = time_s
        return Moment(self._phase)

    def _settle(self, time_s: float) -> None:
        """At rest: how the tags are held."""
        sides, angles = [], []
        for track in self._tracks:
            tags = [tag for at_s, tag in track if time_s - at_s <= self.settings.window_s] or [track[-1][1]]
            sides.append(np.mean([tag.side for tag in tags]))
            angles.append(np.angle(sum(_direction(tag) for tag in tags)))
        angle = float(np.angle(np.exp(1j * angles[LEFT]) + np.exp(1j * angles[RIGHT])))
        apart = abs(np.angle(np.exp(1j * (angles[LEFT] - angles[RIGHT]))))
        reason: Reason | None = None
        limit = np.radians(self.settings.most_turn_deg)
        if abs(angle) > limit or apart > limit:
            reason = "turned"
        else:
            # The diver's left hand is at the right of the picture.
            (x0, y0), (x1, y1) = (track[-1][1].centre for track in self._tracks)
            if (x0 - x1) * np.cos(angle) + (y0 - y1) * np.sin(angle) < 0.0:
                reason = "swapped"
        self._pose = _Pose(float(np.mean(sides)), angle, reason)

    def _go_on(self, extent: float, time_s: float) -> Moment:
        """In a motion: it goes on, ends, or turns out not to be one."""
        settings = self.settings
        if time_s - self._begun_s > settings.longest_s:
            self._phase = "unsettled"
            return Moment(self._phase, reason="endless")
        if extent > settings.rest:
            self._rested_s = time_s
            return Moment(self._phase)
        rested_s = time_s - self._rested_s
        if rested_s < settings.rest_s or self._pose is None:
            return Moment(self._phase)
        curves = [self._curve(track, self._pose) for track in self._tracks]
        sizes = [_size(curve) for curve in curves]
        if max(sizes) < settings.least:
            self._phase = "resting"
            return Moment(self._phase)
        if not self._is_back(curves[LEFT][-1], curves[RIGHT][-1], max(sizes)):
            if rested_s < settings.give_up_s:
                return Moment(self._phase)
            self._phase = "resting"
            return Moment(self._phase, reason="elsewhere")
        self._phase = "resting"
        if self._pose.reason is not None:
            return Moment(self._phase, reason=self._pose.reason)
        self._motion = self._drawn(*curves)
        return Moment(self._phase, self._motion)

    def _is_back(self, left: Curve, right: Curve, size: float) -> bool:
        """Whether both cards are where they began, but for drift, of which both have the same.

        left, right: where each ended, (2,), from where it began. size: of the motion.
        """
        settings = self.settings
        apart, together = float(np.hypot(*(left - right))), float(np.hypot(*(0.5 * (left + right))))
        is_apart = apart > max(settings.open_gap, settings.open_share * size)
        return not is_apart and together <= max(settings.drift_gap, settings.drift_share * size)

    def _drawn(self, left: Curve, right: Curve) -> Motion:
        """What the hands drew by themselves, for a motion that is back."""
        closed = [self._closed(curve, hand) for hand, curve in ((LEFT, left), (RIGHT, right))]
        sizes = [_size(curve) for curve in closed]
        still = max(self.settings.least, self.settings.still_share * max(sizes))
        is_still = [size < still for size in sizes]
        if is_still[LEFT] != is_still[RIGHT]:
            # The hand that is still tells how the whole body went.
            moved, other = (RIGHT, LEFT) if is_still[LEFT] else (LEFT, RIGHT)
            closed[moved] = self._without_drift(closed[moved], moved, closed[other], other)
        return Motion(*(None if still else curve for still, curve in zip(is_still, closed, strict=True)))

    def _closed(self, curve: Curve, hand: int) -> Curve:
        """What a hand drew, less the way from its beginning to its end, evenly over the time: since the motion is back
        where it began, that is drift."""
        times = np.array(self._times(hand))
        part = (times - times[0]) / max(times[-1] - times[0], 1e-9)
        return np.asarray(curve - part[:, None] * (curve[-1] - curve[0]))

    def _times(self, hand: int) -> list[float]:
        """When a tag was seen since the motion began, seconds; one at least."""
        return [at_s for at_s, _ in self._tracks[hand] if at_s >= self._begun_s] or [self._begun_s]

    def _curve(self, track: deque[tuple[float, Tag]], pose: _Pose) -> Curve:
        """What a tag drew since the motion began."""
        points = np.array(
            [tag.centre for at_s, tag in track if at_s >= self._begun_s] or [track[-1][1].centre]
        )
        points = (points - points[0]) / max(pose.side, 1.0)
        cosine, sine = np.cos(pose.angle), np.sin(pose.angle)
        x, y = points[:, 0] * cosine + points[:, 1] * sine, points[:, 1] * cosine - points[:, 0] * sine
        # The picture's x runs to the diver's left, its y down.
        return np.column_stack([-x, -y])

    def _without_drift(self, curve: Curve, hand: int, other: Curve, still: int) -> Curve:
        """What a hand drew beyond how the whole body went, which the hand that was still tells."""
        times, known = self._times(hand), self._times(still)
        drift = np.column_stack([np.interp(times, known, other[:, axis]) for axis in (0, 1)])
        return np.asarray(curve - (drift - drift[0]))

    def _extent(self, track: deque[tuple[float, Tag]], since_s: float) -> float:
        """How far a tag went since then, sides; since it was last seen before, if it was not seen for half of that:
        what is not seen does not rest."""
        recent = [(at_s, tag) for at_s, tag in track if at_s >= since_s]
        if len(recent) < len(track) and (not recent or recent[0][0] - since_s > 0.5 * self.settings.window_s):
            recent.insert(0, track[-len(recent) - 1])
        if len(recent) < 2:
            return 0.0
        points = np.array([tag.centre for _, tag in recent])
        return float(np.hypot(*np.ptp(points, axis=0))) / max(recent[-1][1].side, 1.0)

    def _drop_before(self, time_s: float) -> None:
        for track in self._tracks:
            while len(track) > 1 and track[0][0] < time_s:
                track.popleft()


WAY: Final = (1, 0, 2, 3)
"""Corners whose differences run along the printed tag: the second less the first, the third less the fourth."""


def _direction(tag: Tag) -> complex:
    """Where the printed tag's own x axis points in the picture, of length one."""
    after, before, below_after, below_before = (tag.corners[place] for place in WAY)
    x, y = (after - before) + (below_after - below_before)
    return complex(x, y) / max(abs(complex(x, y)), 1e-9)


def _size(curve: Curve) -> float:
    """The larger of width and height."""
    return float(np.ptp(curve, axis=0).max())
