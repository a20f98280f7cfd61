"""`evaluate hands`: any number of classifiers side by side on hands in given boxes, in bad ones and in found ones."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from lightgesture.benchmarks.accuracy import Failure, Report, frame_samples, sheet_name
from lightgesture.benchmarks.contact_sheet import Image
from lightgesture.benchmarks.finding.pipelines import selector_method
from lightgesture.benchmarks.methods import Classifier
from lightgesture.benchmarks.progress import Progress
from lightgesture.benchmarks.reading.cost import Pair, cost_table
from lightgesture.benchmarks.reading.hands import (
    HandAnswer,
    by_source_table,
    by_token_table,
    classify,
    confusion_table,
    summary_table,
)
from lightgesture.benchmarks.reading.pictures import confusion_picture, error_sheet, reliability_diagram
from lightgesture.benchmarks.reading.reliability import reliability_table
from lightgesture.benchmarks.reading.robustness import (
    box_table,
    find_hands,
    found_table,
    random_table,
    trouble_table,
)
from lightgesture.benchmarks.scorer import Reading
from lightgesture.benchmarks.tables import Table, side_by_side
from lightgesture.features.find.selector import SELECTORS
from lightgesture.features.types import Box
from lightgesture.sources import read_picture
from lightgesture.training.datasets import Sample, group_samples, read_frames, read_hands, read_negatives

VAL = "hands val"
SURE = "hands val, none doubtful"


def evaluate_reading(models: Mapping[str, Classifier], data: Path, progress: Progress) -> Report:
    """Every model on `hands/val`, on the labelled hands of whole frames, and on what is no whole hand.

    models: at least one, by the names of the rows. Parts for which the folder has no pictures are left out.
    """
    samples, parts = read_hands(data), _frame_parts(data)
    answers = {
        name: _answers(classifier, name, samples, parts, progress) for name, classifier in models.items()
    }
    val = {name: own[VAL] for name, own in answers.items()}
    tables = [
        side_by_side([summary_table(list(own.items()), name) for name, own in answers.items()], "part"),
        side_by_side([by_token_table(own, name) for name, own in val.items()], "token"),
        side_by_side([by_source_table(own, name) for name, own in val.items()], "source"),
        side_by_side([confusion_table(own, name) for name, own in val.items()]),
        side_by_side([reliability_table(own, name) for name, own in val.items()]),
        *_trouble_tables(models, data, samples, progress),
        cost_table(models, _pair(parts, samples)),
    ]
    failures = {
        sheet_name(name, part): _failures(own)
        for name, by_part in answers.items()
        for part, own in by_part.items()
        if part not in (VAL, SURE)
    }
    return Report(tuple(table for table in tables if table.rows), failures, pictures=_pictures(val))


def _answers(
    classifier: Classifier,
    name: str,
    samples: Sequence[Sample],
    parts: Mapping[str, Sequence[Sample]],
    progress: Progress,
) -> dict[str, list[HandAnswer]]:
    val = classify(classifier, progress(samples, f"{name}: {VAL}"))
    answers = {VAL: val, SURE: [answer for answer in val if not answer.sample.doubtful]}
    for part, members in parts.items():
        answers[part] = classify(classifier, progress(members, f"{name}: {part}"))
    return answers


def _frame_parts(data: Path) -> dict[str, list[Sample]]:
    """Whole frames by group, and by source where a source has several groups."""
    samples = frame_samples(data)
    groups = group_samples(samples)
    parts = {f"{group}, boxes given": members for group, members in groups.items()}
    for source in dict.fromkeys(sample.source for sample in samples):
        members = [sample for sample in samples if sample.source == source]
        if len({sample.group for sample in members}) > 1:
            parts[f"all of {source}, boxes given"] = members
    return parts


def _trouble_tables(
    models: Mapping[str, Classifier], data: Path, samples: Sequence[Sample], progress: Progress
) -> list[Table]:
    def joined(
        make: Callable[[Classifier, Sequence[Sample], str], Table], own: Sequence[Sample], key: str
    ) -> Table:
        tables = [
            # The progress is told of samples, whose list a table may need to go through.
            make(classifier, list(progress(own, f"{name}: {make.__name__.replace('_', ' ')}")), name)
            for name, classifier in models.items()
        ]
        return side_by_side(tables, key)

    tables = [joined(box_table, samples, "error"), joined(trouble_table, samples, "trouble")]
    if (data / "negatives").is_dir():
        tables.append(joined(random_table, read_negatives(data), "sets"))
    if (data / "frames").is_dir():
        method = selector_method(SELECTORS[0])
        found = find_hands(method.read, progress(read_frames(data), f"find hands: {method.name}"))
        tables.append(side_by_side([found_table(own, found, name) for name, own in models.items()], "source"))
    return tables


def _pair(parts: Mapping[str, Sequence[Sample]], samples: Sequence[Sample]) -> Pair:
    """The first frame with two hands; without one, the first hand twice."""
    pairs = (sample for members in parts.values() for sample in members if len(sample.labels) == 2)
    sample = next(pairs, samples[0])
    first, last = sample.labels[0], sample.labels[-1]
    boxes: tuple[Box, Box] = first.box, last.box
    return Pair(read_picture(sample.path), boxes)


def _failures(answers: Sequence[HandAnswer]) -> list[Failure]:
    return [
        Failure(
            answer.sample.path,
            (answer.label,),
            (Reading(answer.label.box, answer.label.side, answer.token),),
            answer.sample.source,
        )
        for answer in answers
        if answer.failed
    ]


def _pictures(val: Mapping[str, Sequence[HandAnswer]]) -> dict[str, Image]:
    """By file name: every error of each model, the reliability of all, the confusions of all."""
    sheets = {sheet_name("errors", name): error_sheet(own) for name, own in val.items()}
    return {
        **{name: sheet for name, sheet in sheets.items() if sheet is not None},
        "reliability": reliability_diagram(val),
        "confusions": confusion_picture(val),
    }
