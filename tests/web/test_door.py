"""Who is let in to the page: with which token, from which page, how often, and with how much patience."""

import http.client
import socket
import time

import pytest

from lightgesture.web import door
from lightgesture.web.door import ADDRESSES, BURST, OPEN, REQUESTS_PER_S, Door, Rates, is_loopback, token_for

TOKEN = "under-the-water"
ANY = "0.0.0.0"


def port_of(page):
    return int(page.address.rstrip("/").rpartition(":")[2])


def ask(page, path="/", method="GET", **headers):
    """Status, headers and body of one request."""
    connection = http.client.HTTPConnection("127.0.0.1", port_of(page), timeout=10)
    connection.request(
        method, path, headers={name.replace("_", "-"): value for name, value in headers.items()}
    )
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, answer.headers, body


def talk(page, content, wait_s=10.0):
    """What comes back for these bytes."""
    with socket.create_connection(("127.0.0.1", port_of(page)), timeout=wait_s) as link:
        link.sendall(content)
        answer = b""
        while part := link.recv(4096):
            answer += part
    return answer


@pytest.mark.parametrize(
    ("host", "given", "is_extension", "expected"),
    [
        ("127.0.0.1", None, False, ""),
        ("127.8.8.8", None, False, ""),
        ("::1", None, False, ""),
        ("localhost", None, False, ""),
        ("127.0.0.1", TOKEN, False, TOKEN),
        (ANY, OPEN, False, ""),
        (ANY, TOKEN, False, TOKEN),
        (ANY, None, True, ""),
        (ANY, TOKEN, True, TOKEN),
    ],
)
def test_when_a_token_is_asked_for(host, given, is_extension, expected):
    assert token_for(host, given, is_extension) == expected


@pytest.mark.parametrize("host", [ANY, "::", "192.168.2.2", "rov.local"])
def test_who_listens_wider_has_a_new_token_each_time(host):
    assert not is_loopback(host)
    first, second = (token_for(host, None, False) for _ in range(2))
    assert first != second
    assert min(len(first), len(second)) >= 20


def test_the_network_needs_the_token_for_everything(serve):
    page = serve(token=TOKEN)
    for path in (
        "/",
        "/display",
        "/signs",
        "/practice",
        "/state.json",
        "/stream.mjpg",
        "/events",
        "/log.jsonl",
        "/no",
    ):
        status, headers, body = ask(page, path)
        assert status == 401, path
        assert b"token" in body
        assert headers["WWW-Authenticate"].startswith("Bearer")
    for path in ("/?token=wrong", "/?token=", "/?token=%ff", "/?" + "a&" * 40 + "token=x"):
        assert ask(page, path)[0] == 401


def test_the_printed_link_opens_the_page_and_leaves_no_token_in_the_address(serve):
    page = serve(token=TOKEN)
    path = page.link("display").removeprefix(page.address.rstrip("/"))
    status, headers, _ = ask(page, path)
    assert (status, headers["Location"]) == (303, "/display")
    cookie = headers["Set-Cookie"]
    assert {"HttpOnly", "SameSite=Lax", "Path=/"} <= set(cookie.split("; "))
    word = cookie.partition(";")[0]
    assert ask(page, "/display", Cookie=f"other=1; {word}")[0] == 200
    assert ask(page, "/display", Cookie=word + "x")[0] == 401


def test_scripts_name_the_token_in_a_header_or_the_query(serve):
    page = serve(token=TOKEN)
    assert ask(page, "/state.json", Authorization=f"Bearer {TOKEN}")[0] == 200
    assert ask(page, f"/state.json?token={TOKEN}")[0] == 200
    assert ask(page, "/state.json", Authorization=f"Basic {TOKEN}")[0] == 401


def test_loopback_and_who_wants_it_open_need_none(serve):
    page = serve()
    assert page.link() == page.address
    assert ask(page)[0] == 200
    assert ask(serve(token=OPEN))[0] == 200


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": ""},
        {"Origin": "http://127.0.0.1:1"},
        {"Sec_Fetch_Site": "cross-site", "Sec_Fetch_Mode": "no-cors"},
    ],
)
def test_pages_of_other_sites_get_nothing(serve, headers):
    page = serve()
    for path in ("/", "/state.json", "/stream.mjpg", "/events"):
        assert ask(page, path, **headers)[0] == 403


