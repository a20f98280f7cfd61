"""Finding hands without reading them: the product's pipeline up to its tracks, for any number of selectors.

A classifier may pick another extent of a region than the selector does, because it reads better. Here the selector's
own extent counts, so that the figures do not depend on a model.
"""

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.finding.regions import Run, run_sequence, run_single
from lightgesture.benchmarks.methods import Image, PipelineMethod
from lightgesture.benchmarks.progress import Progress
from lightgesture.features.colour import ColourStage
from lightgesture.features.find.selector import SELECTORS, SelectorName, load_selector
from lightgesture.features.find.selector_file import load_classical, load_learned
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.profile import ColourProfile
from lightgesture.features.track.tracker import Tracker
from lightgesture.features.types import Box
from lightgesture.hands import Finder, HandReader, ReadingStage
from lightgesture.models import NONE
from lightgesture.pipeline import Pipeline
from lightgesture.training.datasets import Sample, group_samples, is_sequence
from lightgesture.training.pool.left_out import LeftOut, read_left_out


class NoReader:
    """Stands in for a classifier: every hand is of no known shape, so that its first extent is kept."""

    classes: tuple[str, ...] = ("5", NONE)

    def probabilities(
        self, image_bgr: Image, boxes: Sequence[Box], sides: Sequence[str]
    ) -> NDArray[np.float32]:
        """float32 (number of boxes, 2), all of it on `none`, whatever the picture shows."""
        del image_bgr, sides
        return np.tile(np.array([0.0, 1.0], np.float32), (len(boxes), 1))


@dataclass(frozen=True, slots=True)
class Stages:
    """What makes the stages of a pipeline, None for the product's own."""

    colour: Callable[[], ColourStage] | None = None
    regions: Callable[[], Finder] | None = None
    tracks: Callable[[], Tracker] | None = None


def finding_pipeline(stages: Stages | None = None) -> Pipeline:
    """The product, except that nothing is read, and that single stages may be others."""
    stages = stages or Stages()
    front = HandReader(
        ReadingStage(NoReader()),
        find=stages.regions() if stages.regions else None,
        colour=stages.colour() if stages.colour else None,
        track=stages.tracks,
    )
    return Pipeline(front, rule="frames")


def variant(name: str, stages: Stages) -> PipelineMethod:
    """A method that finds with other stages."""
    return PipelineMethod(name, lambda _: finding_pipeline(stages))


def selector_method(
    selector: str, file: str | None = None, profile: ColourProfile | None = None
) -> PipelineMethod:
    """A method that finds by one of SELECTORS, with what `file` holds instead of what is bundled, called after both.

    selector may be a file itself, whose learned choice is then taken. profile: the colours of the hands. Raises
    lightgesture.features.find.selector_file.SelectorError.
    """
    if selector not in SELECTORS:
        selector, file = SELECTORS[0], selector
    name: SelectorName = "classical" if selector == "classical" else "learned"
    label = name if file is None else f"{name}, {Path(file).stem}"
    stage = load_selector(name, file)
    if profile is None:
        return variant(label, Stages(regions=lambda: stage))
    coloured = Stages(colour=lambda: ColourStage(profile=profile), regions=lambda: stage)
    return variant(f"{label}, profile", coloured)


def run_left_out(
    selector: str,
    files: Sequence[str],
    samples: Sequence[Sample],
    progress: Progress,
    warn: Callable[[str], None],
) -> list[Run]:
    """Score trained files of a selector on exactly the sources that their cards say they did not see.

    Each sample is scored by the first file that left out its source; those that no file left out are skipped, and
    their number is told. A file that still has a part of the bundled one is not scored, which is told too. Raises
    InputError (a card) and SelectorError (a file).
    """
    known = [
        (selector_method(selector, file), read_left_out(Path(file)))
        for file in files
        if _is_trained_anew(selector, file, warn)
    ]
    if not known:
        return []
    name = f"{selector}, left out"
    runs = []
    for group, members in group_samples(samples).items():
        parts = _split(members, [left_out for _, left_out in known])
        skipped = len(members) - sum(map(len, parts))
        if skipped:
            warn(
                f"{group}: {skipped} of {len(members)} frames are of sources that no file was trained without"
            )
        modes = (run_single, run_sequence) if is_sequence(members) else (run_single,)
        for run in modes:
            done = [
                run(method, group, progress(part, f"{name}: {group}"))
                for (method, _), part in zip(known, parts, strict=True)
                if part
            ]
            if done:
                answers = tuple(answer for item in done for answer in item.answers)
                runs.append(replace(done[0], method=name, answers=answers, decoded=None, seen="no"))
    return runs


def _is_trained_anew(selector: str, file: str, warn: Callable[[str], None]) -> bool:
    """Whether nothing of a choice is the shipped one, which has seen what the file's card says was left out."""
    same = shared_parts("classical" if selector == "classical" else "learned", file)
    if same:
        parts = ", ".join(same)
        warn(
            f"{file}: not scored by the {selector} choice, whose parts ({parts}) are those of the bundled file"
        )
    return not same


def _split(samples: Iterable[Sample], left_outs: Sequence[LeftOut]) -> list[list[Sample]]:
    """For each of `left_outs` the samples whose source it is the first to cover."""
    parts: list[list[Sample]] = [[] for _ in left_outs]
    for sample in samples:
        place = next((i for i, item in enumerate(left_outs) if item.covers(sample.source)), None)
        if place is not None:
            parts[place].append(sample)
    return parts


File = str | os.PathLike[str] | None
"""Path of a selector file; None for the bundled one."""


def shared_parts(selector: SelectorName, first: File, second: File = None) -> tuple[str, ...]:
    """Names of the trained parts of one choice that are the same in both files. Raises SelectorError."""
    parts, others = _parts(selector, first), _parts(selector, second)
    return tuple(name for name, part in parts.items() if np.array_equal(part, others[name]))


def _parts(selector: SelectorName, file: File) -> Mapping[str, NDArray[Any]]:
    """What training decides of each part: values of leaves, centres of the bank, weights of a net."""
    if selector == "classical":
        classical = load_classical(file)
        return {
            "trees": classical.regions.value,
            "trees of pairs": classical.pairs.value,
            "bank": classical.bank.centres,
        }
    learned = load_learned(file)
    verified = {} if learned.verifier is None else {"verifier": _weights(learned.verifier)}
    return {
        "locator": _weights(learned.locator),
        "refiner": _weights(learned.refiner),
        **verified,
        "trees": learned.places.value,
        "trees of pairs": learned.pairs.value,
    }


def _weights(network: IntegerNetwork) -> NDArray[np.int8]:
    return np.concatenate([own.weights.ravel() for own in network.weights.values()])
