"""Real hands on the synthetic diver: truth where the hand is, thumbs by the diver's sides, seeds that repeat."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture.synth.body import BodyLook, Camera
from lightgesture.synth.diver import ArmState, DiverState
from lightgesture.synth.shading import Light
from lightgesture.synth.water import make_water
from lightgesture.training.pictures import surroundings
from lightgesture.training.pictures.composites import Background
from lightgesture.training.pictures.cutouts import Cutout
from lightgesture.training.pictures.diver_composites import NO_POSE, DiverComposer
from lightgesture.training.pictures.real_hands import Shown, draw_diver, skin_colour
from lightgesture.training.pictures.surroundings import Scenery, darken, light_of_room, water_of_picture

SIZE = (160, 120)
BLUE, MAGENTA = (200, 30, 30), (200, 30, 200)


def drawn_cutout(token, colour=MAGENTA, source="anna"):
    """A fist with a thumb that points to image left: a disc with a bar."""
    image = np.full((80, 80, 3), colour, np.uint8)
    alpha = np.zeros((80, 80), np.float32)
    cv2.circle(alpha, (45, 40), 20, 1.0, -1)
    cv2.rectangle(alpha, (8, 34), (45, 42), 1.0, -1)
    return Cutout(image, alpha, (8, 20, 58, 41), (45.0, 60.0), token, source)


def a_state(depth=900.0):
    arms = [ArmState(np.array([x, 60.0, 200.0]), np.zeros(3), NO_POSE) for x in (260.0, -260.0)]
    return DiverState(np.array([0.0, -60.0, depth]), np.zeros(3), arms[0], arms[1])


def draw(hands, state=None, water=None):
    picture = np.full((SIZE[1], SIZE[0], 3), 0.1, np.float32)
    camera = Camera(140.0, (80.0, 60.0))
    shown = {side: Shown([cutout], [1.0]) for side, cutout in hands.items()}
    pasted, cover = draw_diver(picture, state or a_state(), BodyLook(), shown, camera, Light(), water)
    return picture, {hand.side: hand for hand in pasted}, cover


def test_hands_are_on_the_divers_own_sides_and_in_their_boxes():
    picture, pasted, cover = draw({"left": drawn_cutout("left"), "right": drawn_cutout("left", BLUE)})
    magenta = (picture[..., 2] > 0.3) & (picture[..., 1] < 0.1)
    x, y, width, height = pasted["left"].box
    assert cv2.boundingRect(magenta.astype(np.uint8)) == pytest.approx((x, y, width, height), abs=2)
    assert x > SIZE[0] // 2 > pasted["right"].box[0]
    assert pasted["left"].visible == pytest.approx(1.0, abs=0.03)
    assert cover[y + height // 2, x + 3 * width // 4] == pytest.approx(1.0, abs=0.05)


def test_a_hand_at_the_edge_is_seen_in_part():
    state = a_state()
    state = replace(state, left=replace(state.left, wrist=np.array([390.0, 60.0, 200.0])))
    _, pasted, _ = draw({"left": drawn_cutout("0")}, state)
    assert 0.2 < pasted["left"].visible < 0.9
    assert pasted["left"].box[0] + pasted["left"].box[2] == SIZE[0]


def test_a_hand_behind_the_other_is_seen_in_part():
    state = a_state()
    near = replace(state.right, wrist=np.array([-20.0, 60.0, 300.0]))
    far = replace(state.left, wrist=np.array([20.0, 60.0, 150.0]))
    hands = {side: drawn_cutout("0") for side in ("left", "right")}
    _, pasted, _ = draw(hands, replace(state, left=far, right=near))
    assert pasted["right"].visible == pytest.approx(1.0, abs=0.03)
    assert pasted["left"].visible < 0.7


def test_hands_shrink_with_distance_and_fade_in_water():
    near, boxes, _ = draw({"left": drawn_cutout("0")})
    _, far_boxes, _ = draw({"left": drawn_cutout("0")}, a_state(1800.0))
    assert far_boxes["left"].box[3] < 0.6 * boxes["left"].box[3]
    wet, _, _ = draw({"left": drawn_cutout("0")}, water=make_water("II", 2.0, 0.8))
    x, y, width, height = boxes["left"].box
    middle = y + height // 2, x + 3 * width // 4
    assert wet[middle][2] < 0.8 * near[middle][2]


def test_cross_fading_mixes_two_pictures():
    camera, picture = Camera(140.0, (80.0, 60.0)), np.zeros((SIZE[1], SIZE[0], 3), np.float32)
    both = Shown([drawn_cutout("0", (0, 0, 255)), drawn_cutout("0", (0, 255, 0))], [0.5, 0.5])
    pasted, _ = draw_diver(picture, a_state(), BodyLook(), {"left": both}, camera, Light(), None)
    x, y, width, height = pasted[0].box
    _, green, red = picture[y + height // 2, x + 3 * width // 4]
    assert green == pytest.approx(red, rel=0.05)
    assert green > 0.3


def test_skin_colour_is_linear_and_ignores_what_is_cut_away():
    blue, green, red = skin_colour(drawn_cutout("0", (0, 128, 255)))
    assert (blue, green, red) == pytest.approx((0.0, 0.2195, 1.0), abs=1e-3)


@pytest.fixture(name="composer", scope="module")
def _composer():
    rng = np.random.default_rng(0)
    waters = [Background(np.full((90, 120, 3), (150, 110, 40), np.uint8), "sea")]
    rooms = [Background(rng.integers(0, 255, (90, 120, 3), np.uint8), "room")]
    hands = [drawn_cutout(token, source=source) for source in "ab" for token in ("left", "0")]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(surroundings, "COUNT", 2)
        return DiverComposer(hands, waters, rooms, SIZE)


def test_composed_pictures_repeat_and_their_boxes_lie_inside(composer):
    first = [composer.compose(rng) for rng in [np.random.default_rng(5)] for _ in range(8)]
    again = [composer.compose(rng) for rng in [np.random.default_rng(5)] for _ in range(8)]
    for one, other in zip(first, again, strict=True):
        np.testing.assert_array_equal(one.image, other.image)
        assert (one.boxes, one.tokens) == (other.boxes, other.tokens)
        assert one.image.shape == (SIZE[1], SIZE[0], 3)
        assert len(one.boxes) == len(one.tokens) <= 2
        for x, y, width, height in one.boxes:
            assert 0 <= x < x + width <= SIZE[0]
            assert 0 <= y < y + height <= SIZE[1]
    assert sum(len(one.boxes) for one in first) > 8


def test_thumbs_point_by_the_divers_own_sides(composer):
    rng = np.random.default_rng(1)
    for _ in range(20):
        hands = composer.draw_pair(rng)
        for side, cutout in hands.items():
            if cutout.token == "left":  # inwards: to image left on the diver's left hand
                is_at_left = cutout.alpha[38, :15].any()
                assert is_at_left == (side == "left")


def test_water_takes_the_tint_of_a_real_picture():
    picture = np.full((40, 60, 3), (0.3, 0.2, 0.02), np.float32)
    water = water_of_picture(picture, 1.2, np.random.default_rng(0))
    blue, green, red = water.transmission(1.2)
    assert blue > green > red
    np.testing.assert_allclose(water.veil, picture[0, 0], rtol=1e-3)


def test_darkness_leaves_lamps_bright():
    picture = np.full((40, 60, 3), 0.2, np.float32)
    picture[:5] = 1.0
    rng = np.random.default_rng(0)
    light = light_of_room(picture, rng)
    dark = darken(Scenery(picture, light, None), rng)
    assert dark.picture[0, 0, 0] == pytest.approx(1.0)
    assert dark.picture[20, 20, 0] < 0.1
    assert dark.light.key[0] < 0.5 * light.key[0]
