"""Frozen records made as quickly as plain ones.

A frozen dataclass sets each field of a new record through `object.__setattr__`, which takes several times as long as an
assignment. The decoder makes records in the midst of the frames of a video, where every microsecond counts.
"""

from collections.abc import Callable
from dataclasses import MISSING, fields
from typing import Any, ParamSpec, TypeVar, cast

Fields = ParamSpec("Fields")
Record = TypeVar("Record")


def quick(record: Callable[Fields, Record]) -> Callable[Fields, Record]:
    """A function that makes the same records as the frozen, slotted dataclass `record`, in a quarter of the time.

    It sets the fields of an instance of a plain class with the same slots and then gives it the class of the record:
    classes with the same slots may take each other's place (The Python Language Reference, 3.3.2.4.1). As a dataclass
    does, it comes of a text, so that every field is set by an assignment of its own. Fields are given by name;
    their defaults are values, not factories.
    """
    columns = fields(cast("Any", record))
    names = tuple(column.name for column in columns)
    space: dict[str, Any] = {"Plain": type("Plain", (), {"__slots__": names}), "Record": record}
    arguments, lines = [], []
    for column in columns:
        default = f"default_{column.name}"
        space[default] = column.default
        if column.init:
            arguments.append(column.name + ("" if column.default is MISSING else f"={default}"))
        lines.append(f"    made.{column.name} = {column.name if column.init else default}")
    head = [f"def make(*, {', '.join(arguments)}):", "    made = Plain()"]
    exec("\n".join([*head, *lines, "    made.__class__ = Record", "    return made"]), space)
    return cast("Callable[Fields, Record]", space["make"])
