"""From probabilities to tokens, with refusal: rather no token than a wrong one."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Image, Side
from lightgesture.hands.looks import LastLooks, Look, says_the_same
from lightgesture.hands.memory import NO_MEMORY, ReadingMemory
from lightgesture.models import NONE, Classifier
from lightgesture.records import Hand

Row = NDArray[np.float32]
"""Probabilities of the classes, or rows of them."""
Extents = Literal["clearest", "mean"]
"""What stands for a hand that may have several extents: the one in which some token is likeliest, which is the
sharpest and can be sharply wrong where a box cuts off a finger, or the mean of all of them, which is in doubt where
they differ."""


@dataclass(frozen=True, slots=True)
class ReadingSettings:
    """When a hand gets a token.

    token_probability: least calibrated probability of the best token, 0 to 1. Higher refuses more and reads fewer
        wrong; what stays below is `low_confidence`.
    extents: how the extents that a hand may have are read together, see `Extents`.
    edge_share: share of a box's side within which the picture's edge cuts the hand, which is then `partial` if the
        classifier is not sure.
    covered_share: share of a hand's box that another hand's covers, from which it counts as crowded, 0 to 1.
    edge_factor, crowded_factor: factors on the confidence of a hand that is cut by the edge, and of one that is
        crowded, 0.7 to 1; the smaller where it is both. What is read there must be clearer; where `token_probability`
        is above a factor, nothing is.
    """

    token_probability: float = 0.7
    extents: Extents = "clearest"
    edge_share: float = 0.02
    covered_share: float = 0.25
    edge_factor: float = 0.72
    crowded_factor: float = 0.9


class HandInView(Protocol):
    """What a hand must have to be read: a track, or a region on its own, whose side is known."""

    @property
    def number(self) -> int | None:
        """Of its track; None in a picture on its own."""
        ...

    @property
    def side(self) -> Side | None:
        """The diver's own."""
        ...

    @property
    def box(self) -> Box:
        """Its likeliest extent, source pixels."""
        ...

    @property
    def alternatives(self) -> tuple[Box, ...]:
        """Its other extents."""
        ...

    @property
    def certainty(self) -> float:
        """How sure the side is, 0 to 1."""
        ...


def is_crowded(
    box: Box, others: Sequence[Box], face: tuple[float, float] | None, settings: ReadingSettings | None = None
) -> bool:
    """Whether something skin-coloured is behind or before a hand: the middle of the face lies in its box, or
    another hand covers a share of it."""
    settings = settings or ReadingSettings()
    x, y, width, height = box
    if face is not None and x <= face[0] < x + width and y <= face[1] < y + height:
        return True
    for left, top, wide, tall in others:
        across = min(x + width, left + wide) - max(x, left)
        down = min(y + height, top + tall) - max(y, top)
        if min(across, down) > 0 and across * down > settings.covered_share * width * height:
            return True
    return False


def _touches_edge(box: Box, size: tuple[int, int], share: float) -> bool:
    x, y, width, height = box
    margin_x, margin_y = share * width, share * height
    return (
        x <= margin_x or y <= margin_y or x + width >= size[0] - margin_x or y + height >= size[1] - margin_y
    )


def read_token(
    probabilities: NDArray[np.float32],
    classes: Sequence[str],
    at_edge: bool,
    crowded: bool,
    settings: ReadingSettings,
) -> tuple[str | None, float, str | None]:
    """Token, confidence and reason of one hand from its row of probabilities (classes,).

    The token is None where `none` is most likely ("unknown_shape") or no token likely enough
    ("partial" at the picture's edge, "occluded" before a face or another hand, else "low_confidence"). At the edge
    and before others the confidence of what is read is lowered, and must still suffice.
    """
    best = int(np.argmax(probabilities))
    confidence = float(probabilities[best])
    confidence *= min(
        settings.edge_factor if at_edge else 1.0,
        settings.crowded_factor if crowded else 1.0,
    )
    if classes[best] == NONE:
        return None, confidence, "unknown_shape"
    if confidence < settings.token_probability:
        return None, confidence, "partial" if at_edge else "occluded" if crowded else "low_confidence"
    return classes[best], confidence, None


def clearest(rows: NDArray[np.float32], classes: Sequence[str]) -> int:
    """The row (extents, classes) in which some token, not `none`, is most likely."""
    return int(rows[:, _token_columns(tuple(classes))].max(axis=1).argmax())


@lru_cache(maxsize=4)
def _token_columns(classes: tuple[str, ...]) -> NDArray[np.intp]:
    return np.array([column for column, name in enumerate(classes) if name != NONE], np.intp)


