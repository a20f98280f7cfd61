"""What `live` does about sources that are not there, and what it shows of a login."""

import json
import socket
import subprocess
import sys
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import cv2
import numpy as np
import pytest

from lightgesture.errors import ExitStatus

FILE = cv2.imencode(".jpg", np.full((48, 64, 3), 90, np.uint8))[1].tobytes()
SECRETS = ("hu#sh", "hu%23sh", "diver", "t0ken")


@pytest.fixture
def camera():
    """Sends three pictures to each request and hangs up."""

    class Handler(BaseHTTPRequestHandler):
        def log_message(self, *words):
            """Nothing on standard error."""

        def do_GET(self):
            self.send_response(200)
            self.end_headers()
            self.wfile.write(FILE * 3)

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True).start()
    yield f"127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()


def test_a_login_stands_in_no_record_no_datagram_and_no_message(camera):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as heard:
        heard.bind(("127.0.0.1", 0))
        heard.settimeout(0.2)
        address = f"http://diver:hu%23sh@{camera}/?action=stream&auth=t0ken"
        command = [sys.executable, "-m", "lightgesture", "live", address, "--json", "--frames"]
        done = _end_after([*command, "--udp", f"127.0.0.1:{heard.getsockname()[1]}"])
        datagrams = []
        while True:
            try:
                datagrams.append(heard.recv(1 << 16).decode())
            except TimeoutError:
                break
    assert json.loads(done[0].splitlines()[0])["source"] == f"http://{camera}/?***"
    assert len(datagrams) > 3
    for text in (*done, *datagrams):
        assert not [secret for secret in SECRETS if secret in text]


def _end_after(command):
    """Standard output and error of a run that is asked to end after its sixth record."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        lines = [child.stdout.readline() for _ in range(6)]
        child.terminate()
        out, err = child.communicate(timeout=30)
    return "".join(lines) + out, err


@pytest.mark.parametrize(
    ("source", "reason"),
    [
        ("/dev/video77", "/dev/video77: no such device; this machine has"),
        pytest.param(
            "77",
            "77: no such device",
            marks=pytest.mark.skipif(sys.platform != "linux", reason="has other names"),
        ),
        ("videotestsrc ! appsink", "this OpenCV has no GStreamer"),
        ("http://diver:hu#sh@cam/", "percent-encode the password"),
        ("camera.sdp", "camera.sdp: cannot be read"),
        ("rtp://0.0.0.0", "names no port; write rtp://0.0.0.0:5600"),
    ],
)
def test_what_can_never_be_opened_ends_it(run, fake, monkeypatch, source, reason):
    monkeypatch.setattr(cv2.videoio_registry, "hasBackend", lambda _: False)
    result = run("live", source)
    assert (result.status, len(result.err)) == (ExitStatus.USAGE, 1)
    assert reason in result.err[0]
    assert not [secret for secret in SECRETS if secret in result.err[0]]


def test_what_may_come_back_is_given_up_where_the_user_says_so(run, fake):
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    result = run("live", f"http://127.0.0.1:{port}/", "--give-up", 0.4, "--quiet")
    assert result.status == ExitStatus.SOME_FAILED
    assert "nothing listens there, check host and port; trying again for 0 s" in result.err[0]
    assert result.err[1] == f"lightgesture: http://127.0.0.1:{port}/: no picture for 0.4 s; given up"
