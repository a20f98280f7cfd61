"""Exit statuses, and the two errors that a user can mend: each text is one line: what, why, what to do."""

import errno
import sys
import traceback
from enum import IntEnum
from pathlib import Path
from typing import Final


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


MEMORY_SIGNS: Final = (
    "cannot allocate memory",
    "failed to map segment",
    "insufficient memory",
    "unable to allocate",
    "bad_alloc",
)
"""What libraries say, in small letters, where the system gives them no more memory."""


def is_out_of_memory(error: BaseException) -> bool:
    """Whether the memory was too small, whoever noticed: Python, NumPy, OpenCV, a library that could not be loaded."""
    if isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno == errno.ENOMEM):
        return True
    return any(sign in str(error).lower() for sign in MEMORY_SIGNS)


def defect_of(error: Exception) -> str:
    """One line for an error that nobody foresaw: what it was and where; Python's development mode raises it again.

    Where the memory was too small it says so, for that is no defect.
    """
    if sys.flags.dev_mode:
        raise error
    last = traceback.extract_tb(error.__traceback__)[-1]
    what = " ".join(f"{type(error).__name__}: {error}".split())
    if is_out_of_memory(error):
        return f"the memory is too small ({what}); end other programs, raise the limit, or use fewer --jobs"
    return (
        f"broke off at a defect ({what}; {Path(last.filename).name}, line {last.lineno}); "
        "report it with this line; python -X dev -m lightgesture shows the way there"
    )
