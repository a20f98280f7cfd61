"""Inputs on a Dask cluster: the same map as in worker processes, over the machines of a scheduler.

The machines see inputs, models and the folder of results under the same paths, as on a shared file system, and have the
same version of this package. A worker that dies is no loss: the scheduler gives its input to another.
"""

import logging
import os
import threading
import uuid
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from lightgesture.archive.runner import Runner
from lightgesture.archive.tasks import Advanced, Done, Hear, Message, Outcome, Task
from lightgesture.config.settings import DecodeSettings, change_paths
from lightgesture.console import messages_shown
from lightgesture.errors import InputError, UsageError

CONNECT_S = 10.0
"""Seconds that a scheduler has to answer, and one of its workers to be there."""

_kept = threading.local()
"""Each thread of a Dask worker keeps its own runner: the nets are not to be shared by threads."""


def run_on_cluster(
    tasks: Sequence[Task], settings: DecodeSettings, encoding: str, address: str, hear: Hear
) -> None:
    """Decode the tasks on the workers of the scheduler at `address`.

    UsageError: Dask is not there, no scheduler answers, or a worker met one. InputError: the scheduler was lost on the
    way; what was heard of by then is done.
    """
    settings = _absolute(settings)
    with _logging_off(), _connect(address) as client, _loss_told(address):
        from dask.distributed import as_completed

        run = uuid.uuid4().hex
        futures = {
            client.submit(
                _decode,
                task.absolute(),
                settings,
                encoding,
                key=f"lightgesture-{run}-{task.place}",
                pure=False,
            ): task
            for task in tasks
        }
        try:
            for future in as_completed(list(futures), loop=client.loop):
                for message in _result(future, futures[future]):
                    hear(message)
                future.release()
        finally:
            client.cancel(list(futures))


def _decode(task: Task, settings: DecodeSettings, encoding: str) -> list[Message]:
    """Runs on a worker: all messages of one input."""
    if getattr(_kept, "key", None) != (settings, encoding):
        _kept.key, _kept.runner = (settings, encoding), Runner(settings, encoding)
    messages: list[Message] = []

    def hear(message: Message) -> None:
        # Nobody sees them before the end: the frames are told in one.
        if not isinstance(message, Advanced):
            messages.append(message)

    with messages_shown():
        outcome = _kept.runner.run(task, hear)
    return [*messages, Advanced(task.place, outcome.frames), Done(task.place, outcome)]


def _result(future: Any, task: Task) -> list[Message]:
    from dask.distributed import KilledWorker

    try:
        messages: list[Message] = future.result()
    except KilledWorker:
        text = (
            f"{task.name}: every worker that decoded it died; the file may be damaged or the memory too small"
        )
        return [Done(task.place, Outcome("failed", text))]
    return messages


@contextmanager
def _connect(address: str) -> Iterator[Any]:
    try:
        from dask.distributed import Client
    except ImportError:
        raise UsageError("--cluster needs Dask; pip install 'lightgesture[cluster]'") from None
    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError, TimeoutError):
        raise UsageError(
            f"--cluster: no scheduler answers at {address}; check the address, such as tcp://HOST:8786"
        ) from None
    with client:
        try:
            client.wait_for_workers(1, timeout=CONNECT_S)
        except TimeoutError:
            raise UsageError(f"--cluster: the scheduler at {address} has no worker; start one") from None
        yield client


@contextmanager
def _loss_told(address: str) -> Iterator[None]:
    """InputError where the scheduler goes away meanwhile: Dask cancels all that was asked for then."""
    from dask.distributed import CancelledError

    try:
        yield
    except CancelledError:
        raise InputError(
            f"--cluster: the scheduler at {address} was lost; the results of finished inputs are kept: run again when "
            "it is back"
        ) from None


@contextmanager
def _logging_off() -> Iterator[None]:
    """Dask logs how it tried to reach a scheduler that went away, some thirty lines; ours says the same in one."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(before)


def _absolute(settings: DecodeSettings) -> DecodeSettings:
    """The settings with paths that hold in any folder; names of built-in models stay."""
    return settings.model_copy(update=change_paths(settings.model_dump(), os.path.abspath))
