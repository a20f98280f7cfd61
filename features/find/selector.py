"""Choosing the hands of a frame: candidates by either selector, then a pair, one hand, or none.

Two candidates that look like the hands of one person are believed at a lower score than one alone: a red
box on a table looks like a hand, but seldom has a partner of its size at its height. Of a diver who
shows a sign with one hand and holds a reel in the other each is believed by itself.
"""

import os
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap, ColourStage
from lightgesture.features.find.candidates import APART_IOU
from lightgesture.features.find.learned import LearnedSelector
from lightgesture.features.find.selector_file import load_classical, load_learned
from lightgesture.features.find.settings import ALONE_CONFIDENCE, SelectorSettings
from lightgesture.features.geometry import box_iou, mirror_box
from lightgesture.features.image import as_bgr8
from lightgesture.features.outline.regions import outline_in
from lightgesture.features.types import Candidates, HandRegion, Side

if TYPE_CHECKING:
    from lightgesture.features.find.classical import ClassicalSelector

SelectorName = Literal["learned", "classical"]
SELECTORS: tuple[SelectorName, ...] = ("learned", "classical")


def load_selector(
    selector: SelectorName = "learned", file: str | os.PathLike[str] | None = None
) -> "LearnedSelector | ClassicalSelector":
    """What finds candidates.

    selector: "learned" or "classical". file: of `lightgesture train regions`, None for the bundled one. Raises
    SelectorError, or ValueError for another selector.
    """
    if selector not in SELECTORS:
        raise ValueError(f"selector {selector!r}: must be learned or classical")
    if selector == "learned":
        return LearnedSelector(load_learned(file))
    from lightgesture.features.compiled.loops import best_loops
    from lightgesture.features.find.classical import ClassicalSelector

    return ClassicalSelector(load_classical(file), best_loops())


def best_pair(pairs: NDArray[np.float32]) -> tuple[tuple[int, int], float] | None:
    """The two candidates that go together best, and how well; None without any."""
    if pairs.size == 0 or pairs.max() <= 0.0:
        return None
    first, second = np.unravel_index(int(pairs.argmax()), pairs.shape)
    return (int(first), int(second)), float(pairs[first, second])


def choose(candidates: Candidates, settings: SelectorSettings) -> list[HandRegion]:
    """The hands of a single picture, by the diver's right first: a pair, else one or two that are believed alone, or
    none."""
    found = best_pair(candidates.pairs)
    if found is not None and found[1] >= settings.pair_score:
        two = [candidates.regions[i] for i in found[0]]
        return _by_order([replace(one, confidence=max(one.confidence, found[1])) for one in two])
    believed = [one for one in candidates.regions if one.confidence >= settings.single_score]
    alone = [
        replace(one, confidence=one.confidence * ALONE_CONFIDENCE, certainty=ALONE_CONFIDENCE)
        for one in believed[:1] + [one for one in believed[1:] if _is_apart(one, believed[0])][:1]
    ]
    if len(alone) == 1:
        axis = candidates.source_size[0] / 2 if candidates.face is None else candidates.face[0]
        side: Side = "right" if _middle(alone[0]) < axis else "left"
        return [replace(alone[0], side=side)]
    return _by_order(alone)


def _by_order(hands: Sequence[HandRegion]) -> list[HandRegion]:
    """Two hands, or none, with the sides of a diver who faces the camera, the right one first."""
    sides: tuple[Side, Side] = ("right", "left")
    return [replace(hand, side=side) for hand, side in zip(sorted(hands, key=_middle), sides, strict=False)]


def _middle(region: HandRegion) -> float:
    return region.box[0] + region.box[2] / 2


def _is_apart(one: HandRegion, other: HandRegion) -> bool:
    """Whether both may be hands of one diver."""
    return box_iou(one.box, other.box) <= APART_IOU


def find_hands(
    image: NDArray[Any], *, mirrored: bool = False, selector: SelectorName = "learned"
) -> list[HandRegion]:
    """The hands of one picture, without memory.

    image: uint8 (height, width, 3), BGR. mirrored: the picture is a selfie camera's; it is searched
    as it would look unmirrored, so the sides are the diver's own, and the boxes are reported in the
    given pixels. Raises SelectorError where the bundled data file is damaged, ValueError for what is no picture.
    """
    stage = _stage(selector)
    picture = as_bgr8(image)
    upright = np.ascontiguousarray(picture[:, ::-1]) if mirrored else picture
    colour = ColourStage().process(upright)
    hands = [outlined(colour, hand) for hand in choose(stage.process(colour), stage.settings)]
    return [mirror_region(hand, picture.shape[1]) for hand in hands] if mirrored else hands


@lru_cache(maxsize=len(SELECTORS))
def _stage(selector: SelectorName) -> "LearnedSelector | ClassicalSelector":
    """Read once, because a caller asks for picture after picture."""
    return load_selector(selector)


def outlined(colour: ColourMap, region: HandRegion) -> HandRegion:
    """The region with its outline, where it has none yet."""
    if len(region.contour):
        return region
    return replace(region, contour=outline_in(colour, region.box))


def mirror_region(region: HandRegion, width: int) -> HandRegion:
    """The region in the picture flipped left to right; its side stays."""
    contour = region.contour * np.array([-1, 1]) + np.array([width - 1, 0])
    return replace(
        region,
        box=mirror_box(region.box, width),
        contour=contour.astype(np.int32),
        alternatives=tuple(mirror_box(box, width) for box in region.alternatives),
    )
