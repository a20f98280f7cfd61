"""The page's server: what it gives, to whom, and that nobody can hold it up."""

import http.client
import json
import socket
import threading
import time

import cv2
import numpy as np
import pytest

from lightgesture.errors import UsageError
from lightgesture.fsm import Instruction, Rejected, State
from lightgesture.fsm.events import Growth
from lightgesture.records import FrameRecord, Hand, SummaryRecord, VehicleRecord
from lightgesture.web import WebListener

AT = {"source": "dive.mp4", "frame": 3, "time_s": 0.1}
HAND = Hand(side="right", token="5", confidence=0.98, box=(8, 8, 20, 20), track=1, reason=None)
FRAME = FrameRecord(hands=(HAND,), **AT)
STATE = State(
    state="collecting", sentence="STOP", dwell=Growth(pair=("5", "5"), word="HOVER", progress=0.4), **AT
)


def picture(value=90, size=(64, 48)):
    return np.full((size[1], size[0], 3), value, np.uint8)


def instruction(text="STOP HOVER GO"):
    return Instruction(
        start_frame=0,
        start_time_s=0.0,
        text=text,
        kind="task",
        action="HOVER",
        duration_s=None,
        program=None,
        parameter=None,
        change=None,
        confidence=0.95,
        words=("STOP", "HOVER", "GO"),
        **AT,
    )


def rejected(text="STOP EXEC 5 GO", detail="no program 5"):
    return Rejected(reason="unknown_program", text=text, detail=detail, **AT)


def port_of(listener):
    return int(listener.address.rstrip("/").rpartition(":")[2])


def test_the_log_has_what_is_listed(serve):
    page = serve()
    assert get(page, "/log.jsonl")[2] == b""
    page.show(picture(), [FRAME, STATE, instruction(), rejected()])
    page.show(None, [instruction("CONTD SNAP GO")])
    lines = [json.loads(line) for line in get(page, "/log.jsonl")[2].splitlines()]
    assert [(line["type"], line["text"]) for line in lines] == [
        ("instruction", "STOP HOVER GO"),
        ("rejected", "STOP EXEC 5 GO"),
        ("instruction", "CONTD SNAP GO"),
    ]


def get(listener, path="/", host=None, method="GET"):
    """Status, headers and body of one request."""
    connection = http.client.HTTPConnection("127.0.0.1", port_of(listener), timeout=10)
    connection.request(method, path, headers={} if host is None else {"Host": host})
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, answer.headers, body


def connect(listener, path, headers=""):
    """A socket on which a long answer begins."""
    link = socket.create_connection(("127.0.0.1", port_of(listener)), timeout=10)
    link.sendall(f"GET {path} HTTP/1.0\r\nHost: localhost\r\n{headers}\r\n".encode())
    return link


def read_until(link, mark, most_s=10.0):
    """What comes until `mark` has come."""
    content, end = b"", time.monotonic() + most_s
    while mark not in content:
        assert time.monotonic() < end, content[-500:]
        part = link.recv(65536)
        assert part, content[-500:]
        content += part
    return content


def drain(link):
    """All that comes until the other end closes."""
    content = b""
    while part := link.recv(65536):
        content += part
    return content


def events_of(content):
    """The server-sent events of a stream's bytes: (name, id, data)."""
    found = []
    for block in content.decode().partition("\r\n\r\n")[2].split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.splitlines() if not line.startswith(":"))
        if "data" in fields:
            found.append((fields["event"], fields.get("id"), json.loads(fields["data"])))
    return found


HOSTILE = '</script><img src=x onerror=alert(1)>\n\ndata: {"no": 1}\n\nevent: state\r\n\u2028'
END = b"\r\n--lightgesture\r\n"


def parts_of(content):
    """The JPEG pictures of a stream's bytes."""
    pieces = content.split(b"Content-Type: image/jpeg\r\n")[1:]
    bodies = [piece.partition(b"\r\n\r\n") for piece in pieces if END in piece]
    return [body[: int(head.rpartition(b": ")[2])] for head, _, body in bodies]


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


