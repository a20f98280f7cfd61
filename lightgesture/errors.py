"""Exit statuses, and the two errors that a user can mend: each text is one line: what, why, what to do."""

import sys
import traceback
from enum import IntEnum
from pathlib import Path


class ExitStatus(IntEnum):
    """Exit status of the command line; the shell's own convention for an interruption."""

    OK = 0
    SOME_FAILED = 1
    USAGE = 2
    INTERRUPTED = 130


class InputError(Exception):
    """One input cannot be read, or not to its end. The other inputs go on; exit status 1."""


class UsageError(Exception):
    """Wrong use or configuration: an option, a model, a grammar, an output folder. Exit status 2."""


def reason_of(error: BaseException) -> str:
    """What the system or a library says went wrong, for the brackets of a message; never empty."""
    return str(getattr(error, "strerror", None) or error or type(error).__name__)


def defect_of(error: Exception) -> str:
    """One line for an error that nobody foresaw: what it was and where; Python's development mode raises it again."""
    if sys.flags.dev_mode:
        raise error
    last = traceback.extract_tb(error.__traceback__)[-1]
    what = " ".join(f"{type(error).__name__}: {error}".split())
    return (
        f"broke off at a defect ({what}; {Path(last.filename).name}, line {last.lineno}); "
        "report it with this line; python -X dev -m lightgesture shows the way there"
    )
