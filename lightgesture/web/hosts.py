"""Which names a browser may call this server by.

A page of another site can make its own name point to this machine and read what it likes ("DNS rebinding"). It
cannot make a bare address do so, and it does not know the names of this machine.
"""

import ipaddress
import socket
from collections.abc import Iterable


def known_names(host: str) -> frozenset[str]:
    """Names that are right for a server bound to `host`, in small letters."""
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


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