def test_state_and_entries(serve):
    listener = serve()
    listener.show(picture(), [FRAME, STATE, instruction(), rejected()])
    state = json.loads(get(listener, "/state.json")[2])
    assert (state["state"], state["sentence"]) == ("collecting", "STOP")
    assert state["dwell"] == {"pair": ["5", "5"], "word": "HOVER", "progress": 0.4}
    assert state["hands"][0]["token"] == "5"
    assert state["picture_age_s"] < 5
    assert [(entry["type"], entry["number"]) for entry in state["entries"]] == [
        ("instruction", 1),
        ("rejected", 2),
    ]


def test_what_the_diver_is_told(serve):
    page = WebListener(0, obeys=True)
    page.start()
    page.show(None, [instruction(), vehicle("sent"), vehicle("accepted")])
    state = json.loads(get(page, "/state.json")[2])
    assert state["tasks"] == ["STOP HOVER GO"]
    assert state["answer"]["answer"] == "accepted"
    assert 0 <= state["answer"]["age_s"] < state["answer"]["shown_s"] == 1.5
    page.show(None, [vehicle("refused")])
    state = json.loads(get(page, "/state.json")[2])
    assert (state["tasks"], state["answer"]["answer"]) == ([], "refused")
    assert [entry.get("detail") for entry in state["entries"]] == [None, "why", "why", "why"]
    page.stop()


def vehicle(state):
    return VehicleRecord(time_s=1.0, state=state, instruction="STOP HOVER GO", detail="why")


def test_heartbeats_and_the_end_come_without_a_picture(serve):
    listener = serve()

    class Heartbeat:
        def to_dict(self):
            return {
                "type": "heartbeat",
                "source": "0",
                "time_s": 2.0,
                "frames": 60,
                "dropped": 4,
                "ms_per_frame": 8.5,
                "state": "idle",
            }

    listener.show(None, [Heartbeat()])
    state = json.loads(get(listener, "/state.json")[2])
    assert (state["frames"], state["dropped"], state["picture_age_s"], state["ended"]) == (60, 4, None, None)
    summary = SummaryRecord(
        source="0",
        frames=60,
        seconds=2.0,
        instructions=0,
        rejected=0,
        status="ok",
        ms_per_frame={},
        stages_ms={},
    )
    listener.show(None, [summary])
    assert json.loads(get(listener, "/state.json")[2])["ended"] == "ok"


def test_events_tell_what_was_and_what_comes(serve):
    listener = serve(updates_per_s=50)
    listener.show(picture(), [FRAME, STATE, instruction("FIRST")])
    link = connect(listener, "/events")
    content = read_until(link, b"FIRST")
    listener.show(picture(), [FRAME, instruction("SECOND")])
    content += read_until(link, b"SECOND")
    events = events_of(content)
    assert [data["text"] for name, _, data in events if name == "entry"] == ["FIRST", "SECOND"]
    assert [data["sentence"] for name, _, data in events if name == "state"][:2] == ["STOP", "STOP"]
    assert events[0][0] == "state"
    last = next(number for name, number, data in events if name == "entry" and data["text"] == "FIRST")
    link.close()
    again = connect(listener, "/events", f"Last-Event-ID: {last}\r\n")
    texts = [data["text"] for name, _, data in events_of(read_until(again, b"SECOND")) if name == "entry"]
    assert texts == ["SECOND"]
    other = connect(listener, "/events", "Last-Event-ID: anotherrun-9\r\n")
    assert b"FIRST" in read_until(other, b"SECOND")


def test_hostile_text_stays_text(serve):
    listener = serve()
    listener.show(picture(), [FRAME, rejected(HOSTILE, HOSTILE), STATE])
    link = connect(listener, "/events")
    content = read_until(link, b"event: entry") + read_until(link, b": still here")
    events = events_of(content)
    assert [name for name, _, _ in events].count("entry") == 1
    assert next(data["text"] for name, _, data in events if name == "entry") == HOSTILE
    assert not any("no" in data for _, _, data in events)


