"""The classical choice: regions of many thresholds, scored by trees on what the picture looks like there.

No net: channels of the picture averaged over a grid, the outline's numbers and its nearness to the bank of hand
contours. Two looks: every region is glanced at, and only the few that stand out are seen without their forearms, beside
the bank, by more trees. So a frame costs a bounded time whatever it shows. Selected by `--selector classical`, and the
baseline of every table.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.find import cells
from lightgesture.features.find.bank import PLAIN as PLAIN_BANK
from lightgesture.features.find.bank import (
    Bank,
    BankLoops,
    describe_points,
    distances_from,
    hand_proximity,
    nearest_hand,
)
from lightgesture.features.find.candidates import (
    Numbers,
    Rows,
    best_distinct,
    candidate_rows,
    numbers_of,
    scored_pairs,
)
from lightgesture.features.find.cells import PLAIN, CellLoops
from lightgesture.features.find.proposals import (
    LEVELS,
    Proposals,
    RegionLoops,
    whole_regions,
    without_forearms,
)
from lightgesture.features.find.proposals import PLAIN as PLAIN_REGIONS
from lightgesture.features.find.selector_file import BANK_NUMBERS, ClassicalParts
from lightgesture.features.find.settings import CLASSICAL, SelectorSettings
from lightgesture.features.find.trees import FlatTrees, Trees, Walk, plain_walk
from lightgesture.features.geometry import scale_boxes
from lightgesture.features.skin_map import PLAIN as PLAIN_SKIN
from lightgesture.features.skin_map import SkinLoops, skin_map
from lightgesture.features.types import Box, Candidates, Float, HandRegion, Image

COLUMNS: Final = cells.COLUMNS + BANK_NUMBERS
"""Numbers of one region at the second look."""
STANDING_OUT: Final = 24
"""Most regions that get the second look."""
ARMS: Final = 10
"""Of these, the first of which are tried without their forearm."""
ALTERNATIVES: Final = 3
"""Most other extents kept with a candidate; each is one more patch to read."""
ALTERNATIVE_IOU: Final = 0.35
"""Least overlap of another extent with the candidate."""


@dataclass(frozen=True, slots=True)
class Loops:
    """What loops over pixels, boxes and nodes: NumPy and OpenCV, or compiled; either gives the same answers."""

    skin: SkinLoops = PLAIN_SKIN
    cells: CellLoops = PLAIN
    regions: RegionLoops = PLAIN_REGIONS
    walk: Walk = plain_walk
    pairs: Numbers = numbers_of
    bank: BankLoops = PLAIN_BANK


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A frame made ready. skin: its skin map. sums: its integral images. size: (width, height), working pixels."""

    skin: Image
    sums: cells.Sums
    size: tuple[int, int]

    @classmethod
    def of(cls, colour: ColourMap, loops: Loops, room: cells.Sums | None = None) -> "Scene":
        """room: of `cells.channel_sums`."""
        skin = skin_map(colour.picture, loops.skin) if colour.skin_of is skin_map else colour.skin
        sums = cells.channel_sums(colour.picture, skin, loops.cells, room)
        return cls(skin, sums, (skin.shape[1], skin.shape[0]))


class Scorer:
    """Both looks, with the trees of a file."""

    def __init__(self, glance: Trees, regions: Trees, bank: Bank, loops: Loops) -> None:
        """glance, regions, bank: of `ClassicalParts`."""
        self._glance, self._regions = FlatTrees.of(glance), FlatTrees.of(regions)
        self._bank, self._loops = bank, loops

    def process(self, scene: Scene, levels: int = LEVELS) -> tuple[Proposals, Float]:
        """Regions that may be hands, with and without their forearms, and the predicted IoU of each with a hand.

        levels: of `whole_regions`.
        """
        whole = whole_regions(scene.skin, levels, self._loops.regions)
        rows = cells.describe(scene.sums, whole, scene.size, self._loops.cells)
        seen, rows = standing_out(
            scene, whole, rows, self._glance.scores(rows, self._loops.walk), self._loops
        )
        numbers = with_bank(rows, seen, self._bank, self._loops.bank)
        return seen, self._regions.scores(numbers, self._loops.walk)


def standing_out(
    scene: Scene, whole: Proposals, rows: Float, scores: Float, loops: Loops
) -> tuple[Proposals, Float]:
    """The regions that get the second look, with and without forearms, and their rows of `cells.describe`."""
    best = np.argsort(-scores, kind="stable")[:STANDING_OUT]
    chosen = whole.taken(best)
    hands = without_forearms(whole.taken(best[:ARMS]), loops.regions)
    more = cells.describe(scene.sums, hands, scene.size, loops.cells)
    return chosen.joined(hands), np.concatenate([rows[best], more])


