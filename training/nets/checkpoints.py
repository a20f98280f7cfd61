"""What every training of a net needs: torch, a folder for what is done already, the digest of a file that it goes on
from, and its peak of memory."""

import hashlib
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from lightgesture.errors import UsageError
from lightgesture.results.atomic import replacing

REQUEST: Final = "request.json"
"""What a folder of parts is of."""

MOST_TOLD: Final = 3
"""Settings that are named where requests differ."""

_SETTING: Final = re.compile(r"\b(\w+)=('[^']*'|[^\s,()]+)")


def need_torch() -> None:
    """Raises UsageError where torch is not installed."""
    try:
        import torch  # noqa: F401
    except ImportError as error:
        raise UsageError(
            'torch is not installed, which trains the nets; pip install "lightgesture[train]"'
        ) from error


def checkpoint_folder(out: Path, request: Mapping[str, object]) -> Path:
    """The folder of what is done; UsageError where it belongs to another training: what differs, and what to do."""
    folder = out.with_suffix(".parts")
    note, text = folder / REQUEST, json.dumps(dict(request), sort_keys=True)
    if note.exists() and (before := note.read_text(encoding="utf-8")) != text:
        raise UsageError(
            f"{folder}: holds parts of another training{_difference(before, text)}; {_remedy(folder)}"
        )
    if not note.exists():
        with replacing(note) as temporary:
            temporary.write_text(text, encoding="utf-8")
    return folder


def _difference(before: str, now: str) -> str:
    """What two requests differ in, as far as their settings tell."""
    old, new = (dict(_SETTING.findall(text)) for text in (before, now))
    changed = [name for name in new if name in old and old[name] != new[name]]
    if not changed:
        return " or of other pictures"
    told = ", ".join(f"{name} {old[name]} and not {new[name]}" for name in changed[:MOST_TOLD])
    return f" ({told}{', ...' if len(changed) > MOST_TOLD else ''})"


def _remedy(folder: Path) -> str:
    other = folder.with_name(f"other{folder.suffix}")
    return (
        "give the same options to go on with it, or another --out. To use its patches with other steps: "
        f"mkdir {other}, cp {folder}/patches.* {folder}/[cl]*.npy {other}, and --out {other.with_suffix('.npz')}"
    )


def sha256_of(file: Path) -> str:
    """Of a file's content, in hexadecimal."""
    return hashlib.sha256(file.read_bytes()).hexdigest()


def peak_memory_mib() -> int | None:
    """Of this process without its workers; None where the system does not tell."""
    try:
        import resource
    except ImportError:
        return None
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
