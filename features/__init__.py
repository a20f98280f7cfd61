"""From pixels to hand regions and numbers."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lightgesture.features.find.selector import find_hands

__all__ = ["find_hands"]


def __getattr__(name: str) -> object:
    """Import `find_hands` on first use, so that a type or a box can be had without the selector."""
    if name == "find_hands":
        from lightgesture.features.find.selector import find_hands

        return find_hands
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
