"""Colour of skin and gloves.

Tones are those of the Monk Skin Tone Scale (E. Monk, 2019; sRGB values as published, lightest to darkest). The
scale's swatches hold little blood, so haemoglobin is added as a second, independent density, as in Tsumura, Haneishi
& Miyake, "Independent-component analysis of skin color image", JOSA A 16(9), 1999. Palms hold less melanin
than the back of the hand; how much less was set by eye beside photographs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.synth.raster import Float32

MONK_SRGB = np.array(
    [[246, 237, 228], [243, 231, 219], [247, 234, 208], [234, 218, 186], [215, 189, 150],
     [160, 126, 86], [130, 92, 67], [96, 65, 52], [58, 49, 42], [41, 36, 32]], np.float64
)  # fmt: skip
BLOOD_DENSITY_BGR = np.array([0.30, 0.27, 0.02])
"""Natural-log absorption of one unit of haemoglobin in blue, green and red (ratios of oxy-haemoglobin's bands)."""
PALM_MELANIN_SHARE = 0.68
PALM_EXTRA_BLOOD = 0.35
NAIL_BLOOD = 1.6


@dataclass(frozen=True, slots=True)
class Tone:
    """Linear-light albedo (BGR, 0..1) of the back of the hand, the palm and the nails; gloss 0..1; `glove` or skin."""

    back: Float32
    palm: Float32
    nail: Float32
    gloss: float
    glove: bool = False


def srgb_to_linear(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """sRGB 0..1 to linear light 0..1 (IEC 61966-2-1)."""
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def skin_tone(monk: float, blood: float = 1.0, gloss: float = 0.35) -> Tone:
    """Skin of the scale's tone `monk` (1 very light .. 10 very dark, fractions allowed) with `blood` units (0.3..2)."""
    palm_monk = 1.0 + (monk - 1.0) * PALM_MELANIN_SHARE
    palm_blood = blood + PALM_EXTRA_BLOOD
    return Tone(
        back=_albedo(monk, blood),
        palm=_albedo(palm_monk, palm_blood),
        nail=_albedo(1.0 + (monk - 1.0) * 0.6, blood * NAIL_BLOOD) * np.float32(0.95),
        gloss=gloss,
    )


def _albedo(monk: float, blood: float) -> Float32:
    linear = np.log(srgb_to_linear(MONK_SRGB[:, ::-1] / 255.0))
    steps = np.arange(1.0, 11.0)
    density = np.array([np.interp(monk, steps, linear[:, channel]) for channel in range(3)])
    return np.asarray(np.exp(density - blood * BLOOD_DENSITY_BGR), np.float32)


def glove_tone(bgr: tuple[float, float, float], gloss: float = 0.25) -> Tone:
    """A glove of linear-light colour `bgr`; its palm is a little darker rubber."""
    back = np.array(bgr, np.float32)
    return Tone(back=back, palm=back * np.float32(0.7), nail=back, gloss=gloss, glove=True)
