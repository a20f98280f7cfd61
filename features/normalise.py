"""Colour normalisations: pictures of the same thing under other light, or through other water, made alike.

Pure functions on float32 (height, width, 3), BGR, 0 to 1; each returns a new array of the same shape and range.
They estimate the colour of the light from the picture itself and divide by it channel by channel (von Kries), so a
picture of one colour becomes grey: what remains is how each pixel differs from the rest of the picture.
"""

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float32]

DARKEST_LIGHT = 1e-3
"""An estimate of the light below this counts as this, so that a black channel is not divided by zero."""


def compensate_red(bgr: Float, share: float) -> Float:
    """Give the red channel back what the water took, led by the green channel.

    share: of the missing red that is given back, 0 to 1.
    Ancuti, Ancuti, De Vleeschouwer and Bekaert, "Color Balance and Fusion for Underwater Image
    Enhancement", IEEE Transactions on Image Processing 27(1), 2018, equation 4:
    I_rc = I_r + alpha (mean(I_g) - mean(I_r)) (1 - I_r) I_g, channels in 0 to 1.
    """
    green, red = bgr[..., 1], bgr[..., 2]
    missing = max(float(green.mean()) - float(red.mean()), 0.0)
    compensated = bgr.copy()
    compensated[..., 2] = red + share * missing * (1.0 - red) * green
    return compensated


def divide_by_light(bgr: Float, light: Float) -> Float:
    """Divide each channel by its light, float32 (3,), the mean of the three kept; values are clipped to 1."""
    return np.asarray(np.minimum(bgr * (light.mean() / np.maximum(light, DARKEST_LIGHT)), 1.0), np.float32)


def gray_world(bgr: Float) -> Float:
    """Scale each channel to the common mean.

    Buchsbaum, "A spatial processor model for object colour perception", Journal of the Franklin Institute
    310(1), 1980: the average of a scene is grey.
    """
    return divide_by_light(bgr, bgr.reshape(-1, 3).mean(axis=0))


def shades_of_gray(bgr: Float, order: float = 6.0) -> Float:
    """Scale each channel to the common Minkowski mean of an order.

    order: 1 is gray-world, larger ones listen more to the bright pixels, towards white patch.
    Finlayson and Trezzi, "Shades of Gray and Colour Constancy", 12th Color Imaging Conference, 2004; an order of 6 did
    best there. Raises ValueError for an order below 1.
    """
    if not order >= 1.0:
        raise ValueError(f"order {order} is below 1; take 1 for gray-world or more")
    means = np.power(bgr.reshape(-1, 3).astype(np.float64), order).mean(axis=0) ** (1.0 / order)
    return divide_by_light(bgr, means.astype(np.float32))


def white_patch(bgr: Float, percent: float = 99.0) -> Float:
    """Scale each channel so that its brightest pixels are white.

    percent: of the pixels that lie at or below white, 50 to 100; 100 takes the single brightest one, which glints and
    dead pixels spoil. The brightest thing in view is white: Land and McCann, "Lightness and Retinex Theory",
    Journal of the Optical Society of America 61(1), 1971.
    """
    light = np.percentile(bgr.reshape(-1, 3), percent, axis=0)
    return np.asarray(np.minimum(bgr / np.maximum(light, DARKEST_LIGHT), 1.0), np.float32)
