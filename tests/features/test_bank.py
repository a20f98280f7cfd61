"""Descriptors of outlines and the bank of them: what is equal, what is near, and what a file may hold."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.features.find.bank import (
    OTHER,
    DescriptorSettings,
    bank_distances,
    bank_from,
    describe_outlines,
    hand_proximity,
)
from lightgesture.training.model_files import bank_arrays
from lightgesture.training.regions.bank import build_bank, k_means, mirrored

SETTINGS = DescriptorSettings()


def _outline(mask):
    contours = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
    return max(contours, key=cv2.contourArea).reshape(-1, 2).astype(np.int32)


def _mask(fingers, scale=1.0, lean=0.0, at=(0, 0)):
    """A palm with upright fingers, the middle one or the leaning ones highest."""
    mask = np.zeros((420, 420), np.uint8)
    base = np.array([160 + at[0], 210 + at[1]])
    cv2.circle(mask, tuple(base), round(40 * scale), 255, cv2.FILLED)
    for finger in range(fingers):
        tip = base + np.array([(finger - (fingers - 1) / 2) * 28 + lean, -110 + 6 * finger]) * scale
        cv2.line(mask, tuple(base), tuple(np.rint(tip).astype(int)), 255, round(14 * scale))
    return mask


def _hand(*args, **kwargs):
    return _outline(_mask(*args, **kwargs))


def _written_out(contour, settings=SETTINGS):
    """The descriptor of one outline by the Fourier transform of the library."""
    points = contour[np.arange(settings.points) * len(contour) // settings.points] @ np.array([1, 1j])
    points = points - points.mean()
    points = points / np.sqrt(np.square(np.abs(points)).mean())
    points = np.roll(points, -int(points.imag.argmin()))
    transformed = np.fft.fft(points) / settings.points
    kept = np.arange(1, settings.harmonics + 1)
    coefficients = transformed[np.concatenate([kept, -kept])]
    return np.concatenate([coefficients.real, coefficients.imag])


def test_many_outlines_at_once_are_described_as_each_by_the_library():
    contours = [_hand(fingers, 0.5 + 0.2 * fingers) for fingers in range(6)]
    expected = [_written_out(contour) for contour in contours]
    np.testing.assert_allclose(describe_outlines(contours), expected, atol=1e-5)


@given(
    fingers=st.integers(1, 5),
    scale=st.floats(1.0, 1.6),
    at=st.tuples(st.integers(-20, 60), st.integers(-20, 80)),
)
@settings(max_examples=40, deadline=None)
def test_moving_and_enlarging_hardly_change_a_descriptor(fingers, scale, at):
    # A smaller drawing has thinner gaps between its fingers, down to none: another outline, not the same one smaller.
    first, second = describe_outlines([_hand(fingers), _hand(fingers, scale, at=at)])
    # Among a thousand sizes the farthest from the first is an open hand's, by 0.203.
    assert np.linalg.norm(first - second) < 0.21


@given(fingers=st.integers(1, 5), lean=st.floats(10, 40))
@settings(max_examples=30, deadline=None)
def test_a_mirror_image_turns_the_sign_of_the_real_half(fingers, lean):
    mask = _mask(fingers, lean=lean)
    first, second = describe_outlines([_outline(mask), _outline(np.ascontiguousarray(mask[:, ::-1]))])
    assert np.linalg.norm(mirrored(first[None])[0] - second) < 0.03
    np.testing.assert_allclose(mirrored(mirrored(first[None]))[0], first)


@pytest.mark.parametrize("fingers", range(1, 6))
def test_where_an_outline_begins_hardly_matters(fingers):
    contour = _hand(fingers)
    every = describe_outlines([np.roll(contour, shift, axis=0) for shift in range(len(contour))])
    # Which points are taken of an outline depends on the first; the most by which that shows is 0.217, of an open hand.
    assert np.linalg.norm(every - every[0], axis=1).max() < 0.22


def test_a_hand_upside_down_is_another_outline():
    mask = _mask(3)
    upright, turned = describe_outlines([_outline(mask), _outline(np.ascontiguousarray(mask[::-1, ::-1]))])
    assert np.linalg.norm(upright - turned) > 0.4


@pytest.mark.parametrize("contour", [[[5, 5]], [[5, 5], [6, 5]], [[3, 3]] * 40])
def test_points_and_lines_have_finite_descriptors(contour):
    assert np.isfinite(describe_outlines([np.array(contour, np.int32)])).all()


def test_no_outlines_give_no_rows():
    bank = build_bank({"1": [_hand(1)], OTHER: [_hand(0)]}, 2, seed=0)
    assert describe_outlines([]).shape == (0, SETTINGS.length)
    assert bank_distances([], bank).shape == (0, 2)


@pytest.mark.parametrize(("points", "harmonics"), [(4, 1), (1000, 8), (32, 16), (32, 0)])
def test_settings_that_make_no_descriptor_are_refused(points, harmonics):
    with pytest.raises(ValueError, match="do not make a descriptor"):
        DescriptorSettings(points, harmonics)


@pytest.fixture(scope="module")
def bank():
    def several(fingers):
        return [_hand(fingers, scale, lean) for scale in (0.7, 1.0, 1.4) for lean in (0.0, 10.0)]

    others = [_outline(cv2.rectangle(np.zeros((200, 200), np.uint8), (20, 20), corner, 255, -1))
              for corner in ((60, 150), (150, 60), (120, 120))]  # fmt: skip
    return build_bank({"1": several(1), "2": several(2), "5": several(5), OTHER: others}, 3, seed=1)


@pytest.mark.parametrize("flipped", [False, True])
def test_the_nearest_class_is_the_own_one_for_either_hand(bank, flipped):
    for name, fingers in (("1", 1), ("2", 2), ("5", 5)):
        mask = _mask(fingers, 1.2, lean=5.0)
        contour = _outline(np.ascontiguousarray(mask[:, ::-1]) if flipped else mask)
        distances = bank_distances([contour], bank)
        assert bank.classes[int(distances[0].argmin())] == name
        assert hand_proximity(distances, bank)[0] > 0.6


def test_a_box_is_nearer_to_other_things(bank):
    square = _outline(cv2.rectangle(np.zeros((90, 90), np.uint8), (9, 9), (70, 75), 255, cv2.FILLED))
    assert hand_proximity(bank_distances([square], bank), bank)[0] < 0.4


def test_distances_are_those_written_out(bank):
    contours = [_hand(fingers) for fingers in range(1, 6)]
    described = describe_outlines(contours)
    expected = np.linalg.norm(described[:, None] - bank.centres[None], axis=2)
    expected = np.stack([expected[:, bank.owner == index].min(axis=1) for index in range(4)], axis=1)
    found = bank_distances(contours, bank)
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, expected, atol=2e-3)


def test_the_same_outlines_and_seed_give_the_same_bank():
    outlines = {"1": [_hand(1, 0.5 + 0.02 * step) for step in range(40)], OTHER: [_hand(0), _hand(4)]}
    first, second = (bank_arrays("bank", build_bank(outlines, 5, seed=3)) for _ in range(2))
    assert first.keys() == second.keys()
    assert all(first[name].tobytes() == second[name].tobytes() for name in first)


def test_stored_arrays_are_read_as_they_were(bank, tmp_path):
    np.savez_compressed(tmp_path / "bank.npz", **bank_arrays("bank", bank))
    with np.load(tmp_path / "bank.npz", allow_pickle=False) as arrays:
        read = bank_from(arrays, "bank")
    assert read.classes == bank.classes
    assert read.settings == bank.settings
    np.testing.assert_array_equal(read.centres, bank.centres)
    np.testing.assert_array_equal(read.owner, bank.owner)


def test_centres_are_the_middles_of_clusters():
    rng = np.random.default_rng(0)
    middles = np.array([[0, 0], [10, 0], [0, 10]], np.float32)
    points = np.concatenate([middle + rng.normal(0, 0.3, (50, 2)) for middle in middles]).astype(np.float32)
    found = k_means(points, 3, np.random.default_rng(5))
    gaps = np.linalg.norm(found[:, None] - middles[None], axis=2)
    assert sorted(gaps.argmin(axis=0)) == [0, 1, 2]
    assert gaps.min(axis=0).max() < 0.2


def test_as_many_centres_as_there_are_different_points():
    same = np.ones((20, 4), np.float32)
    assert len(k_means(same, 6, np.random.default_rng(0))) == 1
    few = np.eye(4, dtype=np.float32)
    np.testing.assert_array_equal(k_means(few, 6, np.random.default_rng(0)), few)


@pytest.mark.parametrize("outlines", [{}, {"1": []}])
def test_a_class_without_an_outline_makes_no_bank(outlines):
    with pytest.raises(ValueError, match=r"give the outlines|give one"):
        build_bank(outlines, 3, seed=0)


def test_proximity_needs_other_things():
    bank = build_bank({"1": [_hand(1)], "2": [_hand(2)]}, 2, seed=0)
    with pytest.raises(ValueError, match="must hold hands and the class 'other'"):
        hand_proximity(bank_distances([_hand(1)], bank), bank)


@pytest.mark.parametrize(
    "wrong",
    [
        {"centres": np.zeros((4, 3), np.float32)},
        {"centres": np.zeros(32, np.float32)},
        {"centres": np.full((12, 32), np.nan, np.float32)},
        {"centres": np.zeros((300_000, 32), np.float32)},
        {"owner": np.zeros(12, np.int16)},
        {"owner": np.zeros(3, np.int16)},
        {"classes": np.array(["1", "1", "5", OTHER])},
        {"points": np.int32(7)},
        {"harmonics": np.int32(16)},
    ],
)
def test_arrays_that_do_not_fit_together_are_refused_in_one_line(bank, wrong):
    arrays = {**bank_arrays("bank", bank), **{f"bank_{name}": value for name, value in wrong.items()}}
    with pytest.raises(ValueError, match=r"\w+") as caught:
        bank_from(arrays, "bank")
    assert "\n" not in str(caught.value)


def test_a_missing_array_is_named(bank):
    arrays = bank_arrays("bank", bank)
    del arrays["bank_owner"]
    with pytest.raises(KeyError, match="bank_owner"):
        bank_from(arrays, "bank")
