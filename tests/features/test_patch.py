import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lightgesture.features.patch import PatchSettings, cut_patch, cut_patches

SMALL = PatchSettings(size=24, context=1.0)


def gradient_picture(rows: int = 60, columns: int = 80) -> np.ndarray:
    """Blue grows along x, green along y."""
    picture = np.zeros((rows, columns, 3), np.uint8)
    picture[..., 0] = np.arange(columns)
    picture[..., 1] = np.arange(rows)[:, None]
    return picture


def test_a_patch_of_its_own_size_is_the_pixels_of_the_box() -> None:
    picture = gradient_picture()
    assert np.array_equal(cut_patch(picture, (10, 20, 24, 24), "left", SMALL), picture[20:44, 10:34])


def test_context_widens_the_square_on_all_sides() -> None:
    picture = gradient_picture()
    patch = cut_patch(picture, (30, 20, 16, 16), "left", PatchSettings(size=24, context=1.5))
    assert np.array_equal(patch, picture[16:40, 26:50])


def test_the_square_follows_the_longer_side_about_the_middle() -> None:
    picture = gradient_picture()
    assert np.array_equal(cut_patch(picture, (20, 20, 12, 24), "left", SMALL), picture[20:44, 14:38])


def test_a_right_hand_is_the_mirror_image_of_a_left_one() -> None:
    picture = gradient_picture()
    left = cut_patch(picture, (10, 20, 30, 36), "left", SMALL)
    assert np.array_equal(cut_patch(picture, (10, 20, 30, 36), "right", SMALL), left[:, ::-1])
    mirrored = np.ascontiguousarray(picture[:, ::-1])
    assert np.array_equal(cut_patch(mirrored, (80 - 40, 20, 30, 36), "right", SMALL), left)


def test_pixels_beyond_the_edge_repeat_the_edge() -> None:
    patch = cut_patch(gradient_picture(), (-12, 20, 24, 24), "left", SMALL)
    assert (patch[:, :12, 0] == 0).all()
    assert np.array_equal(patch[0, 12:, 0], np.arange(12))


@given(
    x=st.integers(-200, 200),
    y=st.integers(-200, 200),
    width=st.integers(-3, 300),
    height=st.integers(-3, 300),
)
def test_any_box_gives_a_patch_or_one_clear_refusal(x: int, y: int, width: int, height: int) -> None:
    picture = gradient_picture()
    touches = width > 0 and height > 0 and x < 80 and y < 60 and x + width > 0 and y + height > 0
    if touches:
        assert cut_patch(picture, (x, y, width, height), "left", SMALL).shape == (24, 24, 3)
    else:
        with pytest.raises(ValueError, match="box"):
            cut_patch(picture, (x, y, width, height), "left", SMALL)


@pytest.mark.parametrize("box", [(0, 0, 1, 1), (79, 59, 1, 1), (5, 5, 8, 8), (0, 0, 80, 60), (40, 0, 1, 60)])
def test_tiny_and_whole_boxes_give_patches(box: tuple[int, int, int, int]) -> None:
    assert cut_patch(gradient_picture(), box, "left").shape == (32, 32, 3)


def test_grey_pictures_are_read_as_equal_channels() -> None:
    grey = gradient_picture()[..., 0]
    expected = cut_patch(np.repeat(grey[..., None], 3, axis=2), (5, 5, 30, 30), "left", SMALL)
    assert np.array_equal(cut_patch(grey, (5, 5, 30, 30), "left", SMALL), expected)
    assert np.array_equal(cut_patch(grey[..., None], (5, 5, 30, 30), "left", SMALL), expected)


@pytest.mark.parametrize(
    ("picture", "words"),
    [
        (np.zeros((20, 20, 3), np.uint16), "8 bit"),
        (np.zeros((20, 20, 3), np.float32), "8 bit"),
        (np.zeros((20, 20, 5), np.uint8), "shape"),
        (np.zeros((0, 20, 3), np.uint8), "shape"),
        (np.zeros((20,), np.uint8), "shape"),
    ],
)
def test_other_pictures_are_refused(picture: np.ndarray, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        cut_patch(picture, (0, 0, 9, 9), "left")


def test_an_unknown_side_is_refused() -> None:
    with pytest.raises(ValueError, match="middle"):
        cut_patch(gradient_picture(), (0, 0, 9, 9), "middle")


def test_boxes_and_sides_must_pair_up() -> None:
    with pytest.raises(ValueError, match="2 boxes but 1"):
        cut_patches(gradient_picture(), [(0, 0, 9, 9), (9, 9, 9, 9)], ["left"])
    assert cut_patches(gradient_picture(), [], [], SMALL).shape == (0, 24, 24, 3)


def test_a_large_hand_gives_nearly_what_averaging_all_its_pixels_gives() -> None:
    random = np.random.default_rng(0)
    coarse = random.integers(0, 256, (12, 12, 3)).astype(np.uint8)
    picture = np.asarray(cv2.resize(coarse, (600, 600), interpolation=cv2.INTER_CUBIC), np.uint8)
    averaged = cv2.resize(picture[50:450, 100:500], (24, 24), interpolation=cv2.INTER_AREA)
    patch = cut_patch(picture, (100, 50, 400, 400), "left", SMALL)
    assert np.abs(patch.astype(int) - averaged).mean() < 2
