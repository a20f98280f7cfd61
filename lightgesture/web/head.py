"""The head of a request, read within bounds of size and time, whatever the other side does."""

import re
import socket
import time
from http import HTTPStatus
from typing import Final

from lightgesture.web.door import Refusal

HEAD_BYTES: Final = 16 * 1024
"""Largest head of a request: its line and headers."""

HEAD_S: Final = 5.0
"""Seconds in which the whole head must have come: a byte now and then does not hold a place ("slow loris")."""

_END: Final = re.compile(rb"\r?\n\r?\n")
_READ_BYTES: Final = 4096


def read_head(link: socket.socket) -> bytes | Refusal:
    """What came up to the blank line, or to the end of what the other side sends. Nothing where that is nothing.

    Raises OSError where the connection breaks off.
    """
    head, end_s = b"", time.monotonic() + HEAD_S
    while _END.search(head, max(0, len(head) - _READ_BYTES - 4)) is None:
        link.settimeout(max(end_s - time.monotonic(), 0.001))
        try:
            part = link.recv(_READ_BYTES)
        except TimeoutError:
            if not head:
                return b""
            return Refusal(HTTPStatus.REQUEST_TIMEOUT, f"the request was not whole after {HEAD_S:g} s")
        if not part:
            break
        head += part
        if len(head) > HEAD_BYTES:
            text = f"the request's head has more than {HEAD_BYTES} bytes"
            return Refusal(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE, text)
    return head
