"""Reading a grammar file: the only input or output of the package."""

import os
from pathlib import Path
from typing import Any

from lightgesture.fsm.language.grammar import Defect, Grammar, GrammarError

BUNDLED = Path(__file__).resolve().parents[1] / "grammar.toml"
"""The grammar that comes with the package."""

MAX_BYTES = 1 << 20
"""Largest grammar file that is read, bytes; the bundled one has about 4,000."""


def load_grammar(path: str | os.PathLike[str] | None = None) -> Grammar:
    """Read, check and compile a grammar file; None: the bundled one.

    GrammarError: the file cannot be read or something in it is wrong.
    """
    file = os.fsdecode(BUNDLED if path is None else path)
    document = _parse(_read(file), file)
    # pydantic takes longer to import than everything else here, and only files need it
    from lightgesture.fsm.language.build import build

    return build(document, file)


def inspect_grammar(path: str | os.PathLike[str] | None = None) -> tuple[Grammar | None, list[Defect]]:
    """All that is wrong with a grammar file, the fatal defects first, and its grammar where there are none of these.

    GrammarError: the file cannot be read or is no TOML.
    """
    file = os.fsdecode(BUNDLED if path is None else path)
    document = _parse(_read(file), file)
    from lightgesture.fsm.language.build import inspect

    return inspect(document, file)


def _read(file: str) -> bytes:
    try:
        with open(file, "rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise GrammarError.at(file, "", "no such file", "name an existing grammar file (TOML)") from None
    except IsADirectoryError:
        raise GrammarError.at(file, "", "is a folder", "name a grammar file (TOML)") from None
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name
        reason = getattr(error, "strerror", None) or str(error)
        raise GrammarError.at(file, "", f"cannot be read ({reason})", "name a readable file") from None
    if len(content) > MAX_BYTES:
        raise GrammarError.at(file, "", f"is larger than {MAX_BYTES} bytes", "name a grammar file (TOML)")
    return content


def _parse(content: bytes, file: str) -> dict[str, Any]:
    import tomllib

    try:
        return tomllib.loads(content.decode("utf-8-sig"))  # some editors write a byte order mark
    except UnicodeDecodeError as error:
        raise GrammarError.at(file, f"byte {error.start}", "is not UTF-8", "save the file as UTF-8") from None
    except tomllib.TOMLDecodeError as error:
        remedy = "write valid TOML, each key once in its table"
        raise GrammarError.at(file, "", f"TOML syntax: {error}", remedy) from None
    except (RecursionError, ValueError) as error:  # too deep, or an integer of thousands of digits
        reason = "too deeply nested" if isinstance(error, RecursionError) else str(error)
        raise GrammarError.at(file, "", reason, "keep to the layout of the bundled grammar") from None
