"""Files that somebody else wrote, read once, whole, and within bounds.

What is looked at afterwards is in memory, so that a file which is replaced or written to meanwhile cannot be one thing
when it is checked and another when it is used.
"""

import errno
import os
import stat
from pathlib import Path


class FileRefusedError(OSError):
    """A file that is not read, for what it is and not for what the system says: `strerror` is the reason."""


def read_whole(file: str | os.PathLike[str], most_bytes: int) -> bytes:
    """The content of a regular file of at most `most_bytes` bytes.

    Raises OSError: it cannot be opened or read. FileRefusedError, one of these: it is no regular file (a pipe would be
    waited for), is larger, or was written to while it was read.
    """
    path = Path(file)
    with open(path, "rb", opener=_opener) as stream:
        before = os.fstat(stream.fileno())
        if not stat.S_ISREG(before.st_mode):
            raise FileRefusedError(errno.EINVAL, "is no regular file")
        if before.st_size > most_bytes:
            raise FileRefusedError(errno.EFBIG, f"is larger than {_size(most_bytes)}")
        # A byte more than there is, so that one that grows is seen to. Room is made for all that is asked for.
        content = stream.read(before.st_size + 1)
        after = os.fstat(stream.fileno())
    is_same = (before.st_size, before.st_mtime_ns) == (after.st_size, after.st_mtime_ns)
    if not is_same or len(content) != after.st_size:
        raise FileRefusedError(errno.EAGAIN, "changed while it was read; read it again when it is whole")
    return content


def _opener(path: str, flags: int) -> int:
    """Opens without waiting for a writer, which a pipe may never have."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _size(number: int) -> str:
    return f"{number >> 20} MiB" if number >= 1 << 20 else f"{number} bytes"
