"""Answers to a server that asks for a login by RFC 7616 (digest), so that the password itself is not sent."""

import hashlib
import os
import re
from collections.abc import Callable, Sequence
from urllib.parse import urlsplit
from urllib.request import parse_http_list, parse_keqv_list

_HASHES: dict[str, Callable[[bytes], str]] = {
    "SHA-256": lambda data: hashlib.sha256(data).hexdigest(),
    "MD5": lambda data: hashlib.md5(data, usedforsecurity=False).hexdigest(),
}
"""Algorithms, the better one first."""

_DIGEST = re.compile(r"\bdigest\s+(.*)", re.IGNORECASE | re.DOTALL)


def digest_answer(
    challenges: Sequence[str], url: str, user: str, password: str, nonce_of_client: str | None = None
) -> str | None:
    """The header `Authorization` for a GET of `url`; None: none of the challenges is one that is known here.

    challenges: the headers `WWW-Authenticate` of the answer with status 401. nonce_of_client: for tests.
    """
    asked = [_parse(match[1]) for text in challenges if (match := _DIGEST.search(text))]
    for name, digest in _HASHES.items():
        for challenge in asked:
            algorithm = challenge.get("algorithm", "MD5")
            if algorithm.upper().removesuffix("-SESS") == name and "nonce" in challenge:
                own = nonce_of_client or os.urandom(8).hex()
                return _answer(challenge, algorithm, digest, url, (user, password), own)
    return None


def _answer(
    challenge: dict[str, str],
    algorithm: str,
    digest: Callable[[bytes], str],
    url: str,
    login: tuple[str, str],
    own_nonce: str,
) -> str | None:
    def hashed(*parts: str) -> str:
        return digest(":".join(parts).encode("utf-8"))

    realm, nonce = challenge.get("realm", ""), challenge["nonce"]
    parts = urlsplit(url)
    uri = (parts.path or "/") + (f"?{parts.query}" if parts.query else "")
    secret = hashed(login[0], realm, login[1])
    if algorithm.upper().endswith("-SESS"):
        secret = hashed(secret, nonce, own_nonce)
    request = hashed("GET", uri)
    fields = {"username": login[0], "realm": realm, "nonce": nonce, "uri": uri}
    plain = {"algorithm": algorithm} if "algorithm" in challenge else {}
    protections = [word.strip().lower() for word in challenge.get("qop", "").split(",") if word.strip()]
    if not protections:  # as RFC 2069 had it
        fields["response"] = hashed(secret, nonce, request)
    elif "auth" in protections:
        count = "00000001"
        fields["response"] = hashed(secret, nonce, count, own_nonce, "auth", request)
        fields["cnonce"] = own_nonce
        plain |= {"qop": "auth", "nc": count}
    else:
        return None
    if "opaque" in challenge:
        fields["opaque"] = challenge["opaque"]
    quoted = [f'{name}="{_quoted(value)}"' for name, value in fields.items()]
    return "Digest " + ", ".join(quoted + [f"{name}={value}" for name, value in plain.items()])


def _parse(text: str) -> dict[str, str]:
    """The fields of a challenge, names in small letters; what is no field, as of another challenge behind, is left."""
    fields = [one for one in parse_http_list(text) if "=" in one]
    return {name.strip().lower(): value for name, value in parse_keqv_list(fields).items()}


def _quoted(value: str) -> str:
    return value.replace("\\", "\\\\").replace('"', '\\"')
