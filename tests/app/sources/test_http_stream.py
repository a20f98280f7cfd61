"""MJPEG over HTTP, from servers that do what cameras do."""

import base64
import socket
import threading
from contextlib import suppress

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks.mjpeg_server import MjpegServer
from lightgesture.errors import InputError, UsageError
from lightgesture.sources.http_stream import HttpStream

FILES = [cv2.imencode(".jpg", np.full((48, 64, 3), 40 * n, np.uint8))[1].tobytes() for n in range(3)]


@pytest.fixture
def answering():
    """Serves one connection after the other with the given bytes, and keeps it open where `is_held`."""
    stopping = threading.Event()
    servers = []

    def start(answer, *, is_held=False):
        server = socket.create_server(("127.0.0.1", 0))
        servers.append(server)
        asked = []

        def serve():
            while not stopping.is_set():
                try:
                    peer, _ = server.accept()
                except OSError:
                    return
                with peer, suppress(BrokenPipeError):
                    asked.append(peer.recv(65536))
                    for part in answer:
                        peer.sendall(part)
                        stopping.wait(0.03)
                    if is_held:
                        stopping.wait(5)

        threading.Thread(target=serve, daemon=True).start()
        return f"127.0.0.1:{server.getsockname()[1]}/?action=stream", asked

    yield start
    stopping.set()
    for server in servers:
        server.shutdown(socket.SHUT_RDWR)
        server.close()


OK = b"HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=x\r\n\r\n"


def test_pictures_of_a_server_in_order_and_again():
    with MjpegServer(FILES, fps=200, limit=5) as server:
        stream = HttpStream(server.address)
        for _ in range(2):
            with stream:
                assert list(stream) == [*FILES, *FILES[:2]]


def test_login_is_sent_and_not_shown(answering):
    address, asked = answering([OK, FILES[0]])
    with HttpStream(f"http://di%40ver:sec%3Aret@{address}") as stream:
        assert list(stream) == FILES[:1]
    assert stream.name == f"http://{address}"
    assert base64.b64encode(b"di@ver:sec:ret") in asked[0]


def test_chunked_answers(answering):
    chunk = FILES[1]
    head = OK.replace(b"\r\n\r\n", b"\r\nTransfer-Encoding: chunked\r\n\r\n")
    pieces = [b"%x\r\n" % len(part) + part + b"\r\n" for part in (chunk[:100], chunk[100:])]
    address, _ = answering([head, *pieces, b"0\r\n\r\n"])
    with HttpStream(f"http://{address}") as stream:
        assert list(stream) == [chunk]


@pytest.mark.parametrize(
    ("answer", "options", "reason"),
    [
        ([b"HTTP/1.1 404 Not Found\r\n\r\n"], {}, "the server answers 404 Not Found"),
        ([b"SSH-2.0 hello\r\n\r\n"], {}, r"cannot be opened \(SSH-2.0 hello"),
        ([], {"is_held": True}, r"cannot be opened \(timed out\)"),
        ([OK, FILES[0]], {"is_held": True}, r"broke off \(timed out\)"),
        ([OK, *([b"a" * 4000] * 20)], {}, "sends data, but no JPEG picture for 0.2 s; is it MJPEG"),
    ],
)
def test_what_may_go_wrong(monkeypatch, answering, answer, options, reason):
    address, _ = answering(answer, **options)
    monkeypatch.setattr("lightgesture.sources.types.TIMEOUT_S", 0.4)
    monkeypatch.setattr("lightgesture.sources.types.NO_PICTURE_S", 0.2)
    stream = HttpStream(f"http://{address}")
    with pytest.raises(InputError, match=f"^http://{address.replace('?', '[?]')}: {reason}"), stream:
        list(stream)


def test_nobody_there():
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    with (
        pytest.raises(InputError, match=r"cannot be opened \(Connection refused\)"),
        HttpStream(f"http://127.0.0.1:{port}/"),
    ):
        pass


@pytest.mark.parametrize("address", ["http://", "http://[::1", "http://host:port/", "http:///path"])
def test_no_address(address):
    with pytest.raises(UsageError, match=r"write http://HOST:PORT/PATH"):
        HttpStream(address)
