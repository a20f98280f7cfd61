"""Accuracy of the whole chain on real frames over a data folder, and what every report is made of.

`lightgesture evaluate` is the thin command in front of this module.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from lightgesture.benchmarks.contact_sheet import Image, choose_evenly, draw_tile, save_picture, save_sheet
from lightgesture.benchmarks.finding.region_tables import (
    instructions_table,
    negatives_table,
    regions_table,
    tokens_table,
)
from lightgesture.benchmarks.finding.regions import Run, run_methods
from lightgesture.benchmarks.methods import Classifier, Method, PaperMethod, product
from lightgesture.benchmarks.paper.bank import build_bank
from lightgesture.benchmarks.progress import Progress
from lightgesture.benchmarks.scorer import Reading
from lightgesture.benchmarks.tables import Table
from lightgesture.features.find.selector import SELECTORS, SelectorName
from lightgesture.sources import read_picture
from lightgesture.training.datasets import Label, Sample, read_frames, read_negatives, read_webcam

HANDS = "hands"
REGIONS = "regions"
TARGETS = (HANDS, REGIONS)


@dataclass(frozen=True, slots=True)
class Failure:
    """A picture to look at: what was labelled, what was read, and where."""

    path: Path
    labels: tuple[Label, ...]
    readings: tuple[Reading, ...]
    caption: str


@dataclass(frozen=True, slots=True)
class Report:
    """Tables of an evaluation, and the failures behind them by the name of their contact sheet: as pictures to be read
    and drawn, or as tiles that are drawn already. pictures: whole ones, by name.
    """

    tables: tuple[Table, ...]
    failures: dict[str, list[Failure]]
    tiles: Mapping[str, Sequence[Image]] = field(default_factory=dict)
    pictures: Mapping[str, Image] = field(default_factory=dict)


def evaluate_regions(methods: Sequence[Method], data: Path, progress: Progress) -> Report:
    """Every method on the whole frames of the folder, and on those without a gesturing diver."""
    positives = run_methods(methods, frame_samples(data), progress)
    has_negatives = (data / "negatives").is_dir()
    negatives = run_methods(methods, read_negatives(data), progress) if has_negatives else []
    tables = [
        regions_table(positives),
        tokens_table(positives, methods[0].name),
        instructions_table(positives),
        negatives_table(negatives),
    ]
    runs = [*positives, *negatives]
    failures = {sheet_name(run.method, run.group, run.mode): _run_failures(run) for run in runs}
    return Report(tuple(table for table in tables if table.rows), failures)


def available_targets(data: Path) -> list[str]:
    """The targets for which a data folder holds pictures."""
    folders = {HANDS: ("hands",), REGIONS: ("webcam", "frames")}
    return [target for target in TARGETS if any((data / name).is_dir() for name in folders[target])]


def default_methods(
    classifier: Classifier, model: str, data: Path | None, selectors: Sequence[SelectorName] = SELECTORS[:1]
) -> list[Method]:
    """The pipeline with each selector; and, where the pictures for its bank are there, the paper's chain named in both
    ways."""
    pipelines: list[Method] = [product(model, selector) for selector in selectors]
    if data is None or not (data / "hands" / "train.csv").is_file():
        return pipelines
    bank = build_bank(data)
    return [*pipelines, PaperMethod(bank), PaperMethod(bank, classifier)]


def save_failures(
    report: Report, folder: Path, warn: Callable[[str], None], suffix: str = ".jpg"
) -> list[Path]:
    """Draw a contact sheet per list of failures, and write the pictures as .png; returns the files written.

    suffix: of the sheets, .jpg, or .png for exact pixels.
    """
    written = []
    for name, picture in report.pictures.items():
        save_picture(folder / f"{name}.png", picture)
        written.append(folder / f"{name}.png")
    for name in (*report.failures, *report.tiles):
        failures, tiles = report.failures.get(name, []), report.tiles.get(name, ())
        count = len(failures) + len(tiles)
        chosen = choose_evenly(count)
        if len(chosen) < count:
            warn(f"{name}: shows {len(chosen)} of {count} failures")
        if chosen:
            path = folder / f"{name}{suffix}"
            save_sheet(path, [tiles[index] if tiles else _tile(failures[index]) for index in chosen])
            written.append(path)
    return written


def frame_samples(data: Path) -> list[Sample]:
    """The whole frames with labelled hands that a data folder holds, those that selectors are trained on left aside."""
    samples: list[Sample] = []
    if (data / "webcam").is_dir():
        samples += read_webcam(data)
    if (data / "frames").is_dir():
        samples += read_frames(data)
    return samples


def _tile(failure: Failure) -> Image:
    return draw_tile(read_picture(failure.path), failure.labels, failure.readings, failure.caption)


def _run_failures(run: Run) -> list[Failure]:
    return [
        Failure(answer.sample.path, answer.sample.labels, answer.readings, answer.sample.path.name)
        for answer in run.answers
        if answer.failed
    ]


def sheet_name(*words: str) -> str:
    """A file name from words: lower case, runs of other characters than letters and digits become "_"."""
    joined = "".join(character if character.isalnum() else " " for character in " ".join(words).lower())
    return "_".join(joined.split())
