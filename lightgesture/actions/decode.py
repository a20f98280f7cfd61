"""What `decode` does: inputs through the pipeline, records to standard output and to files.

`lightgesture.archive` has the parts: what an input is, who decodes it, the folder of results and what is told.
"""

import importlib.util
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from lightgesture.archive.board import Board, table
from lightgesture.archive.dives import refuse_foreign, write_dives
from lightgesture.archive.folder import ArchiveFolder, open_archive_folder
from lightgesture.archive.tasks import Done, Hear, Message, Outcome, Task, make_tasks
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import one_line, say, write_message
from lightgesture.errors import ExitStatus, UsageError
from lightgesture.results import WRITERS
from lightgesture.results.ownership import ANNOTATED

SAMPLE = Path(__file__).resolve().parents[1] / "data" / "sample.mp4"
"""The bundled clip, decoded where no input is named."""


def decode(inputs: Sequence[str], settings: DecodeSettings) -> ExitStatus:
    """Decode every input; none: the bundled clip.

    An input that fails is told on standard error and the others go on. UsageError: the model, the grammar
    or an output folder is wrong, or an option needs a package that is not there.
    """
    _check(settings)
    tasks = _tasks(inputs, settings)
    _keep_out_of_inputs(tasks, settings)
    with open_archive_folder(settings) as folder:
        known = {task.place: folder.look_up(task) for task in tasks} if folder else {}
        waiting = [task for task in tasks if known.get(task.place) is None]
        if folder is not None:
            folder.refuse_to_replace(waiting, _suffixes(settings))
            refuse_foreign(folder.path)
        with _table_written(folder), Board(tasks, settings.quiet) as board:

            def hear(message: Message) -> None:
                # Noted before it is told: what the user has seen is not done again.
                if folder is not None and isinstance(message, Done):
                    folder.remember(tasks[message.place], message.outcome)
                board.hear(message)

            for place, outcome in known.items():
                if outcome is not None:
                    board.hear(Done(place, outcome))
            _execute(waiting, settings, hear)
    if not settings.quiet:
        _tell(tasks, board.outcomes)
    is_failed = any(outcome.status == "failed" for outcome in board.outcomes.values())
    return ExitStatus.SOME_FAILED if is_failed else ExitStatus.OK


@contextmanager
def _table_written(folder: ArchiveFolder | None) -> Iterator[None]:
    """Write the table over all inputs of a folder after the block, also where it was interrupted."""
    try:
        yield
    finally:
        if folder is not None:
            write_dives(folder.path)


def usable_cores() -> int:
    """Cores that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on every system
        return os.cpu_count() or 1


def _check(settings: DecodeSettings) -> None:
    for option, is_chosen in (("annotate", settings.is_annotated), ("plot", settings.plot)):
        if is_chosen and not settings.out:
            raise UsageError(
                f"--{option}: its file lies beside the other results; name a folder with --out DIR"
            )
    if settings.plot and importlib.util.find_spec("matplotlib") is None:
        raise UsageError("--plot needs matplotlib; pip install 'lightgesture[plots]'")


def _tasks(inputs: Sequence[str], settings: DecodeSettings) -> list[Task]:
    def tell(text: str) -> None:
        if not settings.quiet:
            say(text)

    if inputs:
        return make_tasks(inputs, recursive=settings.recursive, join=settings.join, tell=tell)
    tell("no input named; decoding the bundled clip")
    return [Task(0, str(SAMPLE), SAMPLE.name, SAMPLE.stem)]


def _keep_out_of_inputs(tasks: Sequence[Task], settings: DecodeSettings) -> None:
    """UsageError: pictures of stages would come among the frames of an input."""
    if not settings.debug_dir:
        return
    for task in tasks:
        folder = os.path.join(settings.debug_dir, task.stem)
        if os.path.isdir(folder) and os.path.isdir(task.path) and os.path.samefile(folder, task.path):
            raise UsageError(f"--debug-dir {settings.debug_dir}: {folder} is an input; name another folder")


def _suffixes(settings: DecodeSettings) -> list[str]:
    """Of the files that each input gets."""
    chosen = {ANNOTATED: settings.is_annotated, ".png": settings.plot}
    return [*WRITERS, *(suffix for suffix, is_chosen in chosen.items() if is_chosen)]


def _execute(tasks: Sequence[Task], settings: DecodeSettings, hear: Hear) -> None:
    """Here, in worker processes, or on a cluster."""
    encoding = sys.stdout.encoding or "utf-8"
    is_piped = any(task.is_standard_input for task in tasks)
    jobs = 1 if is_piped else min(settings.jobs or usable_cores(), len(tasks))
    if not tasks:
        return
    if settings.cluster:
        if is_piped:
            raise UsageError("-: standard input reaches no other machine; leave out --cluster")
        from lightgesture.archive.cluster import run_on_cluster

        run_on_cluster(tasks, settings, encoding, settings.cluster, hear)
    elif jobs > 1:
        from lightgesture.archive.workers import run_in_processes

        run_in_processes(tasks, settings, encoding, jobs, hear)
    else:
        from lightgesture.archive.runner import Runner

        runner = Runner(settings, encoding)
        for task in tasks:
            hear(Done(task.place, runner.run(task, hear)))


def _tell(tasks: Sequence[Task], outcomes: dict[int, Outcome]) -> None:
    before = sum(outcome.status == "done before" for outcome in outcomes.values())
    if before:
        say(f"{before} of {len(tasks)} inputs done before and unchanged; not decoded again")
    if len(tasks) > 1:
        for line in table(tasks, outcomes):
            write_message(one_line(line))
