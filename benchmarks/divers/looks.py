"""How hand patches look, in numbers: what sets pictures of real divers apart from those that a net learns from.

All is measured on patches as a classifier sees them, with the margin that a pool keeps round them: uint8 (n, side,
side, 3), BGR. Nothing here knows where a patch comes from.
"""

from collections.abc import Mapping
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

Patches = NDArray[np.uint8]
Values = NDArray[np.float64]

CORE: Final = 0.28
"""Radius of the disc in the middle of a patch that is mostly hand, as a share of the patch's side."""
RIM: Final = 0.12
"""Width of the frame along a patch's edge that is mostly background, likewise."""
FINE: Final = 0.2
"""Cycles a pixel from which detail is fine: half a finger of a hand that fills the patch."""
CHUNK: Final = 2048
"""Patches that are measured at a time, which bounds the memory."""

MEASURES: Final = {
    "brightness": "mean luma, 0 to 255",
    "spread": "standard deviation of luma in the patch",
    "stands_out": "CIE76 between the middle and the rim",
    "lighter": "L of the middle less that of the rim; below 0 the hand is darker than what is behind it",
    "redder": "a of the middle less that of the rim",
    "cast_a": "mean a: below 0 green, above 0 red",
    "cast_b": "mean b: below 0 blue, above 0 yellow",
    "red_spread": "spread of red over that of green",
    "blue_spread": "spread of blue over that of green",
    "plane": "share of the variance, square roots of luma, that is a plane: light that falls off over the patch",
    "above": "mean of the upper quarter less that of the lower, over the spread: above 0 the light comes from above",
    "within": "spread of luma in the middle over that in the patch: texture of the hand",
    "fine": "share of the luma's power in fine detail, which blur takes and noise adds",
    "noise": "noise of luma, 8-bit steps",
    "noise_red": "noise of red over its spread, which is what the net sees of it",
    "edges": "largest tenth of the gradients of luma over its spread, a pixel",
}
"""What is measured of each patch, and what it tells."""

_NOISE_KERNEL: Final = np.array([[1, -2, 1], [-2, 4, -2], [1, -2, 1]], np.float64)
"""Blind to planes and to straight edges along the axes (Immerkaer, CVIU 1996)."""
_NOISE_SCALE: Final = 1.4826 / 6.0
"""From the median size of its answers to a standard deviation: 6 is its norm, and 1.4826 medians of normal noise are
one."""


def measure(patches: Patches) -> dict[str, Values]:
    """Every one of MEASURES for each patch, (n,)."""
    parts = [_measure(patches[start : start + CHUNK]) for start in range(0, len(patches), CHUNK)]
    return {
        name: np.concatenate([part[name] for part in parts]) if parts else np.zeros(0) for name in MEASURES
    }


def _measure(patches: Patches) -> dict[str, Values]:
    side = patches.shape[1]
    core, rim = _masks(side)
    flat = np.ascontiguousarray(patches).reshape(-1, side, 3).astype(np.float32) / np.float32(255)
    lab = cv2.cvtColor(flat, cv2.COLOR_BGR2Lab).reshape(-1, side, side, 3).astype(np.float64)
    values = patches.astype(np.float64)
    luma = values @ np.array([0.114, 0.587, 0.299])
    spread = luma.std(axis=(1, 2))
    spreads = values.std(axis=(1, 2)) + 1e-6
    difference = lab[:, core].mean(axis=1) - lab[:, rim].mean(axis=1)
    cast = lab.mean(axis=(1, 2))
    return {
        "brightness": luma.mean(axis=(1, 2)),
        "spread": spread,
        "stands_out": np.linalg.norm(difference, axis=1),
        "lighter": difference[:, 0],
        "redder": difference[:, 1],
        "cast_a": cast[:, 1],
        "cast_b": cast[:, 2],
        "red_spread": spreads[:, 2] / spreads[:, 1],
        "blue_spread": spreads[:, 0] / spreads[:, 1],
        "plane": _plane_share(np.sqrt(luma)),
        "above": _above(luma) / (spread + 1e-6),
        "within": luma[:, core].std(axis=1) / (spread + 1e-6),
        "fine": _fine_share(luma),
        "noise": _noise(luma),
        "noise_red": _noise(values[..., 2]) / spreads[:, 2],
        "edges": _edges(luma) / (spread + 1e-6),
    }


def _masks(side: int) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Where the middle and the rim of a patch are, bool (side, side)."""
    places = (np.arange(side) + 0.5) / side - 0.5
    core = np.hypot(places[:, None], places) < CORE
    rim = np.maximum(np.abs(places)[:, None], np.abs(places)) > 0.5 - RIM
    return core, rim


def _plane_share(values: Values) -> Values:
    """Share of the variance that the best plane explains; it is flat where nothing varies."""
    side = values.shape[1]
    slope = np.linspace(-1.0, 1.0, side)
    still = values - values.mean(axis=(1, 2), keepdims=True)
    down = (still * slope[:, None]).sum(axis=(1, 2))
    across = (still * slope).sum(axis=(1, 2))
    explained = (down**2 + across**2) / (side * (slope**2).sum())
    return np.asarray(explained / (np.square(still).sum(axis=(1, 2)) + 1e-9), np.float64)


def _above(luma: Values) -> Values:
    """Mean of the upper quarter less that of the lower."""
    quarter = luma.shape[1] // 4
    return np.asarray(luma[:, :quarter].mean(axis=(1, 2)) - luma[:, -quarter:].mean(axis=(1, 2)), np.float64)


def _fine_share(luma: Values) -> Values:
    """Share of the power, without the mean, at FINE cycles a pixel and more; a Hann window keeps the edges out."""
    side = luma.shape[1]
    window = np.hanning(side)
    still = luma - luma.mean(axis=(1, 2), keepdims=True)
    power = np.abs(np.fft.rfft2(still * window[:, None] * window)) ** 2
    frequency = np.hypot(np.fft.fftfreq(side)[:, None], np.fft.rfftfreq(side))
    return np.asarray(power[:, frequency >= FINE].sum(axis=1) / (power.sum(axis=(1, 2)) + 1e-9), np.float64)


def _noise(channel: Values) -> Values:
    """Standard deviation of the noise: the median answer to a kernel that most of a picture gives none."""
    answers = [np.abs(cv2.filter2D(one, -1, _NOISE_KERNEL)[1:-1, 1:-1]) for one in channel]
    return np.asarray(np.median(np.stack(answers), axis=(1, 2)) * _NOISE_SCALE, np.float64)


def _edges(luma: Values) -> Values:
    """Mean of the largest tenth of the gradients."""
    down, across = np.gradient(luma, axis=(1, 2))
    steep = np.sort(np.hypot(down, across).reshape(len(luma), -1), axis=1)
    return np.asarray(steep[:, -max(1, steep.shape[1] // 10) :].mean(axis=1), np.float64)


def apart(first: Values, second: Values) -> float:
    """Largest difference of two distributions, the statistic of Kolmogorov and Smirnov: 0 where they agree, 1 where no
    value of one is among those of the other. Neither may be empty.
    """
    both = np.sort(np.concatenate([first, second]))
    below = [np.searchsorted(np.sort(one), both, side="right") / len(one) for one in (first, second)]
    return float(np.abs(below[0] - below[1]).max())


def quantiles(values: Mapping[str, Values], name: str) -> tuple[float, ...]:
    """5, 25, 50, 75 and 95 % of a measure."""
    return tuple(float(value) for value in np.quantile(values[name], (0.05, 0.25, 0.5, 0.75, 0.95)))
