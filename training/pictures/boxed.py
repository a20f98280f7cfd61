"""A picture and the boxes of what nets and trees learn to find in it."""

from dataclasses import dataclass

from lightgesture.features.types import Box, Image


@dataclass(frozen=True, slots=True, eq=False)
class BoxedPicture:
    """image: uint8 (h, w, 3), BGR. boxes: outlines of all hands in it, source pixels; may be empty. faces: boxes of
    faces that are known. all_faces: those are all. sources: whose pictures went in. ignored: boxes of what may be a
    hand, of which nothing is learnt."""

    image: Image
    boxes: tuple[Box, ...]
    faces: tuple[Box, ...] = ()
    all_faces: bool = False
    sources: frozenset[str] = frozenset()
    ignored: tuple[Box, ...] = ()
