"""Those who look: pictures drawn and sent, and the bounds to how many look and how long."""

import socket
import threading
import time

import cv2
import numpy as np

from tests.web.browser import FRAME, connect, drain, get, picture, port_of, read_until

END = b"\r\n--lightgesture\r\n"


def parts_of(content):
    """The JPEG pictures of a stream's bytes."""
    pieces = content.split(b"Content-Type: image/jpeg\r\n")[1:]
    bodies = [piece.partition(b"\r\n\r\n") for piece in pieces if END in piece]
    return [body[: int(head.rpartition(b": ")[2])] for head, _, body in bodies]


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
