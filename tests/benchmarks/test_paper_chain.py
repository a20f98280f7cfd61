"""The paper's region selection on drawn hands."""

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks.paper.bank import (
    LEFT_OUT,
    PER_CLASS,
    HandBank,
    build_bank,
    drawn_contour,
    hu_distances,
    hu_moments,
    largest_contour,
)
from lightgesture.benchmarks.paper.chain import PATIENCE, PaperChain, skin_mask, within_gate

SKIN = (120, 150, 210)
WATER = (150, 110, 40)


def scene(*centres, size=(480, 640)):
    image = np.full((*size, 3), WATER, np.uint8)
    for x, y in centres:
        cv2.ellipse(image, (x, y), (30, 42), 0, 0, 360, SKIN, -1)
    return image


def oval_bank(accepted_distance=0.05):
    oval = largest_contour((scene((300, 200)) == SKIN).all(axis=2).astype(np.uint8))
    return HandBank(hu_moments(oval)[None], ("0",), accepted_distance)


def random_hand(seed):
    rng = np.random.default_rng(seed)
    return drawn_contour(rng.uniform(0, 100, (21, 2)).astype(np.float32))


@pytest.mark.parametrize("seed", range(8))
def test_hu_distance_is_that_of_match_shapes(seed):
    first, second = random_hand(seed), random_hand(seed + 100)
    ours = hu_distances(hu_moments(first), hu_moments(second)[None])[0]
    assert ours == pytest.approx(cv2.matchShapes(first, second, cv2.CONTOURS_MATCH_I1, 0), rel=1e-9)


def test_mirrored_moments_are_those_of_the_mirror_image():
    hand = random_hand(3)
    mirror = (hand * [-1, 1] + [500, 0]).astype(np.int32)
    np.testing.assert_allclose(hu_moments(hand, mirrored=True), hu_moments(mirror), rtol=1e-6, atol=1e-15)


def test_two_hands_get_the_divers_sides_and_tight_boxes():
    right, left = sorted(PaperChain(oval_bank()).process(scene((150, 200), (480, 210))), key=lambda h: h.box)
    assert (right.side, left.side, right.token) == ("right", "left", "0")
    np.testing.assert_allclose(right.box, (120, 158, 61, 85), atol=4)


@pytest.mark.parametrize(("x", "side"), [(150, "right"), (480, "left")])
def test_a_lone_hand_takes_the_side_of_its_half(x, side):
    assert [hand.side for hand in PaperChain(oval_bank()).process(scene((x, 200)))] == [side]


def test_water_cast_hides_the_hands():
    """What the row is kept for: under a blue-green cast no pixel is left in the fixed skin range."""
    cast = np.clip(scene((150, 200)) * [1.2, 1.0, 0.3], 0, 255).astype(np.uint8)
    assert not skin_mask(cast).any()
    assert PaperChain(oval_bank()).process(cast) == []


def test_remembered_hands_reject_a_far_region():
    chain = PaperChain(oval_bank())
    chain.process(scene((150, 200), (480, 210)))
    hands = chain.process(scene((160, 205), (480, 430)))
    assert [(hand.side, round(hand.box[0], -1)) for hand in hands] == [("right", 130)]


def test_a_lost_hand_is_searched_everywhere_after_a_while():
    chain = PaperChain(oval_bank())
    chain.process(scene((150, 200), (480, 210)))
    counts = [len(chain.process(scene((160, 205), (480, 430)))) for _ in range(PATIENCE + 1)]
    assert counts == [1] * PATIENCE + [2]


def test_a_shape_unlike_the_bank_is_no_hand():
    image = np.full((480, 640, 3), WATER, np.uint8)
    cv2.rectangle(image, (50, 100), (600, 130), SKIN, -1)
    assert PaperChain(oval_bank(accepted_distance=0.01)).process(image) == []


@pytest.mark.parametrize(
    ("box", "inside"), [((100, 100, 40, 40), True), ((130, 100, 40, 40), True), ((145, 100, 40, 40), False)]
)
def test_gate_on_place(box, inside):
    assert within_gate(box, (100, 100, 40, 40)) is inside


def test_gate_on_size():
    assert not within_gate((100, 100, 60, 60), (100, 100, 40, 40))


@pytest.mark.parametrize("image", [np.zeros((1, 1, 3), np.uint8), np.full((480, 640, 3), SKIN, np.uint8)])
def test_empty_and_full_frames_are_survived(image):
    assert len(PaperChain(oval_bank()).process(image)) <= 1


def test_bank_is_built_from_cut_outs_and_drawn_landmarks(data):
    bank = build_bank(data)
    assert bank.tokens == ("5", "left")
    assert bank.moments.shape == (2, 7)
    assert np.isfinite(bank.accepted_distance)


def test_bank_leaves_out_the_people_of_scored_frames(data):
    table = data / "hands" / "train.csv"
    table.write_text(table.read_text().replace("carl", *LEFT_OUT))
    assert build_bank(data).tokens == ("5",)


def test_real_bank_has_every_class(real_data):
    bank = build_bank(real_data)
    assert {bank.tokens.count(token) for token in set(bank.tokens)} == {PER_CLASS}
    assert set(bank.tokens) == {"0", "1", "2", "3", "4", "5", "left", "right", "ok", "pic"}