def test_its_own_pages_and_links_from_elsewhere_are_answered(serve):
    page = serve()
    own = page.address.rstrip("/")
    assert ask(page, Origin=own, Sec_Fetch_Site="same-origin", Sec_Fetch_Mode="cors")[0] == 200
    assert ask(page, Sec_Fetch_Site="cross-site", Sec_Fetch_Mode="navigate")[0] == 200


def test_requests_of_one_address_are_bounded_and_come_again():
    now_s = [0.0]
    rates = Rates(lambda: now_s[0])
    assert sum(rates.take("a") for _ in range(1000)) == BURST
    assert rates.take("b")
    now_s[0] += 2.0
    assert sum(rates.take("a") for _ in range(1000)) == 2 * REQUESTS_PER_S


def test_addresses_that_are_counted_are_bounded():
    rates = Rates(lambda: 0.0)
    for _ in range(int(BURST)):
        rates.take("first")
    assert not rates.take("first")
    for number in range(ADDRESSES):
        rates.take(str(number))
    assert rates.take("first")  # forgotten


def test_too_many_requests_are_told_so(serve, monkeypatch):
    monkeypatch.setattr(door, "BURST", 3.0)
    page = serve()
    answers = [ask(page, "/state.json") for _ in range(8)]
    assert [answer[0] for answer in answers[:3]] == [200] * 3
    assert 429 in [answer[0] for answer in answers]
    assert answers[-1][1]["Retry-After"]


def test_one_address_does_not_take_all_connections(serve):
    page = serve(connections_of_one=2)
    held = [socket.create_connection(("127.0.0.1", port_of(page))) for _ in range(2)]
    time.sleep(0.2)
    assert b"503" in talk(page, b"")
    with socket.create_connection(("127.0.0.1", port_of(page)), 5, ("127.0.0.2", 0)) as other:
        other.sendall(b"GET /state.json HTTP/1.0\r\nHost: localhost\r\n\r\n")
        assert b"200" in other.recv(100)
    for link in held:
        link.close()
    time.sleep(0.2)
    assert ask(page)[0] == 200


def test_a_request_that_comes_byte_by_byte_is_left(serve):
    page = serve(head_s=0.5)
    start_s = time.monotonic()
    with socket.create_connection(("127.0.0.1", port_of(page)), timeout=10) as link:
        answer = b""
        for byte in b"GET / HTTP/1.0\r\nHost: localhost\r\nX-Slow: " + b"x" * 100:
            try:
                link.sendall(bytes([byte]))
            except OSError:
                break
            time.sleep(0.02)
        while part := link.recv(4096):
            answer += part
    assert time.monotonic() - start_s < 3.5
    assert b"408" in answer.partition(b"\r\n")[0]


@pytest.mark.parametrize(
    "content",
    [
        b"GET /" + b"x" * 20_000 + b" HTTP/1.0\r\n\r\n",
        b"GET / HTTP/1.0\r\nHost: localhost\r\n" + b"X: y\r\n" * 5000 + b"\r\n",
    ],
)
def test_a_request_that_is_too_large_is_refused(serve, content):
    page = serve()
    try:
        answer = talk(page, content)
    except ConnectionError:  # it was left while more was still on its way
        answer = b"HTTP/1.0 431"
    assert b"431" in answer.partition(b"\r\n")[0]
    assert ask(page)[0] == 200


@pytest.mark.parametrize(
    "content",
    [b"POST / HTTP/1.0\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"GET /\r\n\r\n", b"<script> x HTTP/1.0\r\n\r\n"],
)
def test_refusals_say_nothing_of_what_was_asked_and_have_all_headers(serve, content):
    answer = talk(serve(), content)
    top, _, body = answer.partition(b"\r\n\r\n")
    assert b"default-src 'none'" in top
    assert b"text/plain" in top
    assert b"script" not in body


def test_a_path_that_is_no_address_is_nothing(serve):
    page = serve()
    assert b"404" in talk(page, b"GET //[ HTTP/1.0\r\nHost: localhost\r\n\r\n").partition(b"\r\n")[0]
    wide = serve(token=TOKEN)
    assert b"401" in talk(wide, b"GET //[?token=a HTTP/1.0\r\nHost: localhost\r\n\r\n").partition(b"\r\n")[0]


def test_the_clock_of_the_door_is_its_own():
    front = Door("127.0.0.1", clock=lambda: 0.0)
    refusals = [front.objection("a", "/", {"Host": "localhost"}, "c") for _ in range(int(BURST) + 1)]
    assert refusals[:-1] == [None] * int(BURST)
    assert refusals[-1] is not None
    assert refusals[-1].status == 429
