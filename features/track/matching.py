"""Tracks and the regions of a frame: which track finds its hand in which region. Pure functions.

First each hand that is followed looks inside its gate, by Mahalanobis distance, and the best assignment counts. What
fails there has leapt, as hands do for a new sign or before a slow camera: to a verified pair near both, or else to a
region near by that is believed on its own. What is left over belongs to the tentative tracks. The distance of a region
is that of the nearest of its extents: with and without the forearm it is the same hand.
"""

import math
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Final, NamedTuple

from lightgesture.features.track.kalman import BoxState, meets, precision_of, squared_distance
from lightgesture.features.track.state import Match, Track
from lightgesture.features.types import Candidates, HandRegion

CONSIDERED: Final = 24
"""Most regions of a frame that are looked at, best first; bounds the time."""
RANKED: Final = 4
"""Pairs of a frame that are looked at, best first."""
TRIED: Final = 6
"""Regions in the gate of a hand that are tried in an assignment, best first; bounds the time."""
KEEP_SHARE: Final = 0.4
"""Least score of a region that a track takes as its own, as a share of what a lone region must score. Lower bridges
weak frames, higher leaves a hand sooner. Where two hands meet, it is the whole of it."""
RETURN_S: Final = 0.2
"""For so many seconds a missing hand may return with a region that is only just good enough; later the region must be
believed on its own or with its partner."""
NEARNESS: Final = 0.7
"""What a region at the predicted place is worth beside its score and its pair's. Larger keeps to what was seen before,
smaller to what looks most like a hand."""
ORDER: Final = 0.3
"""What it is worth, on the same scale, that hands of which one went behind the other come back in the order in which
they met. Larger takes them for hands that parted again, smaller for hands that crossed."""
LEAP_NOISE: Final = 0.45
"""Standard deviation of the centre and of the size, sizes of the hand, by which a hand may leap from one frame to the
next where its region is half of a verified pair or believed on its own."""


class PairScore(NamedTuple):
    """Two regions of a frame and how well they go together, 0 to 1."""

    score: float
    first: int
    second: int


@dataclass(frozen=True, slots=True, eq=False)
class Observed:
    """The part of a frame's candidates that tracks look at.

    regions: by their number, best first. scores: (n, n), of all pairs of numbers up to the greatest of these regions.
    pairs: verified ones, best first.
    """

    regions: dict[int, HandRegion]
    scores: list[list[float]]
    pairs: tuple[PairScore, ...]

    def together(self, first: int | None, second: int | None) -> float:
        """Score of a pair, 0 to 1; 0 where it is no number, or where there are not two."""
        if first is None or second is None:
            return 0.0
        score = self.scores[first][second]
        return score if score > 0.0 else 0.0

    def credible(self, least: float, taken: Container[int] = ()) -> dict[int, HandRegion]:
        """The regions with a confidence of at least `least`, except those that are taken."""
        return {
            index: region
            for index, region in self.regions.items()
            if region.confidence >= least and index not in taken
        }


def look_at(candidates: Candidates, least: float) -> Observed:
    """The sound ones of the best regions, and their pairs that score at least `least`."""
    picture = candidates.source_size
    regions = {
        index: region
        for index, region in enumerate(candidates.regions[:CONSIDERED])
        if _is_sound(region, picture)
    }
    scores: list[list[float]] = candidates.pairs[:CONSIDERED, :CONSIDERED].tolist()
    pairs = [
        PairScore(scores[first][second], first, second)
        for first, second in combinations(regions, 2)
        if scores[first][second] >= least
    ]
    return Observed(regions, scores, tuple(sorted(pairs, reverse=True)[:RANKED]))


def _is_sound(region: HandRegion, picture: tuple[int, int]) -> bool:
    """Whether the box is one, lies at least partly in the picture, and has a score."""
    x, y, width, height = region.box
    return (
        width > 0
        and height > 0
        and x < picture[0]
        and y < picture[1]
        and x + width > 0
        and y + height > 0
        and math.isfinite(region.confidence)
    )


def match_tracks(
    hands: Sequence[Track],
    tentative: Sequence[Track],
    observed: Observed,
    now: float,
    gate: float,
    leap_score: float,
    single_score: float,
) -> dict[int, Match]:
    """Key of a track -> what it found. hands, tentative: the tracks with and without a number, predicted to `now`
    seconds.

    gate: largest squared distance at which a region is a track's own. leap_score: least score of a pair to which hands
    leap: it must be as good a pair as they were before, or another thing beside a hand would be taken for its partner.
    single_score: least score of a region that is believed on its own.
    """
    found = _match_hands(hands, observed, now, gate, single_score)
    if len(found) < len(hands) and observed.pairs:
        missing = [track for track in hands if track.key not in found]
        found |= _match_leaps(missing, _taken(found), observed, gate, leap_score)
    if len(found) < len(hands):
        missing = [track for track in hands if track.key not in found]
        free = observed.credible(single_score, _taken(found))
        found |= _match_nearest(missing, free, gate, leap=True)
    if tentative:
        free = observed.credible(single_score * KEEP_SHARE, _taken(found))
        found |= _match_nearest(tentative, free, gate, leap=False)
    return found


