"""How hypothesis changes the kept inputs of a target: bytes, or the values of the document that they hold."""

import copy
import json
import tomllib
from collections.abc import Iterator
from typing import Any

from hypothesis import strategies as st

from .targets import Shape, Target

MOST_CHANGES = 4
ODD_TEXTS = ("", "\0", "\n", "nan", "-1", "1e999", "../../etc/passwd", "%s%n", "\ud800", "ok", "x" * 3000)
ODD_NUMBERS = (0, -1, 1, 2**31, 2**63, -(2**63), 10**400, 0.5, 1e308, 1e-320, float("nan"), float("inf"))

VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.sampled_from(ODD_NUMBERS)
    | st.sampled_from(ODD_TEXTS)
    | st.text(max_size=6),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=6,
)
"""What a value of a document may be replaced by."""


def inputs(target: Target, kept: list[bytes]) -> st.SearchStrategy[bytes]:
    """Inputs for a target, made of its kept ones."""
    if target.shape in ("toml", "json", "lines"):
        return documents(target.shape, kept) | changed_bytes(kept)
    return changed_bytes(kept)


@st.composite
def changed_bytes(draw: st.DrawFn, kept: list[bytes]) -> bytes:
    """A kept input with pieces overwritten, taken out, doubled, or put in from another; or any bytes."""
    content = bytearray(draw(st.sampled_from(kept) if kept else st.binary(max_size=64)))
    for _ in range(draw(st.integers(0, MOST_CHANGES))):
        place = draw(st.integers(0, len(content)))
        length = draw(st.sampled_from((0, 1, 2, 4, 16, 256)))
        piece = draw(st.binary(max_size=8) | st.sampled_from((b"\xff" * 4, b"\0" * 4, b"\x7f" * 8)))
        match draw(st.sampled_from(("replace", "double", "other"))):
            case "replace":
                content[place : place + length] = piece
            case "double":
                content[place:place] = content[place : place + length] * 2
            case _ if kept:
                other = draw(st.sampled_from(kept))
                start = draw(st.integers(0, len(other)))
                content[place : place + length] = other[start : start + 64]
            case _:
                content[place:place] = piece
    return bytes(content)


@st.composite
def documents(draw: st.DrawFn, shape: Shape, kept: list[bytes]) -> bytes:
    """A kept document with some of its values replaced, left out or named otherwise."""
    content = _parse(shape, draw(st.sampled_from(kept)))
    document = copy.deepcopy(content)
    for _ in range(draw(st.integers(1, MOST_CHANGES))):
        places = list(_places(document))
        if not places:
            break
        holder, key = draw(st.sampled_from(places))
        match draw(st.sampled_from(("replace", "replace", "remove", "add"))):
            case "replace":
                holder[key] = draw(VALUES)
            case "remove":
                del holder[key]
            case _ if isinstance(holder, dict):
                holder[draw(st.text(max_size=6))] = draw(VALUES)
            case _:
                holder.insert(0, draw(VALUES))
    return _write(shape, document)


def _parse(shape: Shape, content: bytes) -> Any:
    try:
        if shape == "toml":
            return tomllib.loads(content.decode())
        if shape == "lines":
            return [json.loads(line) for line in content.splitlines() if line.strip()]
        return json.loads(content)
    except (ValueError, RecursionError):  # a kept input that is no document at all
        return {}


def _places(value: Any) -> Iterator[tuple[Any, Any]]:
    """Every place in a document: what holds it, and its key or number there; none in a document that is one value."""
    if not isinstance(value, (dict, list)):
        return
    for key in list(value) if isinstance(value, dict) else range(len(value)):
        yield value, key
        yield from _places(value[key])


def _write(shape: Shape, document: Any) -> bytes:
    if shape == "toml":
        lines = [f"{_text(str(key))} = {_toml(value)}" for key, value in document.items()]
        return "\n".join(lines).encode("utf-8", "surrogatepass")
    if shape == "lines":
        return "\n".join(json.dumps(line) for line in document).encode()
    return json.dumps(document).encode()


def _toml(value: Any) -> str:
    match value:
        case None:
            return '""'
        case bool():
            return "true" if value else "false"
        case dict():
            return "{" + ", ".join(f"{_text(str(key))} = {_toml(one)}" for key, one in value.items()) + "}"
        case list():
            return "[" + ", ".join(map(_toml, value)) + "]"
        case str():
            return _text(value)
    return str(value)


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
