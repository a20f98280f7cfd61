"""Files that are there whole or not at all."""

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from lightgesture.errors import UsageError


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary name beside `path` to write to, and rename it to `path` when the block ends well.

    After an exception, an interruption included, the temporary file is gone and `path` is as it was.
    Missing folders are made. UsageError: the place cannot be written.
    """
    # A name of its own, for one made from that of `path` could be too long for the file system.
    temporary = path.with_name(f".{uuid.uuid4().hex}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield temporary
        os.replace(temporary, path)
    except OSError as error:
        raise UsageError(f"{path}: cannot be written ({error.strerror}); name another folder") from error
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
