"""MJPEG over HTTP, as OpenROV, mjpg-streamer and most network cameras send it."""

import base64
import http.client
import ssl
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from typing import Any, Final, Self
from urllib.parse import urlsplit

from lightgesture.errors import InputError, UsageError, reason_of
from lightgesture.sources import types
from lightgesture.sources.address import Address, split_address
from lightgesture.sources.http_login import digest_answer
from lightgesture.sources.jpeg import JpegSplitter
from lightgesture.sources.types import LiveSource

MOST_LOGINS: Final = 3
"""Answers to challenges for one picture stream: one for each redirection that has its own, and no more, for cameras
lock out who tries too often."""

SNAPSHOT_S: Final = 0.05
"""Seconds from one request to the next where each answer is one picture; shorter ones would only keep a camera busy."""

_JPEG = b"\xff\xd8"
_PAGE = (b"<", b"{")
_LOGIN_HEADER = "Authorization"


class HttpStream(LiveSource):
    """The JPEG files in the answer to one request, still encoded.

    Where the files begin and end is read from themselves, so that neither the boundary of a multipart answer nor
    lengths in its headers need be right. Of an address of single pictures one is asked for after the other. User and
    password may stand in the address and are kept out of `name`; they are sent to that host alone. insecure: a
    certificate that nobody vouches for will do.
    """

    def __init__(self, address: str, insecure: bool = False) -> None:
        self._address = split_address(address)
        self.name = self._address.name
        self._answer: http.client.HTTPResponse | None = None
        try:
            self._request = _make_request(self._address.plain)
        except ValueError:
            raise UsageError(f"{self.name}: is no address; write http://HOST:PORT/PATH") from None
        if self._address.user is not None:
            login = f"{self._address.user}:{self._address.password or ''}".encode()
            basic = "Basic " + base64.b64encode(login).decode("ascii")
            self._request.add_unredirected_header(_LOGIN_HEADER, basic)
        context = ssl.create_default_context()
        if insecure:
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        # A camera on the tether is never behind a proxy.
        self._opener = urllib.request.build_opener(
            urllib.request.ProxyHandler({}), urllib.request.HTTPSHandler(context=context), _SameHost()
        )

    def __enter__(self) -> Self:
        try:
            self._answer = self._open()
        except urllib.error.HTTPError as error:
            raise InputError(f"{self.name}: {_refusal(error, self._address)}") from None
        except (OSError, http.client.HTTPException, ValueError) as error:
            raise InputError(f"{self.name}: cannot be opened ({_reason(error)}){_remedy(error)}") from None
        return self

    def close(self) -> None:
        """End the connection."""
        if self._answer is not None:
            self._answer.close()

    def __iter__(self) -> Iterator[bytes]:
        while True:
            start_s, count = time.monotonic(), 0
            for file in self._pictures():
                count += 1
                yield file
            if count != 1 or not self._is_single_picture():
                return
            self.close()
            time.sleep(max(0.0, start_s + SNAPSHOT_S - time.monotonic()))
            self.__enter__()

    def _is_single_picture(self) -> bool:
        """Whether the address is that of the newest picture and not of a stream."""
        return self._answer is not None and self._answer.headers.get_content_type() == "image/jpeg"

    def _pictures(self) -> Iterator[bytes]:
        """The files in one answer."""
        splitter = JpegSplitter()
        start_s = last_s = time.monotonic()
        while chunk := self._read():
            files = splitter.feed(chunk)
            yield from files
            now_s = time.monotonic()
            if files:
                last_s = now_s
            elif last_s == start_s and chunk.lstrip().startswith(_PAGE) and _JPEG not in chunk:
                raise InputError(
                    f"{self.name}: answers with a page and no pictures; check the path, such as /?action=stream"
                )
            elif now_s - last_s > types.NO_PICTURE_S:
                raise InputError(
                    f"{self.name}: sends data, but no JPEG picture for {types.NO_PICTURE_S:g} s; is it MJPEG?"
                )

    def _open(self) -> http.client.HTTPResponse:
        """The answer with the pictures, to a second request where the server has a challenge for the first."""
        request = self._request
        for _ in range(MOST_LOGINS):
            try:
                return self._ask(request)
            except urllib.error.HTTPError as error:
                header = self._login(error)
                if header is None or (request.full_url == error.url and _is_digest(request)):
                    raise
                request = _make_request(error.url)
                request.add_unredirected_header(_LOGIN_HEADER, header)
        return self._ask(request)

    def _ask(self, request: urllib.request.Request) -> http.client.HTTPResponse:
        answer: http.client.HTTPResponse = self._opener.open(request, timeout=types.TIMEOUT_S)
        return answer

    def _login(self, error: urllib.error.HTTPError) -> str | None:
        """The header that answers a challenge; None: it is none, or another host's."""
        address = self._address
        if error.code != http.client.UNAUTHORIZED or address.user is None:
            return None
        if not _may_have_login(self._request.full_url, error.url):
            return None
        challenges = error.headers.get_all("WWW-Authenticate", [])
        return digest_answer(challenges, error.url, address.user, address.password or "")

    def _read(self) -> bytes:
        assert self._answer is not None
        try:
            return self._answer.read1(types.CHUNK_BYTES)
        except (OSError, http.client.HTTPException, ValueError) as error:
            raise InputError(f"{self.name}: broke off ({_reason(error)})") from None


