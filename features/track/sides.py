"""The diver's own sides: which hand is the right one.

A diver faces the camera, so in an unmirrored picture the right hand is at image left when both are seen and first
believed. From then on a side stays with its track, wherever the hand goes. A lone hand is on the side of the axis
of the body or face on which it is seen, or else of the picture's middle: a guess, which its partner puts right.
"""

from typing import Literal

from lightgesture.features.types import Side

Basis = Literal["none", "middle", "axis", "pair"]
"""What a side rests on: nothing yet, the picture's middle, the body's axis, both hands seen together."""

CERTAIN: Basis = "pair"


def opposite(side: Side) -> Side:
    """The other side."""
    return "left" if side == "right" else "right"


def lone_side(x: float, axis: float | None, width: int) -> tuple[Side, Basis]:
    """Side of a hand whose centre is at x, by the body's axis where it is seen, else by the picture's middle.

    x, axis: source pixels. width: that of the picture.
    """
    line = width / 2 if axis is None else axis
    return "right" if x < line else "left", "middle" if axis is None else "axis"


def pair_sides(
    first_x: float, second_x: float, first: Side | None = None, second: Side | None = None
) -> tuple[Side, Side]:
    """Sides of two hands at these x. first, second: a side that one of them is known to have, which decides."""
    if first is not None:
        return first, opposite(first)
    if second is not None:
        return opposite(second), second
    return ("right", "left") if first_x <= second_x else ("left", "right")