def _taken(found: Mapping[int, Match]) -> set[int]:
    return {match.index for match in found.values()}


def _match_hands(
    hands: Sequence[Track], observed: Observed, now: float, gate: float, single_score: float
) -> dict[int, Match]:
    """The matches inside the gates of at most two hands."""
    # What is seen where hands meet may be both of them as one thing, which tells little of either.
    is_met = len(hands) == 2 and meets(hands[0].motion, hands[1].motion)
    rows = []
    for track in hands:
        is_late = now - track.seen_s > RETURN_S
        least = single_score * (1.0 if is_late or is_met else KEEP_SHARE)
        rows.append(gated(track.motion, observed.credible(least), gate))
    values = [{index: _worth(match, gate) for index, match in row.items()} for row in rows]
    is_hidden = is_met and any(track.missed for track in hands)

    def together(first: int, second: int) -> float:
        score = observed.together(first, second)
        return score + _order(hands, first, second, observed) if is_hidden else score

    assigned = assign(values, together)
    return {hands[row].key: rows[row][index] for row, index in assigned.items()}


def _order(hands: Sequence[Track], first: int, second: int, observed: Observed) -> float:
    """What it adds that hands which met, one behind the other, come back in the order along x in which they went."""
    one, other = observed.regions[first].box, observed.regions[second].box
    went = hands[1].seen_x - hands[0].seen_x
    came = (other[0] + other[2] / 2) - (one[0] + one[2] / 2)
    return ORDER if went * came > 0.0 else 0.0


def _worth(match: Match, gate: float) -> float:
    """What a match adds: below 0 it is better to miss the hand. Nearness counts from 1 to -1 at the gate, so that a
    weak region is taken only near by, and two bad matches do not outweigh a good one."""
    return NEARNESS * (1.0 - 2.0 * match.squared / gate) + match.region.confidence


def _match_leaps(
    missing: Sequence[Track], taken: set[int], observed: Observed, gate: float, leap_score: float
) -> dict[int, Match]:
    """Leaps of all missing hands to the best verified pair that is near enough, with what the other hand found."""
    for pair in observed.pairs:
        ends = {pair.first, pair.second}
        if not taken <= ends or pair.score < leap_score:
            continue
        regions = {index: observed.regions[index] for index in ends - taken}
        leaps = _match_nearest(missing, regions, gate, leap=True)
        if len(leaps) == len(missing):
            return leaps
    return {}


def _match_nearest(
    tracks: Sequence[Track], regions: Mapping[int, HandRegion], gate: float, *, leap: bool
) -> dict[int, Match]:
    """The tracks and the regions in their gates, the nearest two first. leap: as wide as for a new sign."""
    rows = [gated(track.motion, regions, gate, leap=leap) for track in tracks]
    assigned = assign_nearest(
        (match.squared, row, index) for row, matches in enumerate(rows) for index, match in matches.items()
    )
    return {tracks[row].key: rows[row][index] for row, index in assigned.items()}


def gated(
    motion: BoxState, regions: Mapping[int, HandRegion], gate: float, *, leap: bool = False
) -> dict[int, Match]:
    """The regions with an extent inside the gate of a predicted hand, by their number.

    Beyond three times the gate's radius from the region's box the alternatives are not tried: they overlap it.
    """
    precision = precision_of(motion, LEAP_NOISE if leap else 0.0)
    matches = {}
    for index, region in regions.items():
        extent, least = 0, squared_distance(motion, precision, region.box)
        if least > 9.0 * gate:
            continue
        for number, box in enumerate(region.alternatives, start=1):
            squared = squared_distance(motion, precision, box)
            if squared < least:
                extent, least = number, squared
        if least <= gate:
            matches[index] = Match(index, region, extent, least, leap)
    return matches


def assign(values: Sequence[Mapping[int, float]], together: Callable[[int, int], float]) -> dict[int, int]:
    """Track -> region of the greatest total value, each region once; a track may stay without.

    values: for each of at most two tracks the value of each region that it may take; below 0 none is better; of equal
    ones the first counts. together: what two regions are worth beyond their own values.
    """
    first, second = (*values, {}, {})[:2]
    tried = [sorted(row, key=row.__getitem__, reverse=True)[:TRIED] for row in (first, second)]
    best: tuple[int | None, int | None] = None, None
    best_total = 0.0
    for one in (None, *tried[0]):
        own = 0.0 if one is None else first[one]
        for other in (None, *tried[1]):
            if other is None:
                total = own
            elif other == one:
                continue
            else:
                total = own + second[other] + (0.0 if one is None else together(one, other))
            if total > best_total:
                best, best_total = (one, other), total
    return {track: index for track, index in enumerate(best) if index is not None}


def assign_nearest(distances: Iterable[tuple[float, int, int]]) -> dict[int, int]:
    """Track -> region, the nearest two first. distances: (squared distance, track, region) of what may be matched."""
    assigned: dict[int, int] = {}
    used: set[int] = set()
    for _, track, index in sorted(distances):
        if track not in assigned and index not in used:
            assigned[track] = index
            used.add(index)
    return assigned
