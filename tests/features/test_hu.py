import cv2
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lightgesture.features.outline.contours import SMALLEST, hu_moments, log_signed

SHAPE = np.array([[0, 0], [400, 0], [400, 120], [150, 160], [140, 500], [0, 520]], np.float64)
"""An outline without any symmetry, large enough that whole pixels hardly matter."""


def turned(angle: float, scale: float = 1.0, mirror: bool = False) -> np.ndarray:
    points = SHAPE * (-1, 1) if mirror else SHAPE
    matrix = cv2.getRotationMatrix2D((0, 0), angle, scale)[:, :2]
    return np.rint(points @ matrix.T + 3000).astype(np.int32)


def relative_difference(first: np.ndarray, second: np.ndarray) -> float:
    return float(np.abs(hu_moments(first)[:4] / hu_moments(second)[:4] - 1).max())


@given(angle=st.floats(-180, 180), scale=st.floats(0.8, 4.0))
def test_turning_and_enlarging_change_nothing(angle: float, scale: float) -> None:
    assert relative_difference(turned(angle, scale), turned(0)) < 0.06


@given(angle=st.floats(-180, 180))
def test_a_mirror_image_changes_the_sign_of_the_seventh_alone(angle: float) -> None:
    plain, mirrored = hu_moments(turned(angle)), hu_moments(turned(angle, mirror=True))
    np.testing.assert_allclose(mirrored[:4], plain[:4], rtol=0.06)
    assert np.sign(mirrored[6]) == -np.sign(plain[6])
    assert np.sign(mirrored[5]) == np.sign(plain[5])


def test_a_long_rectangle_has_the_moments_of_the_formula() -> None:
    # eta20 = w / (12 h), eta02 = h / (12 w); h1 is their sum and h2 the squared difference.
    rectangle = np.array([[0, 0], [300, 0], [300, 100], [0, 100]], np.int32)
    moments = hu_moments(rectangle)
    np.testing.assert_allclose(moments[0], 3 / 12 + 1 / 36)
    np.testing.assert_allclose(moments[1], (3 / 12 - 1 / 36) ** 2)
    np.testing.assert_allclose(moments[2:], 0, atol=1e-12)


def test_an_outline_without_area_gives_zeros() -> None:
    assert not hu_moments(np.array([[3, 3], [9, 9]], np.int32)).any()


@given(st.lists(st.floats(-1, 1), min_size=7, max_size=7))
def test_logarithms_keep_sign_and_order(values: list[float]) -> None:
    moments = np.array(values)
    logarithms = log_signed(moments)
    kept = np.abs(moments) > SMALLEST * 1.001
    assert np.array_equal(np.sign(logarithms[kept]), np.sign(moments[kept]))
    assert (np.diff(logarithms[np.argsort(moments)]) >= 0).all()


@given(st.integers(0, 2**32 - 1), st.integers(3, 12))
def test_equals_opencv(seed: int, points: int) -> None:
    outline = np.random.default_rng(seed).integers(0, 64, (points, 2)).astype(np.int32)
    expected = cv2.HuMoments(cv2.moments(outline)).reshape(-1)
    np.testing.assert_allclose(hu_moments(outline), expected, rtol=1e-9, atol=1e-15)
