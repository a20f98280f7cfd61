"""How much source there is, read by `ast`; nothing of it is run."""

import ast
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import lightgesture

PACKAGE = Path(lightgesture.__file__).parent
ROOMS: Final = ("features", "models", "fsm", "synth", "training", "benchmarks")
"""Beside the application, whose settings are counted too."""


@dataclass(frozen=True, slots=True)
class Holder:
    """A class and those of its fields that are asked for. file: its folder and name."""

    file: str
    name: str
    fields: tuple[str, ...]


def import_closure(modules: Iterable[str], package: Path = PACKAGE) -> dict[str, Path]:
    """Name and file of every module of the package that these import, one through the other, in functions too."""
    found: dict[str, Path] = {}
    waiting = [*modules]
    while waiting:
        name = waiting.pop()
        file = _module_file(name, package)
        if file is None or name in found:
            continue
        found[name] = file
        waiting += [name.rpartition(".")[0], *imported(ast.parse(file.read_text(encoding="utf-8")))]
    return found


def imported(tree: ast.Module) -> Iterator[str]:
    """What may be a module among the names that a module imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)


def _module_file(name: str, package: Path) -> Path | None:
    first, *parts = name.split(".")
    if first != package.name:
        return None
    place = package.joinpath(*parts)
    files = (place / "__init__.py", place.with_suffix(".py")) if parts else (package / "__init__.py",)
    return next((file.resolve() for file in files if file.is_file()), None)


def count_lines(files: Iterable[Path]) -> int:
    """Lines of all files together, each file once."""
    return sum(len(file.read_text(encoding="utf-8").splitlines()) for file in set(files))


def settings_fields(package: Path = PACKAGE) -> list[Holder]:
    """The annotated fields of each class of the package and its rooms whose name ends in Settings."""
    places = [package, *(package / room for room in ROOMS)]
    # Python does not walk through links, which is what the rooms are in a checkout.
    files = {file.resolve() for place in places for file in place.rglob("*.py")}
    return [
        Holder(_place(file), node.name, tuple(name for name, _ in _fields(node)))
        for file in sorted(files)
        for node in _classes(file)
        if node.name.endswith("Settings")
    ]


def box_holders(files: Iterable[Path]) -> list[Holder]:
    """Dataclasses and named tuples with a field that is one box, or several of type `Box`.

    Arrays of many boxes, (n, 4), do not count: they are the numbers of a search.
    """
    found = []
    for file in sorted(set(files)):
        for node in _classes(file):
            fields = [name for name, kind in _fields(node) if name == "box" or "Box" in _names(kind)]
            if fields and _is_record(node):
                found.append(Holder(_place(file), node.name, tuple(fields)))
    return found


def _place(file: Path) -> str:
    return f"{file.parent.name}/{file.name}"


def _classes(file: Path) -> Iterator[ast.ClassDef]:
    tree = ast.parse(file.read_text(encoding="utf-8"))
    return (node for node in ast.walk(tree) if isinstance(node, ast.ClassDef))


def _fields(node: ast.ClassDef) -> Iterator[tuple[str, ast.expr]]:
    for part in node.body:
        if isinstance(part, ast.AnnAssign) and isinstance(part.target, ast.Name):
            yield part.target.id, part.annotation


def _names(node: ast.AST) -> set[str]:
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}


def _is_record(node: ast.ClassDef) -> bool:
    marks = [*node.decorator_list, *node.bases]
    return any({"dataclass", "NamedTuple"} & _names(mark) for mark in marks)
