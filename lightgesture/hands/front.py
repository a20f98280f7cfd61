"""The hand reader, a front end: find the hands, follow them, read them."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any, Final, Protocol, Self

import numpy as np

from lightgesture.features.colour import ColourMap, ColourStage
from lightgesture.features.find.selector import choose, load_selector
from lightgesture.features.find.settings import SelectorSettings
from lightgesture.features.geometry import mirror_box, turn_box
from lightgesture.features.image import as_bgr8, turned
from lightgesture.features.track.state import Track
from lightgesture.features.track.tracker import Tracker
from lightgesture.features.types import Box, Candidates, Image
from lightgesture.front_end import FrontEnd
from lightgesture.fsm import UNSEEN, Sign, Signs
from lightgesture.hands.hidden import HiddenHands
from lightgesture.hands.memory import ReadingMemory
from lightgesture.hands.pictures import draw_colour, draw_hands, draw_regions, draw_tracks
from lightgesture.hands.reading import HandInView
from lightgesture.records import Hand
from lightgesture.repeats import LastFrame

HIDDEN: Final = Sign(None, 0.0, reason="occluded")
"""A hand that something hides where it is held."""


class Finder(Protocol):
    """Finds regions that may be hands; `features.find.selector.load_selector` gives the product's own."""

    settings: SelectorSettings

    def process(self, colour: ColourMap) -> Candidates:
        """Search one frame."""
        ...

    def follow(self, image: Image, boxes: Sequence[Box]) -> Candidates | None:
        """Look at boxes of a frame alone, one or more, source pixels; None where it cannot but search."""
        ...


class Follower(Protocol):
    """Remembers the hands of a stream; `features.track.tracker.Tracker` is the product's own."""

    def predict(self, time_s: float) -> tuple[Box, ...]:
        """Where they should be in the next frame, source pixels; empty where the whole of it must be searched."""
        ...

    def explains(self, candidates: Candidates) -> bool:
        """Whether what was found in the predicted boxes is enough."""
        ...

    def update(self, candidates: Candidates, time_s: float, whole: bool = True) -> tuple[Track, ...]:
        """The hands of the frame. whole: all of it was searched."""
        ...


class Reader(Protocol):
    """Names the token of each hand; `hands.reading.ReadingStage` is the product's own."""

    @property
    def classes(self) -> tuple[str, ...]:
        """What it tells apart."""
        ...

    def process(
        self,
        image: Image,
        hands: Sequence[HandInView],
        face: tuple[float, float] | None = None,
        memory: ReadingMemory | None = None,
        time_s: float = 0.0,
    ) -> tuple[Hand, ...]:
        """The hands of a frame with their tokens, in the same order."""
        ...


