"""Two hands followed through the frames: a Kalman filter each, a side for life, birth only on good evidence.

The filter remembers where a hand was and how large, and a region that agrees with this memory is believed at
a lower score. A pair that scores far better elsewhere still wins, so that a track on the wrong thing
cannot hold on: every frame is searched whole.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lightgesture.features import kalman
from lightgesture.features.kalman import Coordinate
from lightgesture.features.selector import SelectorSettings, best_pair, side_in_picture
from lightgesture.features.types import Box, Candidates, HandRegion, Side, Track


@dataclass(frozen=True, slots=True)
class TrackSettings:
    """How tracks live.

    measurement_noise: standard deviation of a region's centre and size over the hand's size, 0.02 to 0.3.
    acceleration: standard deviation, hand sizes a second squared; larger follows faster hands and gates less.
    gate: largest squared Mahalanobis distance over four coordinates at which a region is the track's own;
        13.3 is the 99th percentile of chi-squared with four degrees of freedom.
    memory_gain: added to the score of a region at the predicted place, 0 to 0.3.
    keep_score: least score of a single region that a track accepts as its own.
    birth_frames: frames in a row in which a region without a partner must be seen before it becomes a track.
    lost_s: seconds without a region after which a track ends.
    longest_step_s: a larger gap in time ends all tracks.
    """

    measurement_noise: float = 0.08
    acceleration: float = 40.0
    gate: float = 13.3
    memory_gain: float = 0.15
    keep_score: float = 0.2
    birth_frames: int = 3
    lost_s: float = 0.25
    longest_step_s: float = 1.0


Measured = tuple[float, float, float, float]
"""Centre x, centre y, width, height in source pixels."""


@dataclass(frozen=True, slots=True)
class _Life:
    """A track's own state. coordinates: centre x, centre y, width, height. seen_s: time of the last region."""

    track: Track
    coordinates: tuple[Coordinate, ...]
    seen_s: float


def _measure(box: Box) -> Measured:
    return box[0] + box[2] / 2, box[1] + box[3] / 2, float(box[2]), float(box[3])


def _box(coordinates: tuple[Coordinate, ...], size: tuple[int, int]) -> Box:
    x, y, width, height = (item.position for item in coordinates)
    left, top = max(0, round(x - width / 2)), max(0, round(y - height / 2))
    left, top = min(left, size[0] - 1), min(top, size[1] - 1)
    return left, top, max(1, min(round(width), size[0] - left)), max(1, min(round(height), size[1] - top))


def _hand_size(coordinates: tuple[Coordinate, ...]) -> float:
    return math.sqrt(max(coordinates[2].position * coordinates[3].position, 1.0))


def squared_distance(coordinates: tuple[Coordinate, ...], measured: Measured, noise: float) -> float:
    """Squared Mahalanobis distance of a box from a predicted one, over centre and size. The filters of
    the coordinates are independent, so it is the sum of theirs."""
    variance = (noise * _hand_size(coordinates)) ** 2
    return sum(kalman.distance(c, z, variance) for c, z in zip(coordinates, measured, strict=True))


def assign(distances: NDArray[np.float64], gate: float) -> dict[int, int]:
    """Track -> region for at most two tracks and two regions, float (tracks, regions): as many within the
    gate as can be, then the least sum."""
    best: tuple[int, float, dict[int, int]] = (0, 0.0, {})
    tracks, regions = distances.shape
    options = [[None, *range(regions)] for _ in range(tracks)]
    combinations: list[list[int | None]] = [[]]
    for option in options:
        combinations = [[*start, item] for start in combinations for item in option]
    for combination in combinations:
        used = [item for item in combination if item is not None]
        if len(set(used)) < len(used):
            continue
        matched = {t: r for t, r in enumerate(combination) if r is not None and distances[t, r] <= gate}
        total = float(sum(distances[t, r] for t, r in matched.items()))
        if (len(matched), -total) > (best[0], -best[1]):
            best = len(matched), total, matched
    return best[2]


