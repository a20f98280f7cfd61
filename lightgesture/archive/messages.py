"""What whoever decodes an input tells the one who reports: small frozen values that cross processes."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

Status = Literal["ok", "failed", "done before"]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one input.

    message: the error line of a failed one. seconds: spent on it. files: names of the files written.
    """

    status: Status
    message: str | None = None
    frames: int = 0
    instructions: int = 0
    rejected: int = 0
    seconds: float = 0.0
    files: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Opened:
    """The input at `place` was opened and promises `frames`; None where it does not say."""

    place: int
    frames: int | None


@dataclass(frozen=True, slots=True)
class Advanced:
    """So many more frames of an input are done."""

    place: int
    frames: int


@dataclass(frozen=True, slots=True)
class Printed:
    """Lines of results of an input, for standard output."""

    place: int
    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Done:
    """An input is finished; nothing comes after."""

    place: int
    outcome: Outcome


Message = Opened | Advanced | Printed | Done
Hear = Callable[[Message], None]
"""Takes the messages of all inputs, in the order in which they come about."""
