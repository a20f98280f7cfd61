"""`evaluate regions` without a model: everything about finding hands in the pictures of a data folder."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from lightgesture.benchmarks.accuracy import Failure, Report, frame_samples, sheet_name
from lightgesture.benchmarks.finding.pipelines import run_left_out, selector_method
from lightgesture.benchmarks.finding.recorded import read_recorded, recorded_runs
from lightgesture.benchmarks.finding.regions import Run, run_methods
from lightgesture.benchmarks.finding.tables import finding_tables
from lightgesture.benchmarks.methods import Method
from lightgesture.benchmarks.progress import Progress
from lightgesture.features.find.selector import SELECTORS
from lightgesture.training.datasets import Sample, read_negatives, read_webcam


@dataclass(frozen=True, slots=True)
class FindingRequest:
    """What is compared.

    selectors: names of SELECTORS or paths of selector files, scored on all pictures but those of `webcam/train`.
    left_out: selector files that are scored only on the sources that they were trained without, `webcam/train` too.
    by: which of SELECTORS these files are used by. recorded: files of boxes that other programs found.
    """

    selectors: Sequence[str] = SELECTORS
    left_out: Sequence[str] = ()
    by: Sequence[str] = SELECTORS
    recorded: Sequence[str] = ()


def evaluate_finding(
    request: FindingRequest, data: Path, progress: Progress, warn: Callable[[str], None]
) -> Report:
    """Hands found by every method, and false ones. Raises InputError and SelectorError."""
    methods: list[Method] = [selector_method(selector) for selector in request.selectors]
    return score_finding(methods, request, data, progress, warn)


def score_finding(
    methods: Sequence[Method],
    request: FindingRequest,
    data: Path,
    progress: Progress,
    warn: Callable[[str], None],
) -> Report:
    """The same for methods that are open; of the request, what others found and what files have left out."""
    pictures, rooms = frame_samples(data), _rooms(data)
    empty = read_negatives(data) if (data / "negatives").is_dir() else []
    positives = run_methods(methods, pictures, progress)
    negatives = run_methods(methods, empty, progress)
    if request.left_out:
        for selector in request.by:
            positives += run_left_out(selector, request.left_out, [*pictures, *rooms], progress, warn)
            negatives += run_left_out(selector, request.left_out, empty, progress, warn)
    for file in request.recorded:
        recorded = read_recorded(Path(file))
        positives += recorded_runs(recorded, [*pictures, *rooms], data)
        negatives += recorded_runs(recorded, empty, data)
    failures = {
        sheet_name("found", run.method, run.group, run.mode): _failures(run)
        for run in [*positives, *negatives]
    }
    return Report(tuple(finding_tables(_by_group(positives), _by_group(negatives))), failures)


def _rooms(data: Path) -> list[Sample]:
    return read_webcam(data, "train") if (data / "webcam" / "train.csv").is_file() else []


def _by_group(runs: Sequence[Run]) -> list[Run]:
    """The runs of a group and mode side by side, in order of first appearance."""
    order = list(dict.fromkeys((run.group, run.mode) for run in runs))
    return sorted(runs, key=lambda run: order.index((run.group, run.mode)))


def _failures(run: Run) -> list[Failure]:
    """Frames with a missed hand or a false one."""
    return [
        Failure(answer.sample.path, answer.sample.labels, answer.readings, answer.sample.path.name)
        for answer in run.answers
        if answer.misfound
    ]
