"""Tables of the scenario suite: how many instructions and gestures came through, by suite and by difficulty."""

from collections.abc import Callable, Sequence

from lightgesture.benchmarks.scorer import share
from lightgesture.benchmarks.suite.run import ClipAnswer
from lightgesture.benchmarks.suite.scenarios import FPS
from lightgesture.benchmarks.suite.scoring import SuiteScore
from lightgesture.benchmarks.tables import Cell, Table

NOTE = (
    "right: issued as signed; wrong: issued and not signed, which must be 0; readable: what a flawless reader of every "
    "frame gets;\ngestures: signed words, one pair of hands each, and those accepted in their place; found: hands that "
    "show a token, IoU >= 0.5;\nread, side: of these hands with the right token, of the found on the right side; "
    "delay: median seconds from a sign's\nfirst frame to its acceptance (a flawless reader needs 0.467)."
)


def all_tables(answers: Sequence[ClipAnswer], method: str) -> list[Table]:
    """Every method by suite, then one method by difficulty and clip; tables without rows are left out."""
    tables = [suite_table(answers), difficulty_table(answers, method), clips_table(answers, method)]
    return [table for table in tables if table.rows]


def suite_table(answers: Sequence[ClipAnswer]) -> Table:
    """One row per method and suite."""
    rows = _rows(answers, lambda answer: (answer.method, answer.scenario.suite))
    return _table("suite", "Scenario suite", rows, ("method", "suite"))


def difficulty_table(answers: Sequence[ClipAnswer], method: str) -> Table:
    """One row per suite and difficulty, for one method."""
    own = [answer for answer in answers if answer.method == method]
    rows = _rows(own, lambda answer: (answer.scenario.suite, answer.scenario.difficulty))
    return _table(
        "suite_by_difficulty", f"Scenario suite by difficulty ({method})", rows, ("suite", "difficulty")
    )


def clips_table(answers: Sequence[ClipAnswer], method: str) -> Table:
    """What one method made of every clip in which it did not issue exactly what was signed."""
    rows: list[dict[str, Cell]] = [
        {
            "clip": answer.scenario.name,
            "difficulty": answer.scenario.difficulty,
            "signed": " ".join(answer.scenario.sentences),
            "issued": "; ".join(answer.decoded.instructions) or "none",
            "words": " ".join(answer.decoded.words) or "none",
        }
        for answer in answers
        if answer.method == method
        and (answer.score.missed or answer.score.wrong or answer.score.gestures_wrong)
    ]
    columns = ("clip", "difficulty", "signed", "issued", "words")
    return Table("suite_clips", f"Clips not decoded as signed ({method})", columns, tuple(rows))


def _rows(
    answers: Sequence[ClipAnswer], key: Callable[[ClipAnswer], tuple[str, str]]
) -> dict[tuple[str, str], SuiteScore]:
    scores: dict[tuple[str, str], SuiteScore] = {}
    for answer in answers:
        scores[key(answer)] = scores.get(key(answer), SuiteScore()) + answer.score
    return scores


def _table(name: str, title: str, scores: dict[tuple[str, str], SuiteScore], keys: tuple[str, str]) -> Table:
    columns = (
        *(*keys, "clips", "seconds", "instructions", "readable", "right", "missed", "wrong", "rejected"),
        *("gestures", "gestures_right", "gestures_wrong", "found", "read", "side", "switches", "delay"),
    )
    rows = tuple({**dict(zip(keys, key, strict=True)), **_cells(score)} for key, score in scores.items())
    return Table(name, title, columns, rows, NOTE)


def _cells(score: SuiteScore) -> dict[str, Cell]:
    hands = score.hands
    return {
        "clips": score.clips,
        "seconds": round(score.frames / FPS),
        "instructions": score.instructions,
        "readable": score.readable,
        "right": score.right,
        "missed": score.missed,
        "wrong": score.wrong,
        "rejected": score.rejected,
        "gestures": score.gestures,
        "gestures_right": score.gestures_right,
        "gestures_wrong": score.gestures_wrong,
        "found": share(hands.found, hands.hands),
        "read": share(hands.read, hands.tokens),
        "side": share(hands.sides_right, hands.sides),
        "switches": score.switches,
        "delay": score.median_delay,
    }
