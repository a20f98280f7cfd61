"""What can be plugged into the loop to see pictures with what was read in them."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lightgesture.records import Record


class Listener(Protocol):
    """Is shown every processed picture; a page for a browser is one."""

    def show(self, image_bgr: NDArray[np.uint8] | None, records: Sequence[Record]) -> None:
        """Take note of a picture and its records, at once: the decoder waits for this call.

        image_bgr: uint8 (height, width, 3), BGR; it may be kept, but not changed. None for records that belong to no
        picture: heartbeats, and at the end what was pending and the summary. records: the frame record first, given
        also where the user wants none in the results, then what the picture led to.
        """
        ...
