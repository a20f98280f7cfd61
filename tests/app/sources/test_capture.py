"""Cameras, network streams and GStreamer, or what stands in for them."""

import socket
from typing import ClassVar

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks.mjpeg_server import MjpegServer
from lightgesture.errors import InputError, UsageError
from lightgesture.sources import SourceOptions, live_source
from lightgesture.sources.capture import CaptureStream, open_camera, open_gstreamer
from lightgesture.sources.http_stream import HttpStream
from lightgesture.sources.network import NetworkStream
from lightgesture.sources.standard_input import StandardInputStream


class FakeCapture:
    """Gives pictures of the sizes listed, then nothing, as a camera does that was unplugged."""

    made: ClassVar = []
    is_there = True
    pictures: ClassVar = [np.zeros((48, 64, 3), np.uint8), np.zeros((24, 32), np.uint8)]

    def __init__(self, target, backend, parameters):
        self.arguments = (target, backend, parameters)
        self.properties = {}
        self.left = list(self.pictures)
        self.is_open = self.is_there
        self.made.append(self)

    def isOpened(self):  # noqa: N802
        return self.is_open

    def set(self, name, value):
        self.properties[name] = value
        return False  # a driver that takes no wishes

    def read(self):
        return (True, self.left.pop(0)) if self.left else (False, None)

    def release(self):
        self.is_open = False


@pytest.fixture
def camera(monkeypatch):
    monkeypatch.setattr(cv2, "VideoCapture", FakeCapture)
    monkeypatch.setattr(FakeCapture, "made", [])
    monkeypatch.setattr(FakeCapture, "is_there", True)
    return FakeCapture


@pytest.mark.parametrize(
    ("name", "target"), [("0", 0), ("12", 12), ("/dev/video3", 3), ("/dev/cam", "/dev/cam")]
)
def test_a_camera_by_index_or_device(camera, name, target):
    stream = open_camera(name, SourceOptions())
    shapes = []
    with pytest.raises(InputError, match=f"^{name}: broke off"), stream:
        shapes.extend(image.shape for image in stream)
    assert shapes == [(48, 64, 3), (24, 32, 3)]
    assert camera.made[0].arguments == (target, cv2.CAP_ANY, [])
    assert camera.made[0].properties == {cv2.CAP_PROP_BUFFERSIZE: 1}
    assert not camera.made[0].is_open


def test_a_link_to_a_camera(camera, tmp_path):
    link = tmp_path / "by-id"
    link.symlink_to("/dev/video7")
    with open_camera(str(link), SourceOptions(size=(640, 480))):
        assert camera.made[0].arguments[0] == 7
        assert camera.made[0].properties[cv2.CAP_PROP_FRAME_WIDTH] == 640
        assert camera.made[0].properties[cv2.CAP_PROP_FRAME_HEIGHT] == 480


def test_a_camera_that_is_not_there(camera, monkeypatch):
    monkeypatch.setattr(FakeCapture, "is_there", False)
    stream = open_camera("5", SourceOptions())
    with pytest.raises(InputError, match=r"^5: cannot be opened; is it there"), stream:
        pass
    monkeypatch.setattr(FakeCapture, "is_there", True)
    with stream:  # plugged in
        assert len(camera.made) == 2


def test_no_camera_in_this_machine_is_an_input_error():
    with pytest.raises(InputError, match=r"^97: cannot be opened"), open_camera("97", SourceOptions()):
        pass


def test_a_picture_of_a_kind_that_cannot_be_used(camera, monkeypatch):
    monkeypatch.setattr(FakeCapture, "pictures", [np.zeros((4, 4), np.float32)])
    with (
        pytest.raises(InputError, match=r"sends what is no picture .frame of float32"),
        open_camera("0", SourceOptions()) as stream,
    ):
        list(stream)


def test_ffmpeg_reads_a_stream_and_tells_its_end():
    """The same class as for RTSP, over a protocol that needs no server of another's making."""
    files = [cv2.imencode(".jpg", np.full((48, 64, 3), 30 * n, np.uint8))[1].tobytes() for n in range(8)]
    with MjpegServer(files, fps=100, limit=40) as server:
        shapes = []
        stream = NetworkStream(server.address)
        with pytest.raises(InputError, match=r"^http://127.*: broke off, or sends nothing more"), stream:
            shapes.extend(image.shape for image in stream)
    assert set(shapes) == {(48, 64, 3)}
    assert len(shapes) > 20


def test_ffmpeg_gives_up_on_a_silent_peer(monkeypatch):
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"rtsp://user:secret@127.0.0.1:{server.getsockname()[1]}/cam"
        monkeypatch.setattr("lightgesture.sources.types.TIMEOUT_S", 0.3)
        stream = NetworkStream(address)
        with (
            pytest.raises(InputError, match=r"^rtsp://127.0.0.1:\d+/cam: cannot be opened .timed out"),
            stream,
        ):
            pass


def test_gstreamer_where_opencv_has_it(camera, monkeypatch):
    line = "v4l2src ! videoconvert ! appsink"
    monkeypatch.setattr(
        cv2.videoio_registry, "getStreamBackends", lambda: [cv2.CAP_FFMPEG, cv2.CAP_GSTREAMER]
    )
    monkeypatch.setattr(cv2.videoio_registry, "hasBackend", lambda _: True)
    with live_source(line, SourceOptions()):
        assert camera.made[0].arguments[:2] == (line, cv2.CAP_GSTREAMER)
    for name, value in (("hasBackend", False), ("getStreamBackends", [cv2.CAP_FFMPEG])):
        monkeypatch.setattr(cv2.videoio_registry, name, lambda *_, value=value: value)
        with pytest.raises(UsageError, match="this OpenCV has no GStreamer; use the system's"):
            open_gstreamer(line)


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("-", StandardInputStream),
        ("http://rov:8090/?action=stream", HttpStream),
        ("HTTPS://rov/", HttpStream),
        ("0", CaptureStream),
        ("/dev/video9", CaptureStream),
        ("/dev/null", CaptureStream),
        ("rtsp://rov/cam", NetworkStream),
        ("udp://127.0.0.1:5600", NetworkStream),
    ],
)
def test_names_of_streams(name, kind):
    assert isinstance(live_source(name, SourceOptions()), kind)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("rtsp://", "rtsp://: names no host; write rtsp://HOST:PORT/PATH"),
        ("rtsp://[::1/a", "is no address"),
        ("ftp://host/a", "is no stream; name a camera"),
        ("no_such_thing", "is no stream; name a camera"),
        ("", "is no stream; name a camera"),
        (__file__, "is no stream; decode files and folders with `lightgesture decode`"),
    ],
)
def test_names_that_are_none(name, reason):
    with pytest.raises(UsageError) as caught:
        live_source(name, SourceOptions())
    assert reason in str(caught.value)
