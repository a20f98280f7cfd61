"""Where a target puts what it is fed, and what counts as a refusal."""

import atexit
import os
import shutil
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

from lightgesture.console import one_line
from lightgesture.errors import InputError, UsageError
from lightgesture.features.archive import ArchiveError
from lightgesture.features.find.selector_file import SelectorError
from lightgesture.features.motion.shapes import ShapesError
from lightgesture.features.net.network import NetworkError
from lightgesture.features.profile import ProfileError
from lightgesture.fsm import GrammarError
from lightgesture.models import ModelError

from .engines import MEMORY

REFUSALS = (
    ArchiveError,
    GrammarError,
    InputError,
    ModelError,
    NetworkError,
    ProfileError,
    SelectorError,
    ShapesError,
    UsageError,
)
"""The project's own errors: the command line prints each as one line."""

LONGEST_MESSAGE = 2000
"""Characters of a refusal; a longer one hands the input back to whoever reads it."""


class FaultError(AssertionError):
    """Something that a target does not say in the way it must."""


@cache
def folder() -> Path:
    """A folder of this process, in memory where there is such a place."""
    path = Path(tempfile.mkdtemp(prefix="fuzz-", dir=MEMORY if os.access(MEMORY, os.W_OK) else None))
    atexit.register(shutil.rmtree, path, ignore_errors=True)
    return path


def file_of(content: bytes, name: str) -> Path:
    """A file with this content."""
    path = folder() / name
    path.write_bytes(content)
    return path


def clean(name: str) -> Path:
    """An empty folder of this name."""
    path = folder() / name
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir()
    return path


def feed(run: Callable[[bytes], None], content: bytes) -> bool:
    """Whether a target took the content; False: it refused it in one line. Anything else is raised."""
    try:
        run(content)
    except REFUSALS as error:
        text = one_line(str(error))
        if not text or len(text) > LONGEST_MESSAGE:
            raise FaultError(f"{type(error).__name__} of {len(text)} characters: {text[:200]!r}") from error
        return False
    return True
