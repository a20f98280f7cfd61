"""A browser as tests need it, and what it is shown."""

import http.client
import socket
import time

import numpy as np

from lightgesture.records import FrameRecord, Hand

AT = {"source": "dive.mp4", "frame": 3, "time_s": 0.1}
HAND = Hand(side="right", token="5", confidence=0.98, box=(8, 8, 20, 20), track=1, reason=None)
FRAME = FrameRecord(hands=(HAND,), **AT)


def picture(value=90, size=(64, 48)):
    return np.full((size[1], size[0], 3), value, np.uint8)


def port_of(listener):
    return int(listener.address.rstrip("/").rpartition(":")[2])


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
