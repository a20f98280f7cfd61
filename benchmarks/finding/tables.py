"""Tables of how hands were found, whatever they show: by group, by source, by token, and where there are none."""

from collections.abc import Iterable, Sequence

from lightgesture.benchmarks.finding.region_tables import (
    FOUND_COLUMNS,
    RUN_COLUMNS,
    false_counts,
    found_row,
    run_row,
)
from lightgesture.benchmarks.finding.regions import MAX_BOXES, SINGLE, Answer, Run
from lightgesture.benchmarks.scorer import is_token, matched_readings, percentile, share
from lightgesture.benchmarks.tables import Cell, Table

NOTE = (
    f"found: IoU >= 0.5 with the label, at most {MAX_BOXES} boxes a frame; mean_iou, median_iou: of the found; "
    "sides: found hands\nwhose side is known, and the share of them on the right side; extra: boxes on no hand, where "
    "all hands are labelled;\nseen: what the selector was trained on, which says little about other people."
)


def finding_tables(positives: Sequence[Run], negatives: Sequence[Run]) -> list[Table]:
    """All tables of pictures; those without rows are left out."""
    tables = [
        found_table(positives),
        found_by_source_table(positives),
        found_by_token_table(positives),
        false_hands_table(negatives),
    ]
    return [table for table in tables if table.rows]


def found_table(runs: Sequence[Run]) -> Table:
    """One row per method, group and mode."""
    columns = (*FOUND_COLUMNS, "median_iou", "sides", "side_share", "extra")
    return Table("found", "Hands found in whole frames", columns, tuple(map(_found_row, runs)), NOTE)


def _found_row(run: Run) -> dict[str, Cell]:
    found = overlaps(run.answers)
    return {**found_row(run), "median_iou": percentile(found, 50) if found else None}


def overlaps(answers: Iterable[Answer]) -> list[float]:
    """IoU of every found hand with its label."""
    return [
        overlap
        for answer in answers
        for reading, overlap in matched_readings(answer.sample.labels, answer.readings)
        if reading is not None
    ]


def found_by_source_table(runs: Sequence[Run]) -> Table:
    """Sources with missed hands, for groups of more than one source."""
    rows: list[dict[str, Cell]] = []
    for run in runs:
        sources: dict[str, list[Answer]] = {}
        for answer in run.answers:
            sources.setdefault(answer.sample.source, []).append(answer)
        if run.mode == SINGLE and len(sources) > 1:
            rows += [row for source, own in sources.items() if (row := _source_row(run, source, own))]
    columns = ("method", "group", "source", "hands", "found")
    return Table("found_by_source", "Sources with missed hands, single frames", columns, tuple(rows))


def _source_row(run: Run, source: str, answers: Sequence[Answer]) -> dict[str, Cell] | None:
    hands, found = (sum(getattr(answer.score, name) for answer in answers) for name in ("hands", "found"))
    if found == hands:
        return None
    return {"method": run.method, "group": run.group, "source": source, "hands": hands, "found": found}


def found_by_token_table(runs: Sequence[Run]) -> Table:
    """What the missed hands show, all groups together: one row per method and token with missed hands."""
    counts: dict[tuple[str, str], list[int]] = {}
    for run in runs:
        for answer in run.answers if run.mode == SINGLE else ():
            labels = answer.sample.labels
            for label, (reading, _) in zip(labels, matched_readings(labels, answer.readings), strict=True):
                token = label.token if is_token(label.token) else "other"
                count = counts.setdefault((run.method, token or "other"), [0, 0])
                count[0] += 1
                count[1] += reading is not None
    rows: list[dict[str, Cell]] = [
        {"method": method, "token": token, "hands": hands, "found": found, "found_share": share(found, hands)}
        for (method, token), (hands, found) in sorted(counts.items())
    ]
    columns = ("method", "token", "hands", "found", "found_share")
    return Table("found_by_token", "Hands found by token, single frames of all groups", columns, tuple(rows))


def false_hands_table(runs: Sequence[Run]) -> Table:
    """Frames without a gesturing diver in which a pair, or any hand, was found; single pictures are summed up."""
    rows = [{**run_row(run), **false_counts(run.answers)} for run in runs]
    for method in dict.fromkeys(run.method for run in runs):
        answers = [a for run in runs if (run.method, run.mode) == (method, SINGLE) for a in run.answers]
        rows.append({"method": method, "group": "all", "mode": SINGLE, **false_counts(answers)})
    columns = (*RUN_COLUMNS, "frames", "pair", "any_hand")
    title = "Frames without a gesturing diver in which hands were found"
    return Table("false_hands", title, columns, tuple(rows))
