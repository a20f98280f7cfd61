"""The pictures from which the selector learns, read from a data folder, and its training from end to end."""

import json
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from lightgesture.datasets import (
    Sample,
    read_frames,
    read_landmarks,
    read_negatives,
    read_table,
    read_webcam,
)
from lightgesture.features.selector_file import Selector, save_selector
from lightgesture.features.training import BoxedPicture, fit_pairs, fit_regions
from lightgesture.features.types import Image
from lightgesture.results.atomic import replacing
from lightgesture.sources import read_picture
from lightgesture.training.composites import Composer, attenuate, expose
from lightgesture.training.cutouts import Cutout, cut_out


@dataclass(frozen=True, slots=True)
class RegionTraining:
    """What goes into the selector.

    region_composites, pair_composites: composed pictures for each of the two fits.
    cutouts_per_source: most hands cut out of one source, so that no person rules.
    longest_side: whole frames are reduced to this many pixels first.
    negative_sets: sets of `negatives` that are trained on; all others stay unseen for the report.
    left_out_sources: sources of `hands` that are not cut out: their people are those of `frames/drone`, whose figures
        would not count otherwise.
    """

    region_composites: int = 8000
    pair_composites: int = 2500
    cutouts_per_source: int = 8
    longest_side: int = 320
    negative_sets: tuple[str, ...] = ("funie", "rov25", "u45")
    left_out_sources: tuple[str, ...] = ("emre_drone",)


