"""Video in: files and folders become frames, BGR with 8 bits, each with its time."""

from lightgesture.sources.names import expand_inputs, natural_key
from lightgesture.sources.pictures import is_picture_name, read_picture
from lightgesture.sources.registry import DEFAULT_FPS, SOURCES, open_source
from lightgesture.sources.types import Source

__all__ = [
    "DEFAULT_FPS",
    "SOURCES",
    "Source",
    "expand_inputs",
    "is_picture_name",
    "natural_key",
    "open_source",
    "read_picture",
]