def test_the_stream_shows_the_newest_picture_drawn(serve):
    listener = serve(pictures_per_s=50)
    link = connect(listener, "/stream.mjpg")
    read_until(link, b"--lightgesture\r\n")
    shown = []
    for value in (40, 200):
        listener.show(picture(value, (320, 240)), [FRAME])
        content = read_until(link, END)
        if value == 200:  # the one before may have been on its way again
            content += read_until(link, END)
        jpegs = parts_of(content)
        shown.append(cv2.imdecode(np.frombuffer(jpegs[-1], np.uint8), cv2.IMREAD_COLOR))
    for image, value in zip(shown, (40, 200), strict=True):
        assert image.shape[1:] == (320, 3)
        assert image.shape[0] > 240, "with a bar below"
        assert abs(int(image[110:130, 200:].mean()) - value) < 8
        assert abs(image[8:28, 8:10].astype(int) - value).max() > 60


def test_a_camera_that_stands_still_is_shown_again(serve):
    listener = serve()
    listener.show(picture(), [FRAME])
    link = connect(listener, "/stream.mjpg")
    content = read_until(link, b"--lightgesture\r\n")
    while len(parts_of(content)) < 3:
        content += read_until(link, END)
    assert len(set(parts_of(content))) == 1


def test_wide_pictures_are_reduced_and_the_drawing_can_be_another(serve):
    listener = serve(
        draw=lambda image, records: np.full_like(image, 250 if records else 0), picture_width=100
    )
    link = connect(listener, "/stream.mjpg")
    read_until(link, b"--lightgesture\r\n")
    listener.show(picture(90, (400, 200)), [FRAME])
    jpeg = parts_of(read_until(link, END))[-1]
    image = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    assert image.shape == (50, 100, 3)
    assert image.mean() > 240


def test_nothing_is_drawn_while_nobody_looks(serve):
    drawn = []
    listener = serve(draw=lambda image, records: drawn.append(1) or image, pictures_per_s=50)
    for _ in range(5):
        listener.show(picture(), [FRAME])
    get(listener, "/state.json")
    assert drawn == []
    link = connect(listener, "/stream.mjpg")
    read_until(link, b"image/jpeg")
    assert len(drawn) == 1
    link.close()


def test_a_browser_that_takes_nothing_delays_nobody(serve):
    listener = serve(client_timeout_s=0.5, pictures_per_s=60, send_buffer=4096)
    noise = np.random.default_rng(1).integers(0, 255, (480, 640, 3), np.uint8)
    slow = socket.socket()
    slow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
    slow.connect(("127.0.0.1", port_of(listener)))
    slow.sendall(b"GET /stream.mjpg HTTP/1.0\r\nHost: localhost\r\n\r\n")
    quick = connect(listener, "/stream.mjpg")
    received = []
    reader = threading.Thread(target=lambda: received.append(drain(quick)))
    reader.start()
    longest, end = 0.0, time.monotonic() + 2.0
    while time.monotonic() < end:
        start = time.monotonic()
        listener.show(noise, [FRAME])
        longest = max(longest, time.monotonic() - start)
        time.sleep(0.01)
    assert listener.viewers == 1  # the slow one was left
    listener.stop()
    reader.join()
    assert received[0].count(b"image/jpeg") >= 3
    assert longest < 0.5
    slow.close()


def test_there_is_a_bound_to_those_who_stay(serve):
    listener = serve(viewers=1, listeners=1)
    listener.show(picture(), [FRAME])
    for path, mark in (("/stream.mjpg", b"image/jpeg"), ("/events", b"event: state")):
        first = connect(listener, path)
        read_until(first, mark)
        status, headers, body = get(listener, path)
        assert status == 503
        assert headers["Retry-After"]
        assert b"too many" in body
        first.close()


def test_there_is_a_bound_to_connections(serve):
    listener = serve(connections=2)
    idle = [socket.create_connection(("127.0.0.1", port_of(listener))) for _ in range(2)]
    time.sleep(0.3)
    extra = socket.create_connection(("127.0.0.1", port_of(listener)), timeout=5)
    assert b"503" in extra.recv(200)
    for link in idle:
        link.close()
    time.sleep(0.3)
    assert get(listener)[0] == 200


def test_a_connection_that_says_nothing_is_left(serve):
    listener = serve(head_s=0.3)
    silent = socket.create_connection(("127.0.0.1", port_of(listener)), timeout=10)
    assert silent.recv(10) == b""


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