class ReadingStage:
    """Hands of a frame -> the same with their tokens."""

    def __init__(self, classifier: Classifier, settings: ReadingSettings | None = None) -> None:
        self._classifier = classifier
        self._settings = settings or ReadingSettings()

    @property
    def classes(self) -> tuple[str, ...]:
        """What the classifier tells apart."""
        return tuple(self._classifier.classes)

    def process(
        self,
        image: Image,
        hands: Sequence[HandInView],
        face: tuple[float, float] | None = None,
        memory: ReadingMemory | None = None,
        time_s: float = 0.0,
    ) -> tuple[Hand, ...]:
        """Read every hand that is seen in one BGR frame, in the order of `hands`.

        face: middle of the diver's face, source pixels, None where none is seen. memory: of the stream, whose frame
        at `time_s` seconds this is; None for a picture on its own.
        """
        memory = memory or NO_MEMORY
        memory.keep_only([hand.number for hand in hands])
        if not hands:
            return ()
        looks = memory.looks
        standing = [
            None if looks is None else looks.standing(image, hand.number, hand.box, time_s) for hand in hands
        ]
        fresh = iter(
            self._read_anew(
                image, [hand for hand, look in zip(hands, standing, strict=True) if not look], looks, time_s
            )
        )
        read = []
        for hand, look in zip(hands, standing, strict=True):
            if look is None:
                found = next(fresh)
                row, extent = found[:2]
                if looks is not None:
                    looks.keep(image, hand.number, hand.box, found, time_s)
            else:
                row, extent = look.row, look.extent
            others = [other.box for other in hands if other is not hand]
            crowded = is_crowded(hand.box, others, face, self._settings)
            steady = memory.steady(hand.number, row, time_s)
            read.append(self._named(image, hand, extent, steady, crowded))
        return tuple(read)

    def _read_anew(
        self, image: Image, hands: Sequence[HandInView], looks: LastLooks | None, time_s: float
    ) -> list[tuple[Row, int, Row, float]]:
        """Of each hand: its probabilities (classes,), the number of the extent in which it reads most clearly, those of
        its other extents, and when these were read: not now where they would tell nothing."""
        recent = [None if looks is None else looks.recent(hand.number, hand.box, time_s) for hand in hands]
        asked = [
            (hand, (hand.box, *(() if look else hand.alternatives)))
            for hand, look in zip(hands, recent, strict=True)
        ]
        rows = self._probabilities(image, asked)
        missing = [
            (hand, () if look is None or says_the_same(own[0], look) else hand.alternatives)
            for hand, look, own in zip(hands, recent, rows, strict=True)
        ]
        more = self._probabilities(image, missing)
        return [self._joined(*one, time_s) for one in zip(recent, rows, more, strict=True)]

    def _joined(self, look: Look | None, rows: Row, more: Row, time_s: float) -> tuple[Row, int, Row, float]:
        """What is read of a hand from rows of its box and, where there is no recent look, of its other extents; more:
        those of them that were read after all."""
        others, others_s = rows[1:], time_s
        if look is not None:
            others, others_s = (more, time_s) if len(more) else (look.others, look.others_s)
        own = np.concatenate([rows[:1], others])
        extent = clearest(own, self._classifier.classes) if len(own) > 1 else 0
        row = own[extent] if self._settings.extents == "clearest" else own.mean(axis=0)
        return row, extent, others, others_s

    def _probabilities(self, image: Image, asked: Sequence[tuple[HandInView, Sequence[Box]]]) -> list[Row]:
        """Rows (boxes, classes) of some boxes of each hand, in one call for all."""
        boxes = [box for _, own in asked for box in own]
        sides = [hand.side or "right" for hand, own in asked for _ in own]
        if not boxes:
            return [np.empty((0, len(self._classifier.classes)), np.float32)] * len(asked)
        rows, found, first = self._classifier.probabilities(image, boxes, sides), [], 0
        for _, own in asked:
            found.append(rows[first : first + len(own)])
            first += len(own)
        return found

    def _named(
        self, image: Image, hand: HandInView, extent: int, row: NDArray[np.float32], crowded: bool
    ) -> Hand:
        """The hand with its token, in the box of an extent."""
        classes = self._classifier.classes
        box = hand.alternatives[extent - 1] if 0 < extent <= len(hand.alternatives) else hand.box
        at_edge = _touches_edge(box, (image.shape[1], image.shape[0]), self._settings.edge_share)
        token, confidence, reason = read_token(row, classes, at_edge, crowded, self._settings)
        return Hand(
            side=hand.side or "right",
            token=token,
            confidence=round(confidence * hand.certainty, 4),
            box=box,
            track=hand.number,
            reason=reason,
            probabilities=dict(zip(classes, row.tolist(), strict=True)),
        )
