"""Two hands followed through the frames: a Kalman filter each, a side for life, birth only on good evidence.

What a frame does to the tracks, in order: all are predicted to its time; each finds its region or misses it; regions
that may be hands come under observation as tentative tracks; pairs of tracks gather evidence; a believed pair, or
without one a believed single hand, is confirmed, in the place of what it contradicts; what was unseen or unproved
for too long ends. The arithmetic is in pure functions (`kalman`, `state`, `matching`, `births`); the tracker holds the
state and the clock.
"""

import math
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Final

from lightgesture.features.find.settings import SelectorSettings
from lightgesture.features.geometry import box_iou
from lightgesture.features.track import births
from lightgesture.features.track.births import PairEvidence, PairKey
from lightgesture.features.track.kalman import box_of, predict_box
from lightgesture.features.track.matching import Observed, look_at, match_tracks
from lightgesture.features.track.settings import TrackSettings
from lightgesture.features.track.state import (
    Match,
    Track,
    begin,
    is_over,
    seen,
    unseen,
    with_lone_side,
    with_pair_sides,
)
from lightgesture.features.types import Box, Candidates

LONGEST_STEP_S: Final = 1.0
"""A larger gap in time ends all tracks, seconds."""
STALLED_STEP_S: Final = 1 / 30
"""Seconds that count as passed where the time of a frame stands still, runs back or is no number."""
STILL_IOU: Final = 0.6
"""Overlap of the predicted box with the one found in it, from which a hand stands still enough for a look at the box to
do, 0 to 1. Larger searches oftener, where hands move, and its boxes are truer."""
WHOLE_ALONE_S: Final = 0.1
"""The most that `TrackSettings.whole_s` is for a hand alone, so that the second one is found soon, seconds."""
MOST_TENTATIVE: Final = 6
"""Most regions under observation at a time; bounds the time."""


@dataclass(slots=True, eq=False)
class _NextFrame:
    """The tracks predicted `step` seconds ahead, and what they find there: what `update` need not do again.

    hands: those with a number; tentative: those without. matching: the candidates that were last asked about, what
    there is to see in them, and what each track found, by its key.
    """

    step: float
    hands: list[Track]
    tentative: list[Track]
    matching: tuple[Candidates, Observed, dict[int, Match]] | None = None


