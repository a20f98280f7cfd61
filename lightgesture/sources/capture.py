"""Cameras and GStreamer pipelines, read by OpenCV."""

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Self

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import InputError, UsageError
from lightgesture.sources import types
from lightgesture.sources.address import hide_login
from lightgesture.sources.pictures import depth_of
from lightgesture.sources.types import LiveSource, SourceOptions

_VIDEO_DEVICE = re.compile(r"/dev/video(\d+)")


class CaptureStream(LiveSource):
    """The pictures that one of OpenCV's back-ends reads from `target`, an index or a name.

    parameters: properties and values that opening must obey. wishes: likewise, which a driver need not know.
    """

    def __init__(
        self,
        name: str,
        target: str | int,
        backend: int,
        parameters: Sequence[int] = (),
        wishes: Mapping[int, float] = MappingProxyType({}),
    ) -> None:
        self.name = name
        self._target, self._backend = target, backend
        self._parameters, self._wishes = list(parameters), wishes
        self._capture: cv2.VideoCapture | None = None
        self._depth = depth_of(name)

    def __enter__(self) -> Self:
        try:
            self._capture = cv2.VideoCapture(self._target, self._backend, self._parameters)
        except cv2.error as error:
            raise InputError(f"{self.name}: cannot be opened ({error.err})") from None
        if not self._capture.isOpened():
            self._capture.release()
            raise InputError(f"{self.name}: cannot be opened; is it there, and used by nobody else?")
        for wish, value in self._wishes.items():
            self._capture.set(wish, value)
        return self

    def close(self) -> None:
        """Let go of the device or the connection."""
        if self._capture is not None:
            self._capture.release()
            self._capture = None

    def __iter__(self) -> Iterator[NDArray[np.uint8]]:
        while (image := self._read()) is not None:
            yield image
        raise InputError(f"{self.name}: broke off, or sends nothing more")

    def _read(self) -> NDArray[np.uint8] | None:
        assert self._capture is not None
        try:
            is_read, image = self._capture.read()
            return self._depth.bgr8(image) if is_read else None
        except (cv2.error, ValueError) as error:
            raise InputError(f"{self.name}: sends what is no picture ({error})") from None


def open_camera(name: str, options: SourceOptions) -> CaptureStream:
    """A camera by its index (`0`) or its device file (`/dev/video0`, or a link to it), not yet opened."""
    match = _VIDEO_DEVICE.fullmatch(os.path.realpath(name))
    target: str | int = int(name) if name.isdecimal() else int(match[1]) if match else name
    # One picture in the driver's queue, where the driver lets us choose: older ones are of no use.
    wishes: dict[int, float] = {cv2.CAP_PROP_BUFFERSIZE: 1}
    if options.size is not None:
        width, height = options.size
        wishes |= {cv2.CAP_PROP_FRAME_WIDTH: width, cv2.CAP_PROP_FRAME_HEIGHT: height}
    return CaptureStream(name, target, cv2.CAP_ANY, wishes=wishes)


def open_gstreamer(line: str) -> CaptureStream:
    """A GStreamer pipeline that ends in `appsink`, not yet opened. UsageError: OpenCV was built without GStreamer."""
    name = hide_login(line)
    registry = cv2.videoio_registry
    # Some builds know of it as a plug-in that is not there.
    if cv2.CAP_GSTREAMER not in registry.getStreamBackends() or not registry.hasBackend(cv2.CAP_GSTREAMER):
        raise UsageError(
            f"{name}: this OpenCV has no GStreamer; use the system's OpenCV package, or send the pictures to "
            "standard input as MJPEG"
        )
    return CaptureStream(name, line, cv2.CAP_GSTREAMER, _timeouts())


def _timeouts() -> list[int]:
    return [
        *(cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, round(types.TIMEOUT_S * 1e3)),
        *(cv2.CAP_PROP_READ_TIMEOUT_MSEC, round(types.TIMEOUT_S * 1e3)),
    ]
