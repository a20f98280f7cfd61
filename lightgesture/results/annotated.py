"""The annotated video: every frame with the overlay, at its own time.

Written by PyAV and not by OpenCV, whose writer knows one constant rate, tells nobody of a full disk, and has no H.264,
which is what browsers and phones play.
"""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Final

import cv2
import numpy as np

from lightgesture.features.types import Image
from lightgesture.records import Record
from lightgesture.results.atomic import replacing
from lightgesture.results.overlay import Overlay, Place
from lightgesture.results.ownership import MARK
from lightgesture.results.sound import SoundTrack

if TYPE_CHECKING:
    from av.container import OutputContainer
    from av.video.stream import VideoStream

CODEC: Final = "libx264"
"""An encoder of FFmpeg that PyAV brings."""

QUALITY: Final = 27
"""Constant rate factor of x264, 0 (lossless) to 51; 18 to 28 is sensible."""

PRESET: Final = "ultrafast"
"""Of x264; slower ones make smaller files. At this quality the picture differs from the drawn one no more than with
`superfast` and 25, which takes twice as long for four fifths of the bytes."""

PIXELS: Final = "yuv420p"
"""How the video holds its pixels: what every player takes."""

TICKS_PER_S: Final = 90_000
"""Of the file's clock: MPEG's, which holds all usual rates exactly."""

NOMINAL_RATE: Final = 30
"""Frames a second, a hint to the encoder only."""


class AnnotatedVideo:
    """Takes frame after frame with its records; overlay: draws on them."""

    def __init__(self, container: "OutputContainer", sound: SoundTrack, overlay: Overlay) -> None:
        self._container, self._sound = container, sound
        self._overlay = overlay
        self._stream: VideoStream | None = None
        self._size = (0, 0)
        self._tick = -1

    def write(self, image_bgr: Image, time_s: float, records: Sequence[Record]) -> None:
        """Append a frame, shown from `time_s` (seconds) on; the first one's size is the video's.

        A frame whose stamp does not come after the last one's is shown a tick later. OSError: it cannot be written.
        """
        import av

        picture = self._overlay.draw(image_bgr, records)
        if self._stream is None:
            self._stream = self._open(picture)
            self._sound.add_to(self._container)
        # By OpenCV, several times as fast as FFmpeg's own way from BGR, and truer at the edges of letters.
        planes = cv2.cvtColor(_fitted(picture, self._size), cv2.COLOR_BGR2YUV_I420)
        # The encoder copies what it is lent, so that there is one copy and not two.
        frame = av.VideoFrame.from_numpy_buffer(np.asarray(planes, np.uint8), format=PIXELS)
        self._tick = max(self._tick + 1, round(time_s * TICKS_PER_S))
        self._sound.write_until(self._tick / TICKS_PER_S)
        frame.pts, frame.time_base = self._tick, Fraction(1, TICKS_PER_S)
        self._container.mux(self._stream.encode(frame))

    def finish(self) -> None:
        """Write what the encoder still holds."""
        if self._stream is not None:
            self._container.mux(self._stream.encode(None))
            self._sound.write_until(math.inf)

    def _open(self, picture: Image) -> "VideoStream":
        height, width = picture.shape[:2]
        self._size = width + width % 2, height + height % 2  # H.264 shares a colour between two by two pixels
        options = {"crf": str(QUALITY), "preset": PRESET}
        stream = self._container.add_stream(CODEC, NOMINAL_RATE, options=options)
        stream.width, stream.height = self._size
        stream.pix_fmt = PIXELS
        stream.codec_context.time_base = Fraction(1, TICKS_PER_S)
        stream.codec_context.thread_count = 1  # one video a core; and the same bytes on any machine
        return stream


@contextmanager
def open_annotated_video(
    path: Path, originals: Sequence[str] = (), place: Place = "over", rotate: int = 0
) -> Iterator[AnnotatedVideo]:
    """Write an `.mp4` file that appears under its name when the block ends well.

    originals: paths of the video, or of its chapters, whose sound and metadata it gets, where it has any. place,
    rotate: as of `Overlay`.
    """
    import av

    with replacing(path) as temporary, open(temporary, "wb") as stream:
        # Through a file of our own: FFmpeg would read signs in a name as a protocol.
        container = av.open(stream, "w", format="mp4")
        sound = SoundTrack(originals)
        container.metadata.update(_marked(sound.metadata))
        try:
            video = AnnotatedVideo(container, sound, Overlay(place, rotate))
            yield video
            video.finish()
        finally:
            container.close()
            sound.close()


def _marked(metadata: dict[str, str]) -> dict[str, str]:
    """With a word by which the file is known for ours."""
    comment = metadata.get("comment", "")
    return metadata | {"comment": f"{comment}; {MARK}" if comment else MARK}


def _fitted(picture: Image, size: tuple[int, int]) -> Image:
    """The picture in the video's size (width, height): a missing row or column repeated, another size scaled to fit."""
    width, height = size
    if not (width - 1 <= picture.shape[1] <= width and height - 1 <= picture.shape[0] <= height):
        scale = min(width / picture.shape[1], height / picture.shape[0])
        new = max(1, round(picture.shape[1] * scale)), max(1, round(picture.shape[0] * scale))
        picture = np.asarray(cv2.resize(picture, new, interpolation=cv2.INTER_AREA), np.uint8)
        down, across = height - picture.shape[0], width - picture.shape[1]
        edges = down // 2, down - down // 2, across // 2, across - across // 2
        return np.asarray(cv2.copyMakeBorder(picture, *edges, cv2.BORDER_CONSTANT, value=(0, 0, 0)), np.uint8)
    down, across = height - picture.shape[0], width - picture.shape[1]
    if not (down or across):
        return picture
    return np.asarray(cv2.copyMakeBorder(picture, 0, down, 0, across, cv2.BORDER_REPLICATE), np.uint8)
