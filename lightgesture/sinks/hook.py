"""A command that is run for each accepted instruction."""

import os
import shlex
import shutil
import signal
import subprocess
import sys
from contextlib import suppress
from typing import Final

from lightgesture.errors import UsageError
from lightgesture.fsm import Instruction
from lightgesture.records import Record
from lightgesture.results import to_json_line
from lightgesture.sinks.outbox import RecordError, Sink

TIMEOUT_S: Final = 5.0
"""Seconds after which a command that is still running is killed; the next one waits for it."""


class HookSink(Sink):
    """Runs a command, without a shell, with the record as one line of JSON on its standard input.

    Its standard output goes nowhere, for ours belongs to the records; its standard error is ours. A command that
    fails is reported and not repeated, since it may have done half of its work.
    place: where it was named, for messages. UsageError when made: there is no such command.
    """

    def __init__(self, command: str, place: str = "--hook") -> None:
        self.name = f"hook {command}"
        self._words = _split(command, place)

    def wants(self, record: Record) -> bool:
        """Accepted instructions only."""
        return isinstance(record, Instruction)

    def send(self, record: Record) -> None:
        """Run the command. RecordError: it could not be started, failed, or took too long."""
        line = (to_json_line(record) + "\n").encode("utf-8", "surrogateescape")
        try:
            # A group of its own, so that what the command has started can be ended with it.
            with subprocess.Popen(
                self._words,
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=_standard_error(),
                start_new_session=True,
            ) as process:
                _talk(process, line)
        except subprocess.TimeoutExpired:
            raise RecordError(f"{self.name}: killed after {TIMEOUT_S:g} s") from None
        except OSError as error:
            raise RecordError(f"{self.name}: cannot be run ({error.strerror})") from None
        if process.returncode:
            raise RecordError(f"{self.name}: failed with status {process.returncode}")


def _standard_error() -> int | None:
    """Ours, which need not be descriptor 2: that one is muted while native libraries run."""
    try:
        return sys.stderr.fileno()
    except (OSError, ValueError, AttributeError):
        return None


def _talk(process: "subprocess.Popen[bytes]", line: bytes) -> None:
    try:
        process.communicate(line, TIMEOUT_S)
    except subprocess.TimeoutExpired:
        with suppress(OSError):
            os.killpg(process.pid, signal.SIGKILL)
        raise


def _split(command: str, place: str) -> list[str]:
    try:
        words = shlex.split(command)
    except ValueError as error:
        raise UsageError(
            f"{place} {command}: cannot be split into words ({error}); close the quotes"
        ) from None
    if not words or shutil.which(words[0]) is None:
        raise UsageError(f"{place} {command}: no such command; name a program that can be run")
    return words
