"""What every training of a net needs: torch, a folder for what is done already, and its peak of memory."""

import json
from collections.abc import Mapping
from pathlib import Path

from lightgesture.errors import UsageError
from lightgesture.results.atomic import replacing


def need_torch() -> None:
    """Raises UsageError where torch is not installed."""
    try:
        import torch  # noqa: F401
    except ImportError as error:
        raise UsageError(
            'torch is not installed, which trains the nets; pip install "lightgesture[train]"'
        ) from error


def checkpoint_folder(out: Path, request: Mapping[str, object]) -> Path:
    """The folder of what is done; UsageError where it belongs to another training."""
    folder = out.with_suffix(".parts")
    note, text = folder / "request.json", json.dumps(dict(request), sort_keys=True)
    if note.exists() and note.read_text(encoding="utf-8") != text:
        raise UsageError(f"{folder}: holds parts of another training; remove it or give another --out")
    if not note.exists():
        with replacing(note) as temporary:
            temporary.write_text(text, encoding="utf-8")
    return folder


def peak_memory_mib() -> int | None:
    """Of this process without its workers; None where the system does not tell."""
    try:
        import resource
    except ImportError:
        return None
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
