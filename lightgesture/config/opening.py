"""From settings to a pipeline and to output folders, with what is wrong told as a UsageError."""

from collections.abc import Callable
from inspect import signature
from pathlib import Path
from typing import Final

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.features.find.selector_file import SelectorError
from lightgesture.features.profile import ProfileError
from lightgesture.fsm import GrammarError
from lightgesture.models import ModelError
from lightgesture.pipeline import Pipeline
from lightgesture.results import DebugPictures

PIPELINE_OPTIONS: Final = tuple(
    name for name in signature(Pipeline).parameters if name in DecodeSettings.model_fields
)
"""Options that are keywords of `Pipeline` too, under the same names."""


def open_stream(
    settings: DecodeSettings, source: str | None, debug: DebugPictures | None, remark: Callable[[str], None]
) -> Pipeline:
    """As `open_pipeline`, for frames that follow each other: their signs become words.

    remark: is told of signs that the grammar does not know. UsageError: also where it has tokens that are never read.
    """
    pipeline = open_pipeline(settings, source, debug)
    try:
        warning = pipeline.check_language()
    except ModelError as error:
        raise UsageError(str(error)) from error
    if warning is not None:
        remark(warning)
    return pipeline


def open_pipeline(settings: DecodeSettings, source: str | None, debug: DebugPictures | None) -> Pipeline:
    """The pipeline for one input, `source` being its name in the records.

    UsageError: the model, the selector's data, the colour profile or the grammar is wrong, or options exclude each
    other.
    """
    try:
        options = {name: getattr(settings, name) for name in PIPELINE_OPTIONS}
        return Pipeline(**options, source=source, debug=debug)
    except (ModelError, SelectorError, ProfileError, GrammarError, ValueError) as error:
        raise UsageError(str(error)) from error


def make_debug_pictures(
    settings: DecodeSettings, stem: str, tell: Callable[[str], None] | None = None
) -> DebugPictures | None:
    """Where the pictures of the stages of one input go, None where the user wants none. tell: see `DebugPictures`."""
    return DebugPictures(Path(settings.debug_dir) / stem, tell) if settings.debug_dir else None


def make_folder(path: str) -> None:
    """Make a folder for results, if it is not there. UsageError: it cannot be made."""
    try:
        Path(path).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(
            f"{path}: is no folder that can be written ({error.strerror}); name another"
        ) from None
