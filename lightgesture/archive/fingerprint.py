"""Short names for what a result depends on: when one differs, the result is made anew."""

import hashlib
import json
import os
from importlib.resources import files
from pathlib import Path

from lightgesture._version import __version__
from lightgesture.archive.tasks import Task
from lightgesture.config.settings import BUILT_IN_MODELS, NO_INFLUENCE, PATH_OPTIONS, DecodeSettings
from lightgesture.sources import is_picture_name
from lightgesture.sources.bag_name import is_bag

_ROOMS_WITH_DATA = ("features", "models")


def input_fingerprint(task: Task) -> str | None:
    """Of size and time of change: of a file or its chapters, or of the pictures of a folder, or the files of a bag,
    with their names.

    None where there is nothing to go by: no such file, a stream, a folder that cannot be read.
    """
    try:
        if not os.path.isdir(task.path):
            files = task.chapters or (task.path,)
            return _digest([_stamp(path) for path in files]) if all(map(os.path.isfile, files)) else None
        is_whole = is_bag(task.path)
        names = task.pictures or sorted(
            name for name in os.listdir(task.path) if is_whole or is_picture_name(name)
        )
        return _digest([(os.fsencode(name).hex(), *_stamp(os.path.join(task.path, name))) for name in names])
    except OSError:
        return None


def run_fingerprint(settings: DecodeSettings) -> str:
    """Of the version of this package, all settings that matter, and the content of the files that they name."""
    content = settings.model_dump(mode="json", exclude=set(NO_INFLUENCE))
    for key in PATH_OPTIONS:
        value = content.get(key)
        if value is not None and value not in BUILT_IN_MODELS and os.path.isfile(value):
            content[key] = hashlib.sha256(Path(value).read_bytes()).hexdigest()
    return _digest([__version__, content, *_bundled()])


def _bundled() -> list[str]:
    """Digests of the models and the grammar that come with the package."""
    package = files("lightgesture")
    data = [item for room in _ROOMS_WITH_DATA for item in (package / room / "data").iterdir()]
    data.append(package / "fsm" / "grammar.toml")
    return [hashlib.sha256(item.read_bytes()).hexdigest() for item in sorted(data, key=str) if item.is_file()]


def _stamp(path: str) -> tuple[int, int]:
    status = os.stat(path)
    return status.st_size, status.st_mtime_ns


def _digest(content: object) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
