"""Two hands followed through the frames: a Kalman filter each, a side for life, birth only on good evidence.

What a frame does to the tracks, in order: all are predicted to its time; each finds its region or misses it; regions
that may be hands come under observation as tentative tracks; pairs of tracks gather evidence; a believed pair, or
without one a believed single hand, is confirmed, in the place of what it contradicts; what was unseen or unproved
for too long ends. The arithmetic is in pure functions (`matching`, `births`, `evidence`, `track_state`); the stage
holds the state and the clock.
"""

import math

from lightgesture.features.find.settings import ALONE_CONFIDENCE, SelectorSettings
from lightgesture.features.geometry import box_iou
from lightgesture.features.track import births, matching
from lightgesture.features.track import state as track_state
from lightgesture.features.track.births import PairKey
from lightgesture.features.track.evidence import PairEvidence, observe
from lightgesture.features.track.matching import Found, Observed
from lightgesture.features.track.motion import box_of, load_filter
from lightgesture.features.track.settings import TrackSettings
from lightgesture.features.track.sides import CERTAIN, Basis
from lightgesture.features.track.state import TrackState
from lightgesture.features.types import Box, Candidates, Track


class TrackStage:
    """Candidates of each frame -> at most two tracks, one a side.

    Raises lightgesture.features.track.motion.FilterError where the filter of the settings is not there.
    """

    def __init__(
        self, settings: TrackSettings | None = None, selection: SelectorSettings | None = None
    ) -> None:
        self.settings = settings or TrackSettings()
        self._selection = selection or SelectorSettings()
        self._filter = load_filter(self.settings.filter)
        self._certainty: dict[Basis, float] = {
            CERTAIN: 1.0,
            "axis": self.settings.axis_certainty,
            "middle": ALONE_CONFIDENCE,
        }
        self._next_number = 1
        self._next_key = 1
        self.reset()

    def reset(self) -> None:
        """Forget everything, as at the start of another stream; numbers go on."""
        self._tracks: list[TrackState] = []
        self._evidence: dict[PairKey, PairEvidence] = {}
        self._now = 0.0
        self._whole = -math.inf
        self._time_s: float | None = None
        self._size: tuple[int, int] | None = None

    def process(self, candidates: Candidates, time_s: float, *, whole: bool = True) -> tuple[Track, ...]:
        """Follow the hands into the next frame at `time_s` seconds: the tracks, the diver's right hand first.

        whole: whether the whole frame was searched, or only the windows. Time that stands still, runs back or is no
        number counts as `stalled_step_s`; a long gap or a frame of another size starts anew.
        """
        step = self._step(time_s)
        if step > self.settings.longest_step_s or self._size not in (None, candidates.source_size):
            self.reset()
        self._now += step
        self._time_s = time_s if math.isfinite(time_s) else self._time_s
        self._size = candidates.source_size
        if whole:
            self._whole = self._now
        observed = self._look_at(candidates)
        self._tracks, owners = self._followed(observed, step)
        self._observe_more(observed, owners)
        self._gather_evidence(observed, owners, step)
        self._confirm(candidates)
        self._end(observed, owners)
        return self._told(candidates.source_size)

    def predictions(self, time_s: float) -> tuple[Box, ...]:
        """Where the hands should be in the frame at `time_s`, source pixels; nothing changes.

        Empty where the whole frame must be searched: without tracks, with one that is not seen just now, with a
        region under observation, or when the last whole search is too long ago.
        """
        step = self._step(time_s)
        is_alone = len(births.numbered(self._tracks)) == 1
        longest = self.settings.whole_alone_s if is_alone else self.settings.whole_s
        is_due = self._now + step - self._whole > longest or step > self.settings.longest_step_s
        if self._size is None or is_due or any(track.life != "confirmed" for track in self._tracks):
            return ()
        moved = [
            track_state.predict(track.motion, step, self._filter, self.settings) for track in self._tracks
        ]
        picture = self._size
        return tuple(box_of(motion, picture) for motion in moved)

    def explains(self, candidates: Candidates, time_s: float) -> bool:
        """Whether each confirmed track would find its region among these at `time_s`, about where it was predicted;
        nothing changes. A hand that moved on was seen through a window beside it, and its box cannot be trusted."""
        step = self._step(time_s)
        picture = self._size
        if picture is None or candidates.source_size != picture or step > self.settings.longest_step_s:
            return False
        confirmed = [track for track in self._tracks if track.life == "confirmed"]
        predicted, observed = self._predicted(confirmed, step), self._look_at(candidates)
        found = self._match(predicted, observed, step)
        if len(found) < len(confirmed):
            return False
        pairs = [
            (box_of(predicted[place].motion, picture), observed.regions[item.region].box)
            for place, item in found.items()
        ]
        return all(box_iou(one, other) >= self.settings.still_iou for one, other in pairs)

    def _step(self, time_s: float) -> float:
        """Seconds from the last frame to this one, above 0; 0 for the first frame."""
        if self._size is None:
            return 0.0
        step = math.nan if self._time_s is None else time_s - self._time_s
        return step if math.isfinite(step) and step > 0.0 else self.settings.stalled_step_s

    def _look_at(self, candidates: Candidates) -> Observed:
        return matching.look_at(candidates, self._selection.pair_score, self.settings.considered)

    def _predicted(self, tracks: list[TrackState], step: float) -> list[TrackState]:
        return [
            track._replace(motion=track_state.predict(track.motion, step, self._filter, self.settings))
            for track in tracks
        ]

    def _match(self, tracks: list[TrackState], observed: Observed, step: float) -> dict[int, Found]:
        held = births.held_level(self._tracks, self._evidence)
        return matching.match_tracks(tracks, observed, held, self._now + step, self.settings, self._selection)

    def _followed(self, observed: Observed, step: float) -> tuple[list[TrackState], dict[int, int]]:
        """The tracks with or without a region in this frame, and track key -> region."""
        tracks = self._predicted(self._tracks, step)
        found = self._match(tracks, observed, 0.0)
        followed = []
        for place, track in enumerate(tracks):
            item = found.get(place)
            if item is None:
                others = [other for other in tracks if other.number and other.key != track.key]
                followed.append(track_state.unseen(track, others, self._now, step, self.settings))
                continue
            region = observed.regions[item.region]
            if item.leap:
                followed.append(track_state.leapt(track, region, self._now, step, self.settings))
            else:
                followed.append(
                    track_state.seen(
                        track, region, item.measured, self._now, step, self._filter, self.settings
                    )
                )
        return followed, {tracks[place].key: item.region for place, item in found.items()}

    def _observe_more(self, observed: Observed, owners: dict[int, int]) -> None:
        """Keep the regions that may be hands under observation, and take new ones while there is room."""
        held = births.held_level(self._tracks, self._evidence)
        worth = births.worth_observing(self._tracks, observed, held, self.settings, self._selection)
        self._tracks = [
            track._replace(proved_s=self._now, hits=track.hits + 1)
            if not track.number and owners.get(track.key) in worth
            else track
            for track in self._tracks
        ]
        taken = set(owners.values())
        room = self.settings.tentative - sum(not track.number for track in self._tracks)
        for index in [index for index in worth if index not in taken][: max(room, 0)]:
            track = track_state.begin(self._next_key, observed.regions[index], self._now, self.settings)
            self._next_key += 1
            self._tracks.append(track)
            owners[track.key] = index

    def _gather_evidence(self, observed: Observed, owners: dict[int, int], step: float) -> None:
        """Scores of all pairs of tracks in this frame, 0 where not both were seen."""
        least = self._selection.pair_score
        keys = sorted(track.key for track in self._tracks)
        gathered = {}
        for place, first in enumerate(keys):
            for second in keys[place + 1 :]:
                known = self._evidence.get((first, second))
                both = first in owners and second in owners
                score = observed.together(owners[first], owners[second]) if both else 0.0
                if known is not None or score >= least:
                    gathered[first, second] = observe(known, score, self._now, step, least, self.settings)
        self._evidence = gathered

    def _confirm(self, candidates: Candidates) -> None:
        """Give numbers and sides to what is believed, and drop what it contradicts."""
        pair = births.believed_pair(self._tracks, self._evidence, self.settings, self._selection)
        if pair is not None:
            sided = births.with_pair_sides(*pair, self.settings)
            self._keep(births.with_old_number(sided, self._tracks))
        elif (single := births.believed_single(self._tracks, self.settings, self._selection)) is not None:
            self._keep((single,))
        width = candidates.source_size[0]
        self._tracks = [births.with_lone_side(track, candidates.axis, width) for track in self._tracks]

    def _keep(self, believed: tuple[TrackState, ...]) -> None:
        """Follow these, and of the others only what is under observation."""
        kept = []
        for track in believed:
            number = track.number
            if not number:
                number, self._next_number = self._next_number, self._next_number + 1
            kept.append(track._replace(number=number, life="confirmed", proved_s=self._now))
        keys = {track.key for track in kept}
        self._tracks = kept + [item for item in self._tracks if not item.number and item.key not in keys]

    def _end(self, observed: Observed, owners: dict[int, int]) -> None:
        present = [owners.get(track.key) for track in births.numbered(self._tracks)]
        score = 0.0
        if len(present) == 2 and present[0] is not None and present[1] is not None:
            score = observed.together(present[0], present[1])
        held = births.held_level(self._tracks, self._evidence)
        tracks = births.proved(self._tracks, score, held, self._now, self.settings, self._selection)
        self._tracks = [track for track in tracks if not track_state.is_over(track, self._now, self.settings)]

    def _told(self, picture: tuple[int, int]) -> tuple[Track, ...]:
        told = [
            track_state.to_track(track, picture, self._certainty[track.basis])
            for track in births.numbered(self._tracks)
        ]
        return tuple(sorted(told, key=lambda track: track.side, reverse=True))
