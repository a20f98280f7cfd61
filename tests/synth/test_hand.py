import numpy as np
import pytest

from lightgesture.synth.atlas import paint_atlas
from lightgesture.synth.hand import HandLook, decode, encode, mask_box, render_hand
from lightgesture.synth.poses import TOKENS, token_pose
from lightgesture.synth.raster import Canvas, Cone
from lightgesture.synth.skeleton import rotation_y
from lightgesture.synth.skin import glove_tone, skin_tone
from lightgesture.synth.surface import Forearm, HandView

FRONT = np.eye(3)


def render(token="5", rotation=FRONT, left=False, look=None, px_per_mm=0.5, wrist=(80.0, 150.0)):
    pose = token_pose(token, np.random.default_rng(0), 0.0)
    return render_hand(
        pose, HandView(rotation, wrist, px_per_mm, 900.0, left), look, forearm=Forearm(60.0, 20.0)
    )


def test_a_sphere_is_drawn_where_it_is():
    canvas = Canvas(60, 40)
    canvas.draw(Cone((30.0, 20.0, 5.0, 10.0), (30.0, 20.0, 5.0, 10.0), 1.0, 1))
    inside = canvas.material == 1
    assert inside.sum() == pytest.approx(np.pi * 100.0, rel=0.05)
    assert canvas.height[inside].max() == pytest.approx(15.0, abs=0.1)
    rows, columns = np.nonzero(inside)
    assert (columns.mean() + 0.5, rows.mean() + 0.5) == pytest.approx((30.0, 20.0), abs=0.1)


def test_the_surface_of_a_round_cone_agrees_with_a_march_of_spheres():
    start, end = np.array([15.0, 12.0, -4.0, 9.0]), np.array([42.0, 30.0, 8.0, 5.0])
    canvas = Canvas(60, 45)
    canvas.draw(Cone(tuple(start), tuple(end), 0.01, 1))
    y, x = np.mgrid[0:45, 0:60] + 0.5
    reference = np.full((45, 60), -np.inf)
    for part in np.linspace(0.0, 1.0, 2001):
        cx, cy, cz, r = start + part * (end - start)
        depth = r * r - (x - cx) ** 2 - (y - cy) ** 2
        reference = np.maximum(
            reference, np.where(depth > 0.0, cz + np.sqrt(np.maximum(depth, 0.0)), -np.inf)
        )
    both = (canvas.material == 1) & np.isfinite(reference)
    assert both.sum() > 0.98 * np.isfinite(reference).sum()
    assert np.abs(canvas.height - reference)[both].max() < 0.05
    assert np.linalg.norm(canvas.normal[:, both], axis=0) == pytest.approx(np.ones(both.sum()), abs=1e-3)


@pytest.mark.parametrize("token", TOKENS)
def test_the_box_holds_the_hand_tightly_and_leaves_out_the_forearm(token):
    hand = render(token)
    x, y, width, height = hand.box
    rows, columns = np.nonzero(hand.hand >= 0.5)
    assert (x, y) == (columns.min() + hand.origin[0], rows.min() + hand.origin[1])
    assert (width, height) == (np.ptp(columns) + 1, np.ptp(rows) + 1)
    tips = hand.landmarks[[4, 8, 12, 16, 20], :2]
    assert np.all(tips >= np.array([x, y]) - 1.5)
    assert np.all(tips <= np.array([x + width, y + height]) + 1.5)
    assert y + height < hand.landmarks[0, 1] + 8.0
    assert hand.alpha.sum() > hand.hand.sum()


@pytest.mark.parametrize(
    ("left", "palm", "thumb_left"), [(True, True, True), (True, False, False), (False, True, False)]
)
def test_the_thumb_points_where_side_and_face_put_it(left, palm, thumb_left):
    token = "left" if thumb_left else "right"
    hand = render(token, FRONT if palm else rotation_y(180.0), left)
    thumb, knuckles = hand.landmarks[4, 0], hand.landmarks[[5, 9, 13, 17], 0].mean()
    assert (thumb < knuckles) == thumb_left
    left_part = hand.hand[:, : int(knuckles) - hand.origin[0]].sum() / hand.hand.sum()
    assert (left_part > 0.5) == thumb_left


def test_a_left_hand_is_the_mirror_image_of_a_right_hand():
    right, left = render("pic"), render("pic", left=True)
    assert left.landmarks[:, 0] - 80.0 == pytest.approx(80.0 - right.landmarks[:, 0])
    assert left.hand.sum() == pytest.approx(right.hand.sum(), rel=0.02)


def test_darker_skin_is_darker_and_keeps_a_lighter_palm():
    def brightness(monk, rotation):
        look = HandLook(tone=skin_tone(monk), atlas=paint_atlas(np.random.default_rng(1)))
        hand = render("5", rotation, look=look)
        return hand.radiance[hand.hand > 0.9].mean()

    palms = [brightness(monk, FRONT) for monk in (1.0, 4.0, 7.0, 10.0)]
    backs = [brightness(monk, rotation_y(180.0)) for monk in (1.0, 4.0, 7.0, 10.0)]
    assert palms == sorted(palms, reverse=True)
    assert backs == sorted(backs, reverse=True)
    assert palms[-1] > 1.5 * backs[-1]


def test_skin_reflects_red_most_and_a_glove_its_own_colour():
    hand = render()
    blue, green, red = hand.radiance[hand.hand > 0.9].mean(axis=0)
    assert red > green > blue
    glove = HandLook(
        tone=glove_tone((0.4, 0.1, 0.05)), atlas=paint_atlas(np.random.default_rng(1), glove=True)
    )
    blue, green, red = (hand := render(look=glove)).radiance[hand.hand > 0.9].mean(axis=0)
    assert blue > green > red


def test_pasting_is_clipped_at_the_edges():
    hand = render()
    for x, y in ((0.0, 0.0), (-500.0, 50.0), (98.0, 79.0)):
        picture = np.full((80, 100, 3), 0.5, np.float32)
        render(wrist=(x, y)).paste(picture)
        assert np.all(np.isfinite(picture))
    canvas = np.zeros((200, 200, 3), np.float32)
    hand.paste(canvas)
    assert canvas.sum() == pytest.approx(hand.radiance.sum(), rel=1e-3)


def test_coding_to_eight_bits_can_be_undone():
    grey = np.arange(256, dtype=np.uint8).reshape(16, 16)
    assert np.abs(encode(decode(grey)).astype(int) - grey).max() <= 1


def test_an_empty_mask_has_an_empty_box():
    assert mask_box(np.zeros((4, 4), np.float32)) == (0, 0, 0, 0)
