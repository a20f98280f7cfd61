"""Cameras over HTTP with logins, redirections, pages and certificates of their own."""

import base64
import hashlib
import shutil
import socket
import ssl
import subprocess
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.request import parse_http_list, parse_keqv_list

import cv2
import numpy as np
import pytest

from lightgesture.errors import InputError
from lightgesture.sources.http_login import digest_answer
from lightgesture.sources.http_stream import HttpStream

FILE = cv2.imencode(".jpg", np.full((48, 64, 3), 90, np.uint8))[1].tobytes()
USER, PASSWORD = "di:ver", "pa#s/s?[ü"
LOGIN = "di%3Aver:pa%23s%2Fs%3F%5B%C3%BC"


class Camera(BaseHTTPRequestHandler):
    """Each path is a camera. seen: path and login of each request."""

    protocol_version = "HTTP/1.1"
    challenge = 'Digest realm="cam", nonce="n1", qop="auth", opaque="o"'
    elsewhere = ""
    seen: list[tuple[str, str]]

    def log_message(self, *words):
        """Nothing on standard error."""

    def do_GET(self):
        path, login = self.path, self.headers.get("Authorization", "")
        self.seen.append((path, login))
        if path.startswith("/digest"):
            self.pictures() if self.is_digest(login) else self.answer(401, self.challenge)
        elif path == "/basic":
            expected = "Basic " + base64.b64encode(f"{USER}:{PASSWORD}".encode()).decode()
            self.pictures() if login == expected else self.answer(401, 'Basic realm="cam"')
        elif path == "/page":
            self.answer(200, body=b"\r\n<!DOCTYPE html><html><body>login</body></html>", kind="text/html")
        elif path == "/json":
            self.answer(200, body=b'{"error": 5}', kind="application/json")
        elif path == "/mistyped":
            self.answer(200, body=FILE * 2, kind="text/html")
        elif path == "/newest":
            self.answer(200, body=FILE, kind="image/jpeg")
        elif path.startswith("/to"):
            self.answer(302, location=path[3:] if path.startswith("/to/") else self.elsewhere)
        else:
            self.answer(403 if path == "/forbidden" else 404)

    def is_digest(self, login):
        if not login.startswith("Digest "):
            return False
        fields = parse_keqv_list(parse_http_list(login[7:]))
        name = fields.get("algorithm", "MD5").lower().replace("-", "").removesuffix("sess")

        def hashed(*parts):
            return hashlib.new(name, ":".join(parts).encode()).hexdigest()

        one, two = hashed(USER, "cam", PASSWORD), hashed("GET", self.path)
        if fields.get("algorithm", "").endswith("-sess"):
            one = hashed(one, fields["nonce"], fields["cnonce"])
        middle = [fields["nc"], fields["cnonce"], fields["qop"]] if "qop" in fields else []
        is_right = fields["response"] == hashed(one, fields["nonce"], *middle, two)
        return is_right and (fields["uri"], fields["nonce"]) == (self.path, "n1")

    def pictures(self):
        self.answer(200, body=FILE * 3, kind="multipart/x-mixed-replace")

    def answer(self, status, challenge=None, body=b"", kind=None, location=None):
        self.send_response(status)
        named = {"WWW-Authenticate": challenge, "Content-Type": kind, "Location": location}
        for name, value in named.items():
            if value is not None:
                self.send_header(name, value)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)


@pytest.fixture
def camera():
    """Starts a camera with what differs from the class; gives its host and port and what it saw."""
    servers = []

    def start(context=None, **differences):
        handler = type("Handler", (Camera,), {"seen": [], **differences})
        server = ThreadingHTTPServer(("127.0.0.1", 0), handler)
        server.daemon_threads = True
        if context is not None:
            server.socket = context.wrap_socket(server.socket, server_side=True)
        servers.append(server)
        threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True).start()
        return f"127.0.0.1:{server.server_port}", handler.seen

    yield start
    for server in servers:
        server.shutdown()
        server.server_close()


def read(address, **options):
    with HttpStream(address, **options) as stream:
        return list(stream)


@pytest.mark.parametrize(
    "challenge",
    [
        'Digest realm="cam", nonce="n1"',
        'Digest realm="cam", nonce="n1", qop="auth,auth-int", algorithm=MD5, stale=FALSE',
        'Digest realm="cam", nonce="n1", qop="auth", algorithm=MD5-sess',
        'Digest realm="cam", nonce="n1", qop="auth", algorithm=SHA-256',
        'Basic realm="cam", Digest realm="cam", nonce="n1", qop="auth"',
    ],
)
def test_digest(camera, challenge):
    place, seen = camera(challenge=challenge)
    assert read(f"http://{LOGIN}@{place}/digest?action=stream") == [FILE] * 3
    assert [login.split(" ")[0] for _, login in seen] == ["Basic", "Digest"]


