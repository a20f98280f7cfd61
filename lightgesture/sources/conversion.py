"""Decoded frames of FFmpeg become pictures: uint8 (height, width, 3), BGR, progressive and upright."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from lightgesture.features.types import Image

if TYPE_CHECKING:
    from av.filter import Graph
    from av.video.frame import VideoFrame

BICUBIC: Final = 4
"""FFmpeg's number of the interpolation of colours that are stored smaller than the picture."""

DEINTERLACER: Final = "bwdif"
"""FFmpeg's filter; one frame out for each frame in, progressive ones untouched."""

UNSPECIFIED: Final = 2
YCGCO: Final = 8
"""Matrix coefficients of ITU-T H.273, table 4: not told, and YCgCo, which FFmpeg's scaler refuses."""

FULL_RANGE: Final = 2
"""FFmpeg's number of values from 0 to 255, where video otherwise has 16 to 235."""

_QUARTER_TURN: Final = 90


class Converter:
    """Makes pictures of the frames of one stream.

    tell: takes, once, that colours are not as the stream says. Raises ValueError, one line, for a frame that cannot be
    shown.
    """

    def __init__(self, tell: Callable[[str], None]) -> None:
        from av.video.reformatter import VideoReformatter

        self._reformatter = VideoReformatter()
        self._tell = tell
        self._refused: int | None = None

    def bgr8(self, frame: "VideoFrame") -> Image:
        """The frame's picture, turned as its container says."""
        image = self._ycgco(frame) if frame.colorspace == YCGCO else self._image(frame)
        turns = round(frame.rotation / _QUARTER_TURN) % 4
        return np.ascontiguousarray(np.rot90(image, turns)) if turns else image

    def _image(self, frame: "VideoFrame") -> Image:
        if frame.colorspace == self._refused:
            frame.colorspace = UNSPECIFIED
        try:
            picture = self._reformatter.reformat(frame, format="bgr24", interpolation=BICUBIC, threads=1)
            return np.asarray(picture.to_ndarray(), np.uint8)
        except (OSError, ValueError):
            if frame.colorspace == UNSPECIFIED:
                raise ValueError(f"pixels of the form {frame.format.name} cannot be converted") from None
        # The other matrices that the scaler refuses are nearly that of BT.2020, or found where a tag is wrong.
        refused, frame.colorspace = int(frame.colorspace), UNSPECIFIED
        image = self._image(frame)
        self._refused = refused
        self._tell(f"its colour matrix (number {refused} of H.273) is taken for the usual one")
        return image

    def _ycgco(self, frame: "VideoFrame") -> Image:
        """By H.273, equations 56 to 61: G = Y + Cg, B = Y - Cg - Co, R = Y - Cg + Co."""
        frame.colorspace = UNSPECIFIED
        picture = self._reformatter.reformat(
            frame, format="yuv444p", interpolation=BICUBIC, dst_color_range=FULL_RANGE, threads=1
        )
        planes: Any = picture.to_ndarray().astype(np.float32)
        y, cg, co = planes[0], planes[1] - 128, planes[2] - 128
        rest = y - cg
        bgr = np.stack([rest - co, y + cg, rest + co], axis=-1)
        return np.asarray(np.clip(np.rint(bgr), 0, 255), np.uint8)


class Deinterlacer:
    """Frames in, progressive frames out, in order; nothing is done until the first interlaced one comes.

    A frame of another size or form begins anew. What FFmpeg cannot deinterlace is passed on as it is.
    """

    def __init__(self) -> None:
        self._graph: Graph | None = None
        self._kind: tuple[int, int, str] | None = None
        self._is_refused = False

    def feed(self, frame: "VideoFrame") -> list["VideoFrame"]:
        """The frames that are done; the filter looks one frame ahead."""
        import av
        import av.error

        if self._is_refused or (self._graph is None and not frame.interlaced_frame):
            return [frame]
        kind = frame.width, frame.height, frame.format.name
        done: list[VideoFrame] = []
        try:
            if self._graph is None or kind != self._kind:
                done = self.flush()
                self._graph, self._kind = _make_graph(frame), kind
            self._graph.vpush(frame)
            return done + self._pull()
        except (av.error.FFmpegError, ValueError):
            self._graph, self._is_refused = None, True
            return [*done, frame]

    def flush(self) -> list["VideoFrame"]:
        """The frames that are left at the end."""
        if self._graph is None:
            return []
        self._graph.vpush(None)
        done = self._pull()
        self._graph = None
        return done

    def _pull(self) -> list["VideoFrame"]:
        import av
        import av.error

        assert self._graph is not None
        done: list[VideoFrame] = []
        while True:
            try:
                done.append(self._graph.vpull())
            except (av.error.BlockingIOError, av.error.EOFError):
                return done


def _make_graph(frame: "VideoFrame") -> "Graph":
    from av.filter import Graph

    graph = Graph()
    source = graph.add_buffer(
        width=frame.width, height=frame.height, format=frame.format, time_base=frame.time_base
    )
    graph.link_nodes(
        source, graph.add(DEINTERLACER, "mode=send_frame:deint=interlaced"), graph.add("buffersink")
    )
    graph.configure()
    return graph
