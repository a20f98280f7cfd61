"""Numbers of a command line that are no options of `settings.DecodeSettings`, for `type=` of argparse."""

import argparse
from typing import Final

LONGEST_S: Final = 600.0
"""Most seconds of a source that are looked at."""


def whole(text: str) -> int:
    """A whole number from 0."""
    return _at_least(text, 0)


def positive(text: str) -> int:
    """A whole number from 1."""
    return _at_least(text, 1)


def seconds(text: str) -> float:
    """Seconds of a source, above 0."""
    value = float(text)
    if not 0 < value <= LONGEST_S:
        raise argparse.ArgumentTypeError(f"{text} is not above 0 and at most {LONGEST_S:g}")
    return value


def _at_least(text: str, least: int) -> int:
    if not (text.isascii() and text.isdecimal()) or int(text) < least:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number of at least {least}")
    return int(text)