class Tracker:
    """Candidates of each frame -> at most two tracks, one a side.

    A frame is `update` alone, or `predict`, then a look at the predicted boxes, and `explains` to ask whether it was
    enough, then `update`. The tracks are the same: asking changes nothing, and spares `update` what was done for it.
    """

    def __init__(
        self, settings: TrackSettings | None = None, selection: SelectorSettings | None = None
    ) -> None:
        self._settings = settings or TrackSettings()
        self._selection = selection or SelectorSettings()
        self._next_number = 1
        self._next_key = 1
        self._forget()

    def _forget(self) -> None:
        """Forget everything, as at the start of another stream; numbers go on."""
        self._hands: list[Track] = []
        self._tentative: list[Track] = []
        self._evidence: dict[PairKey, PairEvidence] = {}
        self._now = 0.0
        self._whole = -math.inf
        self._time_s: float | None = None
        self._size: tuple[int, int] | None = None
        self._next: _NextFrame | None = None

    def predict(self, time_s: float) -> tuple[Box, ...]:
        """Where the hands should be in the frame at `time_s` seconds, source pixels.

        Empty where the whole frame must be searched: without tracks, with one that is not seen just now, with a
        region under observation, or when the last whole search is too long ago.
        """
        step = self._step_to(time_s)
        if self._size is None or step > LONGEST_STEP_S:
            self._next = None
            return ()
        hands = self._predicted(step).hands
        longest = self._settings.whole_s
        if len(hands) == 1:
            longest = min(longest, WHOLE_ALONE_S)
        is_due = self._now + step - self._whole > longest
        if is_due or self._tentative or any(track.missed for track in hands):
            return ()
        picture = self._size
        return tuple(box_of(track.motion, picture) for track in hands)

    def explains(self, candidates: Candidates) -> bool:
        """Whether each hand that is seen just now finds its region among these, about where `predict` said; False where
        it was not asked. A hand that moved on was seen through a window beside it, and its box cannot be trusted."""
        ahead, picture = self._next, self._size
        if ahead is None or picture is None or candidates.source_size != picture:
            return False
        found = self._matched(ahead, candidates)[1]
        for track in ahead.hands:
            if track.missed:
                continue
            match = found.get(track.key)
            if match is None or box_iou(box_of(track.motion, picture), match.region.box) < STILL_IOU:
                return False
        return True

    def update(self, candidates: Candidates, time_s: float, whole: bool = True) -> tuple[Track, ...]:
        """Follow the hands into the next frame at `time_s` seconds: the tracks, the diver's right hand first.

        whole: whether the whole frame was searched, or only the windows. Time that stands still, runs back or is no
        number counts as STALLED_STEP_S; a long gap or a frame of another size starts anew.
        """
        step = self._step_to(time_s)
        if step > LONGEST_STEP_S or self._size not in (None, candidates.source_size):
            self._forget()
        ahead = self._predicted(step)
        observed, found = self._matched(ahead, candidates)
        self._next = None
        self._now += step
        self._time_s = time_s if math.isfinite(time_s) else self._time_s
        self._size = candidates.source_size
        if whole:
            self._whole = self._now
        held = births.held_level(self._hands, self._evidence)
        self._follow(ahead, found, candidates.source_size)
        self._observe(observed, held)
        tracks = [*self._hands, *self._tentative]
        least = self._selection.pair_score
        self._evidence = births.gather(self._evidence, tracks, observed, self._now, step, least)
        self._confirm(candidates)
        self._end(observed)
        return tuple(sorted(self._hands, key=attrgetter("side"), reverse=True))

    def _step_to(self, time_s: float) -> float:
        """Seconds from the last frame to this one, above 0; 0 for the first frame."""
        if self._size is None:
            return 0.0
        step = math.nan if self._time_s is None else time_s - self._time_s
        return step if math.isfinite(step) and step > 0.0 else STALLED_STEP_S

    def _predicted(self, step: float) -> _NextFrame:
        """The tracks `step` seconds ahead; predicted once for the same step."""
        if self._next is None or self._next.step != step:
            hands = [replace(track, motion=predict_box(track.motion, step)) for track in self._hands]
            others = [replace(track, motion=predict_box(track.motion, step)) for track in self._tentative]
            self._next = _NextFrame(step, hands, others)
        return self._next

    def _matched(self, ahead: _NextFrame, candidates: Candidates) -> tuple[Observed, dict[int, Match]]:
        """What there is to see in a frame, and what each track finds of it; matched once for the same candidates."""
        if ahead.matching is not None and ahead.matching[0] is candidates:
            return ahead.matching[1:]
        selection, settings = self._selection, self._settings
        observed = look_at(candidates, selection.pair_score)
        leap_score = births.held_level(self._hands, self._evidence) - settings.margin
        found = match_tracks(
            ahead.hands,
            ahead.tentative,
            observed,
            self._now + ahead.step,
            settings.gate,
            leap_score,
            selection.single_score,
        )
        ahead.matching = candidates, observed, found
        return observed, found

    def _follow(self, ahead: _NextFrame, found: dict[int, Match], picture: tuple[int, int]) -> None:
        """Take over the predicted tracks, each with what it found in a frame of this size or without."""

        def followed(track: Track) -> Track:
            match = found.get(track.key)
            if match is not None:
                return seen(track, match, self._now, ahead.step)
            others = [other for other in ahead.hands if other.key != track.key]
            return unseen(track, others, self._now, ahead.step, picture)

        self._hands = [followed(track) for track in ahead.hands]
        self._tentative = [followed(track) for track in ahead.tentative]

    def _observe(self, observed: Observed, held: float) -> None:
        """Keep the regions that may be hands under observation, and take new ones while there is room."""
        worth = births.worth_observing(self._hands, observed, held + self._settings.margin, self._selection)
        if not worth:
            return
        taken = {track.region for track in (*self._hands, *self._tentative)}
        self._tentative = [
            replace(track, proved_s=self._now, hits=track.hits + 1) if track.region in worth else track
            for track in self._tentative
        ]
        room = MOST_TENTATIVE - len(self._tentative)
        for index in [index for index in worth if index not in taken][:room]:
            self._tentative.append(begin(self._next_key, index, observed.regions[index], self._now))
            self._next_key += 1

    def _confirm(self, candidates: Candidates) -> None:
        """Give numbers and sides to what is believed, and drop what it contradicts."""
        hands, tentative, selection = self._hands, self._tentative, self._selection
        margin = self._settings.margin
        pair = births.believed_pair(hands, tentative, self._evidence, selection.pair_score, margin)
        if pair is not None:
            self._keep(births.with_old_number(with_pair_sides(*pair, margin), hands))
        else:
            single = births.believed_single(hands, tentative, selection.single_score, margin)
            if single is not None:
                self._keep((single,))
        axis = None if candidates.face is None else candidates.face[0]
        self._hands = [with_lone_side(track, axis, candidates.source_size[0]) for track in self._hands]

    def _keep(self, believed: tuple[Track, ...]) -> None:
        """Follow these, and of the others only what is under observation."""
        hands = []
        for track in believed:
            number = track.number
            if not number:
                number, self._next_number = self._next_number, self._next_number + 1
            hands.append(replace(track, number=number, proved_s=self._now))
        keys = {track.key for track in hands}
        self._hands = hands
        self._tentative = [track for track in self._tentative if track.key not in keys]

    def _end(self, observed: Observed) -> None:
        """Note what was proved, and end the tracks that have not been for too long."""
        now, lost_s, doubt_s = self._now, self._settings.lost_s, self._settings.doubt_s
        hands = self._hands
        score = observed.together(hands[0].region, hands[1].region) if len(hands) == 2 else 0.0
        held = births.held_level(hands, self._evidence)
        hands = births.proved(hands, score, held, now, doubt_s, self._selection)
        self._hands = [track for track in hands if not is_over(track, now, lost_s, doubt_s)]
        self._tentative = [track for track in self._tentative if not is_over(track, now, lost_s, doubt_s)]
