"""Image formation under water.

The picture of an object at distance z is, per channel, I = J exp(-c z) + B (1 - exp(-k z)), with beam attenuation c,
backscatter coefficient k and veil B, which differ from each other (Akkaynak & Treibitz, "A revised underwater image
formation model", CVPR 2018). Daylight has fallen to exp(-K d) at depth d before it reaches the scene.

K is Jerlov's downward irradiance attenuation by water type (N. G. Jerlov, "Marine Optics", 2nd ed. 1976, table
XXVII), read at 450, 525 and 600 nm for blue, green and red. Absorption is taken as 0.75 K (the mean cosine of
daylight under water, Mobley, "Light and Water", 1994, ch. 3); scattering is the free `turbidity`, falling slowly
with wavelength. Forward scatter blurs in proportion to the scattering optical length (Jaffe, "Computer modeling and
the design of optimal underwater imaging systems", IEEE J. Oceanic Eng. 15(2), 1990).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lightgesture.synth.raster import Float32

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


@dataclass(frozen=True, slots=True)
class WaterSettings:
    """Constants that no table of the sources gives for a consumer camera.

    absorption_share: absorption / K. backscatter_share: backscatter coefficient k / attenuation c (below 1: the
    camera also collects light scattered by small angles). veil_albedo: veil per unit of light and scattering
    albedo. scatter_exponent: fall of scattering with wavelength. blur_px: standard deviation of forward scatter in
    pixels of a 640-pixel picture per unit of scattering optical length.
    """

    absorption_share: float = 0.75
    backscatter_share: float = 0.8
    veil_albedo: float = 0.42
    scatter_exponent: float = 0.5
    blur_px: float = 0.55


SETTINGS = WaterSettings()


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

    def transmission(self, distance_m: float) -> Float32:
        """exp(-c z), (3,)."""
        return np.asarray(np.exp(-self.attenuation * np.float32(distance_m)), np.float32)

    def veil_share(self, distance_m: float) -> Float32:
        """1 - exp(-k z), (3,)."""
        return np.asarray(1.0 - np.exp(-self.backscatter * np.float32(distance_m)), np.float32)

    def see_through(self, radiance: Float32, alpha: Float32, distance_m: float) -> Float32:
        """Premultiplied `radiance` (h, w, 3) of something at one distance, as the camera sees it."""
        veil = self.veil * self.veil_share(distance_m)
        return np.asarray(radiance * self.transmission(distance_m) + alpha[..., None] * veil, np.float32)

    def see_points(self, radiance: Float32, distance_m: Float32) -> Float32:
        """Radiance (n, 3) of points at their own distances (n,), as the camera sees it."""
        through = np.exp(-distance_m[:, None] * self.attenuation)
        seen = radiance * through + self.veil * (1.0 - np.exp(-distance_m[:, None] * self.backscatter))
        return np.asarray(seen, np.float32)

    def blur_sigma(self, distance_m: float, width: int) -> float:
        """Forward-scatter blur in pixels of a picture `width` pixels wide."""
        return SETTINGS.blur_px * self.scattering * distance_m * width / 640.0


def make_water(kind: str, depth_m: float, turbidity: float, settings: WaterSettings = SETTINGS) -> Water:
    """Water of a Jerlov type (key of JERLOV_BGR) at `depth_m`, with scattering `turbidity` in 1/m at 525 nm.

    Pools are nearest to type IB with turbidity 0.1 to 0.3; lakes and harbours to 3C..7C with 0.5 to 2.
    Raises ValueError for an unknown type.
    """
    if kind not in JERLOV_BGR:
        raise ValueError(f"unknown water type {kind!r}; choose one of {', '.join(JERLOV_BGR)}")
    downward = np.array(JERLOV_BGR[kind])
    scattering = turbidity * (525.0 / WAVELENGTHS_BGR_NM) ** settings.scatter_exponent
    attenuation = settings.absorption_share * downward + scattering
    light = np.exp(-downward * depth_m)
    light /= light.max()
    veil = settings.veil_albedo * light * scattering / attenuation
    return Water(
        attenuation=np.asarray(attenuation, np.float32),
        backscatter=np.asarray(settings.backscatter_share * attenuation, np.float32),
        light=np.asarray(light, np.float32),
        veil=np.asarray(veil, np.float32),
        scattering=float(scattering.mean()),
    )
