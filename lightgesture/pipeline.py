"""Frames in, records out: the stages in their order, with a time stamp around each."""

import os
from copy import copy
from dataclasses import replace
from typing import Self

import numpy as np

from lightgesture.features.colour import ColourMap, ColourStage
from lightgesture.features.find.selector import RegionStage, SelectorName, choose
from lightgesture.features.find.settings import ALONE_CONFIDENCE
from lightgesture.features.geometry import mirror_box
from lightgesture.features.image import as_bgr8
from lightgesture.features.profile import load_profile
from lightgesture.features.track.tracker import TrackStage
from lightgesture.features.types import Candidates, Image
from lightgesture.fsm import Decoder, Event, Instruction, Rejected, load_grammar
from lightgesture.hands.memory import memory_for_hold
from lightgesture.hands.pictures import PictureSink, draw_colour, draw_hands, draw_regions, draw_tracks
from lightgesture.hands.reading import ReadingStage, Sighting, is_crowded
from lightgesture.models import load_classifier
from lightgesture.models.loading import DEFAULT
from lightgesture.records import FrameRecord, Hand, Record, SummaryRecord
from lightgesture.stage_clock import StageClock
from lightgesture.threads import OneBlasThread


class Pipeline:
    """Decodes one stream of frames; make another for another stream, or take `for_stream`.

    model: "cnn", "svm" or the path of a model file. selector: "learned" (locator and refiner) or "classical" (no net),
    see `features.selector`. profile: path of a colour profile of the diver's hands, which replaces the map of
    skin colours; None for that map. hold: consecutive frames that a sign is held; hold_seconds: seconds instead; both
    None for the grammar's own. grammar: path of a grammar file, None for the bundled one. mirrored: frames come from a
    selfie camera. source: the name in the records. frames: give a frame record for each frame. debug: takes a
    picture of every stage of every frame.
    Raises lightgesture.models.ModelError, lightgesture.features.find.selector_file.SelectorError,
    lightgesture.features.profile.ProfileError, lightgesture.fsm.GrammarError or ValueError: one line each.
    """

    def __init__(
        self,
        *,
        model: str | os.PathLike[str] = DEFAULT,
        selector: SelectorName = "learned",
        profile: str | os.PathLike[str] | None = None,
        hold: int | None = None,
        hold_seconds: float | None = None,
        grammar: str | os.PathLike[str] | None = None,
        mirrored: bool = False,
        source: str | None = None,
        frames: bool = True,
        debug: PictureSink | None = None,
    ) -> None:
        self._frames, self._mirrored = frames, mirrored
        self._colour = ColourStage(profile=None if profile is None else load_profile(profile))
        self._regions = RegionStage(selector)
        self._reading = ReadingStage(load_classifier(model))
        self._grammar, self._hold, self._hold_seconds = load_grammar(grammar), hold, hold_seconds
        self._one_thread = OneBlasThread()
        self._begin(source, debug)

    def for_stream(self, source: str | None, debug: PictureSink | None = None) -> Self:
        """Another pipeline of the same settings, for another stream, with what this one has loaded.

        The two must not run in several threads at once.
        """
        other = copy(self)
        other._begin(source, debug)
        return other

    def _begin(self, source: str | None, debug: PictureSink | None) -> None:
        """Everything that remembers the stream."""
        self._source, self._debug = source, debug
        self._tracks = TrackStage(selection=self._regions.settings)
        self._decoder = Decoder(
            self._grammar, hold=self._hold, hold_seconds=self._hold_seconds, source=source
        )
        self._memory = memory_for_hold(self._decoder.hold_frames, self._decoder.hold_seconds)
        self._clock = StageClock()
        self._index = 0
        self._processed = 0
        self._seconds = 0.0
        self._counts = {Instruction: 0, Rejected: 0}

    def process(self, image_bgr: Image, time_s: float, index: int | None = None) -> list[Record]:
        """Records of the next frame: its frame record, then what it led to.

        image_bgr: uint8 (height, width, 3), BGR; another size than before ends the tracks. time_s: seconds since
        the start of the stream. index: position in the source, by default counted.
        """
        index = self._index if index is None else index
        with self._one_thread.block():
            return self._process(image_bgr, time_s, index)

    def _process(self, image_bgr: Image, time_s: float, index: int) -> list[Record]:
        upright = self._upright(image_bgr)
        with self._clock.stage("colour"):
            colour = self._colour.process(upright)
        with self._clock.stage("regions"):
            candidates, is_whole = self._candidates(colour, time_s)
        with self._clock.stage("tracks"):
            tracks = self._tracks.process(candidates, time_s, whole=is_whole)
        with self._clock.stage("classify"):
            # A track that was not seen now has a predicted box, and whatever is in it is no evidence.
            seen = [track for track in tracks if track.missed == 0]
            sightings = [
                Sighting(
                    track.side,
                    (track.box, *track.alternatives),
                    track.number,
                    track.certainty,
                    is_crowded(track.box, [one.box for one in seen if one is not track], candidates.face),
                )
                for track in seen
            ]
            hands = self._reading.process(upright, sightings, self._memory, time_s)
        with self._clock.stage("decode"):
            events = self._decode(hands, time_s, index)
        self._clock.end_frame()
        self._index, self._seconds = index + 1, time_s
        self._processed += 1
        if self._debug is not None and self._debug.is_selected:
            self._debug.write("colour", index, draw_colour(colour))
            self._debug.write("regions", index, draw_regions(upright, candidates))
            self._debug.write("tracks", index, draw_tracks(upright, tracks))
            self._debug.write("classify", index, draw_hands(upright, hands))
            self._debug.write("decode", index, draw_hands(upright, hands, self._decoder.sentence or "idle"))
        records: list[Record] = []
        if self._frames:
            records.append(self._frame_record(hands, index, time_s, image_bgr.shape[1]))
        return records + self._count(events)

    def _candidates(self, colour: ColourMap, time_s: float) -> tuple[Candidates, bool]:
        """Candidates of the next frame, and whether the whole of it was searched: only where no predicted box holds
        what it should."""
        followed = self._regions.follow(colour, self._tracks.predictions(time_s))
        if followed is not None and self._tracks.explains(followed, time_s):
            return followed, False
        return self._regions.process(colour), True

    def finish(self) -> list[Record]:
        """What is pending at the end of the stream, then the summary."""
        pending = self._count(self._decoder.finish())
        summary = SummaryRecord(
            source=self._source,
            frames=self._processed,
            seconds=round(self._seconds, 6),
            instructions=self._counts[Instruction],
            rejected=self._counts[Rejected],
            status="ok",
            ms_per_frame=self._clock.per_frame(),
            stages_ms=self._clock.per_stage(),
        )
        return [*pending, summary]

    def recognize(self, image_bgr: Image) -> FrameRecord:
        """The hands of a single picture, without memory: `frame` and `time_s` are None."""
        with self._one_thread.block():
            return self._recognize(image_bgr)

    def _recognize(self, image_bgr: Image) -> FrameRecord:
        upright = self._upright(image_bgr)
        colour = self._colour.process(upright)
        candidates = self._regions.process(colour)
        settings = self._regions.settings
        chosen = choose(candidates, settings)
        certainty = ALONE_CONFIDENCE if len(chosen) == 1 else 1.0
        sightings = [
            Sighting(
                region.side or "right",
                (region.box, *region.alternatives),
                None,
                certainty,
                is_crowded(region.box, [one.box for one in chosen if one is not region], candidates.face),
            )
            for region in chosen
        ]
        hands = self._reading.process(upright, sightings)
        if self._debug is not None and self._debug.is_selected:
            self._debug.write("colour", 0, draw_colour(colour))
            self._debug.write("regions", 0, draw_regions(upright, candidates))
            self._debug.write("classify", 0, draw_hands(upright, hands))
        return self._frame_record(hands, None, None, image_bgr.shape[1])

    def _upright(self, image: Image) -> Image:
        # A thermal camera's grey frames must reach the classifier in colours as well.
        picture = as_bgr8(image)
        return np.ascontiguousarray(picture[:, ::-1]) if self._mirrored else picture

    def _decode(self, hands: tuple[Hand, ...], time_s: float, index: int) -> list[Event]:
        read = {hand.side: hand for hand in hands}
        left, right = read.get("left"), read.get("right")
        return self._decoder.step(
            left=left.token if left else None,
            right=right.token if right else None,
            time_s=time_s,
            left_confidence=left.confidence if left else 1.0,
            right_confidence=right.confidence if right else 1.0,
            frame=index,
            left_seen=left is not None,
            right_seen=right is not None,
        )

    def _frame_record(
        self, hands: tuple[Hand, ...], index: int | None, time_s: float | None, width: int
    ) -> FrameRecord:
        if self._mirrored:
            hands = tuple(replace(hand, box=mirror_box(hand.box, width)) for hand in hands)
        return FrameRecord(source=self._source, frame=index, time_s=time_s, hands=hands)

    def _count(self, events: list[Event]) -> list[Record]:
        for event in events:
            if type(event) in self._counts:
                self._counts[type(event)] += 1
        return list(events)
