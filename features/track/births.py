"""Which tracks are believed: births from verified pairs or repeated evidence, and the end of what is contradicted.

A score of one frame says little: a red box on a table scores high now and then. A pair is believed once it scores very
high, or well for some frames in a row; which of two pairs is the better is told by mean scores. The hands that are
followed hold their place against a new pair unless it is clearly better, so that a second pair such as a mirror image
does not take turns with them; and they lose it if it is, so that a red object that was taken for a hand once does not
stay one. Pure functions, in seconds and frames both.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from operator import attrgetter
from typing import Final

from lightgesture.features.find.settings import SelectorSettings
from lightgesture.features.track.matching import Observed
from lightgesture.features.track.state import TENTATIVE_S, Track, blend, trust_s

SURE_SHARE: Final = 0.2
"""A pair whose score exceeds the least one by this share of what is missing to 1 is believed at once."""
PAIR_S: Final = 0.05
"""Seconds for which a weaker pair must have been seen."""
PAIR_FRAMES: Final = 2
"""Frames in which it must have been seen."""
SINGLE_S: Final = 0.06
"""Seconds for which a region without a partner must have been seen."""
SINGLE_FRAMES: Final = 3
"""Frames in which it must have been seen."""
REPLACE_S: Final = 0.1
"""Seconds for which a better pair must have been seen to replace hands that are seen as well."""
SURE_MARGIN: Final = 0.35
"""A pair whose mean score is better by so much replaces them at once."""
NEW_PAIRS: Final = 2
"""Pairs of a frame that may come under observation, best first."""
NEW_SINGLES: Final = 2
"""Regions of a frame that may come under observation on their own, best first."""

PairKey = tuple[int, int]
"""Keys of two tracks, the smaller first."""


@dataclass(frozen=True, slots=True)
class PairEvidence:
    """What is known of a pair. level: mean score, the last frames counting most, 0 to 1. since_s, last_s: first and
    last time of the present run of sufficient scores. hits: frames in it."""

    level: float
    since_s: float
    last_s: float
    hits: int


def observe(known: PairEvidence | None, score: float, now: float, step: float, least: float) -> PairEvidence:
    """The evidence after a frame at `now` seconds in which the pair scored `score` (0: not both were seen).

    least: score that suffices. A run outlives frames that are missed, but not for long.
    """
    if known is None:
        return PairEvidence(score, now, now, 0 if score < least else 1)
    level = blend(known.level, score, step)
    if score < least:
        ended = now - known.last_s > TENTATIVE_S
        return PairEvidence(level, known.since_s, known.last_s, 0 if ended else known.hits)
    return PairEvidence(level, known.since_s if known.hits else now, now, known.hits + 1)


def is_verified(evidence: PairEvidence, least: float) -> bool:
    """Whether the pair is believed: `least` exceeded by a good share, or reached for long enough."""
    if evidence.hits and evidence.level >= least + SURE_SHARE * (1.0 - least):
        return True
    lasted = evidence.last_s - evidence.since_s >= PAIR_S
    return evidence.hits >= PAIR_FRAMES and lasted and evidence.level >= least


def gather(
    evidence: Mapping[PairKey, PairEvidence],
    tracks: Iterable[Track],
    observed: Observed,
    now: float,
    step: float,
    least: float,
) -> dict[PairKey, PairEvidence]:
    """The evidence on all pairs of tracks after a frame; kept of pairs that once scored `least`."""
    gathered = {}
    for first, second in combinations(sorted(tracks, key=attrgetter("key")), 2):
        known = evidence.get((first.key, second.key))
        score = observed.together(first.region, second.region)
        if known is not None or score >= least:
            gathered[first.key, second.key] = observe(known, score, now, step, least)
    return gathered


def held_level(hands: Sequence[Track], evidence: Mapping[PairKey, PairEvidence]) -> float:
    """Mean score of the pair that is followed, 0 without one."""
    if len(hands) < 2:
        return 0.0
    first, second = hands[0].key, hands[1].key
    known = evidence.get((min(first, second), max(first, second)))
    return 0.0 if known is None else known.level


def worth_observing(
    hands: Sequence[Track], observed: Observed, better: float, selection: SelectorSettings
) -> list[int]:
    """Regions that may be hands, best first: those of verified pairs of at least the mean score `better`, where two
    hands are followed; else those of any verified pair, and those that are believed on their own."""
    has_pair = len(hands) == 2
    worth = [
        index
        for pair in observed.pairs[:NEW_PAIRS]
        if not has_pair or pair.score >= better
        for index in (pair.first, pair.second)
    ]
    if not has_pair:
        least = max(selection.single_score, hands[0].level if hands else 0.0)
        worth += list(observed.credible(least))[:NEW_SINGLES]
    return list(dict.fromkeys(worth))


def believed_pair(
    hands: Sequence[Track],
    tentative: Sequence[Track],
    evidence: Mapping[PairKey, PairEvidence],
    least: float,
    margin: float,
) -> tuple[Track, Track, float] | None:
    """The pair that is to be followed from now on, at least one of them new, and its mean score; None if all stays
    as it is. least: score of a pair; margin: see TrackSettings."""
    seen = {track.key: track for track in (*hands, *tentative) if not track.missed}
    best: tuple[Track, Track, float] | None = None
    for (first, second), known in evidence.items():
        if first not in seen or second not in seen:
            continue
        pair = seen[first], seen[second]
        new = (not pair[0].number) + (not pair[1].number)
        if not new or not is_verified(known, least) or (best is not None and known.level <= best[2]):
            continue
        held = held_level(hands, evidence)
        if _replaces(known, new, hands, held, least, margin):
            best = *pair, known.level
    return best


def _replaces(
    known: PairEvidence, new: int, hands: Sequence[Track], held: float, least: float, margin: float
) -> bool:
    """Whether a verified pair, `new` of its tracks without a number, takes the place of the hands that are followed,
    whose mean score is `held`."""
    if len(hands) == 2:
        lead = known.level - held
        is_settled = known.last_s - known.since_s >= REPLACE_S
        is_held = not any(track.missed for track in hands)
        return lead >= margin and (lead >= SURE_MARGIN or is_settled or not is_held)
    if hands and new == 2 and hands[0].basis == "pair" and not hands[0].missed:
        # One of two hands that were seen together: more than any two regions that pass for a pair.
        return known.level >= least + margin
    return True


def believed_single(
    hands: Sequence[Track], tentative: Sequence[Track], least: float, margin: float
) -> Track | None:
    """The lone hand that is to be followed from now on; None if all stays as it is. least: score of a lone region;
    margin: see TrackSettings."""
    if len(hands) == 2:
        return None
    if hands:
        least = max(least, hands[0].level + margin)
    known = [
        track
        for track in tentative
        if not track.missed
        and track.level >= least
        and track.hits >= SINGLE_FRAMES
        and track.proved_s - track.since_s >= SINGLE_S
    ]
    return max(known, key=attrgetter("level"), default=None)


def with_old_number(believed: tuple[Track, ...], hands: Sequence[Track]) -> tuple[Track, ...]:
    """The believed pair, the new hand with the number of a lost one: a diver has two hands, so the partner of one is
    the other, wherever it comes back. One that is still seen elsewhere was another thing."""
    kept = {track.key for track in believed}
    lost = [track for track in hands if track.missed and track.key not in kept]
    if len(lost) != 1 or sum(1 for track in believed if track.number) != 1:
        return believed
    return tuple(track if track.number else replace(track, number=lost[0].number) for track in believed)


def proved(
    hands: Sequence[Track],
    score: float,
    held: float,
    now: float,
    doubt_s: float,
    selection: SelectorSettings,
) -> list[Track]:
    """The hands with what was proved in this frame: the time at which they were last believed, and how good a pair
    their sides rest on.

    score, held: of the pair that is followed, in this frame and in the mean. Two hands that are seen prove each
    other; where they have not for too long (`doubt_s`), one of them is none, and the better one stays only if it is
    believed on its own.
    """
    seen = [track for track in hands if not track.missed]
    fresh = set()
    if len(seen) == 2 and score >= selection.pair_score:
        fresh = {track.key for track in seen}
    elif len(seen) == 1 and seen[0].confidence >= selection.single_score:
        fresh = {seen[0].key}
    elif len(seen) == 2 and all(now - track.proved_s > trust_s(track, doubt_s) for track in seen):
        better = max(seen, key=attrgetter("level"))
        if better.level >= selection.single_score:
            fresh = {better.key}
    return [
        replace(track, proved_s=now, side_level=max(track.side_level, held)) if track.key in fresh else track
        for track in hands
    ]