def with_bank(rows: Float, regions: Proposals, bank: Bank, loops: BankLoops | None = None) -> Float:
    """float32 (n, COLUMNS): rows of `cells.describe`, then how near the outline is to the bank's hands, and how much
    nearer than to other things."""
    if not len(regions):
        return np.zeros((0, COLUMNS), np.float32)
    described = describe_points(regions.points, regions.starts, regions.lengths, bank.settings, loops)
    distances = distances_from(described, bank)
    found = np.empty((len(regions), COLUMNS), np.float32)
    found[:, :-BANK_NUMBERS] = rows
    found[:, -2], found[:, -1] = nearest_hand(distances, bank), hand_proximity(distances, bank)
    return found


def scored_candidates(
    colour: ColourMap,
    proposals: Proposals,
    scores: Float,
    overlap: NDArray[np.float64],
    loops: RegionLoops | None = None,
) -> tuple[list[int], Rows]:
    """Numbers of the proposals that go on to pairing, and what their pairs need. overlap: IoU of every two, (n, n)."""
    kept = best_distinct(overlap, scores)
    chosen = proposals.taken(np.array(kept, np.intp))
    colours = (loops or PLAIN_REGIONS).colours(colour.picture, chosen).astype(np.float32) / np.float32(255.0)
    return kept, candidate_rows(chosen.boxes, scores[kept], chosen.levels, colours)


def other_extents(overlap: NDArray[np.float64], scores: Float, kept: Sequence[int]) -> list[list[int]]:
    """For each kept proposal the best of the others that overlap it most among the kept. overlap: IoU of every two, (n,
    n)."""
    if not kept:
        return []
    with_kept = overlap[:, kept]
    nearest = with_kept.argmax(axis=1).tolist()
    near_enough = (with_kept.max(axis=1) >= ALTERNATIVE_IOU).tolist()
    others: list[list[int]] = [[] for _ in kept]
    for index in np.argsort(-scores, kind="stable").tolist():
        place = nearest[index]
        if near_enough[index] and index != kept[place] and len(others[place]) < ALTERNATIVES:
            others[place].append(index)
    return others


def _regions(
    colour: ColourMap,
    proposals: Proposals,
    scores: Float,
    kept: Sequence[int],
    others: Sequence[Sequence[int]],
) -> Iterator[HandRegion]:
    """The kept proposals in source pixels, each with its other extents."""
    numbers = [number for index, extents in zip(kept, others, strict=True) for number in (index, *extents)]
    boxes = iter(scale_boxes(proposals.boxes[numbers], colour.scale, colour.source_size))
    outlines = [proposals.contour(index) for index in kept]
    points = np.concatenate(outlines) if outlines else np.zeros((0, 2), np.int32)
    contours = np.rint((points + 0.5) * np.array(colour.scale)).astype(np.int32)
    begin = 0
    for index, extents, outline in zip(kept, others, outlines, strict=True):
        contour = contours[begin : begin + len(outline)]
        begin += len(outline)
        score = min(max(float(scores[index]), 0.0), 1.0)
        yield HandRegion(next(boxes), contour, None, score, tuple(next(boxes) for _ in extents))


class ClassicalSelector:
    """Colour map -> candidates with scores, by trees on regions of the skin map."""

    settings: SelectorSettings = CLASSICAL

    def __init__(self, parts: ClassicalParts, loops: Loops | None = None) -> None:
        """loops: None for NumPy's and OpenCV's."""
        self._loops = loops or Loops()
        self._scorer = Scorer(parts.glance, parts.regions, parts.bank, self._loops)
        self._pairs = FlatTrees.of(parts.pairs)
        # Of frames before: one for each thread that searches at a time.
        self._rooms: deque[cells.Sums] = deque()

    def process(self, colour: ColourMap) -> Candidates:
        """Score the regions of one frame. A frame without contrast gives no candidates."""
        try:
            room = self._rooms.pop()
        except IndexError:
            room = None
        scene = Scene.of(colour, self._loops, room)
        proposals, scores = self._scorer.process(scene)
        self._rooms.append(scene.sums)
        overlap = self._loops.regions.overlaps(proposals.boxes)
        kept, items = scored_candidates(colour, proposals, scores, overlap, self._loops.regions)
        together = scored_pairs(
            lambda rows: self._pairs.scores(rows, self._loops.walk),
            items,
            scene.size,
            None,
            overlap[kept][:, kept],
            self._loops.pairs,
        )
        regions = _regions(colour, proposals, scores, kept, other_extents(overlap, scores, kept))
        return Candidates(tuple(regions), together, colour.source_size)

    def follow(self, image: Image, boxes: Sequence[Box]) -> Candidates | None:
        """None: this choice cannot but search."""
        del image, boxes
        return None
