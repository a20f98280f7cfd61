"""Names of inputs: natural order, and globs made into files."""

import glob
import os
import re
from collections.abc import Iterable

_NUMBER = re.compile(r"(\d+)")


def natural_key(name: str) -> tuple[list[tuple[int, str]], str]:
    """Sort key by which frame 9 comes before frame 10, whatever their zeros and capitals."""
    parts = _NUMBER.split(name)
    key = [(int(part), "") if place % 2 else (0, part.casefold()) for place, part in enumerate(parts)]
    return key, name


def expand_inputs(inputs: Iterable[str]) -> list[str]:
    """The inputs in the order given, globs replaced by what they match in natural order, each file once.

    A name that exists is taken as it stands, also where it holds `*`, `?` or `[`. A glob that matches
    nothing stays, so that opening it tells the user. Two names of the same file are one (`a` and `./a`);
    a link is a file of its own.
    """
    found: dict[str, str] = {}
    for name in inputs:
        is_glob = not os.path.lexists(name) and glob.has_magic(name)
        matches = sorted(glob.glob(name, recursive=True), key=natural_key) if is_glob else []
        for match in matches or [name]:
            found.setdefault(os.path.normcase(os.path.abspath(match)), match)
    return list(found.values())
