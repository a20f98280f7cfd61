"""Read a diver's two-handed signs in video and turn them into robot instructions."""

from typing import TYPE_CHECKING

from lightgesture._version import __version__

if TYPE_CHECKING:
    from lightgesture.pipeline import Pipeline

__all__ = ["Pipeline", "__version__"]


def __getattr__(name: str) -> object:
    """Import `Pipeline` on first use, so that `import lightgesture` loads neither OpenCV nor NumPy."""
    if name == "Pipeline":
        from lightgesture.pipeline import Pipeline

        return Pipeline
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
