"""RTSP from a server that speaks just enough of it: JPEG in RTP (RFC 2435) inside the connection itself."""

import socket
import struct
import threading
import time
from contextlib import suppress

import cv2
import numpy as np
import pytest

from lightgesture.errors import InputError
from lightgesture.sources import SourceOptions, live_source

SDP = (
    "v=0\r\no=- 0 0 IN IP4 127.0.0.1\r\ns=dive\r\nt=0 0\r\nm=video 0 RTP/AVP 26\r\nc=IN IP4 0.0.0.0\r\n"
    "a=control:track\r\n"
)
COLOUR = (40, 120, 200)


def payload(image):
    """The body of an RTP packet with the whole picture: its header, its tables, its compressed data."""
    content = cv2.imencode(".jpg", image)[1].tobytes()
    tables, place = b"", 2
    while content[place + 1] != 0xDA:
        length = int.from_bytes(content[place + 2 : place + 4], "big")
        if content[place + 1] == 0xDB:
            tables += b"".join(content[at + 1 : at + 65] for at in range(place + 4, place + 2 + length, 65))
        place += 2 + length
    scan = content[place + 2 + int.from_bytes(content[place + 2 : place + 4], "big") : -2]
    height, width = image.shape[:2]
    head = struct.pack(">IBBBB", 0, 1, 255, width // 8, height // 8)
    return head + struct.pack(">BBH", 0, 0, len(tables)) + tables + scan


def answer(request):
    lines = request.decode("ascii").split("\r\n")
    number = next(line for line in lines if line.lower().startswith("cseq"))
    head, body = f"RTSP/1.0 200 OK\r\n{number}\r\nSession: 7\r\n", ""
    match lines[0].split()[0]:
        case "OPTIONS":
            head += "Public: OPTIONS, DESCRIBE, SETUP, PLAY, TEARDOWN\r\n"
        case "DESCRIBE":
            head, body = head + f"Content-Type: application/sdp\r\nContent-Length: {len(SDP)}\r\n", SDP
        case "SETUP":
            head += "Transport: RTP/AVP/TCP;unicast;interleaved=0-1\r\n"
    return f"{head}\r\n{body}".encode("ascii")


@pytest.fixture
def address():
    """Serves 40 pictures to each client, one after the other, and hangs up."""
    body = payload(np.full((48, 64, 3), COLOUR, np.uint8))
    server = socket.create_server(("127.0.0.1", 0))

    def talk(peer):
        request = b""
        while not request.startswith(b"PLAY"):
            request = b""
            while not request.endswith(b"\r\n\r\n"):
                request += peer.recv(4096)
            peer.sendall(answer(request))
        for number in range(40):
            packet = struct.pack(">BBHII", 0x80, 0x80 | 26, number, number * 3000, 7) + body
            peer.sendall(struct.pack(">cBH", b"$", 0, len(packet)) + packet)
            time.sleep(0.01)

    def serve():
        with suppress(OSError):
            while True:
                peer, _ = server.accept()
                with peer, suppress(OSError):
                    talk(peer)

    threading.Thread(target=serve, daemon=True).start()
    yield f"rtsp://127.0.0.1:{server.getsockname()[1]}/camera"
    server.shutdown(socket.SHUT_RDWR)
    server.close()


def test_pictures_until_the_server_hangs_up_and_again(address):
    stream = live_source(address, SourceOptions())
    for _ in range(2):
        images = []
        with pytest.raises(InputError, match=r"^rtsp://127.*: broke off, or sends nothing more"), stream:
            images.extend(stream)
        assert len(images) > 20
        assert np.abs(images[-1].astype(int) - COLOUR).max() < 12
