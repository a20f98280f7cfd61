"""Reading a grammar file: the only input or output of the package."""

import os
from pathlib import Path
from typing import Any

from lightgesture.fsm.language.grammar import Defect, Grammar, GrammarError
from lightgesture.fsm.toml_file import TomlError, read_toml

BUNDLED = Path(__file__).resolve().parents[1] / "grammar.toml"
"""The grammar that comes with the package."""


def load_grammar(path: str | os.PathLike[str] | None = None) -> Grammar:
    """Read, check and compile a grammar file; None: the bundled one.

    GrammarError: the file cannot be read or something in it is wrong.
    """
    file = os.fsdecode(BUNDLED if path is None else path)
    document = _document(file)
    # pydantic takes longer to import than everything else here, and only files need it
    from lightgesture.fsm.language.build import build

    return build(document, file)


def inspect_grammar(path: str | os.PathLike[str] | None = None) -> tuple[Grammar | None, list[Defect]]:
    """All that is wrong with a grammar file, the fatal defects first, and its grammar where there are none of these.

    GrammarError: the file cannot be read or is no TOML.
    """
    file = os.fsdecode(BUNDLED if path is None else path)
    document = _document(file)
    from lightgesture.fsm.language.build import inspect

    return inspect(document, file)


def _document(file: str) -> dict[str, Any]:
    try:
        return read_toml(file, "grammar file", "the bundled grammar")
    except TomlError as error:
        raise GrammarError.at(file, error.place, error.reason, error.remedy) from None