def _reduce(picture: BoxedPicture, longest: int) -> BoxedPicture:
    height, width = picture.image.shape[:2]
    scale = longest / max(height, width)
    if scale >= 1.0:
        return picture
    image = cv2.resize(picture.image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    boxes = tuple(
        (round(x * scale), round(y * scale), round(w * scale), round(h * scale))
        for x, y, w, h in picture.boxes
    )
    return BoxedPicture(image, boxes)  # type: ignore[arg-type]


def _mirrored(picture: BoxedPicture) -> BoxedPicture:
    width = picture.image.shape[1]
    boxes = tuple((width - x - w, y, w, h) for x, y, w, h in picture.boxes)
    return BoxedPicture(np.ascontiguousarray(picture.image[:, ::-1]), boxes)


def _boxed(sample: Sample, longest: int) -> BoxedPicture:
    boxes = tuple(label.box for label in sample.labels)
    return _reduce(BoxedPicture(read_picture(sample.path), boxes), longest)


def whole_frames(data: Path, settings: RegionTraining) -> list[BoxedPicture]:
    """People in rooms with their hands boxed: `webcam/train` and the single pictures of `frames/subhi`."""
    singles = [sample for sample in read_frames(data) if sample.source == "subhi" and sample.order is None]
    return [_boxed(sample, settings.longest_side) for sample in read_webcam(data, "train") + singles]


def negatives(data: Path, settings: RegionTraining) -> list[BoxedPicture]:
    """Underwater frames without a hand, of the sets that may be trained on."""
    samples = [sample for sample in read_negatives(data) if sample.source in settings.negative_sets]
    return [_boxed(sample, settings.longest_side) for sample in samples]


def cutouts(data: Path, settings: RegionTraining, seed: int) -> list[Cutout]:
    """Hands of `hands/train`, cut out, at most a few from each source."""
    by_source: dict[str, list[dict[str, str]]] = {}
    for row in read_table(data, "hands/train.csv"):
        if row["set"] not in settings.left_out_sources:
            by_source.setdefault(row["set"], []).append(row)
    rng = np.random.default_rng(seed)
    found = []
    for source in sorted(by_source):
        own = by_source[source]
        for index in rng.permutation(len(own))[: settings.cutouts_per_source]:
            row = own[index]
            image = read_picture(data / "hands" / row["path"])
            cutout = cut_out(image, read_landmarks(row), row["token"], source)
            if cutout is not None:
                found.append(cutout)
    return found


def without_hands(picture: BoxedPicture) -> Image:
    """The frame as a background: each labelled hand painted over from what stands around it."""
    mask = np.zeros(picture.image.shape[:2], np.uint8)
    for x, y, width, height in picture.boxes:
        margin_x, margin_y = width // 6, height // 5
        cv2.rectangle(
            mask, (x - margin_x, y - margin_y), (x + width + margin_x, y + height + margin_y), 255, -1
        )
    return cv2.inpaint(picture.image, mask, 5, cv2.INPAINT_TELEA)  # type: ignore[return-value]


def variants(picture: BoxedPicture, rng: np.random.Generator) -> Iterator[BoxedPicture]:
    """The picture itself, then it and its mirror image under water and in the dark."""
    yield picture
    for view in (picture, _mirrored(picture)):
        image = view.image.astype(np.float32) / np.float32(255.0)
        yield BoxedPicture(expose(attenuate(image, rng), rng), view.boxes)
        shaded = np.power(np.power(image, 2.2) * rng.uniform(0.03, 0.3), 1 / 2.2)
        yield BoxedPicture(expose(np.asarray(shaded, np.float32), rng), view.boxes)


def _composed(composer: Composer, count: int, seed: int) -> Iterator[BoxedPicture]:
    rng = np.random.default_rng(seed)
    for _ in range(count):
        composite = composer.compose(rng)
        yield BoxedPicture(composite.image, composite.boxes)


def train_regions(
    data: Path,
    out: Path,
    seed: int = 0,
    settings: RegionTraining | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> None:
    """Fit the selector and write it with its card (`out` with the suffix .json). Raises InputError."""
    settings = settings or RegionTraining()
    started = time.monotonic()
    progress("reading whole frames and cutting out hands")
    frames, empty = whole_frames(data, settings), negatives(data, settings)
    hands = cutouts(data, settings, seed)
    composer = Composer(hands, [picture.image for picture in empty], [without_hands(p) for p in frames])

    def region_pictures() -> Iterator[BoxedPicture]:
        rng = np.random.default_rng(seed + 1)
        for picture in frames:
            yield from variants(picture, rng)
        yield from empty
        yield from _composed(composer, settings.region_composites, seed + 2)

    progress("fitting the trees for regions")
    regions = fit_regions(region_pictures(), seed)
    progress("fitting the trees for pairs")
    singles = [picture for picture in frames if len(picture.boxes) > 1]
    composed = _composed(composer, settings.pair_composites, seed + 3)
    pairs = fit_pairs((picture for part in (singles, empty, composed) for picture in part), regions, seed)
    save_selector(out, Selector(regions, pairs))
    _write_card(out, seed, settings, frames, hands, empty, time.monotonic() - started)


def _write_card(
    out: Path,
    seed: int,
    settings: RegionTraining,
    frames: Sequence[BoxedPicture],
    hands: Sequence[Cutout],
    empty: Sequence[BoxedPicture],
    seconds: float,
) -> None:
    import sklearn

    card = {
        "model": "selector of hand regions: boosted trees over regions and over pairs of regions",
        "command": f"lightgesture train regions --data DATA --out {out.name} --seed {seed}",
        "data": {
            "whole frames (webcam/train, single pictures of frames/subhi)": len(frames),
            "hands cut out of hands/train": len(hands),
            "sources of these hands": len({hand.source for hand in hands}),
            "composed pictures": settings.region_composites + settings.pair_composites,
            "underwater frames without a hand": len(empty),
            "sets of negatives used": list(settings.negative_sets),
        },
        "never trained on": "frames/robochatgest, frames/drone and its people in hands/train (emre_drone), "
        "the sequences of frames/subhi, webcam/val, hands/val",
        "licences": "pictures of public repositories, most without a stated licence; no picture is part of the package",
        "limits": "hands 8 to 400 pixels high in a 640 x 480 picture; skin redder than what touches it after "
        "colour balance; hands before faces and skin-coloured walls are often missed",
        "seed": seed,
        "seconds": round(seconds),
        "versions": {"numpy": np.__version__, "opencv": cv2.__version__, "scikit-learn": sklearn.__version__},
    }
    with replacing(out.with_suffix(".json")) as temporary:
        temporary.write_text(json.dumps(card, indent=2) + "\n", encoding="utf-8")
