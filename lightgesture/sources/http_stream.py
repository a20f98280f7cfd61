"""MJPEG over HTTP, as OpenROV, mjpg-streamer and most network cameras send it."""

import base64
import http.client
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from typing import Self
from urllib.parse import unquote, urlsplit, urlunsplit

from lightgesture.errors import InputError, UsageError, reason_of
from lightgesture.sources import types
from lightgesture.sources.jpeg import JpegSplitter
from lightgesture.sources.types import LiveSource


class HttpStream(LiveSource):
    """The JPEG files in the answer to one request, still encoded.

    Where the files begin and end is read from themselves, so that neither the boundary of a multipart answer nor
    lengths in its headers need be right. User and password may stand in the address and are kept out of `name`.
    """

    def __init__(self, address: str) -> None:
        self._request, self.name = _make_request(address)
        self._answer: http.client.HTTPResponse | None = None
        # A camera on the tether is never behind a proxy.
        self._opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))

    def __enter__(self) -> Self:
        try:
            self._answer = self._opener.open(self._request, timeout=types.TIMEOUT_S)
        except urllib.error.HTTPError as error:
            raise InputError(f"{self.name}: the server answers {error.code} {error.reason}") from None
        except (OSError, http.client.HTTPException) as error:
            raise InputError(f"{self.name}: cannot be opened ({_reason(error)})") from None
        return self

    def close(self) -> None:
        """End the connection."""
        if self._answer is not None:
            self._answer.close()

    def __iter__(self) -> Iterator[bytes]:
        splitter = JpegSplitter()
        last_s = time.monotonic()
        while chunk := self._read():
            files = splitter.feed(chunk)
            yield from files
            now_s = time.monotonic()
            if files:
                last_s = now_s
            elif now_s - last_s > types.NO_PICTURE_S:
                raise InputError(
                    f"{self.name}: sends data, but no JPEG picture for {types.NO_PICTURE_S:g} s; is it MJPEG?"
                )

    def _read(self) -> bytes:
        assert self._answer is not None
        try:
            return self._answer.read1(types.CHUNK_BYTES)
        except (OSError, http.client.HTTPException, ValueError) as error:
            raise InputError(f"{self.name}: broke off ({_reason(error)})") from None


def _make_request(address: str) -> tuple[urllib.request.Request, str]:
    """The request for an address, and the address without user and password."""
    try:
        parts = urlsplit(address)
        host, _ = parts.hostname, parts.port
    except ValueError as error:
        raise UsageError(f"{address}: is no address ({error}); write http://HOST:PORT/PATH") from None
    if not host:
        raise UsageError(f"{address}: names no host; write http://HOST:PORT/PATH")
    plain = urlunsplit(parts._replace(netloc=parts.netloc.rpartition("@")[2]))
    try:
        request = urllib.request.Request(plain, headers={"User-Agent": "lightgesture"})
    except ValueError as error:
        raise UsageError(f"{plain}: is no address ({error}); write http://HOST:PORT/PATH") from None
    if parts.username is not None:
        login = f"{unquote(parts.username)}:{unquote(parts.password or '')}".encode()
        request.add_unredirected_header("Authorization", "Basic " + base64.b64encode(login).decode("ascii"))
    return request, plain


def _reason(error: Exception) -> str:
    if isinstance(error, urllib.error.URLError) and isinstance(error.reason, Exception):
        error = error.reason
    if isinstance(error, TimeoutError):
        return "timed out"
    return reason_of(error)
