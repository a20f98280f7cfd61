"""The house holds: arrows between the rooms, heavy libraries only where they are needed, nobody's private parts.

Everything is read from the sources by `ast`; imports within functions and for type checkers count like all others.
"""

import ast
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
APPLICATION = "lightgesture"
KINDS = (
    *(ast.Import, ast.ImportFrom, ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef),
    *(ast.Attribute, ast.Name, ast.Call),
)
"""Nodes that are looked at."""

BELOW = {
    "fsm": (),
    "features": (),
    "models": ("features",),
    APPLICATION: ("features", "models", "fsm"),
    "synth": ("features", "models", "fsm", APPLICATION),
    "training": ("features", "models", "fsm", APPLICATION, "synth"),
    "benchmarks": ("features", "models", "fsm", APPLICATION, "synth", "training"),
}
"""Rooms, and the rooms that each may import."""

HEAVY = frozenset(
    {
        *("av", "dask", "distributed", "fpdf", "gpiozero", "matplotlib", "mujoco", "pupil_apriltags"),
        *("pydantic", "pymavlink", "pypdfium2", "rclpy", "rosbags", "rospy", "sklearn", "torch"),
    }
)
"""Libraries that only some uses need: imported in the function that uses them."""

AT_MODULE_LEVEL = {
    "pydantic": (
        "fsm/language/document.py",
        "fsm/language/schema.py",
        "lightgesture/config/*.py",
        "lightgesture/grammar/replay.py",
        "mavlink_map.py",
        "lightgesture/vehicle/profile*.py",
        "lightgesture/vehicle/steps.py",
        "synth/*.py",
    ),
    "torch": ("training/nets/*.py", "benchmarks/paper/net.py"),
}
"""Modules of checked files and of the nets as torch has them: what needs them imports them in a function."""


def python_files(*rooms: str) -> list[Path]:
    """All modules of the rooms; links from room to room are not walked."""
    return sorted(
        file
        for room in rooms
        for folder in [ROOT / room]
        for file in folder.rglob("*.py")
        if not any(
            part.is_symlink() for part in file.parents if part.is_relative_to(folder) and part != folder
        )
    )


@cache
def tree_of(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


@cache
def nodes_of(file: Path) -> tuple[ast.AST, ...]:
    """All nodes of a module of the kinds that are asked for here."""
    return tuple(node for node in ast.walk(tree_of(file)) if isinstance(node, KINDS))


def imports(nodes: Iterable[ast.AST]) -> Iterator[tuple[str, ast.stmt]]:
    """What is imported by nodes, as names with dots, and by which statement."""
    for part in nodes:
        if isinstance(part, ast.Import):
            yield from ((alias.name, part) for alias in part.names)
        elif isinstance(part, ast.ImportFrom):
            assert part.level == 0, "imports are written out"
            yield from ((f"{part.module}.{alias.name}", part) for alias in part.names)


def place(file: Path, node: ast.AST) -> str:
    return f"{file.relative_to(ROOT)}:{getattr(node, 'lineno', 0)}"


def room_of(name: str) -> str | None:
    """The room that an imported name lies in."""
    first, _, rest = name.partition(".")
    if first != APPLICATION:
        return None
    room = rest.partition(".")[0]
    return room if room in BELOW else APPLICATION


@pytest.mark.parametrize("room", BELOW)
def test_imports_go_down_the_house(room):
    files = python_files(room)
    assert files
    wrong = [
        f"{place(file, node)} imports {name}"
        for file in files
        for name, node in imports(nodes_of(file))
        if room_of(name) not in (None, room, *BELOW[room])
    ]
    assert wrong == []


def module_level(node: ast.Module) -> Iterator[ast.stmt]:
    """The statements that an import runs, but for those that only type checkers see."""
    waiting: list[ast.stmt] = [*node.body]
    while waiting:
        part = waiting.pop()
        if isinstance(part, (ast.FunctionDef, ast.AsyncFunctionDef)):
            continue
        if isinstance(part, ast.If) and "TYPE_CHECKING" in ast.unparse(part.test):
            waiting += part.orelse
            continue
        yield part
        waiting += [child for child in ast.iter_child_nodes(part) if isinstance(child, ast.stmt)]


def test_heavy_libraries_are_imported_where_they_are_needed():
    wrong = [
        f"{place(file, part)} imports {name}"
        for file in python_files(*BELOW)
        for part in module_level(tree_of(file))
        if isinstance(part, (ast.Import, ast.ImportFrom))
        for name, _ in imports([part])
        if (library := name.partition(".")[0]) in HEAVY
        and not any(file.relative_to(ROOT).match(allowed) for allowed in AT_MODULE_LEVEL.get(library, ()))
    ]
    assert wrong == []


def is_private(name: str) -> bool:
    return name.startswith("_") and not name.startswith("__") and name != "_"


def defined(file: Path) -> Iterator[str]:
    """Underscored names that a module defines: functions, classes, constants, fields, what is set on an object."""
    for node in nodes_of(file):
        names: list[str] = []
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            names = [node.name]
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names = [node.id]
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and is_self(node.value):
            names = [node.attr]
        yield from filter(is_private, names)


@cache
def private_names_of_the_house() -> frozenset[str]:
    """What is private elsewhere, as in scikit-learn's trees, is no matter of this house."""
    return frozenset(name for file in python_files(*BELOW) for name in defined(file))


def last_name(node: ast.expr) -> str:
    """The name at the end of an expression with dots, empty for another one."""
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def is_self(node: ast.expr) -> bool:
    return isinstance(node, ast.Name) and node.id in ("self", "cls")


def private_uses(file: Path) -> Iterator[str]:
    """Where a module touches an underscored name of another: by a dot, by an import, or by `setattr`."""
    others = private_names_of_the_house() - set(defined(file))
    for node in nodes_of(file):
        names: list[str] = []
        if isinstance(node, ast.Attribute) and not is_self(node.value):
            names = [node.attr]
        elif isinstance(node, ast.ImportFrom):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.Call) and last_name(node.func) in ("setattr", "getattr", "delattr"):
            words = [str(one.value) for one in node.args if isinstance(one, ast.Constant)]
            names = [word.rpartition(".")[2] for word in words]
        yield from (f"{place(file, node)} touches {name}" for name in names if name in others)


def inherited_uses(files: list[Path]) -> Iterator[str]:
    """Where a class touches an underscored name of a base that stands in another room."""
    classes = {
        node.name: (file.relative_to(ROOT), node)
        for file in files
        for node in nodes_of(file)
        if isinstance(node, ast.ClassDef)
    }
    for file, node in classes.values():
        for base in node.bases:
            other, parent = classes.get(last_name(base), (file, node))
            if other.parts[0] != file.parts[0]:
                for name in sorted(private_parts(node) & private_parts(parent)):
                    yield f"{file}:{node.lineno} {node.name} touches {name} of its base {parent.name}"


def private_parts(node: ast.ClassDef) -> set[str]:
    """Underscored names that a class defines, sets, reads or asks of its base."""
    methods = {part.name for part in node.body if isinstance(part, ast.FunctionDef)}
    touched = {
        part.attr for part in ast.walk(node) if isinstance(part, ast.Attribute) and is_self(part.value)
    }
    return {name for name in methods | touched if is_private(name)}


@pytest.mark.parametrize("room", [*BELOW, "tests"])
def test_nothing_outside_a_module_touches_its_underscored_names(room):
    assert [use for file in python_files(room) for use in private_uses(file)] == []


def test_no_class_touches_underscored_names_of_a_base_in_another_room():
    assert list(inherited_uses(python_files(*BELOW, "tests"))) == []
