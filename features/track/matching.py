"""Tracks and the regions of a frame: which track finds its hand in which region. Pure functions.

First each numbered track looks inside its gate. What fails there has leapt, as hands do for a new sign or before a
slow camera: to a verified pair near both, or else to a region near by that is believed on its own. What is left over
belongs to the tentative tracks.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

from lightgesture.features.find.settings import SelectorSettings
from lightgesture.features.track.association import Innovation, Match, assign, assign_nearest, gated
from lightgesture.features.track.motion import Measured, measure, meets
from lightgesture.features.track.settings import TrackSettings
from lightgesture.features.track.state import TrackState, innovation
from lightgesture.features.types import Candidates, HandRegion

RANKED = 4
"""Pairs of a frame that are looked at, best first."""


class PairScore(NamedTuple):
    """Two regions of a frame and how well they go together, 0 to 1."""

    score: float
    first: int
    second: int


class Found(NamedTuple):
    """What a track found. region: its number in the candidates; measured: its nearest extent; leap: beyond the gate."""

    region: int
    measured: Measured
    leap: bool


@dataclass(frozen=True, slots=True, eq=False)
class Observed:
    """The part of a frame's candidates that tracks look at.

    regions: by their number, best first. scores: (n, n), of all pairs of numbers up to the greatest of these regions.
    pairs: verified ones, best first.
    """

    regions: dict[int, HandRegion]
    scores: list[list[float]]
    pairs: tuple[PairScore, ...]

    def together(self, first: int, second: int) -> float:
        """Score of a pair, 0 to 1; 0 where it is no number."""
        score = self.scores[first][second]
        return score if score > 0.0 else 0.0

    def credible(self, least: float) -> dict[int, HandRegion]:
        """The regions with a confidence of at least `least`."""
        return {index: region for index, region in self.regions.items() if region.confidence >= least}


def look_at(candidates: Candidates, least: float, considered: int) -> Observed:
    """The sound ones of the best `considered` regions, and their pairs that score at least `least`."""
    picture = candidates.source_size
    regions = {
        index: region
        for index, region in enumerate(candidates.regions[:considered])
        if _is_sound(region, picture)
    }
    scores: list[list[float]] = candidates.pairs[:considered, :considered].tolist()
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
    tracks: Sequence[TrackState],
    observed: Observed,
    held: float,
    now: float,
    settings: TrackSettings,
    selection: SelectorSettings,
) -> dict[int, Found]:
    """Position in `tracks` (predicted to `now` seconds) -> what it found. held: mean score of the pair followed."""
    numbered = [place for place, track in enumerate(tracks) if track.life != "tentative"]
    found = _match_numbered(tracks, numbered, observed, now, settings, selection)
    missing = [place for place in numbered if place not in found]
    if missing and observed.pairs:
        found |= _match_leaps(tracks, missing, found, observed, held, settings)
    missing = [place for place in numbered if place not in found]
    if missing:
        found |= _match_alone(tracks, missing, found, observed, selection.single_score, settings, leap=True)
    tentative = [place for place, track in enumerate(tracks) if track.life == "tentative"]
    if tentative:
        least = selection.single_score * settings.keep_share
        found |= _match_alone(tracks, tentative, found, observed, least, settings, leap=False)
    return found


def _match_numbered(
    tracks: Sequence[TrackState],
    numbered: Sequence[int],
    observed: Observed,
    now: float,
    settings: TrackSettings,
    selection: SelectorSettings,
) -> dict[int, Found]:
    both = [tracks[place] for place in numbered]
    # What is seen where hands meet may be both of them as one thing, which tells little of either.
    is_met = len(both) == 2 and meets(both[0].motion, both[1].motion)
    rows: list[dict[int, Match]] = []
    for track in both:
        is_late = now - track.seen_s > settings.return_s
        least = selection.single_score * (1.0 if is_late or is_met else settings.keep_share)
        rows.append(gated(innovation(track.motion, settings), observed.credible(least), settings.gate))
    values = [
        {index: _worth(match, observed.regions[index], settings) for index, match in row.items()}
        for row in rows
    ]
    assigned = assign(
        values,
        lambda first, second: (
            observed.together(first, second) + _order(both, first, second, observed, settings)
        ),
    )
    return {
        numbered[row]: Found(index, rows[row][index].measured, leap=False) for row, index in assigned.items()
    }


def _order(
    tracks: Sequence[TrackState], first: int, second: int, observed: Observed, settings: TrackSettings
) -> float:
    """What it adds that hands which met, one behind the other, come back in the order along x in which they went."""
    one, other = tracks
    if not (one.missed or other.missed) or not meets(one.motion, other.motion):
        return 0.0
    went = other.seen_x - one.seen_x
    came = measure(observed.regions[second].box)[0] - measure(observed.regions[first].box)[0]
    return settings.order if went * came > 0.0 else 0.0


def _worth(match: Match, region: HandRegion, settings: TrackSettings) -> float:
    """What a match adds: below 0 it is better to miss the hand. Nearness counts from 1 to -1 at the gate, so that a
    weak region is taken only near by, and two bad matches do not outweigh a good one."""
    return settings.nearness * (1.0 - 2.0 * match.squared / settings.gate) + region.confidence


def _match_leaps(
    tracks: Sequence[TrackState],
    missing: Sequence[int],
    found: dict[int, Found],
    observed: Observed,
    held: float,
    settings: TrackSettings,
) -> dict[int, Found]:
    """Leaps of the missing tracks to the best verified pair that is near enough, with what the others found. It must
    be as good a pair as the hands were before, or another thing beside a hand would be taken for its partner."""
    taken = {item.region for item in found.values()}
    expected = [innovation(tracks[place].motion, settings, leap=True) for place in missing]
    for pair in observed.pairs:
        ends = {pair.first, pair.second}
        if not taken <= ends or pair.score < held - settings.margin:
            continue
        regions = {index: observed.regions[index] for index in ends - taken}
        leaps = _match_nearest(missing, expected, regions, settings.gate, leap=True)
        if len(leaps) == len(missing):
            return leaps
    return {}


def _match_alone(
    tracks: Sequence[TrackState],
    places: Sequence[int],
    found: dict[int, Found],
    observed: Observed,
    least: float,
    settings: TrackSettings,
    *,
    leap: bool,
) -> dict[int, Found]:
    """The tracks at `places` and the regions that no other found and whose confidence is at least `least`."""
    taken = {item.region for item in found.values()}
    free = {index: region for index, region in observed.credible(least).items() if index not in taken}
    expected = [innovation(tracks[place].motion, settings, leap=leap) for place in places]
    return _match_nearest(places, expected, free, settings.gate, leap=leap)


def _match_nearest(
    places: Sequence[int],
    expected: Sequence[Innovation],
    regions: Mapping[int, HandRegion],
    gate: float,
    *,
    leap: bool,
) -> dict[int, Found]:
    """The tracks at `places`, each expected where `expected` says, and the regions in their gates, the nearest two
    first."""
    rows = [gated(item, regions, gate) for item in expected]
    assigned = assign_nearest(
        (match.squared, row, index) for row, matches in enumerate(rows) for index, match in matches.items()
    )
    return {places[row]: Found(index, rows[row][index].measured, leap) for row, index in assigned.items()}
