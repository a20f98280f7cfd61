"""The joints of labelled hands in space, from an archive beside their manifest.

Beside `NAME.csv` may lie `world_NAME.npz`, its arrays in the order of the table's rows: `world` (n, 21, 3), metres, x
right, y down, z away from the camera, in any origin; `hand` (n,), what the detector took the hand for, +1 a right one,
-1 a left one; `err` (n,), how far its landmarks lay from the labelled ones, in sides of the hand's box, NaN where it
found none.
"""

import zipfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import InputError
from lightgesture.synth.joint_angles import fit_hands
from lightgesture.synth.poses import agrees
from lightgesture.synth.skeleton import JOINT_COUNT
from lightgesture.synth.views import OTHER_SIDE

LARGEST_ERROR: Final = 0.06
"""Of the landmarks; joints of hands with more are not trusted."""
LEFT: Final = 1
"""Mark of left hands: the detector takes pictures for those of a mirror, and so each hand for the other."""
TO_CAMERA: Final = np.array([1.0, -1.0, -1.0])
"""From the archive's axes to x right, y up, z towards the camera."""


@dataclass(frozen=True, slots=True, eq=False)
class Joints:
    """Of one hand. world: float32 (21, 3), x right, y up, z towards the camera, metres. left: a left hand."""

    world: NDArray[np.float32]
    left: bool

    def mirrored(self) -> "Joints":
        """What a mirror shows: the other hand."""
        return Joints(self.world * np.array([-1.0, 1.0, 1.0], np.float32), not self.left)


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """Poses of real hands, left ones mirrored. angles: (n, 5, 4), degrees. rotations: (n, 3, 3), before the camera.
    tokens: (n,), names, as mirrored. hands: int (n,), numbers of the hands that had them."""

    angles: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 5, 4)))
    rotations: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 3, 3)))
    tokens: NDArray[np.str_] = field(default_factory=lambda: np.zeros(0, "<U1"))
    hands: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))

    def __len__(self) -> int:
        return len(self.angles)

    def chosen(self, kept: NDArray[np.bool_]) -> "Poses":
        """Those of the kept rows, bool (n,)."""
        return Poses(self.angles[kept], self.rotations[kept], self.tokens[kept], self.hands[kept])


def read_joints(manifest: Path, rows: int) -> list[Joints | None]:
    """Joints of each of a manifest's rows, None where they are not known or not trusted. Raises InputError."""
    path = manifest.with_name(f"world_{manifest.stem}.npz")
    if not path.is_file():
        return [None] * rows
    try:
        with np.load(path, allow_pickle=False) as archive:
            world = np.asarray(archive["world"], np.float32) * TO_CAMERA.astype(np.float32)
            hand, error = np.asarray(archive["hand"]), np.asarray(archive["err"], np.float32)
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile) as reason:
        raise InputError(f"{path}: holds no joints of hands ({reason}); restore or remove it") from None
    if world.shape != (rows, JOINT_COUNT, 3) or hand.shape != (rows,) or error.shape != (rows,):
        raise InputError(
            f"{path}: joints of shape {world.shape} for {rows} rows of {manifest.name}; make it anew or remove it"
        )
    # Of NaN, no comparison holds.
    trusted = (error <= LARGEST_ERROR) & (hand != 0) & np.isfinite(world).all(axis=(1, 2))
    return [Joints(world[row], bool(hand[row] == LEFT)) if trusted[row] else None for row in range(rows)]


def fit_poses(joints: Sequence[Joints | None], tokens: Sequence[str]) -> Poses:
    """Poses of those hands whose joints are known and make the sign. joints, tokens: of the hands, in their order."""
    known = [number for number, one in enumerate(joints) if one is not None]
    if not known:
        return Poses()
    found = [one for one in joints if one is not None]
    left = np.array([one.left for one in found])
    points = np.stack([one.world for one in found]).astype(np.float64)
    points[left, :, 0] *= -1.0
    fitted = fit_hands(points)
    named = [
        OTHER_SIDE.get(tokens[number], tokens[number]) if one.left else tokens[number]
        for number, one in zip(known, found, strict=True)
    ]
    poses = Poses(fitted.angles, fitted.rotations, np.array(named), np.array(known, np.int64))
    told = [agrees(angles, token) for angles, token in zip(fitted.angles, named, strict=True)]
    return poses.chosen(np.array(told))
