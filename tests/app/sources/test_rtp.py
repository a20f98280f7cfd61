"""RTP to a port of this machine, as BlueROV sends it and QGroundControl hears it."""

import socket
import threading
from contextlib import contextmanager

import av
import numpy as np
import pytest

from lightgesture.errors import InputError, UsageError
from lightgesture.sources import SourceOptions, live_source, open_source
from lightgesture.sources.rtp import RtpStream

SETTINGS = {
    "libx264": {"preset": "ultrafast", "tune": "zerolatency", "g": "5"},
    "libx265": {
        "preset": "ultrafast",
        "tune": "zerolatency",
        "x265-params": "log-level=none:repeat-headers=1:keyint=5",
    },
}


def free_port():
    """An even one; the next is that of the reports."""
    while True:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
            one.bind(("127.0.0.1", 0))
            port = one.getsockname()[1]
        if port % 2 == 0:
            return port


@contextmanager
def sending(port, codec):
    """A camera that sends pictures that grow brighter, again and again, 40 a second."""
    stopping = threading.Event()

    def send():
        with av.open(f"rtp://127.0.0.1:{port}?pkt_size=1200", "w", format="rtp") as out:
            stream = out.add_stream(codec, 40, options=SETTINGS[codec])
            stream.width, stream.height = 160, 120
            stream.pix_fmt = "yuv420p"
            number = 0
            while not stopping.wait(0.025):
                image = np.full((120, 160, 3), 40 + number * 10 % 160, np.uint8)
                image[:, :80] = np.arange(80, dtype=np.uint8)[:, None] * 2
                frame = av.VideoFrame.from_ndarray(image, format="bgr24")
                frame.pts = number
                out.mux(stream.encode(frame))
                number += 1

    thread = threading.Thread(target=send, daemon=True)
    thread.start()
    try:
        yield
    finally:
        stopping.set()
        thread.join(5)


def take(stream, count):
    found = []
    with stream:
        for image in stream:
            found.append(image)
            if len(found) == count:
                return found
    raise AssertionError("ended")


@pytest.mark.parametrize("codec", ["libx264", "libx265"])
def test_what_comes_to_a_port_is_found_out_and_read(codec):
    port = free_port()
    stream = live_source(f"rtp://0.0.0.0:{port}", SourceOptions())
    assert (stream.name, stream.is_reopened) == (f"rtp://0.0.0.0:{port}", True)
    with sending(port, codec):
        for _ in range(2):  # as often as it breaks off
            images = take(stream, 12)
            assert {image.shape for image in images} == {(120, 160, 3)}
            levels = [float(image[:, 100:].mean()) for image in images]
            assert np.ptp(levels) > 40
            assert np.ptp(images[0][:, :80].mean(axis=(1, 2))) < 20
            assert np.ptp(images[0][:, :80].mean(axis=(0, 2))) > 50


@pytest.mark.parametrize(("codec", "name"), [("libx264", "H264"), ("libx265", "H265")])
def test_a_stream_that_a_file_describes(tmp_path, codec, name):
    port = free_port()
    path = tmp_path / "camera.sdp"
    path.write_text(
        f"v=0\no=- 0 0 IN IP4 127.0.0.1\ns=ROV\nc=IN IP4 127.0.0.1\nt=0 0\n"
        f"m=video {port} RTP/AVP 96\na=rtpmap:96 {name}/90000\n"
    )
    with sending(port, codec):
        assert len(take(live_source(str(path), SourceOptions()), 3)) == 3
    with pytest.raises(
        InputError, match=r"camera\.sdp: describes a stream; decode it with `lightgesture live`"
    ):
        open_source(path)


def test_a_stream_that_falls_silent(monkeypatch):
    monkeypatch.setattr("lightgesture.sources.types.TIMEOUT_S", 1.0)
    port = free_port()
    stream = RtpStream(f"rtp://127.0.0.1:{port}")
    with (
        pytest.raises(InputError, match=f"nothing came for 1 s; does the vehicle send to .* port {port}"),
        stream,
    ):
        pass
    with sending(port, "libx264"):
        stream.__enter__()
        images = iter(stream)
        next(images)
    with pytest.raises(InputError, match=r"broke off, or sends nothing more \(timed out\)"):
        list(images)
    stream.close()


@pytest.mark.parametrize(
    ("packet", "reason"),
    [
        (b"\x47" + bytes(187), "sends a transport stream without RTP; name it udp://"),
        (b"hello world, hello world", "neither H.264 nor H.265"),
        (b"\x80\x61" + bytes(10) + b"\xff\xff\xff", "neither H.264 nor H.265"),
    ],
)
def test_what_is_no_rtp(monkeypatch, packet, reason):
    monkeypatch.setattr("lightgesture.sources.types.TIMEOUT_S", 0.5)
    port = free_port()
    stopping = threading.Event()

    def send():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
            while not stopping.wait(0.02):
                one.sendto(packet, ("127.0.0.1", port))

    threading.Thread(target=send, daemon=True).start()
    try:
        with pytest.raises(InputError, match=reason), RtpStream(f"rtp://127.0.0.1:{port}"):
            pass
    finally:
        stopping.set()


def test_a_port_that_is_taken():
    port = free_port()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("0.0.0.0", port))
        with (
            pytest.raises(InputError, match=r"Address already in use.*QGroundControl"),
            RtpStream(f"rtp://0.0.0.0:{port}"),
        ):
            pass


@pytest.mark.parametrize("address", ["rtp://0.0.0.0", "rtp://rov:5600", "rtp://0.0.0.0:x", "rtp://[::"])
def test_no_address_of_this_machine(address):
    with pytest.raises(UsageError, match=r"write rtp://0\.0\.0\.0:5600"):
        live_source(address, SourceOptions())


@pytest.mark.parametrize("content", [None, b"", b"v=0\nm=audio 5 RTP/AVP 0\n", b"\0\1"])
def test_no_description(tmp_path, content):
    path = tmp_path / "camera.sdp"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(UsageError, match=r"camera\.sdp: (cannot be read|is no SDP)"):
        live_source(str(path), SourceOptions())
