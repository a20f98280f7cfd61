"""Inputs in worker processes, one a worker at a time.

Not an executor of the standard library: there one crash, and a damaged video can crash a decoder of videos, takes
every other input with it, and progress needs a second channel. Here each worker has a pipe; one that dies costs its own
input, and a fresh one takes its place.
"""

import multiprocessing
import os
import signal
import threading
import time
import traceback
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnContext

from lightgesture.archive.runner import Runner
from lightgesture.archive.tasks import Advanced, Done, Hear, Message, Outcome, Printed, Task
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import messages_shown
from lightgesture.errors import UsageError
from lightgesture.interruption import terminated_as_interrupted

REPORT_INTERVAL_S = 0.2
"""Seconds from one report of a worker to the next: quick for an eye, nothing for a pipe."""

STOP_S = 10.0
"""Seconds that a worker has to clean up after it was told to stop; then it is killed."""


def run_in_processes(
    tasks: Sequence[Task], settings: DecodeSettings, encoding: str, jobs: int, hear: Hear
) -> None:
    """Decode the tasks in at most `jobs` processes.

    UsageError: a worker met one. RuntimeError: a worker met a fault of this program. Whatever is raised, an
    interruption included, the workers are gone when this returns.
    """
    waiting = deque(tasks)
    crew: list[_Worker] = []
    try:
        for _ in range(min(jobs, len(tasks))):
            crew.append(_Worker(settings, encoding))
            crew[-1].give(waiting.popleft())
        while busy := [worker for worker in crew if worker.task is not None]:
            ready = wait([worker.connection for worker in busy])
            for worker in busy:
                if worker.connection in ready and _listen(worker, hear) and waiting:
                    if not worker.is_alive:
                        crew[crew.index(worker)] = worker = _Worker(settings, encoding)
                    worker.give(waiting.popleft())
    finally:
        _stop(crew)


class _Worker:
    """A process with its pipe, and the task that it has."""

    def __init__(self, settings: DecodeSettings, encoding: str) -> None:
        context: SpawnContext = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, settings, encoding), daemon=True)
        self.process.start()
        theirs.close()  # else the end of the process would not close the pipe
        self.task: Task | None = None
        self.is_alive = True

    def give(self, task: Task) -> None:
        self.task = task
        with suppress(OSError):  # one that is dead already is noticed when it is listened to
            self.connection.send(task)


def _listen(worker: _Worker, hear: Hear) -> bool:
    """Pass the next message on; whether the worker's task is over."""
    task = worker.task
    if task is None:
        return False
    try:
        message = worker.connection.recv()
    except (EOFError, OSError):
        worker.process.join(STOP_S)
        worker.connection.close()
        worker.task, worker.is_alive = None, False
        hear(Done(task.place, Outcome("failed", _obituary(task, worker.process.exitcode))))
        return True
    if isinstance(message, Exception):
        raise message
    hear(message)
    if isinstance(message, Done):
        worker.task = None
        return True
    return False


def _obituary(task: Task, code: int | None) -> str:
    reason = f"signal {-code}" if code is not None and code < 0 else f"status {code}"
    return (
        f"{task.name}: the process that decoded it ended ({reason}); "
        "the file may be damaged or the memory too small: run again, or with fewer --jobs"
    )


def _stop(crew: Sequence[_Worker]) -> None:
    """Idle workers end by themselves, busy ones clean up first; one that does not is killed."""
    for worker in crew:
        if worker.task is not None:
            worker.process.terminate()
        worker.connection.close()
    deadline = time.monotonic() + STOP_S
    for worker in crew:
        worker.process.join(max(0.0, deadline - time.monotonic()))
        if worker.process.is_alive():
            worker.process.kill()
            worker.process.join()


class _Reporter:
    """Sends messages in bundles, a few a second."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._lines: list[str] = []
        self._frames = 0
        self._sent_s = time.monotonic()

    def hear(self, message: Message) -> None:
        match message:
            case Printed():
                self._lines += message.lines
            case Advanced():
                self._frames += message.frames
            case _:
                self.flush(message.place)
                self._connection.send(message)
        if time.monotonic() - self._sent_s >= REPORT_INTERVAL_S:
            self.flush(message.place)

    def flush(self, place: int) -> None:
        if self._lines:
            self._connection.send(Printed(place, tuple(self._lines)))
        if self._frames:
            self._connection.send(Advanced(place, self._frames))
        self._lines, self._frames = [], 0
        self._sent_s = time.monotonic()


def _serve(connection: Connection, settings: DecodeSettings, encoding: str) -> None:
    """The life of a worker: tasks from the pipe until it is closed."""
    import cv2

    signal.signal(
        signal.SIGINT, signal.SIG_IGN
    )  # Ctrl-C reaches the whole group; the parent tells what to do
    cv2.setNumThreads(1)
    runner, reporter = Runner(settings, encoding), _Reporter(connection)
    try:
        with terminated_as_interrupted(), messages_shown():
            threading.Thread(target=_die_with_parent, daemon=True).start()
            while True:
                task = connection.recv()
                reporter.hear(Done(task.place, runner.run(task, reporter.hear)))
    except UsageError as error:
        _send(connection, error)
    except (KeyboardInterrupt, EOFError, OSError):  # told to stop, or nobody is at the other end any more
        pass
    except Exception:
        _send(connection, RuntimeError(traceback.format_exc()))


def _send(connection: Connection, error: Exception) -> None:
    with suppress(OSError):
        connection.send(error)


def _die_with_parent() -> None:
    """When the parent has died without a word, stop as if told to, with all clean-ups."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    parent.join()
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(STOP_S)
    os._exit(1)
