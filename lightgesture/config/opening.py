"""From settings to a pipeline and to output folders, with what is wrong told as a UsageError."""

from pathlib import Path

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.features.find.selector_file import SelectorError
from lightgesture.features.profile import ProfileError
from lightgesture.fsm import GrammarError
from lightgesture.models import ModelError
from lightgesture.pipeline import Pipeline
from lightgesture.results import DebugPictures


def open_pipeline(settings: DecodeSettings, source: str | None, debug: DebugPictures | None) -> Pipeline:
    """The pipeline for one input, `source` being its name in the records.

    UsageError: the model, the selector's data, the colour profile or the grammar is wrong, or options exclude each
    other.
    """
    try:
        return Pipeline(
            model=settings.model,
            selector=settings.selector,
            profile=settings.profile,
            threshold=settings.threshold,
            rule=settings.rule,
            hold=settings.hold,
            hold_seconds=settings.hold_seconds,
            caution=settings.caution,
            grammar=settings.grammar,
            mirrored=settings.mirrored,
            source=source,
            frames=settings.frames,
            debug=debug,
        )
    except (ModelError, SelectorError, ProfileError, GrammarError, ValueError) as error:
        raise UsageError(str(error)) from error


def make_debug_pictures(settings: DecodeSettings, stem: str) -> DebugPictures | None:
    """Where the pictures of the stages of one input go, None where the user wants none."""
    return DebugPictures(Path(settings.debug_dir) / stem) if settings.debug_dir else None


def make_folder(path: str) -> None:
    """Make a folder for results, if it is not there. UsageError: it cannot be made."""
    try:
        Path(path).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(
            f"{path}: is no folder that can be written ({error.strerror}); name another"
        ) from None