class TrackStage:
    """Candidates of each frame -> at most two tracks, one a side."""

    def __init__(
        self, settings: TrackSettings | None = None, selection: SelectorSettings | None = None
    ) -> None:
        self.settings = settings or TrackSettings()
        self._selection = selection or SelectorSettings()
        self._next = 1
        self.reset()

    def reset(self) -> None:
        """Forget everything, as at the start of another stream; numbers go on."""
        self._lives: list[_Life] = []
        self._single: tuple[Box, int] | None = None
        self._time_s: float | None = None
        self._size: tuple[int, int] | None = None

    def process(self, candidates: Candidates, time_s: float) -> tuple[Track, ...]:
        """Follow the hands into the next frame at `time_s` seconds. Time that stands still or runs back is
        taken as a step of zero; a long gap or a frame of another size starts anew."""
        step = 0.0 if self._time_s is None else max(0.0, time_s - self._time_s)
        if step > self.settings.longest_step_s or self._size not in (None, candidates.source_size):
            self.reset()
        self._time_s, self._size = time_s, candidates.source_size
        self._lives = [self._predicted(life, step) for life in self._lives]
        chosen = self._choose(candidates)
        self._lives = self._continue(candidates, chosen, time_s)
        return tuple(
            life.track for life in sorted(self._lives, key=lambda life: life.track.side, reverse=True)
        )

    def _predicted(self, life: _Life, step: float) -> _Life:
        variance = (self.settings.acceleration * _hand_size(life.coordinates)) ** 2
        coordinates = tuple(kalman.predict(item, step, variance) for item in life.coordinates)
        return replace(life, coordinates=coordinates)

    def _nearness(self, candidates: Candidates) -> NDArray[np.float32]:
        """float (n,): 1 at a predicted place and size, towards 0 away from it."""
        near = np.zeros(len(candidates.regions), np.float32)
        for index, region in enumerate(candidates.regions):
            for life in self._lives:
                squared = self._squared(life, region.box)
                near[index] = max(near[index], np.exp(-0.5 * squared * 4.0 / self.settings.gate))
        return near

    def _squared(self, life: _Life, box: Box) -> float:
        return squared_distance(life.coordinates, _measure(box), self.settings.measurement_noise)

    def _choose(self, candidates: Candidates) -> list[int]:
        """Numbers of the regions that are believed: a pair, regions at the tracks, or one seen repeatedly."""
        if not candidates.regions:
            return []
        near = self._nearness(candidates)
        possible = candidates.pairs > 0.0
        both = np.minimum(near[:, None], near[None, :])
        found = best_pair(np.where(possible, candidates.pairs + self.settings.memory_gain * both, 0.0))
        if found is not None and found[1] >= self._selection.pair_score:
            return list(found[0])
        kept = self._own(candidates)
        return kept or self._repeated(candidates)

    def _own(self, candidates: Candidates) -> list[int]:
        """Regions that lie within the gate of a track, the nearest to each."""
        own: list[int] = []
        for life in self._lives:
            gated = [
                (self._squared(life, region.box), index)
                for index, region in enumerate(candidates.regions)
                if region.confidence >= self.settings.keep_score and index not in own
            ]
            if gated and min(gated)[0] <= self.settings.gate:
                own.append(min(gated)[1])
        return own

    def _repeated(self, candidates: Candidates) -> list[int]:
        """The best region, once it was seen at about the same place for some frames in a row."""
        best = candidates.regions[0]
        if best.confidence < self._selection.single_score:
            self._single = None
            return []
        count = 1
        if self._single is not None:
            last, seen = self._single
            apart = np.hypot(*(np.subtract(_measure(best.box)[:2], _measure(last)[:2])))
            count = seen + 1 if apart < max(best.box[2:]) else 1
        self._single = best.box, count
        return [0] if count >= self.settings.birth_frames else []

    def _continue(self, candidates: Candidates, chosen: list[int], time_s: float) -> list[_Life]:
        """Tracks after this frame: updated, moved on without a region, born or ended."""
        boxes = [candidates.regions[index].box for index in chosen]
        distances = np.array([[self._squared(life, box) for box in boxes] for life in self._lives]).reshape(
            len(self._lives), len(boxes)
        )
        matched = assign(distances, self.settings.gate)
        lives = []
        for number, life in enumerate(self._lives):
            if number in matched:
                region = candidates.regions[chosen[matched[number]]]
                lives.append(self._updated(life, region, time_s))
            # A believed pair elsewhere replaces what was followed.
            elif len(chosen) < 2 and time_s - life.seen_s <= self.settings.lost_s:
                box = _box(life.coordinates, candidates.source_size)
                missed = life.track.missed + 1
                lives.append(
                    replace(life, track=replace(life.track, box=box, missed=missed, alternatives=()))
                )
        fresh = [index for place, index in enumerate(chosen) if place not in matched.values()]
        return lives + self._born(candidates, fresh, lives, time_s)

    def _updated(self, life: _Life, region: HandRegion, time_s: float) -> _Life:
        variance = (self.settings.measurement_noise * _hand_size(life.coordinates)) ** 2
        coordinates = tuple(
            kalman.update(item, value, variance)
            for item, value in zip(life.coordinates, _measure(region.box), strict=True)
        )
        track = replace(
            life.track,
            box=region.box,
            confidence=region.confidence,
            missed=0,
            alternatives=region.alternatives,
        )
        return _Life(track, coordinates, time_s)

    def _born(
        self, candidates: Candidates, fresh: list[int], lives: list[_Life], time_s: float
    ) -> list[_Life]:
        """New tracks for believed regions that no track claimed, on the sides that are free."""
        fresh = sorted(fresh, key=lambda index: _measure(candidates.regions[index].box)[0])
        taken = {life.track.side for life in lives}
        sides: list[Side]
        if len(fresh) == 2 and not taken:
            sides = ["right", "left"]
        elif len(fresh) == 1 and len(taken) < 2:
            free: list[Side] = [side for side in ("right", "left") if side not in taken]
            guess = side_in_picture(candidates.regions[fresh[0]].box, candidates.source_size[0])
            sides = [guess] if guess in free else free
        else:
            return []
        return [
            self._new(candidates.regions[index], side, time_s)
            for index, side in zip(fresh, sides, strict=True)
        ]

    def _new(self, region: HandRegion, side: Side, time_s: float) -> _Life:
        box = region.box
        size = math.sqrt(box[2] * box[3])
        position = (self.settings.measurement_noise * size) ** 2
        coordinates = tuple(kalman.start(value, position, (2.0 * size) ** 2) for value in _measure(box))
        track = Track(self._next, side, box, region.confidence, 0, region.alternatives)
        self._next += 1
        return _Life(track, coordinates, time_s)
