"""The page and its files, and that nothing else is there."""

import socket
import threading

import pytest

from lightgesture.errors import UsageError
from lightgesture.web import WebListener
from tests.web.browser import FRAME, connect, drain, get, picture, port_of, read_until


def test_the_page_and_what_belongs_to_it(serve):
    listener = serve()
    for path, kind, word in (
        ("/", "text/html", b"<main>"),
        ("/?again", "text/html", b"<main>"),
        ("/page.css", "text/css", b"grid"),
        ("/page.js", "text/javascript", b"EventSource"),
        ("/display", "text/html", b"<main"),
        ("/display.css", "text/css", b"128"),
        ("/display.js", "text/javascript", b"EventSource"),
        ("/icon.svg", "image/svg+xml", b"<svg"),
    ):
        status, headers, body = get(listener, path)
        assert status == 200
        assert headers["Content-Type"].startswith(kind)
        assert word in body
        assert "default-src 'none'" in headers["Content-Security-Policy"]
        assert "unsafe" not in headers["Content-Security-Policy"]
        assert headers["X-Content-Type-Options"] == "nosniff"
        assert headers["Cross-Origin-Resource-Policy"] == "same-origin"


@pytest.mark.parametrize(("path", "code"), [("/", "/page.js"), ("/display", "/display.js")])
def test_the_page_has_no_code_of_its_own(serve, path, code):
    body = get(serve(), path)[2].decode()
    assert "<style" not in body
    assert " on" not in body.replace(" one", "")
    assert "http" not in body.replace("http-equiv", "")
    assert body.count("<script") == body.count(f'<script src="{code}"') == 1
    script = get(serve(), code)[2].decode()
    assert not any(
        word in script for word in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write")
    )


@pytest.mark.parametrize("path", ["/nothing", "/../server.py", "/static/page.js", "/%2e%2e/"])
def test_there_is_nothing_else(serve, path):
    assert get(serve(), path)[0] == 404


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS"])
def test_it_only_reads(serve, method):
    assert get(serve(), "/", method=method)[0] == 501


def test_names_of_other_sites_are_refused(serve):
    listener = serve()
    for host in (
        "evil.example",
        "evil.example:80",
        "localhost.evil.example",
        "[::1",
        "",
        "127.0.0.1.evil.example",
    ):
        for path in ("/", "/state.json", "/stream.mjpg", "/events"):
            assert get(listener, path, host=host)[0] == 421, host
    for host in (
        "localhost",
        "LOCALHOST:9000",
        "127.0.0.1:1",
        "192.168.2.2",
        "[::1]:80",
        socket.gethostname(),
    ):
        assert get(listener, "/", host=host)[0] == 200, host


@pytest.mark.parametrize(
    "request_bytes", [b"\x16\x03\x01\x02\x00\r\n\r\n", b"GET\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"\r\n"]
)
def test_garbage_is_refused_and_the_server_lives(serve, request_bytes, capfd):
    listener = serve()
    with socket.create_connection(("127.0.0.1", port_of(listener)), timeout=10) as link:
        link.sendall(request_bytes)
        link.shutdown(socket.SHUT_WR)
        link.recv(4096)
    assert get(listener)[0] == 200
    assert capfd.readouterr().err == ""


def test_a_port_in_use_is_one_line(serve):
    taken = port_of(serve())
    with pytest.raises(UsageError, match=rf"--web {taken}: cannot listen on 127.0.0.1 .*take another port"):
        WebListener(taken).start()
    with pytest.raises(UsageError, match=r"cannot listen on 203\.0\.113\.9"):
        WebListener(0, "203.0.113.9").start()
    with pytest.raises(UsageError, match="cannot listen on no such name"):
        WebListener(0, "no such name").start()


def test_stopping_ends_everything_and_frees_the_port():
    before = threading.active_count()
    with WebListener(0) as listener:
        port = port_of(listener)
        listener.show(picture(), [FRAME])
        links = [connect(listener, path) for path in ("/stream.mjpg", "/events")]
        for link in links:
            read_until(link, b"\r\n\r\n")
    for link in links:
        drain(link)
    with WebListener(port):
        pass
    assert threading.active_count() == before


def test_loopback_unless_told_otherwise():
    with WebListener(0) as listener:
        assert listener.address.startswith("http://127.0.0.1:")
    with pytest.raises(RuntimeError, match="not started"):
        assert WebListener(0).address