class _SameHost(urllib.request.HTTPRedirectHandler):
    """Follows redirections, and takes a login along to the same host only."""

    def redirect_request(
        self, req: urllib.request.Request, fp: Any, code: int, msg: str, headers: Any, newurl: str
    ) -> urllib.request.Request | None:
        new = super().redirect_request(req, fp, code, msg, headers, newurl)
        header = req.unredirected_hdrs.get(_LOGIN_HEADER)
        if new is not None and header is not None and _may_have_login(req.full_url, new.full_url):
            new.add_unredirected_header(_LOGIN_HEADER, header)
        return new


def _make_request(url: str) -> urllib.request.Request:
    return urllib.request.Request(url, headers={"User-Agent": "lightgesture"})


def _is_digest(request: urllib.request.Request) -> bool:
    return str(request.unredirected_hdrs.get(_LOGIN_HEADER, "")).startswith("Digest")


def _may_have_login(first: str, other: str) -> bool:
    """Whether a login for the first address may go to the other: the same host, no less encrypted."""
    one, two = urlsplit(first), urlsplit(other)
    return one.hostname == two.hostname and (one.scheme == two.scheme or two.scheme == "https")


def _refusal(error: urllib.error.HTTPError, address: Address) -> str:
    """What a status says, and what to do."""
    told = f"the server answers {error.code} {error.reason}"
    match error.code:
        case http.client.UNAUTHORIZED if address.user is None:
            return f"{told}; it wants a login: write http://USER:PASSWORD@HOST/PATH"
        case http.client.UNAUTHORIZED | http.client.FORBIDDEN:
            return f"{told}; check user and password"
        case http.client.NOT_FOUND:
            return f"{told}; check the path"
    return told


def _cause(error: Exception) -> Exception:
    is_wrapped = isinstance(error, urllib.error.URLError) and isinstance(error.reason, Exception)
    return error.reason if is_wrapped else error  # type: ignore[attr-defined]


def _reason(error: Exception) -> str:
    error = _cause(error)
    if isinstance(error, TimeoutError):
        return "timed out"
    if isinstance(error, ssl.SSLCertVerificationError):
        return error.verify_message
    if isinstance(error, (http.client.InvalidURL, UnicodeError)):  # whose text has the address
        return "it holds characters that must be percent-encoded"
    return reason_of(error)


def _remedy(error: Exception) -> str:
    error = _cause(error)
    if isinstance(error, ssl.SSLCertVerificationError):
        return "; where the camera made its certificate itself, --insecure takes it all the same"
    if isinstance(error, ssl.SSLError):
        return "; does the camera speak https?"
    if isinstance(error, ConnectionRefusedError):
        return "; nothing listens there, check host and port"
    return ""
