"""What the documents name is there: links, programs, modules, commands and their options."""

import argparse
import ast
import importlib
import pkgutil
import re
from functools import cache
from pathlib import Path

import pytest

from lightgesture.cli import COMMANDS

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = [
    ROOT / "README.md",
    ROOT / "SECURITY.md",
    *sorted((ROOT / "docs").glob("*.md")),
    ROOT / "benchmarks" / "README.md",
    ROOT / "lightgesture" / "data" / "export.md",
]
ROOMS = ("lightgesture", "features", "models", "fsm", "synth", "training", "benchmarks")
FOLDERS = "|".join((*ROOMS, "docs", "deploy", "examples", "tests"))

LINK = re.compile(r"\]\(([^)\s]+)\)")
PATH = re.compile(rf"(?<![\w./-])((?:{FOLDERS})/[\w./-]*\w/?)(?![\w/])")
PYTHON_FILE = re.compile(r"(?<![\w./-])([\w/]+\.py)\b")
PROGRAM = re.compile(r"python3? -m (lightgesture[\w.]*\w)")
NAME = re.compile(r"\b(lightgesture(?:\.\w+)+)(?!\.\w)\b")
FILE_ENDINGS = (".toml", ".service", ".json", ".lock", ".1")
CODE = re.compile(r"^```.*?^```$|`[^`\n]+`", re.MULTILINE | re.DOTALL)
COMMAND = re.compile(r"(?:^|[`/ |])lightgesture (?!import\b)([a-z]\w*)([^`\n#|]*)", re.MULTILINE)
PYTHON = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
OPTION = re.compile(r"(?<!\S)(--[a-z][a-z-]*)")


def named(document):
    return str(document.relative_to(ROOT))


def is_program(module):
    """Whether `python -m` runs it: a module, or a package with a `__main__`."""
    first, *rest = module.split(".")
    base = ROOT.joinpath(*rest) if rest and rest[0] in ROOMS else ROOT.joinpath(first, *rest)
    return base.with_suffix(".py").is_file() or (base / "__main__.py").is_file()


def is_name(name):
    """Whether a module, or what it defines, bears this name."""
    try:
        pkgutil.resolve_name(name)
    except (ImportError, AttributeError):
        return False
    return True


@cache
def python_files():
    return [f"/{file.relative_to(ROOT)}" for room in ROOMS for file in (ROOT / room).rglob("*.py")]


def anchors(document):
    """Where links may point within a document, as pages of repositories make them of its headings."""
    headings = re.findall(r"^#+ (.+)$", document.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@cache
def parser_of(command):
    parser = argparse.ArgumentParser()
    importlib.import_module(COMMANDS[command][0]).add_arguments(parser)
    return parser


def options_of(parser):
    """The options of a parser and of the parsers below it."""
    for action in parser._actions:
        yield from action.option_strings
        if isinstance(action, argparse._SubParsersAction):
            for child in action.choices.values():
                yield from options_of(child)


def unknown_words(command, rest):
    """Of what stands behind a command: options that it lacks, and what it has no such target or action for."""
    if command not in COMMANDS:
        return [command]
    parser, (first, *_) = parser_of(command), [*rest.split(), ""]
    choices = [
        choice for action in parser._actions if not action.option_strings for choice in action.choices or ()
    ]
    is_wrong = choices and first.isalpha() and first not in choices
    options = set(options_of(parser))
    return [first] * bool(is_wrong) + [word for word in OPTION.findall(rest) if word not in options]


@pytest.mark.parametrize("document", DOCUMENTS, ids=named)
def test_links_lead_to_something(document):
    dead = []
    for link in LINK.findall(document.read_text(encoding="utf-8")):
        if "://" in link:
            continue
        file, _, anchor = link.partition("#")
        target = document.parent / file if file else document
        if not target.exists() or (anchor and anchor not in anchors(target)):
            dead.append(link)
    assert dead == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=named)
def test_files_are_there(document):
    text = document.read_text(encoding="utf-8")
    missing = [path for path in PATH.findall(text) if not (ROOT / path).exists()]
    missing += [
        path
        for path in PYTHON_FILE.findall(text)
        if not any(file.endswith(f"/{path}") for file in python_files()) and not (ROOT / path).is_file()
    ]
    assert missing == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=named)
def test_programs_and_names_of_python_are_there(document):
    text = document.read_text(encoding="utf-8")
    missing = [module for module in PROGRAM.findall(text) if not is_program(module)]
    names = set(NAME.findall(text)) - set(PROGRAM.findall(text))
    missing += sorted(name for name in names if not name.endswith(FILE_ENDINGS) and not is_name(name))
    assert missing == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=named)
def test_python_imports_what_is_there(document):
    trees = map(ast.parse, PYTHON.findall(document.read_text(encoding="utf-8")))
    imports = [node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    names = [f"{node.module}:{alias.name}" for node in imports for alias in node.names]
    assert [name for name in names if not is_name(name)] == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=named)
def test_commands_and_their_options_are_known(document):
    codes = [code.replace("\\\n", " ") for code in CODE.findall(document.read_text(encoding="utf-8"))]
    used = [found for code in codes for found in COMMAND.findall(code)]
    assert [word for command, rest in used for word in unknown_words(command, rest)] == []
