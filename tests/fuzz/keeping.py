"""From the inputs that led a fuzzer on to a few small ones, for the repository."""

import shutil
from pathlib import Path

from .targets import CORPUS

MOST_BYTES = 6144
"""Of the inputs of one target together."""
LARGEST = 1024
"""Bytes of one input that is kept besides those that are there."""
NAME = 12
"""Letters of its name."""


def keep(name: str, found: Path) -> int:
    """Put the smallest of the found inputs into the repository, as many as there is room for; how many these are.

    Each reached something new when the fuzzer found it, so that the smallest are worth most.
    """
    own = CORPUS / name
    own.mkdir(parents=True, exist_ok=True)
    there = {file.name for file in own.iterdir()}
    room = MOST_BYTES - sum(file.stat().st_size for file in own.iterdir())
    kept = 0
    for file in sorted(found.glob("*"), key=lambda file: (file.stat().st_size, file.name)):
        size = file.stat().st_size
        if file.name[:NAME] in there or not 0 < size <= min(room, LARGEST):
            continue
        shutil.copy(file, own / file.name[:NAME])
        room -= size
        kept += 1
    return kept
