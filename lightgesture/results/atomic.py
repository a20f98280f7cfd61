"""Files and folders that are there whole or not at all."""

import errno
import os
import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from lightgesture.errors import UsageError


@contextmanager
def replacing(path: Path, suffix: str = "") -> Iterator[Path]:
    """Give a temporary name beside `path` to write to, and rename it to `path` when the block ends well.

    suffix: ending of the temporary name, for a writer that chooses its format by it. After an exception, an
    interruption included, the temporary file is gone and `path` is as it was. The content is on the disk before it has
    its name, and the name before this returns, so that a loss of power leaves all of it or nothing, and takes away
    nothing that was told to be there. Missing folders are made. UsageError: the place cannot be written.
    """
    temporary = _temporary(path, suffix)
    with _told(path):
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            yield temporary
            _sync(temporary)
            os.replace(temporary, path)
            _sync_folder(path.parent)
        finally:
            with suppress(OSError):
                temporary.unlink(missing_ok=True)


@contextmanager
def replacing_folder(path: Path) -> Iterator[Path]:
    """Likewise a new, empty folder, which takes the place of `path` and all that is in it.

    Where another process has put one there meanwhile, that one stays.
    """
    temporary = _temporary(path)
    with _told(path):
        try:
            temporary.mkdir(parents=True)
            yield temporary
            for file in temporary.rglob("*"):
                if file.is_file():
                    _sync(file)
                elif file.is_dir():
                    _sync_folder(file)
            _sync_folder(temporary)
            shutil.rmtree(path, ignore_errors=True)
            try:
                os.replace(temporary, path)
                _sync_folder(path.parent)
            except OSError as error:
                if error.errno not in (errno.ENOTEMPTY, errno.EEXIST):
                    raise
        finally:
            shutil.rmtree(temporary, ignore_errors=True)


def _temporary(path: Path, suffix: str = "") -> Path:
    # A name of its own, for one made from that of `path` could be too long for the file system.
    return path.with_name(f".{uuid.uuid4().hex}.part{suffix}")


def _sync(file: Path) -> None:
    with open(file, "r+b") as stream:
        os.fsync(stream.fileno())


def _sync_folder(folder: Path) -> None:
    """Put the names in a folder on the disk, where the system can: Windows opens no folder, some systems refuse."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:
        return
    try:
        os.fsync(handle)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP, errno.EBADF):
            raise
    finally:
        os.close(handle)


@contextmanager
def _told(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise UsageError(f"{path}: cannot be written ({error.strerror}); name another folder") from error
