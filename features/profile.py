"""A colour profile: which colours a diver's hands have, bare or in gloves; a small JSON file.

It replaces the default skin map where hands are not the reddest thing in view. The map says how much a colour is that
of a hand, by a table over colours that are standardised channel by channel (`standardise`): a profile learnt in one
water serves in another, as far as colour can. `profile_learning` makes profiles.
"""

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.files import FileRefusedError, read_whole
from lightgesture.features.standardise import channel_tables
from lightgesture.features.types import Image

Kind = Literal["skin", "glove"]

FORMAT = "lightgesture colour profile 1"
UNDECIDED = 128
"""Level of a colour that is as frequent on hands as elsewhere."""

LARGEST_FILE = 512 * 1024
"""Bytes; a file beyond this is refused unread."""
FEWEST_BINS, MOST_BINS = 4, 24
LONGEST_ORIGIN = 500
"""Characters."""
REMEDY = "make it again with: lightgesture calibrate"


class ProfileError(ValueError):
    """A profile file that cannot be used: one line with the file, the reason and the remedy."""


@dataclass(frozen=True, slots=True, eq=False)
class ColourProfile:
    """kind: of the hands. origin: what it was learnt from, in words. separation: area under the ROC curve of telling
    pixels of hands from others in pictures that were not learnt from, 0 to 1, useless at 0.5. reach: standard
    deviations of a channel that the table spans to either side of its mean, 1 to 3. levels: uint8 (bins, bins, bins),
    how much a colour is that of a hand, by blue, green and red; `UNDECIDED` where it may be either.
    """

    kind: Kind
    origin: str
    separation: float
    reach: float
    levels: NDArray[np.uint8]

    def map(self, picture: Image) -> Image:
        """How much each pixel of a BGR picture is a hand, uint8 (h, w, 3) -> (h, w): a `ColourMap.skin`.

        A picture of one colour gives zeros: nothing stands out in it.
        """
        found = self.levels.ravel().take(colour_cells(picture, len(self.levels), self.reach))
        if int(found.min()) == int(found.max()):
            return np.zeros(found.shape, np.uint8)
        return np.asarray(cv2.GaussianBlur(found, (3, 3), 0), np.uint8)


def colour_cells(picture: Image, bins: int, reach: float) -> NDArray[np.intp]:
    """Cell of each pixel of a BGR picture in a table of bins³ standardised colours, (h, w), row-major b, g, r."""
    steps = np.clip((channel_tables(picture) + reach) * (bins / (2.0 * reach)), 0, bins - 1).astype(np.int32)
    steps *= np.array([bins * bins, bins, 1], np.int32)
    blue, green, red = cv2.split(cv2.LUT(picture, steps))
    return np.asarray(blue + green + red, np.intp)


def save_profile(path: Path, profile: ColourProfile) -> None:
    """Write the file. Raises OSError."""
    content = {
        "format": FORMAT,
        "kind": profile.kind,
        "origin": profile.origin[:LONGEST_ORIGIN],
        "separation": round(profile.separation, 4),
        "reach": profile.reach,
        "bins": len(profile.levels),
        "levels": profile.levels.ravel().tolist(),
    }
    path.write_text(json.dumps(content) + "\n", encoding="utf-8")


def load_profile(path: str | os.PathLike[str]) -> ColourProfile:
    """Read a profile. Raises ProfileError."""
    file = Path(path)
    try:
        return _parse(json.loads(read_whole(file, LARGEST_FILE).decode("utf-8")))
    except FileRefusedError as error:
        raise ProfileError(f"{file}: no valid colour profile ({error.strerror}); {REMEDY}") from None
    except OSError as error:
        raise ProfileError(f"{file}: cannot be read ({error.strerror}); {REMEDY}") from None
    except (ValueError, RecursionError) as error:
        reason = " ".join(str(error).split())
        raise ProfileError(f"{file}: no valid colour profile ({reason}); {REMEDY}") from None


def _parse(content: Any) -> ColourProfile:
    """The profile of a file's content. Raises ValueError."""
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ValueError(f"format is not {FORMAT!r}")
    known = {"format", "kind", "origin", "separation", "reach", "bins", "levels"}
    if content.keys() != known:
        wrong = sorted(content.keys() ^ known)
        raise ValueError(f"unknown or missing: {', '.join(wrong)[:200]}")
    kind, origin, bins, levels = (content[name] for name in ("kind", "origin", "bins", "levels"))
    if kind not in get_args(Kind):
        raise ValueError(f"kind is neither of {', '.join(get_args(Kind))}")
    if not isinstance(origin, str) or len(origin) > LONGEST_ORIGIN:
        raise ValueError(f"origin is no text of at most {LONGEST_ORIGIN} characters")
    if type(bins) is not int or not FEWEST_BINS <= bins <= MOST_BINS:
        raise ValueError(f"bins is no whole number from {FEWEST_BINS} to {MOST_BINS}")
    if not isinstance(levels, list) or len(levels) != bins**3:
        raise ValueError("levels is no list of bins³ numbers")
    if not all(type(level) is int and 0 <= level <= 255 for level in levels):
        raise ValueError("levels holds something else than whole numbers from 0 to 255")
    table = np.array(levels, np.uint8).reshape(bins, bins, bins)
    return ColourProfile(
        kind, origin, _number(content, "separation", 0, 1), _number(content, "reach", 1, 3), table
    )


def _number(content: dict[str, Any], name: str, low: float, high: float) -> float:
    value = content[name]
    if type(value) not in (int, float) or not low <= value <= high:
        raise ValueError(f"{name} is no number from {low:g} to {high:g}")
    return float(value)
