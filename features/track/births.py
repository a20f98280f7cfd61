"""Which tracks are believed: births from verified pairs or repeated evidence, and the end of what is contradicted.

The tracks that have a number hold their place against a new pair unless it is clearly better, so that a second pair
such as a mirror image does not take turns with the hands; and they lose it if it is, so that a red object that was
taken for a hand once does not stay one. Pure functions.
"""

from collections.abc import Iterable, Mapping, Sequence

from lightgesture.features.find.settings import SelectorSettings
from lightgesture.features.track.evidence import PairEvidence, is_verified
from lightgesture.features.track.matching import Observed
from lightgesture.features.track.settings import TrackSettings
from lightgesture.features.track.sides import CERTAIN, lone_side, pair_sides
from lightgesture.features.track.state import TrackState, trust_s
from lightgesture.features.types import Side

PairKey = tuple[int, int]
"""Keys of two tracks, the smaller first."""

NEW_PAIRS, NEW_SINGLES = 2, 2
"""Pairs and regions of a frame that may come under observation, best first."""


def pair_key(first: TrackState, second: TrackState) -> PairKey:
    """The name of a pair of tracks."""
    return min(first.key, second.key), max(first.key, second.key)


def numbered(tracks: Iterable[TrackState]) -> list[TrackState]:
    """The tracks that have a number: confirmed or lost."""
    return [track for track in tracks if track.number]


def held_level(tracks: Sequence[TrackState], evidence: Mapping[PairKey, PairEvidence]) -> float:
    """Mean score of the pair that is followed, 0 without one."""
    held = numbered(tracks)
    if len(held) < 2:
        return 0.0
    known = evidence.get(pair_key(held[0], held[1]))
    return 0.0 if known is None else known.level


def worth_observing(
    tracks: Sequence[TrackState],
    observed: Observed,
    held: float,
    settings: TrackSettings,
    selection: SelectorSettings,
) -> list[int]:
    """Regions that may be hands, best first: those of verified pairs that would be better than the present one, whose
    mean score is `held`, and without a pair those that are believed on their own."""
    present = numbered(tracks)
    better = held + settings.margin if len(present) == 2 else 0.0
    worth = [
        index
        for pair in observed.pairs[:NEW_PAIRS]
        if pair.score >= better
        for index in (pair.first, pair.second)
    ]
    if len(present) < 2:
        least = max(selection.single_score, present[0].level if present else 0.0)
        believed = [index for index, region in observed.regions.items() if region.confidence >= least]
        worth += believed[:NEW_SINGLES]
    return list(dict.fromkeys(worth))


def believed_pair(
    tracks: Sequence[TrackState],
    evidence: Mapping[PairKey, PairEvidence],
    settings: TrackSettings,
    selection: SelectorSettings,
) -> tuple[TrackState, TrackState, float] | None:
    """The pair that is to be followed from now on, at least one of them new, and its mean score; None if all stays
    as it is."""
    seen = {track.key: track for track in tracks if not track.missed}
    held = held_level(tracks, evidence)
    best: tuple[TrackState, TrackState, float] | None = None
    for (first, second), known in evidence.items():
        if first not in seen or second not in seen or not is_verified(known, selection.pair_score, settings):
            continue
        pair = seen[first], seen[second]
        new = sum(not track.number for track in pair)
        is_better = new and _replaces(known, new, numbered(tracks), held, settings, selection)
        if is_better and (best is None or known.level > best[2]):
            best = *pair, known.level
    return best


def _replaces(
    known: PairEvidence,
    new: int,
    present: Sequence[TrackState],
    held: float,
    settings: TrackSettings,
    selection: SelectorSettings,
) -> bool:
    """Whether a verified pair, `new` of its tracks without a number, takes the place of the present tracks, whose
    mean score is `held`."""
    if len(present) == 2:
        lead = known.level - held
        is_settled = known.last_s - known.since_s >= settings.replace_s
        is_held = not any(track.missed for track in present)
        return lead >= settings.margin and (lead >= settings.sure_margin or is_settled or not is_held)
    if present and new == 2 and present[0].basis == CERTAIN and not present[0].missed:
        # One of two hands that were seen together: more than any two regions that pass for a pair.
        return known.level >= selection.pair_score + settings.margin
    return True


