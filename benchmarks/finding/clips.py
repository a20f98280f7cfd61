"""`evaluate regions --clips`: hands found in the scenario suite and in short clips of one difficulty each."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from lightgesture.benchmarks.accuracy import Report, sheet_name
from lightgesture.benchmarks.contact_sheet import Image, draw_tile
from lightgesture.benchmarks.finding.difficulties import GLOVES, difficulty_takes, profile_take
from lightgesture.benchmarks.finding.pipelines import selector_method
from lightgesture.benchmarks.finding.regions import MAX_BOXES
from lightgesture.benchmarks.methods import Method
from lightgesture.benchmarks.progress import Progress
from lightgesture.benchmarks.scorer import Reading, Score, matched_readings, percentile, share, total
from lightgesture.benchmarks.suite.cache import Clip, Take, fetch_clip, fetch_clips
from lightgesture.benchmarks.suite.scenarios import LAND, WATER, Scenario
from lightgesture.benchmarks.suite.scoring import count_restarts, count_switches, score_hands
from lightgesture.benchmarks.suite.takes import choose_takes, synthetic_takes
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.features.profile import ColourProfile
from lightgesture.features.profile_learning import learn_profile
from lightgesture.sources import open_source
from lightgesture.training.datasets import Label

BOTH = 2
"""Hands of a frame from which a profile is learnt: one without a label would count as something else."""


def evaluate_clips(
    selectors: Sequence[str], folder: Path, progress: Progress, jobs: int = 1, is_quick: bool = False
) -> Report:
    """Every selector in every clip; on gloves also with a colour profile that was learnt from other frames of them.

    folder: the cache; jobs: processes that render what it lacks; is_quick: every fifth clip of the suite. Raises
    lightgesture.features.find.selector_file.SelectorError.
    """
    methods = [selector_method(selector) for selector in selectors]

    def methods_for(clip: Clip) -> list[Method]:
        if clip.scenario.difficulty != GLOVES:
            return [*methods]
        profile = glove_profile(fetch_clip(profile_take(clip.scenario), folder))
        return [*methods, *(selector_method(selector, profile=profile) for selector in selectors)]

    takes = choose_takes([*synthetic_takes(WATER), *synthetic_takes(LAND)], (), is_quick)
    suite = find_in_clips(lambda _: methods, takes, folder, progress, jobs)
    alone = find_in_clips(methods_for, difficulty_takes(), folder, progress, jobs)
    return Report(tuple(clip_tables(suite, alone)), {}, missed_sheets([*suite, *alone]))


def glove_profile(clip: Clip) -> ColourProfile:
    """What `learn_profile` makes of the frames of a clip in which both hands are labelled."""
    with open_source(str(clip.video)) as source:
        shown = [(frame.image, clip.labels[frame.index]) for frame in source]
    known = [(image, [label.box for label in labels]) for image, labels in shown if len(labels) == BOTH]
    return learn_profile(
        [image for image, _ in known], [boxes for _, boxes in known], "glove", f"clip {clip.scenario.name}"
    )


TILE_STEP = 15
"""Of missed hands in a clip a picture is kept at most every so many frames: neighbours look the same."""

NOTE = (
    "found: hands that show a token, IoU >= 0.5, in every frame; side_share, median_iou: of the found; switches: how "
    "often a\nhand goes on under another track; a_clip, worst: per clip, in the worst clip; restarts: of these, to a "
    "track that is new"
)

Seen = tuple[tuple[Label, ...], tuple[Reading, ...]]
"""Labels and readings of one frame."""
Methods = Callable[[Clip], Sequence[Method]]
"""The methods for a clip: those with a colour profile know one glove only."""


@dataclass(frozen=True, slots=True, eq=False)
class FindingAnswer:
    """What one method found in one clip. overlaps: IoU of the found hands. tiles: frames with missed hands."""

    method: str
    scenario: Scenario
    score: Score
    overlaps: tuple[float, ...]
    switches: int
    restarts: int
    tiles: tuple[Image, ...]


def find_in_clips(
    methods: Methods,
    takes: Sequence[Take],
    folder: Path,
    progress: Progress,
    jobs: int = 1,
) -> list[FindingAnswer]:
    """Every method on every take; `folder` is the cache, `jobs` the processes that render what it lacks."""
    answers = []
    for _, clip in zip(progress(takes, "clips"), fetch_clips(takes, folder, jobs), strict=True):
        answers += [find_in_clip(method, clip) for method in methods(clip)]
    return answers


def find_in_clip(method: Method, clip: Clip) -> FindingAnswer:
    """Follow the hands of a clip with a fresh memory."""
    stream = method.stream(None)
    seen: list[Seen] = []
    tiles: dict[int, Image] = {}
    with open_source(str(clip.video)) as source:
        for frame in source:
            readings = tuple(stream.process(frame.image, frame.time_s)[:MAX_BOXES])
            labels = clip.labels[frame.index]
            seen.append((labels, readings))
            is_due = not tiles or frame.index - max(tiles) >= TILE_STEP
            if is_due and any(reading is None for reading, _ in matched_readings(labels, readings)):
                caption = f"{clip.scenario.name}, {clip.scenario.difficulty}, {frame.index}"
                tiles[frame.index] = draw_tile(frame.image, labels, readings, caption)
    return FindingAnswer(
        method.name,
        clip.scenario,
        score_hands(frame for frame in seen if frame[0]),
        tuple(_overlaps(seen)),
        count_switches(seen),
        count_restarts(seen),
        tuple(tiles.values()),
    )


def _overlaps(seen: Iterable[Seen]) -> Iterator[float]:
    for labels, readings in seen:
        yield from (overlap for reading, overlap in matched_readings(labels, readings) if reading is not None)


def clip_tables(suite: Sequence[FindingAnswer], alone: Sequence[FindingAnswer]) -> list[Table]:
    """The suite by part and by difficulty, then the clips of one difficulty alone; tables without rows are left out."""
    tables = [
        _table("found_suite", "Hands found in the scenario suite", "suite", suite),
        _table("found_suite_by_difficulty", "Hands found in the suite, by difficulty", "difficulty", suite),
        _table("found_alone", "Hands found in short clips of one difficulty alone", "difficulty", alone),
    ]
    return [table for table in tables if table.rows]


def _table(name: str, title: str, key: str, answers: Sequence[FindingAnswer]) -> Table:
    """One row per value of `key`, an attribute of the scenario, and method."""
    groups: dict[tuple[str, str], list[FindingAnswer]] = {}
    for answer in answers:
        groups.setdefault((getattr(answer.scenario, key), answer.method), []).append(answer)
    columns = (
        *("method", key, "clips", "hands", "found", "found_share", "side_share", "median_iou"),
        *("switches", "a_clip", "worst", "restarts"),
    )
    order = list(dict.fromkeys(value for value, _ in groups))
    rows = [
        {"method": method, key: value, **_cells(own)}
        for (value, method), own in sorted(groups.items(), key=lambda item: order.index(item[0][0]))
    ]
    return Table(name, title, columns, tuple(rows), NOTE)


def _cells(answers: Sequence[FindingAnswer]) -> dict[str, Cell]:
    score = total(answer.score for answer in answers)
    overlaps = [overlap for answer in answers for overlap in answer.overlaps]
    switches = [answer.switches for answer in answers]
    return {
        "clips": len(answers),
        "hands": score.hands,
        "found": score.found,
        "found_share": share(score.found, score.hands),
        "side_share": share(score.sides_right, score.sides),
        "median_iou": percentile(overlaps, 50) if overlaps else None,
        "switches": sum(switches),
        "a_clip": sum(switches) / len(switches),
        "worst": max(switches),
        "restarts": sum(answer.restarts for answer in answers),
    }


def missed_sheets(answers: Sequence[FindingAnswer]) -> dict[str, list[Image]]:
    """Frames with missed hands, by the name of a contact sheet: one a suite and method."""
    sheets: dict[str, list[Image]] = {}
    for answer in answers:
        sheets.setdefault(sheet_name("missed", answer.scenario.suite, answer.method), []).extend(answer.tiles)
    return sheets