def test_digest_as_the_standard_has_it():
    """RFC 7616, section 3.9.1, of two challenges the better."""
    common = 'realm="http-auth@example.org", qop="auth, auth-int", algorithm={}, '
    common += 'nonce="7ypf/xlj9XXwfDPEoM4URrv/xwf94BcCAzFZH4GiTo0v", '
    common += 'opaque="FQhe/qaU925kfnzjCev0ciny7QMkPqMAFRtzCUYo5tdS"'
    challenges = ["Digest " + common.format(name) for name in ("MD5", "SHA-256")]
    own = "f2/wE4q74E6zIJEtWaHKaf5wv/H5QzzpXusqGemxURZJ"
    url, login = "http://www.example.org/dir/index.html", ("Mufasa", "Circle of Life")
    answer = digest_answer(challenges, url, *login, own)
    assert 'response="753927fa0e85d155564e2e272a28d1802ca10daf4496794697cf8db5856cb6c1"' in answer
    answer = digest_answer(challenges[:1], url, *login, own)
    assert 'response="8ca523f5e9506fed4657c9700eebdbec"' in answer


@pytest.mark.parametrize("path", ["/to/basic", "/to/digest", "/to/to/digest?x=1"])
def test_a_redirection_on_the_same_host_keeps_the_login(camera, path):
    place, _ = camera()
    assert read(f"http://{LOGIN}@{place}{path}") == [FILE] * 3


@pytest.mark.parametrize("path", ["/basic", "/digest"])
def test_another_host_gets_no_login(camera, path):
    other, seen = camera()
    place, _ = camera(elsewhere=f"http://localhost:{other.partition(':')[2]}{path}")
    with pytest.raises(InputError, match="the server answers 401"):
        read(f"http://{LOGIN}@{place}/to")
    assert seen == [(path, "")]


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        (
            "/basic",
            "the server answers 401 Unauthorized; it wants a login: write http://USER:PASSWORD@HOST/PATH",
        ),
        ("/forbidden", "the server answers 403 Forbidden; check user and password"),
        ("/gone", "the server answers 404 Not Found; check the path"),
        ("/page", "answers with a page and no pictures; check the path, such as /?action=stream"),
        ("/json", "answers with a page and no pictures; check the path"),
    ],
)
def test_what_a_server_may_answer(camera, path, reason):
    place, _ = camera()
    with pytest.raises(InputError) as caught:
        read(f"http://{place}{path}")
    assert str(caught.value).startswith(f"http://{place}{path}: {reason}")
    assert read(f"http://{place}/mistyped") == [FILE] * 2


def test_a_wrong_login_is_not_tried_again_and_again(camera):
    for path, most in (("/basic", 1), ("/digest", 2)):
        place, seen = camera()
        with pytest.raises(InputError, match="the server answers 401 Unauthorized; check user and password"):
            read(f"http://diver:hush@{place}{path}")
        assert len(seen) == most


def test_an_address_of_single_pictures_is_asked_again_and_again(camera):
    place, seen = camera()
    with HttpStream(f"http://{place}/newest") as stream:
        assert [file for file, _ in zip(stream, range(4), strict=False)] == [FILE] * 4
    assert len(seen) >= 4


def test_nobody_listens():
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    with pytest.raises(
        InputError, match=r"\(Connection refused\); nothing listens there, check host and port$"
    ):
        read(f"http://127.0.0.1:{port}/")


def test_characters_that_no_address_has(camera):
    place, _ = camera()
    for path in ("/a b?pwd=hush", "/ä?pwd=hush"):
        with pytest.raises(InputError, match="holds characters that must be percent-encoded") as caught:
            read(f"http://{place}{path}")
        assert "hush" not in str(caught.value)


@pytest.mark.skipif(shutil.which("openssl") is None, reason="makes the certificate")
def test_a_certificate_of_the_cameras_own(camera, tmp_path):
    command = "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj /CN=camera"
    subprocess.run(
        [*command.split(), "-keyout", "key", "-out", "certificate"],
        cwd=tmp_path,
        check=True,
        capture_output=True,
    )
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(tmp_path / "certificate", tmp_path / "key")
    place, seen = camera(context)
    with pytest.raises(
        InputError, match=r"cannot be opened \(self-signed certificate\); .* --insecure takes it"
    ):
        read(f"https://{LOGIN}@{place}/basic")
    assert seen == []
    assert read(f"https://{LOGIN}@{place}/digest", insecure=True) == [FILE] * 3
    plain, _ = camera()
    with pytest.raises(InputError, match="does the camera speak https"):
        read(f"https://{plain}/basic", insecure=True)