def believed_single(
    tracks: Sequence[TrackState], settings: TrackSettings, selection: SelectorSettings
) -> TrackState | None:
    """The lone hand that is to be followed from now on; None if all stays as it is."""
    present = numbered(tracks)
    if len(present) == 2:
        return None
    least = selection.single_score
    if present:
        least = max(least, present[0].level + settings.margin)
    known = [
        track
        for track in tracks
        if not track.number
        and not track.missed
        and track.level >= least
        and track.hits >= settings.single_frames
        and track.proved_s - track.since_s >= settings.single_s
    ]
    return max(known, key=lambda track: track.level, default=None)


def with_pair_sides(
    first: TrackState, second: TrackState, level: float, settings: TrackSettings
) -> tuple[TrackState, TrackState]:
    """Both tracks with the sides of two hands seen together, `level` being their mean score.

    A side stays that a hand has had for a while from as good a pair as this. One from a guess gives way, and one from
    a worse pair or a short one, which may have been a hand and another thing.
    """

    def known(track: TrackState) -> Side | None:
        is_old = track.proved_s - track.since_s >= settings.settle_s
        is_good = track.side_level >= level - settings.margin
        return track.side if track.basis == CERTAIN and is_old and is_good else None

    sides = pair_sides(first.x, second.x, known(first), known(second))
    return (
        first._replace(side=sides[0], basis=CERTAIN, side_level=level),
        second._replace(side=sides[1], basis=CERTAIN, side_level=level),
    )


def with_old_number(believed: tuple[TrackState, ...], tracks: Sequence[TrackState]) -> tuple[TrackState, ...]:
    """The believed pair, the new hand with the number of a lost one: a diver has two hands, so the partner of one is
    the other, wherever it comes back. One that is still seen elsewhere was another thing."""
    kept = {track.key for track in believed}
    lost = [track for track in numbered(tracks) if track.missed and track.key not in kept]
    if len(lost) != 1 or sum(1 for track in believed if track.number) != 1:
        return believed
    return tuple(track if track.number else track._replace(number=lost[0].number) for track in believed)


def with_lone_side(track: TrackState, axis: float | None, width: int) -> TrackState:
    """The track with a better guess of its side, if its side is a guess: made at its birth, by the picture's middle
    if need be, and once more when the body's axis is first seen. It does not change as the hand moves on."""
    is_settled = track.basis in (CERTAIN, "axis") or (track.basis == "middle" and axis is None)
    if not track.number or is_settled:
        return track
    side, basis = lone_side(track.x, axis, width)
    return track._replace(side=side, basis=basis)


def proved(
    tracks: Sequence[TrackState],
    score: float,
    held: float,
    now: float,
    settings: TrackSettings,
    selection: SelectorSettings,
) -> list[TrackState]:
    """The tracks with what was proved in this frame: the time at which they were last believed, and how good a pair
    their sides rest on.

    score, held: of the pair that is followed, in this frame and in the mean. Two hands that are seen prove each
    other; where they have not for too long, one of them is none, and the better one stays only if it is believed on
    its own.
    """
    present = numbered(tracks)
    seen = [track for track in present if not track.missed]
    fresh = set()
    if len(seen) == 2 and score >= selection.pair_score:
        fresh = {track.key for track in seen}
    elif len(seen) == 1 and seen[0].confidence >= selection.single_score:
        fresh = {seen[0].key}
    doubted = [
        track
        for track in present
        if track.key not in fresh and now - track.proved_s > trust_s(track, settings.doubt_s, settings)
    ]
    if len(seen) == 2 and len(doubted) == 2:
        better = max(doubted, key=lambda track: track.level)
        if better.level >= selection.single_score:
            fresh.add(better.key)
    return [
        track._replace(proved_s=now, side_level=max(track.side_level, held)) if track.key in fresh else track
        for track in tracks
    ]
