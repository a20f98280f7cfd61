"""Every method on every picture of divers: each picture is read once, then found in and read by all methods."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.divers.measures import contrast, size_at_reference
from lightgesture.benchmarks.divers.pictures import DiverFrame, side_of
from lightgesture.benchmarks.divers.rows import FrameRow, HandRow
from lightgesture.benchmarks.finding.regions import MAX_BOXES
from lightgesture.benchmarks.methods import Classifier
from lightgesture.benchmarks.scorer import Reading, matched_readings
from lightgesture.features.types import Image
from lightgesture.hands.reading import ReadingSettings, read_token
from lightgesture.models import NONE
from lightgesture.sources import read_picture
from lightgesture.training.datasets import Label


class Reads(Protocol):
    """What finds and reads the hands of a whole picture; `benchmarks.methods.Method` has it."""

    def read(self, image: Image) -> list[Reading]:
        """The hands of a single picture, without memory."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class DiverMethod:
    """What is compared: a name, what reads whole pictures, and its classifier for given boxes."""

    name: str
    whole: Reads
    classifier: Classifier


@dataclass(frozen=True, slots=True)
class Scored:
    """Rows of hands and frames of all methods, and what was found in each frame by (method, file), two at most."""

    hands: tuple[HandRow, ...]
    frames: tuple[FrameRow, ...]
    readings: dict[tuple[str, str], tuple[Reading, ...]]


def score_divers(
    methods: Sequence[DiverMethod],
    frames: Iterable[DiverFrame],
    read: Callable[[DiverFrame], Image] = lambda frame: read_picture(frame.path),
) -> Scored:
    """Rows of every method and frame. InputError: a picture cannot be read."""
    hands: list[HandRow] = []
    rows: list[FrameRow] = []
    readings: dict[tuple[str, str], tuple[Reading, ...]] = {}
    for labelled in frames:
        image = read(labelled)
        height, width = image.shape[:2]
        frame = labelled.in_pixels(width, height)
        sides = [side_of(hand, frame, width) for hand in frame.hands]
        measured = [
            (size_at_reference(hand.box, width), contrast(image, hand.outline)) for hand in frame.hands
        ]
        for method in methods:
            found = tuple(method.whole.read(image)[:MAX_BOXES])
            readings[method.name, frame.file] = found
            own = _hand_rows(method, frame, image, sides, measured, found)
            hands += own
            rows.append(_frame_row(method.name, frame, own, found))
    return Scored(tuple(hands), tuple(rows), readings)


def _hand_rows(
    method: DiverMethod,
    frame: DiverFrame,
    image: Image,
    sides: Sequence[str],
    measured: Sequence[tuple[float, float]],
    found: Sequence[Reading],
) -> list[HandRow]:
    if not frame.hands:
        return []
    labels = [Label(hand.box, None, None) for hand in frame.hands]
    table = method.classifier.probabilities(image, [hand.outline for hand in frame.hands], sides)
    rows = []
    for hand, side, (size, stands_out), (reading, overlap), probabilities in zip(
        frame.hands, sides, measured, matched_readings(labels, found), table, strict=True
    ):
        named, p_named, p_none, given = _given(probabilities, tuple(method.classifier.classes))
        rows.append(
            HandRow(
                method.name,
                *(frame.file, frame.place, frame.dive, *hand.box),
                *(hand.shape or "", hand.glove, hand.view, side),
                *(round(size, 1), round(stands_out, 2), round(overlap, 4)),
                *((reading.token if reading else None) or "", named, round(p_named, 5)),
                *(None if p_none is None else round(p_none, 5), given or ""),
            )
        )
    return rows


def _given(
    probabilities: NDArray[np.float32], classes: tuple[str, ...]
) -> tuple[str, float, float | None, str | None]:
    """Likeliest token, its probability, that of `none`, and what the product reads at its threshold."""
    values = {name: float(value) for name, value in zip(classes, probabilities, strict=True)}
    p_none = values.pop(NONE, None)
    named = max(values, key=lambda name: values[name])
    read, _, _ = read_token(probabilities, classes, False, False, ReadingSettings())
    return named, values[named], p_none, read


def _frame_row(
    method: str, frame: DiverFrame, hands: Sequence[HandRow], found: Sequence[Reading]
) -> FrameRow:
    tokens = [reading.token for reading in found if reading.token]
    on_hands = sum(
        bool(row.found_token) for row, hand in zip(hands, frame.hands, strict=True) if hand.may_be_sign
    )
    return FrameRow(
        method,
        *(frame.file, frame.place, frame.dive, len(frame.hands), sum(hand.is_sign for hand in frame.hands)),
        *(len(found), " ".join(tokens), len(tokens) - on_hands),
    )
