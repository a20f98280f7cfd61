"""What the sources need to know beyond a name."""

from dataclasses import dataclass

DEFAULT_FPS = 30.0
"""Frames a second of sources without time stamps, where the user names no other."""


@dataclass(frozen=True, slots=True)
class SourceOptions:
    """What the user may say about a source; each is used by some sources only.

    fps: frames a second of a folder and of standard input, above 0. size: width and height in pixels: of raw standard
    input, which is taken for JPEG pictures without it; asked of a camera, which may give another. topic: the image
    topic of a bag, needed where it has several.
    """

    fps: float = DEFAULT_FPS
    size: tuple[int, int] | None = None
    topic: str | None = None


@dataclass(frozen=True, slots=True)
class StreamSettings:
    """Limits of streams.

    timeout_s: seconds until a peer must have answered, and without data after which a stream counts as broken off,
    above 0; shorter notices sooner, longer forgives a weak link. no_picture_s: seconds in which data came and no whole
    picture. max_picture_bytes: longest JPEG file; a longer one is no picture. max_pixels: most pixels of a picture,
    against files that promise more than fits the memory. chunk_bytes: read at once.
    """

    timeout_s: float = 5.0
    no_picture_s: float = 10.0
    max_picture_bytes: int = 16 << 20
    max_pixels: int = 40_000_000
    chunk_bytes: int = 1 << 16


STREAM = StreamSettings()
