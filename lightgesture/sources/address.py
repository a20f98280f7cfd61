"""Addresses with logins in them: what is sent, and what may be shown."""

import re
from dataclasses import dataclass
from typing import Final
from urllib.parse import unquote, urlsplit, urlunsplit

from lightgesture.errors import UsageError

HIDDEN: Final = "***"
"""Stands in names where something was that may be a secret."""

_LOGIN_KEY = re.compile(
    r"(?:user|usr|login|account|pas|pw|psw|token|auth|key|secret|cred|session|sess|jwt|sig|code|\b(?:u|p|id|sid|pin))"
    r"[a-z0-9_-]*=",
    re.IGNORECASE,
)
"""A parameter that may be a login; one that is none only makes a name shorter."""

_LOGIN_IN_TEXT = re.compile(r"(?<=:/)[^\s\"']*@")
_QUERY_IN_TEXT = re.compile(r"\?[^\s\"']+")
_LOGIN_OF_PLUGIN = re.compile(
    r"\b((?:user|proxy|auth|location-)[a-z-]*(?:id|pw|user|password))=(\"[^\"]*\"|\S+)"
)


_ENCODE = "percent-encode the password: # is %23, / is %2F, ? is %3F, [ is %5B, @ is %40, % is %25"


@dataclass(frozen=True, slots=True)
class Address:
    """An address as it is asked for, without its login, and that login.

    plain: without user and password. name: what may be shown. user, password: as they are, None where there are none.
    """

    plain: str
    name: str
    user: str | None
    password: str | None


def split_address(address: str) -> Address:
    """Take an address apart. UsageError: it is none, has no host, or its login cannot be told from the rest of it."""
    scheme = address.partition("://")[0].lower()
    example = f"write {scheme}://HOST:PORT/PATH"
    try:
        parts = urlsplit(address)
        host, _ = parts.hostname, parts.port
    except ValueError as error:
        if "@" in address:
            raise UsageError(f"{hide_login(address)}: cannot be split; {_ENCODE}") from None
        raise UsageError(
            f"{hide_login(address)}: is no address ({_plain_reason(error)}); {example}"
        ) from None
    if not host:
        raise UsageError(f"{hide_login(address)}: names no host; {example}")
    plain = urlunsplit(parts._replace(netloc=parts.netloc.rpartition("@")[2], fragment=""))
    user = None if parts.username is None else unquote(parts.username)
    password = None if parts.password is None else unquote(parts.password)
    return Address(plain, hide_login(address), user, password)


def hide_login(text: str) -> str:
    """A name without what may be a login, whether it can be split or not; one that is no address stays as it is."""
    scheme, found, rest = text.partition("://")
    if not found or re.fullmatch(r"[A-Za-z][A-Za-z0-9+.-]*", scheme) is None:
        return _hide_in_pipeline(text)
    host = re.split(r"[/?#]", rest, maxsplit=1)[0]
    behind = rest[len(host) :]
    if "@" in behind:  # of a password with such a sign in it, or of a path: nobody can tell
        host, behind = HIDDEN, "@" + behind.rpartition("@")[2]
    host = host.rpartition("@")[2]
    behind, _, fragment = behind.partition("#")
    path, mark, query = behind.partition("?")
    if _LOGIN_KEY.search(query) or ":" in query:
        query = HIDDEN
    if _LOGIN_KEY.search(path) or (fragment and _LOGIN_KEY.search(fragment)):
        path = "/" + HIDDEN
    return f"{scheme}://{host}{path}{mark}{query}"


def _hide_in_pipeline(text: str) -> str:
    """A line of GStreamer, whose elements have addresses and logins among their properties."""
    text = _LOGIN_OF_PLUGIN.sub(rf"\1={HIDDEN}", _LOGIN_IN_TEXT.sub(f"{HIDDEN}@", text))
    return _QUERY_IN_TEXT.sub(lambda query: f"?{HIDDEN}" if _LOGIN_KEY.search(query[0]) else query[0], text)


def _plain_reason(error: ValueError) -> str:
    """Why an address without a login is none; what the library quotes of it is left out."""
    return str(error).partition(": ")[0].partition(" as ")[0]
