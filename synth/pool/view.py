"""Where the diver is before the camera of a vehicle that moves."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from lightgesture.synth.diver import DiverState
from lightgesture.synth.pool.body import Array, Motion

NEAREST_MM: Final = 450.0
"""Nearer than this the diver is not drawn."""
BROAD_MM: Final = 900.0
"""How far a diver's arms reach to either side."""
HALF_VIEW: Final = 0.75
"""Tangent of half the widest field of view of the rendered cameras, above it the diver is out of the picture."""


def body_axes(motion: Motion) -> Array:
    """Rotation (3, 3): columns are the vehicle's forward, right and down in north, east, down."""
    roll, pitch, yaw = motion.attitude
    cr, sr, cp, sp, cy, sy = (f(angle) for angle in (roll, pitch, yaw) for f in (math.cos, math.sin))
    return np.array(
        [
            [cp * cy, sr * sp * cy - cr * sy, cr * sp * cy + sr * sy],
            [cp * sy, sr * sp * sy + cr * cy, cr * sp * sy - sr * cy],
            [-sp, sr * cp, cr * cp],
        ]
    )


@dataclass(frozen=True, slots=True)
class DiverPlace:
    """Where the script plays: its camera looks north from the start at this depth; swum: north since then, metres."""

    depth_m: float
    swum_m: float = 0.0

    def world(self, state: DiverState) -> tuple[float, float, float]:
        """North, east, down of the diver, metres."""
        right, up, forward = (float(value) / 1000.0 for value in state.position)
        return forward + self.swum_m, right, self.depth_m - up

    def seen(self, state: DiverState, motion: Motion) -> DiverState | None:
        """The diver before the vehicle's camera; None where the picture does not show the diver."""
        offset = np.array(self.world(state)) - np.array(motion.position)
        forward, right, down = (float(part) * 1000.0 for part in body_axes(motion).T @ offset)
        if forward < NEAREST_MM or abs(right) > HALF_VIEW * forward + BROAD_MM:
            return None
        turned = state.rotation + np.array([math.degrees(motion.attitude[2]), 0.0, 0.0])
        return replace(state, position=np.array([right, -down, forward]), rotation=turned)
