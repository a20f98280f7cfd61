"""`evaluate regions --ablation`: what each stage of finding hands buys, in one row per variant of the product."""

from collections.abc import Sequence
from pathlib import Path

from lightgesture.benchmarks.accuracy import Report, frame_samples
from lightgesture.benchmarks.finding.ablation_stages import ablations
from lightgesture.benchmarks.finding.clips import FindingAnswer, find_in_clips
from lightgesture.benchmarks.finding.difficulties import difficulty_takes
from lightgesture.benchmarks.finding.regions import MAX_BOXES, SINGLE, Run, run_methods
from lightgesture.benchmarks.finding.tables import overlaps
from lightgesture.benchmarks.progress import Progress
from lightgesture.benchmarks.scorer import percentile, share, total
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.training.datasets import read_negatives

NOTE = (
    "groups: share of the labelled hands that were found (IoU >= 0.5), in single pictures or, where so named, in "
    "sequences;\nmedian_iou: of those found in single pictures; pair, any_hand: frames without a gesturing diver in "
    "which they were\nfound; clips, switches (with --clips): hands found in short clips of one difficulty each, and "
    "how often one goes on\nunder another track. Nothing was trained again for a variant, and all have the product's "
    "thresholds."
)


def evaluate_ablation(data: Path, progress: Progress, folder: Path | None = None, jobs: int = 1) -> Report:
    """Every variant on all pictures of a data folder, and on short clips.

    folder: the cache of clips, None to do without; jobs: processes that render what it lacks. Raises
    lightgesture.features.find.selector_file.SelectorError.
    """
    methods = ablations()
    empty = read_negatives(data) if (data / "negatives").is_dir() else []
    found = run_methods(methods, frame_samples(data), progress)
    clips: list[FindingAnswer] = []
    if folder is not None:
        clips = find_in_clips(lambda _: methods, difficulty_takes(), folder, progress, jobs)
    return Report((ablation_table(found, run_methods(methods, empty, progress), clips),), {})


def ablation_table(found: Sequence[Run], empty: Sequence[Run], clips: Sequence[FindingAnswer]) -> Table:
    """One row per method: its share of each group and mode of `found`, frames of `empty` with hands, clips."""
    groups = list(dict.fromkeys(_column(run) for run in found))
    names = list(dict.fromkeys(run.method for run in (*found, *empty)))
    columns = ("method", *groups, "median_iou", "pair", "any_hand", *(("clips", "switches") if clips else ()))
    rows = [
        {
            "method": name,
            **_found_cells([run for run in found if run.method == name]),
            **_false_cells([run for run in empty if run.method == name and run.mode == SINGLE]),
            **_clip_cells([answer for answer in clips if answer.method == name]),
        }
        for name in names
    ]
    return Table("ablation", "What each stage of finding hands buys", columns, tuple(rows), NOTE)


def _column(run: Run) -> str:
    return run.group if run.mode == SINGLE else f"{run.group}, {run.mode}"


def _found_cells(runs: Sequence[Run]) -> dict[str, Cell]:
    singles = [overlap for run in runs if run.mode == SINGLE for overlap in overlaps(run.answers)]
    cells: dict[str, Cell] = {_column(run): share(run.score.found, run.score.hands) for run in runs}
    return {**cells, "median_iou": percentile(singles, 50) if singles else None}


def _false_cells(runs: Sequence[Run]) -> dict[str, Cell]:
    counts = [len(answer.readings) for run in runs for answer in run.answers]
    return {"pair": sum(count == MAX_BOXES for count in counts), "any_hand": sum(map(bool, counts))}


def _clip_cells(answers: Sequence[FindingAnswer]) -> dict[str, Cell]:
    if not answers:
        return {}
    score = total(answer.score for answer in answers)
    switches = sum(answer.switches for answer in answers)
    return {"clips": share(score.found, score.hands), "switches": switches}
