"""Options, from the command line and from files."""

from typing import Final

DEFAULT_FPS: Final = 30.0
"""Frames a second of sources without time stamps, where the user names no other."""
