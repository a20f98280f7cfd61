"""Who is let in: by what name the server was called, from which page, how often, and with which token."""

import hmac
import ipaddress
import re
import secrets
import socket
import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from http import HTTPStatus
from typing import Final, Protocol
from urllib.parse import parse_qs, urlsplit

LOCAL_NAME: Final = re.compile(r"[a-z0-9-]{1,63}\.local")
"""Names of multicast DNS: no other site of the internet can have one."""

OPEN: Final = "none"
"""Given as the token: whoever reaches the server may look."""

TOKEN_BYTES: Final = 16
"""Random bytes of a token that nobody gave; too many to be guessed at any rate."""

REQUESTS_PER_S: Final = 20.0
"""Requests that one address may make in the long run, a second."""

BURST: Final = 150.0
"""Requests that it may make at once: a page with all its drawings takes 30."""

ADDRESSES: Final = 512
"""Addresses whose requests are counted; beyond, the one that asked longest ago is forgotten."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a request is not answered: the status, and a line for whoever made it."""

    status: HTTPStatus
    text: str


class Headers(Protocol):
    """The headers of a request, by any spelling of their names."""

    def get(self, name: str, /) -> str | None:
        """A header, the first of that name; None where there is none."""
        ...


class Door:
    """Decides on requests; its methods may be called from any thread.

    host: address that the server is bound to. token: what a request must name; "" where none is asked for.
    is_extension: of BlueOS, which calls it by any name that ends in `.local`. clock: for tests.
    """

    def __init__(
        self,
        host: str,
        token: str = "",
        is_extension: bool = False,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.token, self._is_extension = token, is_extension
        self._names = known_names(host)
        self._rates = Rates(clock)

    def objection(self, address: str, path: str, headers: Headers, cookie: str) -> Refusal | None:
        """Why a request is refused; None: it may be answered.

        address: of who asks. path: with its query. cookie: name of the one
        that holds the token.
        """
        if not self._rates.take(address):
            return Refusal(HTTPStatus.TOO_MANY_REQUESTS, "too many requests; wait a few seconds")
        if not self.is_called(headers.get("Host")):
            text = "call this server by its address, localhost or its name"
            return Refusal(HTTPStatus.MISDIRECTED_REQUEST, text)
        if is_foreign(headers):
            return Refusal(
                HTTPStatus.FORBIDDEN, "pages of other sites are not answered; open the page itself"
            )
        if self.token and not any(_is_same(self.token, given) for given in tokens_of(path, headers, cookie)):
            text = "open the address with its token, as lightgesture printed it at its start: /?token=..."
            return Refusal(HTTPStatus.UNAUTHORIZED, text)
        return None

    def is_called(self, header: str | None) -> bool:
        """Whether a `Host` header names this server."""
        name = name_of((header or "").strip()) if self._is_extension else None
        is_local = name is not None and LOCAL_NAME.fullmatch(name.lower()) is not None
        return is_local or is_known(header, self._names)


class Rates:
    """Counts requests of each address: a bucket of `BURST` that fills by `REQUESTS_PER_S`."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._lock = clock, threading.Lock()
        self._buckets: dict[str, tuple[float, float]] = {}

    def take(self, address: str) -> bool:
        """Whether this address may have one more request now."""
        now_s = self._clock()
        with self._lock:
            left, seen_s = self._buckets.pop(address, (BURST, now_s))
            left = min(BURST, left + (now_s - seen_s) * REQUESTS_PER_S)
            is_allowed = left >= 1.0
            # The last is the one that asked last, so that the first can go.
            self._buckets[address] = (left - is_allowed, now_s)
            if len(self._buckets) > ADDRESSES:
                del self._buckets[next(iter(self._buckets))]
        return is_allowed


def token_for(host: str, given: str | None, is_extension: bool) -> str:
    """The token of a server: the one given, a new one where it listens wider than this machine, "" for none.

    An extension of BlueOS has none unless one is given: BlueOS itself opens its pages to its network, and cannot name
    a token.
    """
    if given is not None:
        return "" if given == OPEN else given
    return "" if is_extension or is_loopback(host) else secrets.token_urlsafe(TOKEN_BYTES)


def is_loopback(host: str) -> bool:
    """Whether only this machine reaches a server that is bound to `host`."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def tokens_of(path: str, headers: Headers, cookie: str) -> list[str]:
    """The tokens that a request names: in its query, as a bearer, in its cookie."""
    found = _asked(path)
    scheme, _, bearer = (headers.get("Authorization") or "").partition(" ")
    if scheme.lower() == "bearer":
        found.append(bearer.strip())
    for part in (headers.get("Cookie") or "").split(";"):
        name, _, value = part.strip().partition("=")
        if name == cookie:
            found.append(value)
    return found


def is_foreign(headers: Headers) -> bool:
    """Whether a page of another site asks, by what its browser says: `Origin`, or `Sec-Fetch-Site`.

    A link that somebody follows from elsewhere is none of these: the page opens, and the other site sees nothing.
    """
    origin = headers.get("Origin")
    if origin is not None and not _is_same_place(origin, headers.get("Host") or ""):
        return True
    mode, site = headers.get("Sec-Fetch-Mode"), headers.get("Sec-Fetch-Site")
    return site == "cross-site" and mode != "navigate"


def known_names(host: str) -> frozenset[str]:
    """Names that a browser may call a server by that is bound to `host`, in small letters.

    A page of another site can make its own name point to this machine and read what it likes ("DNS rebinding"). It
    cannot make a bare address do so, and it does not know the names of this machine.
    """
    own = socket.gethostname().lower()
    names = {"localhost", host.lower(), own, own.split(".")[0], own.split(".")[0] + ".local"}
    return frozenset(name for name in names if name)


def is_known(header: str | None, names: Iterable[str]) -> bool:
    """Whether a `Host` header, with or without a port, is an address or one of the names.

    Any port is right, for a tunnel has one of its own.
    """
    name = name_of((header or "").strip())
    if name is None:
        return False
    return name.lower().rstrip(".") in names or _is_address(name)


def name_of(header: str) -> str | None:
    """The name or address of a `Host` header without its port; None where it is malformed."""
    if header.startswith("["):
        name, bracket, port = header[1:].partition("]")
        is_port = port == "" or (port[0] == ":" and port[1:].isdigit())
        return name if bracket and is_port and ":" in name else None
    name, colon, port = header.partition(":")
    return name if name and (not colon or port.isdigit()) else None


def _asked(path: str) -> list[str]:
    try:
        return parse_qs(urlsplit(path).query, max_num_fields=16).get("token", []) if "token=" in path else []
    except ValueError:  # a query of too many fields, or what is no address
        return []


def _is_same_place(origin: str, host: str) -> bool:
    """Whether an `Origin` is that of the page that this server gave under this `Host`."""
    scheme, mark, place = origin.partition("://")
    return bool(mark) and scheme in ("http", "https") and place.lower() == host.strip().lower()


def _is_same(token: str, given: str) -> bool:
    """Compared in a time that says nothing of how much of it is right."""
    return hmac.compare_digest(token.encode(), given.encode("utf-8", "surrogateescape"))


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
