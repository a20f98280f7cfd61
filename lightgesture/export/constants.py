"""Every constant and setting of the stages before and behind the nets, read from the modules themselves."""

import ast
import importlib
import inspect
import math
import pkgutil
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from itertools import pairwise
from types import ModuleType
from typing import Any, Final

import lightgesture.features
import lightgesture.fsm

ROOMS: Final = (lightgesture.features, lightgesture.fsm)
"""Packages whose modules are looked through."""


def constants() -> dict[str, dict[str, Any]]:
    """By module: name of a constant -> its value and what its docstring says; a settings class likewise, by field."""
    found = {name.removeprefix("lightgesture."): dict(_of_module(module)) for name, module in _modules()}
    return {name: entries for name, entries in sorted(found.items()) if entries}


def _modules() -> Iterator[tuple[str, ModuleType]]:
    for room in ROOMS:
        for info in pkgutil.walk_packages(room.__path__, f"{room.__name__}."):
            yield info.name, importlib.import_module(info.name)


def _of_module(module: ModuleType) -> Iterator[tuple[str, Any]]:
    body = ast.parse(inspect.getsource(module)).body
    about = _docstrings(body)
    for name in _assigned(body):
        value = getattr(module, name, None)
        if name.isupper() and not name.startswith("_") and _is_plain(value):
            yield name, {"value": value, "about": about.get(name, "")}
    for item in body:
        if isinstance(item, ast.ClassDef) and item.name.endswith("Settings"):
            yield item.name, _of_settings(getattr(module, item.name), item)


def _of_settings(kind: Any, item: ast.ClassDef) -> dict[str, Any]:
    """A settings class: what its docstring says, and each field that is a plain value."""
    about = _docstrings(item.body)
    values: dict[str, Any] = {}
    for field in fields(kind) if is_dataclass(kind) else ():
        if _is_plain(field.default):
            values[field.name] = {"value": field.default, "about": about.get(field.name, "")}
    return {"about": inspect.cleandoc(ast.get_docstring(item) or ""), "fields": values}


def _assigned(body: list[ast.stmt]) -> Iterator[str]:
    for item in body:
        targets = item.targets if isinstance(item, ast.Assign) else [getattr(item, "target", None)]
        for target in targets:
            for name in target.elts if isinstance(target, ast.Tuple) else [target]:
                if isinstance(name, ast.Name):
                    yield name.id


def _docstrings(body: list[ast.stmt]) -> dict[str, str]:
    """Name -> the text in the line below its assignment."""
    texts = {}
    for item, following in pairwise(body):
        if isinstance(following, ast.Expr) and isinstance(following.value, ast.Constant):
            text = " ".join(str(following.value.value).split())
            texts.update(dict.fromkeys(_assigned([item]), text))
    return texts


def _is_plain(value: Any) -> bool:
    """Whether JSON can hold it: a number, a text, or a tuple of these."""
    if isinstance(value, tuple):
        return all(_is_plain(one) for one in value)
    if isinstance(value, float):
        return math.isfinite(value)
    return value is None or isinstance(value, bool | int | str)
