"""Moved cards as a front end: what two tags draw between rest and rest is a word."""

import math
from collections.abc import Callable, Iterator
from typing import Any, Final, Self

import numpy as np

from lightgesture.cards.front import card_sign, grey_of
from lightgesture.cards.pictures import draw_cards, draw_way
from lightgesture.features.image import as_bgr8
from lightgesture.features.motion.matching import ShapeBase
from lightgesture.features.motion.segments import Moment, Motion, Segmenter
from lightgesture.features.motion.shapes import Curve
from lightgesture.features.tags.detector import TagDetector
from lightgesture.features.tags.tag import Tag
from lightgesture.features.types import Image
from lightgesture.front_end import FrontEnd
from lightgesture.fsm import UNSEEN, Sign, Signs
from lightgesture.fsm.language.grammar import STILL, MotionWords
from lightgesture.records import CardSign

UNREAD_S: Final = 0.8
"""How long the decoder is told that a motion was seen and not read, seconds: long enough that it drops an open
sentence, which would lack a word."""

NOT_READ: Final = Sign(reason="unknown_motion")
"""What is said of it then."""


class MotionReader(FrontEnd):
    """Frames -> the word that two moved cards draw.

    words: what pairs of shapes say. base: the shapes. make_detector: makes what finds the tags of one stream. mirrored:
    as of `CardReader`.

    The word is shown while both cards rest after the motion. What is no word, unsure, cut off, endless or ends
    elsewhere than it began is told as a sign that was seen and not read, which drops an open sentence.
    """

    def __init__(
        self,
        words: MotionWords,
        base: ShapeBase,
        make_detector: Callable[[], TagDetector],
        *,
        mirrored: bool = False,
    ) -> None:
        super().__init__()
        self._words, self._base, self._make_detector = words, base, make_detector
        self._mirrored = mirrored
        self._begin()

    def _begin(self) -> None:
        """What remembers the stream."""
        self._detector, self._segments = self._make_detector(), Segmenter()
        self._image: Image | None = None
        self._cards: tuple[CardSign, ...] = ()
        self._motion: Motion | None = None
        self._sign = UNSEEN
        self._unread_until_s = -math.inf

    def for_stream(self) -> Self:
        """Another reader of the same motions, which has seen nothing yet."""
        other = super().for_stream()
        other._begin()
        return other

    def process(self, image: Image, time_s: float) -> Signs:
        """The word that is said in the next frame."""
        left, right = self._look(image, time_s)
        self.clock.lap("tags")
        moment = self._segments.process(left, right, time_s)
        sign = self._read(moment, time_s)
        self._tell(left, right, sign.token)
        self.clock.lap("motion")
        return Signs(left=sign)

    def recognize(self, image: Image) -> Signs:
        """In a picture on its own nothing moves: its tags are told, and no word."""
        self._tell(*self._look(image, 0.0, self._make_detector()), None)
        return Signs()

    def shown(self) -> dict[str, tuple[Any, ...]]:
        """The two tags in the last frame, with the word after a motion."""
        return {"signs": self._cards}

    def pictures(self) -> Iterator[tuple[str, Image]]:
        """See FrontEnd: the tags, and the last motion."""
        if self._image is None:
            return
        yield "tags", draw_cards(self._image, self._cards)
        if self._motion is not None:
            yield "motion", draw_way(self._image, self._motion.left, self._motion.right)

    def _look(
        self, image: Image, time_s: float, detector: TagDetector | None = None
    ) -> tuple[Tag | None, Tag | None]:
        """The left and the right hand's tag. Of two with one id neither counts: nobody knows which is moved."""
        self._image = as_bgr8(image)
        tags = (detector or self._detector).process(grey_of(self._image, self._mirrored), time_s)
        found: list[Tag | None] = []
        for number in (self._words.left, self._words.right):
            own = [tag for tag in tags if tag.id == number]
            found.append(own[0] if len(own) == 1 else None)
        return found[0], found[1]

    def _tell(self, left: Tag | None, right: Tag | None, word: str | None) -> None:
        width = self._image.shape[1] if self._mirrored and self._image is not None else None
        hands = (("left", left), ("right", right))
        self._cards = tuple(card_sign(tag, side, word, width) for side, tag in hands if tag is not None)

    def _read(self, moment: Moment, time_s: float) -> Sign:
        if moment.reason is not None:
            self._unread_until_s = time_s + UNREAD_S
        if moment.motion is None:
            self._motion = None
        elif moment.motion is not self._motion:
            self._motion = moment.motion
            self._sign = self._name(moment.motion)
            if self._sign.token is None:
                self._unread_until_s = time_s + UNREAD_S
        if time_s < self._unread_until_s <= time_s + UNREAD_S:
            return NOT_READ
        return self._sign if moment.motion is not None and self._sign.token is not None else UNSEEN

    def _name(self, motion: Motion) -> Sign:
        """The word of a motion; no token where it is none, or unsure."""
        left, right = (self._shape(curve) for curve in (motion.left, motion.right))
        if left is None or right is None:
            return NOT_READ
        word = self._words.words.get((left[0], right[0]))
        return NOT_READ if word is None else Sign(word, min(left[1], right[1]), is_word=True)

    def _shape(self, curve: Curve | None) -> tuple[str, float] | None:
        """What a hand drew and how sure that is, 0 to 1; None: no shape, or one of two."""
        if curve is None:
            return STILL, 1.0
        match = self._base.match(curve)
        return (
            (match.name, float(np.clip(1.0 - match.distance, 0.0, 1.0)))
            if match.is_sure(self._base.settings)
            else None
        )
