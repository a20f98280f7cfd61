"""What the user sees of many inputs: results in the order of the inputs, progress, a table at the end."""

from collections import defaultdict
from collections.abc import Sequence
from typing import Any, Self

from lightgesture.archive.tasks import Advanced, Done, Message, Opened, Outcome, Printed, Remarked, Task
from lightgesture.console import Bars, fail, one_line, print_line, warn


class Board:
    """Hears the messages of all inputs and shows them.

    Lines of results and errors come in the order of the inputs, whoever is done first: those of the first input that
    is not finished at once, those of later ones when their turn comes.
    """

    def __init__(self, tasks: Sequence[Task], quiet: bool) -> None:
        self._tasks = list(tasks)
        self._turn = 0
        self._lines: dict[int, list[str]] = defaultdict(list)
        self._frames: dict[int, int | None] = {}
        self._bars = Bars(quiet)
        self._of_task: dict[int, Any] = {}
        self._of_all: Any = None
        self._remarks: set[str] = set()
        self._quiet = quiet
        self.outcomes: dict[int, Outcome] = {}

    def __enter__(self) -> Self:
        if len(self._tasks) > 1:
            self._of_all = self._bars.add("all inputs", None)
        return self

    def __exit__(self, *reason: object) -> None:
        self._bars.close()

    def hear(self, message: Message) -> None:
        """Take in the next message."""
        match message:
            case Opened():
                self._frames[message.place] = message.frames
                self._of_task[message.place] = self._bars.add(self._tasks[message.place].name, message.frames)
                self._estimate()
            case Advanced():
                self._bars.advance(self._of_task.get(message.place), message.frames)
                self._bars.advance(self._of_all, message.frames)
            case Printed():
                self._lines[message.place] += message.lines
            case Remarked():
                if not self._quiet and message.text not in self._remarks:
                    warn(message.text)
                self._remarks.add(message.text)
            case Done():
                self.outcomes[message.place] = message.outcome
                self._bars.remove(self._of_task.pop(message.place, None))
                self._frames[message.place] = message.outcome.frames
                self._estimate()
        self._show()

    def _show(self) -> None:
        while self._turn < len(self._tasks):
            for line in self._lines.pop(self._turn, ()):
                with self._bars.away():
                    print_line(line)
            outcome = self.outcomes.get(self._turn)
            if outcome is None:
                return
            if outcome.message is not None:
                with self._bars.away():
                    fail(outcome.message)
            self._turn += 1

    def _estimate(self) -> None:
        """Frames in all: those that are known, and for every other input their mean."""
        known = [frames for frames in self._frames.values() if frames is not None]
        if known:
            unknown = len(self._tasks) - len(known)
            self._bars.set_total(self._of_all, round(sum(known) * (1 + unknown / len(known))))


def table(tasks: Sequence[Task], outcomes: dict[int, Outcome]) -> list[str]:
    """The summary of all inputs, a line each, then their totals."""
    rows = [("input", "frames", "instructions", "rejected", "frames/s", "status")]
    rows += [_row(task.name, outcomes[task.place]) for task in tasks if task.place in outcomes]
    done = list(outcomes.values())
    failed = sum(outcome.status == "failed" for outcome in done)
    total = Outcome(
        "failed" if failed else "ok",
        frames=sum(outcome.frames for outcome in done),
        instructions=sum(outcome.instructions for outcome in done),
        rejected=sum(outcome.rejected for outcome in done),
    )
    rows.append((*_row(f"{len(done)} inputs", total)[:-1], f"{failed} failed" if failed else "ok"))
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    return [_line(row, widths) for row in rows]


def _row(name: str, outcome: Outcome) -> tuple[str, str, str, str, str, str]:
    is_timed = outcome.seconds > 0 and outcome.frames > 0
    rate = f"{outcome.frames / outcome.seconds:.1f}" if is_timed else "-"
    numbers = str(outcome.frames), str(outcome.instructions), str(outcome.rejected)
    return one_line(name), *numbers, rate, outcome.status


def _line(row: Sequence[str], widths: Sequence[int]) -> str:
    numbers = "  ".join(text.rjust(width) for text, width in zip(row[1:-1], widths[1:-1], strict=True))
    return f"{row[0].ljust(widths[0])}  {numbers}  {row[-1]}"
