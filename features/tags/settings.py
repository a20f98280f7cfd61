"""What tells a tag from anything else."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class TagSettings:
    """What tells a tag from anything else, and what is done for those that are hard to see."""

    least_margin: float = 3.0
    """Least half difference between white and black cells, grey levels, 0 to 127. Less: more is read in murk, and noise
    may be taken for a tag."""
    least_agreement: float = 0.9
    """Least share of cells that are as they should be, 0 to 1. Less: more is read behind fingers and bubbles; the codes
    of 36h11 differ in 11 of 64 cells, so that 0.9 is far from any other."""
    alone_agreement: float = 0.95
    """The same of a tag that OpenCV does not name, where none with its id was shortly before."""
    threshold: int = 5
    """How much darker than its surroundings a pixel is to be black, grey levels. Less: more is read in murk and in
    blur, and everything takes longer, for there are more outlines."""
    near_threshold: int = 3
    """The same where a tag was lost."""
    follow_s: float = 1.0
    """How long a tag that is no longer found is looked for where it was last, seconds. More: takes longer."""
    follow_reach: float = 1.0
    """How far round its last place, in sides of the tag. More: quicker cards are followed, which takes longer."""
    small_side: float = 48.0
    """Side below which a tag that is followed is looked at enlarged, pixels."""
    least_perimeter: float = 0.05
    """Least perimeter of a tag as a share of the picture's longer side: 8 pixels a side at 640. OpenCV's own is 0.03.
    Less: reefs, sand and leaves take longer."""
    busy: float = 0.06
    """Share of neighbouring pixels that differ by more than `threshold` from which on a picture is busy, 0 to 1. Then
    one window of WINDOWS_PX is tried a frame, in turn, unless a tag was lost: reefs have thousands of outlines. Less:
    more pictures are quick, and a tag that only one window finds is found a frame or two later."""
