"""Reasons of the records in words, for people."""

from typing import Final

UNREAD: Final = {
    "low_confidence": "too unsure to tell",
    "unknown_shape": "no sign of the language",
    "partial": "only partly in the picture",
    "occluded": "covered",
}
"""Why a hand was not read."""

UNREAD_SHORT: Final = {
    "low_confidence": "unsure",
    "unknown_shape": "no sign",
    "partial": "cut off",
    "occluded": "covered",
}
"""The same for a label at the hand."""

REJECTED: Final = {
    "ambiguous": "could be two sentences",
    "cancelled": "cancelled by the diver",
    "does_not_fit": "the signs make no sentence",
    "limit": "too long or too large",
    "out_of_order": "a word out of place",
    "passed_over": "something was shown and not read",
    "timeout": "it was not finished in time",
    "unconfirmed": "it was not confirmed",
    "unknown_parameter": "there is no such parameter",
    "unknown_program": "there is no such program",
    "unread_sign": "a sign was not read",
    "weak_sign": "a sign was not seen well",
}
"""Why a sentence was dropped."""


def unread(reason: str | None, is_short: bool = False) -> str:
    """Why a hand was not read; a reason that is not known, as it is."""
    return (UNREAD_SHORT if is_short else UNREAD).get(reason or "", plain(reason))


def rejected(reason: str) -> str:
    """Why a sentence was dropped; a reason that is not known, as it is."""
    return REJECTED.get(reason, plain(reason))


def plain(reason: str | None) -> str:
    """A reason of another program's making, as words."""
    return (reason or "no reason given").replace("_", " ")
