"""Tables of how hands in whole frames were found and read."""

from collections.abc import Sequence

from lightgesture.benchmarks.finding.regions import MAX_BOXES, SCRIPTS, SINGLE, Answer, Run
from lightgesture.benchmarks.scorer import is_token, matched_readings, share
from lightgesture.benchmarks.tables import Cell, Table

SEEN = {
    "webcam train": "pictures",
    "subhi": "pictures",
    "subhi_26": "person",
    "subhi_46": "person",
    "funie": "pictures",
    "rov25_reef": "pictures",
    "u45": "pictures",
}
"""Groups that the shipped models know: their very pictures, or other pictures of the same people."""


def seen_word(run: Run) -> str:
    """What the models of a run were trained on that its group shows."""
    return SEEN.get(run.group, "no") if run.seen is None else run.seen


RUN_COLUMNS = ("method", "group", "seen", "mode")
"""What every row says of its run."""
FOUND_COLUMNS = (*RUN_COLUMNS, "frames", "hands", "found", "found_share", "mean_iou")
"""Begin every table of hands in frames that show some."""


def run_row(run: Run) -> dict[str, Cell]:
    """The cells of RUN_COLUMNS."""
    return {"method": run.method, "group": run.group, "seen": seen_word(run), "mode": run.mode}


def found_row(run: Run) -> dict[str, Cell]:
    """The cells of FOUND_COLUMNS, and of what else a table of found hands may tell: sides and boxes on no hand."""
    score = run.score
    return {
        **run_row(run),
        "frames": score.frames,
        "hands": score.hands,
        "found": score.found,
        "found_share": share(score.found, score.hands),
        "mean_iou": score.mean_iou,
        "sides": score.sides,
        "side_share": share(score.sides_right, score.sides),
        "extra": score.extra,
    }


def false_counts(answers: Sequence[Answer]) -> dict[str, Cell]:
    """Frames without a hand, and those of them in which any hand, or a pair, was found."""
    return {
        "frames": len(answers),
        "any_hand": sum(bool(answer.readings) for answer in answers),
        "pair": sum(len(answer.readings) == MAX_BOXES for answer in answers),
    }


def regions_table(runs: Sequence[Run]) -> Table:
    """Hands found, tokens, sides and pairs of every run."""
    columns = (
        *(*FOUND_COLUMNS, "side_share"),
        *("tokens", "read", "read_share", "wrong", "pairs", "both", "both_share", "extra"),
    )
    note = (
        f"found: IoU >= 0.5 with the label, at most {MAX_BOXES} boxes a frame; read: found and the right "
        "token; wrong: found and given another token;\n"
        "side_share: sides right among the found; pairs: frames with two hands of known token; both: both "
        "read;\n"
        "extra: boxes on no hand where all hands are labelled; seen: what the shipped models were trained on,"
        "\nwhich says little about other people."
    )
    return Table("regions", "Hands in whole frames", columns, tuple(map(_region_row, runs)), note)


def _region_row(run: Run) -> dict[str, Cell]:
    score = run.score
    return {
        **found_row(run),
        "tokens": score.tokens,
        "read": score.read,
        "read_share": share(score.read, score.tokens),
        "wrong": score.wrong,
        "pairs": score.pairs,
        "both": score.both,
        "both_share": share(score.both, score.pairs),
    }


def tokens_table(runs: Sequence[Run], method: str) -> Table:
    """Hands found and read per group and token, single pictures of one method."""
    rows: list[dict[str, Cell]] = []
    for run in runs:
        if run.mode == SINGLE and run.method == method:
            rows.extend(_token_rows(run))
    columns = ("group", "token", "hands", "found", "read", "read_share")
    return Table("regions_by_token", f"Tokens in single frames ({method})", columns, tuple(rows))


def _token_rows(run: Run) -> list[dict[str, Cell]]:
    counts: dict[str, list[int]] = {}
    for answer in run.answers:
        labels = answer.sample.labels
        for label, (reading, _) in zip(labels, matched_readings(labels, answer.readings), strict=True):
            if label.token is not None and is_token(label.token):
                count = counts.setdefault(label.token, [0, 0, 0])
                count[0] += 1
                count[1] += reading is not None
                count[2] += reading is not None and reading.token == label.token
    return [
        {
            "group": run.group,
            "token": token,
            "hands": hands,
            "found": found,
            "read": read,
            "read_share": share(read, hands),
        }
        for token, (hands, found, read) in sorted(counts.items())
    ]


def instructions_table(runs: Sequence[Run]) -> Table:
    """Instructions issued on the sequences whose instruction is known."""
    rows: list[dict[str, Cell]] = []
    for run in runs:
        if run.decoded is not None and run.group in SCRIPTS:
            expected = SCRIPTS[run.group].instructions
            rows.append(
                {
                    "method": run.method,
                    "sequence": run.group,
                    "hold": run.hold,
                    "expected": "; ".join(expected),
                    "issued": "; ".join(run.decoded.instructions) or "none",
                    "right": "yes" if run.decoded.instructions == expected else "no",
                    "words": ", ".join(run.decoded.words) or "none",
                    "rejected": run.decoded.rejected,
                }
            )
    columns = ("method", "sequence", "hold", "expected", "issued", "right", "words", "rejected")
    return Table("instructions", "Instructions of signed sequences", columns, tuple(rows))


def negatives_table(runs: Sequence[Run]) -> Table:
    """Frames without a gesturing diver in which something was found; words and instructions must be 0."""
    rows: list[dict[str, Cell]] = [
        {
            **run_row(run),
            **false_counts(run.answers),
            "any_token": sum(
                any(reading.token is not None for reading in answer.readings) for answer in run.answers
            ),
            "words": len(run.decoded.words) if run.decoded else None,
            "instructions": len(run.decoded.instructions) if run.decoded else None,
        }
        for run in runs
    ]
    columns = (
        *(*RUN_COLUMNS, "frames"),
        *("any_hand", "pair", "any_token", "words", "instructions"),
    )
    title = "Frames without a gesturing diver: nothing may be found"
    return Table("negatives", title, columns, (*rows, *_negative_totals(rows)))


def _negative_totals(rows: Sequence[dict[str, Cell]]) -> list[dict[str, Cell]]:
    """Sums over the groups of single pictures, one row a method."""
    methods = list(dict.fromkeys(row["method"] for row in rows))
    counted = ("frames", "any_hand", "pair", "any_token")
    totals: list[dict[str, Cell]] = []
    for method in methods:
        members = [row for row in rows if row["method"] == method and row["mode"] == SINGLE]
        sums: dict[str, Cell] = {name: sum(_count(row[name]) for row in members) for name in counted}
        totals.append({"method": method, "group": "all", "mode": SINGLE, **sums})
    return totals


def _count(cell: Cell) -> int:
    return cell if isinstance(cell, int) else 0
