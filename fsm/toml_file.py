"""TOML files that people write, read within bounds; what is wrong is told by place, reason and remedy.

Grammars, configurations, maps and scenes are all read here. Like the rest of `fsm` it imports nothing of the other
rooms, so that each caller makes its own error of a `TomlError`.
"""

import os
from collections.abc import Sequence
from typing import Any, Final

MAX_BYTES: Final = 1 << 20
"""Largest file that is read, bytes; the bundled grammar has about 4,000."""


class TomlError(ValueError):
    """A file that cannot be read or is no TOML.

    place: the byte in it, "" for the file as a whole. reason, remedy: what is wrong and what to do, in words.
    """

    def __init__(self, place: str, reason: str, remedy: str) -> None:
        super().__init__(": ".join(filter(None, (place, f"{' '.join(reason.split())}; {remedy}"))))
        self.place, self.reason, self.remedy = place, reason, remedy


def read_toml(path: str | os.PathLike[str], kind: str, example: str) -> dict[str, Any]:
    """The content of a TOML file, UTF-8 with or without a byte order mark. Raises TomlError.

    kind: what the file is, in words. example: where its layout is shown.
    """
    content = _read(path, kind)
    import tomllib

    try:
        return tomllib.loads(content.decode("utf-8-sig"))  # some editors write a byte order mark
    except UnicodeDecodeError as error:
        raise TomlError(f"byte {error.start}", "is not UTF-8", "save the file as UTF-8") from None
    except tomllib.TOMLDecodeError as error:
        remedy = "write valid TOML, each key once in its table"
        raise TomlError("", f"TOML syntax: {error}", remedy) from None
    except (RecursionError, ValueError) as error:  # too deep, or an integer of thousands of digits
        reason = "too deeply nested" if isinstance(error, RecursionError) else str(error)
        raise TomlError("", reason, f"keep to the layout of {example}") from None


def suggest_key(key: str, known: Sequence[str]) -> str:
    """What to do about an unknown key: the known one that is spelt like it, else all of them."""
    import difflib

    close = difflib.get_close_matches(key, known, n=1)
    return f"did you mean '{close[0]}'?" if close else "use " + ", ".join(known)


def _read(path: str | os.PathLike[str], kind: str) -> bytes:
    try:
        with open(path, "rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise TomlError("", "no such file", f"name an existing {kind} (TOML)") from None
    except IsADirectoryError:
        raise TomlError("", "is a folder", f"name a {kind} (TOML)") from None
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name
        reason = getattr(error, "strerror", None) or str(error)
        raise TomlError("", f"cannot be read ({reason})", "name a readable file") from None
    if len(content) > MAX_BYTES:
        raise TomlError("", f"is larger than {MAX_BYTES} bytes", f"name a {kind} (TOML)")
    return content
