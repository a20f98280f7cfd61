"""Image formation under water: the one place that knows how water changes light.

The picture of an object at distance z is, per channel, I = J exp(-c z) + B (1 - exp(-k z)), with beam attenuation c,
backscatter coefficient k and veil B, which differ from each other (Akkaynak & Treibitz, "A revised underwater image
formation model", CVPR 2018). Daylight has fallen to exp(-K d) at depth d before it reaches the scene.

K is Jerlov's downward irradiance attenuation by water type (N. G. Jerlov, "Marine Optics", 2nd ed. 1976, table
XXVII), read at 450, 525 and 600 nm for blue, green and red. Absorption is taken as 0.75 K (the mean cosine of
daylight under water, Mobley, "Light and Water", 1994, ch. 3); scattering is the free `turbidity`, falling slowly
with wavelength. Forward scatter blurs in proportion to the scattering optical length (Jaffe, "Computer modeling and
the design of optimal underwater imaging systems", IEEE J. Oceanic Eng. 15(2), 1990).

What is rendered knows its distance and takes a `Water`; a photograph that is put under water does not, and takes a
`WaterPath`. Both are the same equation, `through_water`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.synth.raster import Float32

Floats = NDArray[np.floating]
Range = tuple[float, float]

# Downward attenuation K in 1/m at 450, 525 and 600 nm (blue, green, red).
JERLOV_BGR: dict[str, tuple[float, float, float]] = {
    "I": (0.019, 0.043, 0.235),
    "IA": (0.026, 0.048, 0.240),
    "IB": (0.036, 0.054, 0.245),
    "II": (0.068, 0.076, 0.260),
    "III": (0.135, 0.116, 0.295),
    "1C": (0.25, 0.13, 0.30),
    "3C": (0.39, 0.20, 0.33),
    "5C": (0.56, 0.31, 0.40),
    "7C": (0.89, 0.49, 0.48),
    "9C": (1.60, 0.78, 0.60),
}
WAVELENGTHS_BGR_NM = np.array([450.0, 525.0, 600.0])


# Constants that no table of the sources gives for a consumer camera.
ABSORPTION_SHARE: Final = 0.75
"""Absorption over K."""
BACKSCATTER_SHARE: Final = 0.8
"""Backscatter coefficient k over attenuation c; below 1, because the camera also collects light scattered by small
angles."""
VEIL_ALBEDO: Final = 0.42
"""Veil per unit of light and scattering albedo."""
SCATTER_EXPONENT: Final = 0.5
"""Fall of scattering with wavelength."""
BLUR_PX: Final = 0.55
"""Standard deviation of forward scatter in pixels of a 640-pixel picture per unit of scattering optical length."""


def through_water(
    light: Floats, direct: Any, scattered: Any, veil: Floats, cover: Floats | float = 1.0
) -> Floats:
    """I = J t_D + B (1 - t_B) for linear light J (..., 3), transmissions t_D = exp(-c z) and t_B = exp(-k z), veil B.

    cover: share of each pixel that has this water before it, for premultiplied light. All broadcast; the type is
    what NumPy makes of theirs.
    """
    return np.asarray(light * direct + cover * (veil * (1.0 - scattered)))


@dataclass(frozen=True, slots=True)
class Water:
    """A body of water as a camera at one depth meets it, BGR.

    attenuation c and backscatter k: 1/m. light: downwelling light, 1 at the brightest channel. veil: B, linear
    light. scattering: mean, 1/m.
    """

    attenuation: Float32
    backscatter: Float32
    light: Float32
    veil: Float32
    scattering: float

    def transmission(self, distance_m: float | Float32) -> Float32:
        """exp(-c z): (3,) for one distance, (..., 3) for distances (..., 1)."""
        return np.asarray(np.exp(-self.attenuation * np.asarray(distance_m, np.float32)), np.float32)

    def see_through(self, radiance: Float32, alpha: Float32, distance_m: float) -> Float32:
        """Premultiplied `radiance` (h, w, 3) of something at one distance, as the camera sees it."""
        return self._seen(radiance, np.asarray(distance_m, np.float32), alpha[..., None])

    def see_points(self, radiance: Float32, distance_m: Float32) -> Float32:
        """Radiance (n, 3) of points at their own distances (n,), as the camera sees it."""
        return self._seen(radiance, distance_m[:, None])

    def _seen(self, radiance: Float32, distance_m: Float32, cover: Float32 | float = 1.0) -> Float32:
        scattered = np.exp(-self.backscatter * distance_m)
        seen = through_water(radiance, self.transmission(distance_m), scattered, self.veil, cover)
        return np.asarray(seen, np.float32)

    def blur_sigma(self, distance_m: float, width: int) -> float:
        """Forward-scatter blur in pixels of a picture `width` pixels wide."""
        return BLUR_PX * self.scattering * distance_m * width / 640.0


def make_water(kind: str, depth_m: float, turbidity: float) -> Water:
    """Water of a Jerlov type (key of JERLOV_BGR) at `depth_m`, with scattering `turbidity` in 1/m at 525 nm.

    Pools are nearest to type IB with turbidity 0.1 to 0.3; lakes and harbours to 3C..7C with 0.5 to 2.
    Raises ValueError for an unknown type.
    """
    if kind not in JERLOV_BGR:
        raise ValueError(f"unknown water type {kind!r}; choose one of {', '.join(JERLOV_BGR)}")
    downward = np.array(JERLOV_BGR[kind])
    scattering = turbidity * (525.0 / WAVELENGTHS_BGR_NM) ** SCATTER_EXPONENT
    attenuation = ABSORPTION_SHARE * downward + scattering
    light = np.exp(-downward * depth_m)
    light /= light.max()
    veil = VEIL_ALBEDO * light * scattering / attenuation
    return Water(
        attenuation=np.asarray(attenuation, np.float32),
        backscatter=np.asarray(BACKSCATTER_SHARE * attenuation, np.float32),
        light=np.asarray(light, np.float32),
        veil=np.asarray(veil, np.float32),
        scattering=float(scattering.mean()),
    )


@dataclass(frozen=True, slots=True)
class WaterRange:
    """What a random water is drawn from, as the arguments of `make_water`."""

    kinds: Sequence[str]
    """Keys of JERLOV_BGR."""
    depth_m: Range
    """Drawn evenly, metres."""
    turbidity: Range
    """Drawn evenly in the logarithm, 1/m."""
    weights: Sequence[float] | None = None
    """How often each kind is drawn, against the others; None: all alike."""

    def draw(self, rng: np.random.Generator) -> tuple[str, float, float]:
        """Kind, depth in metres and turbidity in 1/m."""
        share = None if self.weights is None else np.array(self.weights) / np.sum(self.weights)
        kind = str(rng.choice(list(self.kinds), p=share))
        depth_m = float(rng.uniform(*self.depth_m))
        return kind, depth_m, float(np.exp(rng.uniform(*np.log(self.turbidity))))


@dataclass(frozen=True, slots=True)
class WaterPath:
    """All water before a picture in which no distance is known, as shares of light.

    Water that absorbs alone lies behind water that scatters alone: c z is the sum of both, k z that of the second.
    """

    absorbed: Floats
    """What absorption leaves of each channel, (3,)."""
    scattered: Any
    """What scattering leaves of all channels, 0 to 1; a scalar of the picture's type."""
    veil: Floats
    """B, (3,)."""

    def see(self, picture: Floats) -> Floats:
        """The picture (..., 3), 0 to 1, behind this water."""
        return through_water(picture * self.absorbed, self.scattered, self.scattered, self.veil)