class HandReader(FrontEnd):
    """Frames -> the signs of the diver's two bare or gloved hands.

    Each stage may be another: read: names the token of each hand, the one stage that needs a model. find: colour map ->
    candidates, by default the learned choice. colour: frame -> colour map. track, memory: make what remembers the hands
    of one stream, where they are and what they showed. rotate: degrees, 0, 90, 180 or 270, by which the picture is
    turned clockwise to stand upright; mirrored: it is a selfie camera's. Boxes are told in the pixels of the picture as
    it came.
    """

    def __init__(
        self,
        read: Reader,
        *,
        find: Finder | None = None,
        colour: ColourStage | None = None,
        track: Callable[[], Follower] | None = None,
        memory: Callable[[], ReadingMemory] = ReadingMemory,
        mirrored: bool = False,
        rotate: int = 0,
    ) -> None:
        super().__init__()
        self._read = read
        self.tokens = read.classes
        self._find: Finder = find or load_selector()
        self._colour = colour or ColourStage()
        self._make_track: Callable[[], Follower] = track or (lambda: Tracker(selection=self._find.settings))
        self._make_memory = memory
        if rotate not in (0, 90, 180, 270):
            raise ValueError(f"rotate is {rotate}; it must be 0, 90, 180 or 270")
        self._mirrored, self._rotate = mirrored, rotate
        self._begin()

    def _begin(self) -> None:
        """What remembers the stream, and what was made of its last frame."""
        self._track, self._memory = self._make_track(), self._make_memory()
        self._hidden, self._last = HiddenHands(), LastFrame()
        self._found: tuple[Candidates, bool] | None = None
        self._upright: Image | None = None
        self._map: ColourMap | None = None
        self._candidates: Candidates | None = None
        self._tracks: tuple[Track, ...] | None = None
        self._hands: tuple[Hand, ...] = ()

    def for_stream(self) -> Self:
        """Another hand reader with the same stages, which has seen nothing yet."""
        other = super().for_stream()
        other._begin()
        return other

    def process(self, image: Image, time_s: float) -> Signs:
        """The signs of both hands in the next frame; another size than before ends the tracks."""
        upright = self._turn_upright(image)
        self.clock.lap("colour")
        self._found = candidates, is_whole = self._search(upright, time_s)
        self.clock.lap("regions")
        self._tracks = self._track.update(candidates, time_s, whole=is_whole)
        self.clock.lap("tracks")
        # A track that was not seen now has a predicted box, and whatever is in it is no evidence.
        seen = [track for track in self._tracks if track.missed == 0]
        self._hands = self._read.process(upright, seen, candidates.face, self._memory, time_s)
        self.clock.lap("classify")
        self._candidates = candidates
        # What is hidden in its place is shown all the same, and not read.
        return Signs(HIDDEN, HIDDEN) if self._hidden.process(self._tracks) else self._signs()

    @property
    def is_searched(self) -> bool:
        """Whether the whole of the last frame was searched; else its hands were only followed."""
        return self._found is not None and self._found[1]

    def recognize(self, image: Image) -> Signs:
        """The signs of both hands in a picture on its own."""
        upright = self._turn_upright(image)
        self._candidates, self._tracks = self._find.process(self._colours(upright)), None
        chosen = choose(self._candidates, self._find.settings)
        self._hands = self._read.process(upright, chosen, self._candidates.face)
        return self._signs()

    def shown(self) -> dict[str, tuple[Any, ...]]:
        """The hands of the last frame, boxes in its own pixels."""
        if self._upright is None or not (self._mirrored or self._rotate):
            return {"hands": self._hands}
        return {"hands": tuple(replace(hand, box=self._as_it_came(hand.box)) for hand in self._hands)}

    def pictures(self) -> Iterator[tuple[str, Image]]:
        """See FrontEnd; of a picture on its own there are no tracks."""
        if self._upright is None or self._candidates is None:
            return
        yield "colour", draw_colour(self._map or self._colours(self._upright))
        yield "regions", draw_regions(self._upright, self._candidates)
        if self._tracks is not None:
            yield "tracks", draw_tracks(self._upright, self._tracks)
        yield "classify", draw_hands(self._upright, self._hands)

    def _turn_upright(self, image: Image) -> Image:
        # A thermal camera's grey frames must reach the classifier in colours as well.
        picture = turned(as_bgr8(image), self._rotate)
        self._upright = np.ascontiguousarray(picture[:, ::-1]) if self._mirrored else picture
        self._map = None
        return self._upright

    def _colours(self, upright: Image) -> ColourMap:
        """The colour map of the frame, which only a search needs."""
        self._map = self._colour.process(upright)
        return self._map

    def _as_it_came(self, box: Box) -> Box:
        """A box of the upright picture in the picture as it came."""
        assert self._upright is not None
        height, width = self._upright.shape[:2]
        box = mirror_box(box, width) if self._mirrored else box
        return turn_box(box, (width, height), -self._rotate)

    def _search(self, upright: Image, time_s: float) -> tuple[Candidates, bool]:
        """Candidates of the next frame, and whether the whole of it was searched: only where a look at the hands
        finds not what it should. In a frame that equals the last one there is what was found in that."""
        boxes = self._track.predict(time_s)
        if self._last.equals(upright) and self._found is not None and (boxes or self._found[1]):
            return self._found
        followed = self._find.follow(upright, boxes) if boxes else None
        if followed is not None and self._track.explains(followed):
            return followed, False
        self.clock.lap("regions")
        colour = self._colours(upright)
        self.clock.lap("colour")
        return self._find.process(colour), True

    def _signs(self) -> Signs:
        signs = {
            hand.side: Sign(hand.token, hand.confidence, hand.probabilities, True, hand.reason)
            for hand in self._hands
        }
        return Signs(signs.get("left", UNSEEN), signs.get("right", UNSEEN))
