"""Pictures in: files, folders, bags and streams become frames, BGR with 8 bits, each with its time."""

from lightgesture.config import DEFAULT_FPS
from lightgesture.sources.folder import natural_key
from lightgesture.sources.pictures import is_picture_name, read_picture, to_image
from lightgesture.sources.registry import (
    LIVE_SOURCES,
    SOURCES,
    expand_inputs,
    live_source,
    open_any,
    open_source,
    refuse_missing_device,
)
from lightgesture.sources.stream_frames import StreamFrames
from lightgesture.sources.types import Content, LiveSource, Source, SourceOptions

__all__ = [
    "DEFAULT_FPS",
    "LIVE_SOURCES",
    "SOURCES",
    "Content",
    "LiveSource",
    "Source",
    "SourceOptions",
    "StreamFrames",
    "expand_inputs",
    "is_picture_name",
    "live_source",
    "natural_key",
    "open_any",
    "open_source",
    "read_picture",
    "refuse_missing_device",
    "to_image",
]
