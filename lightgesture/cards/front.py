"""Cards as a front end: the tag that is shown is a word."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final, Self

import cv2
import numpy as np

from lightgesture.cards.memory import ShownCards
from lightgesture.cards.pictures import draw_cards
from lightgesture.features.image import as_bgr8
from lightgesture.features.tags.detector import Grey, TagDetector
from lightgesture.features.tags.tag import Tag
from lightgesture.features.types import Image
from lightgesture.front_end import FrontEnd
from lightgesture.fsm import UNSEEN, Sign, Signs
from lightgesture.fsm.language.grammar import CardWords
from lightgesture.fsm.signs import two_cards
from lightgesture.records import CardSign

CORNER_DECIMALS: Final = 1
"""Decimals of the corners in the records, pixels."""


class CardReader(FrontEnd):
    """Frames -> the word of the card that is shown, by either hand.

    words: what the ids say. make_detector: makes what finds the tags of one stream. mirrored: the picture is a selfie
    camera's; it is turned back first, because a mirrored tag is none, and corners are told in its own pixels.

    A card is a word from its second sighting on. Two cards with two words are no word. A tag that says nothing counts
    only where no other is in view: docks and cages wear tags too.
    """

    def __init__(
        self, words: CardWords, make_detector: Callable[[], TagDetector], *, mirrored: bool = False
    ) -> None:
        super().__init__()
        self._words, self._make_detector, self._mirrored = words, make_detector, mirrored
        self._begin()

    def _begin(self) -> None:
        """What remembers the stream."""
        self._detector, self._shown = self._make_detector(), ShownCards()
        self._image: Image | None = None
        self._cards: tuple[CardSign, ...] = ()

    def for_stream(self) -> Self:
        """Another reader of the same cards, which has seen nothing yet."""
        other = super().for_stream()
        other._begin()
        return other

    def process(self, image: Image, time_s: float) -> Signs:
        """The word that is shown in the next frame."""
        tags = self._look(image, time_s, self._detector)
        self.clock.lap("tags")
        return signs_of(self._shown.process(self._said(tags), time_s))

    def recognize(self, image: Image) -> Signs:
        """The word of a picture on its own."""
        return signs_of(self._said(self._look(image, 0.0, self._make_detector())))

    def shown(self) -> dict[str, tuple[Any, ...]]:
        """The tags of the last frame."""
        return {"signs": self._cards}

    def pictures(self) -> Iterator[tuple[str, Image]]:
        """See FrontEnd: the tags with their words."""
        if self._image is not None:
            yield "tags", draw_cards(self._image, self._cards)

    def _look(self, image: Image, time_s: float, detector: TagDetector) -> tuple[Tag, ...]:
        self._image = as_bgr8(image)
        tags = detector.process(grey_of(self._image, self._mirrored), time_s)
        width = self._image.shape[1] if self._mirrored else None
        self._cards = tuple(card_sign(tag, None, self._words.words.get(tag.id), width) for tag in tags)
        return tags

    def _said(self, tags: Sequence[Tag]) -> dict[str, float]:
        """What the tags in view say, each with how sure it is: words, or where there is none what is no word."""
        said: dict[str, float] = {}
        for tag in tags:
            word = self._words.words.get(tag.id)
            if word is not None:
                said[word] = max(tag.agreement, said.get(word, 0.0))
        return said or {f"tag {tag.id}": tag.agreement for tag in tags[:1]}


def grey_of(image: Image, mirrored: bool) -> Grey:
    """The frame as tags are looked for, uint8 (h, w)."""
    grey = np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), np.uint8)
    return np.ascontiguousarray(grey[:, ::-1]) if mirrored else grey


def card_sign(tag: Tag, side: str | None, word: str | None, width: int | None) -> CardSign:
    """The record of a tag. width: of the picture where it was turned, None where it was not."""
    corners = tag.corners.copy()
    if width is not None:
        corners[:, 0] = width - 1 - corners[:, 0]
    rounded = corners.astype(float).round(CORNER_DECIMALS).tolist()
    return CardSign(
        side=side,
        id=tag.id,
        word=word,
        corners=tuple((x, y) for x, y in rounded),
        margin=tag.margin,
    )


def signs_of(said: dict[str, float]) -> Signs:
    """What the decoder is told: one word, or that there are two."""
    if not said:
        return Signs()
    if len(said) > 1:
        first, second, *_ = sorted(said)
        return Signs(left=two_cards(first, second))
    ((text, confidence),) = said.items()
    return Signs(Sign(text, confidence, is_word=True), UNSEEN)
