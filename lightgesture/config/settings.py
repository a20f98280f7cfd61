"""Every option of the decoding commands with its range and its effect, as one model of three parts."""

from collections.abc import Callable, Mapping
from typing import Any

from lightgesture.config.declaring import DECODE, LIVE, RECOGNIZE, option
from lightgesture.config.file_options import FileOptions
from lightgesture.config.live_options import LiveOptions
from lightgesture.config.reading_options import ReadingOptions

BUILT_IN_MODELS = ("cnn", "svm")
"""Names that `--model` knows; any other is the path of a file."""

BUILT_IN_VEHICLES = ("ardusub", "manual")
"""Likewise profiles that `--obey` knows."""


# Fields stand in the order of the bases from the last to the first: so they come in the help and in a written file.
class DecodeSettings(LiveOptions, FileOptions, ReadingOptions):
    """Every option of the decoding commands, checked."""

    debug_dir: str | None = option(
        None,
        "write a picture of every stage: DIR/<input stem>/<stage>-<frame>.png",
        "DIR",
        kind="path",
        only=(DECODE, RECOGNIZE, LIVE),
        min_length=1,
    )
    quiet: bool = option(False, "no progress and no remarks on standard error", changes_results=False)


def _fields_with(key: str, value: object) -> tuple[str, ...]:
    """Fields whose options say this of themselves."""
    fields = DecodeSettings.model_fields.items()
    return tuple(
        name
        for name, field in fields
        if isinstance(field.json_schema_extra, dict) and field.json_schema_extra[key] == value
    )


PATH_OPTIONS = _fields_with("kind", "path")
"""Fields that name files and folders."""

NO_INFLUENCE = _fields_with("changes_results", False)
"""Fields that change no file of results; any other makes these anew."""


def change_paths(values: Mapping[str, Any], change: Callable[[str], str]) -> dict[str, str]:
    """The paths among the values of options, each as `change` makes it; names of what is built in are none."""
    given = {name: values.get(name) for name in PATH_OPTIONS}
    return {
        name: change(path)
        for name, path in given.items()
        if path and path not in (*BUILT_IN_MODELS, *BUILT_IN_VEHICLES)
    }
