"""Colour profiles: learnt, kept in a file, used by the colour stage."""

import json

import cv2
import numpy as np
import pytest

from lightgesture.features.colour import ColourStage
from lightgesture.features.profile import (
    ColourProfile,
    ProfileError,
    colour_cells,
    load_profile,
    save_profile,
)
from lightgesture.features.profile_learning import learn_profile, proposed_share
from lightgesture.synth.scene import Scene
from lightgesture.synth.spec import DiverSpec, SceneSpec

BLUE_RUBBER = (200, 90, 40)
BOXES = [(60, 60, 90, 120), (400, 80, 90, 120)]


def _picture(seed, hand=BLUE_RUBBER, cast=(1.0, 1.0, 1.0)):
    """Two gloved hands before sand and a dark suit, with noise."""
    image = np.full((300, 560, 3), (120, 150, 160), np.uint8)
    cv2.rectangle(image, (200, 60), (350, 299), (40, 45, 50), cv2.FILLED)
    for x, y, width, height in BOXES:
        cv2.ellipse(image, (x + width // 2, y + height // 2), (width // 2, height // 2), 0, 0, 360, hand, -1)
    noise = np.random.default_rng(seed).normal(0, 6, image.shape)
    return np.clip((image + noise) * np.array(cast), 0, 255).astype(np.uint8)


@pytest.fixture(scope="module")
def profile():
    return learn_profile([_picture(1), _picture(2)], [BOXES, BOXES], "glove", "drawn")


def test_gloves_are_bright_and_all_else_is_dark(profile):
    levels = profile.map(_picture(3))
    for x, y, width, height in BOXES:
        middle = levels[y + height // 4 : y + 3 * height // 4, x + width // 4 : x + 3 * width // 4]
        assert middle.mean() > 220
    assert levels[:, 160:390].mean() < 40
    assert profile.separation > 0.99


def test_a_profile_serves_through_another_water(profile):
    tinted = _picture(4, cast=(1.0, 0.9, 0.5))
    assert proposed_share([tinted], [BOXES], profile) == 1.0
    assert proposed_share([tinted], [BOXES]) == 0.0


def test_masks_teach_as_boxes_do():
    masks = [(np.abs(_picture(seed).astype(int) - BLUE_RUBBER).sum(axis=2) < 60) for seed in (1, 2)]
    taught = learn_profile([_picture(1), _picture(2)], masks, "glove", "drawn")
    assert proposed_share([_picture(5)], [BOXES], taught) == 1.0


def test_what_colour_cannot_tell_has_a_low_separation():
    images = [_picture(seed, hand=(120, 150, 160)) for seed in (1, 2)]
    assert learn_profile(images, [BOXES, BOXES], "glove", "sand on sand").separation < 0.7


def test_learning_is_the_same_each_time(profile):
    again = learn_profile([_picture(1), _picture(2)], [BOXES, BOXES], "glove", "drawn")
    np.testing.assert_array_equal(again.levels, profile.levels)


@pytest.mark.parametrize("boxes", [[[], []], [[(0, 0, 560, 300)], []]], ids=["no hands", "nothing but hand"])
def test_pictures_without_hands_or_without_anything_else_teach_nothing(boxes):
    with pytest.raises(ValueError, match="no picture shows a hand"):
        learn_profile([_picture(1), _picture(2)], boxes, "glove", "drawn")
    with pytest.raises(ValueError, match="hands of 1"):
        learn_profile([_picture(1), _picture(2)], boxes[:1], "glove", "drawn")


def test_the_colour_stage_uses_the_profile(profile):
    picture = _picture(6)
    with_profile, default = ColourStage(profile=profile).process(picture), ColourStage().process(picture)
    np.testing.assert_array_equal(with_profile.skin, profile.map(with_profile.picture))
    assert (with_profile.skin != default.skin).any()


@pytest.mark.parametrize("shape", [(1, 1, 3), (1, 90, 3), (40, 30, 3)])
@pytest.mark.parametrize("value", [0, 120, 255])
def test_a_picture_of_one_colour_holds_nothing(profile, shape, value):
    assert not profile.map(np.full(shape, value, np.uint8)).any()


def test_cells_are_numbered_by_blue_green_and_red():
    picture = np.array([[[0, 0, 0], [255, 255, 255], [255, 0, 0]]] * 3, np.uint8)
    dark, light, blue = (np.unravel_index(cell, (8, 8, 8)) for cell in colour_cells(picture, 8, 1.0)[0])
    assert light[0] == blue[0] > dark[0]
    assert light[1] == light[2] == 7
    assert blue[1:] == dark[1:]


def test_a_saved_profile_is_read_as_it_was(profile, tmp_path):
    path = tmp_path / "glove.json"
    save_profile(path, profile)
    first = path.read_bytes()
    read = load_profile(path)
    save_profile(path, read)
    assert path.read_bytes() == first
    assert [entry.name for entry in tmp_path.iterdir()] == ["glove.json"]
    assert (read.kind, read.origin, read.reach) == ("glove", "drawn", profile.reach)
    np.testing.assert_array_equal(read.levels, profile.levels)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"format": "another"}, "format is not"),
        ({"colour": 1}, "unknown or missing: colour"),
        ({"kind": None}, "kind is neither of"),
        ({"kind": "mitten"}, "kind is neither of"),
        ({"origin": "x" * 501}, "origin is no text"),
        ({"bins": 3}, "bins is no whole number"),
        ({"bins": 25}, "bins is no whole number"),
        ({"bins": True}, "bins is no whole number"),
        ({"bins": 5}, "levels is no list"),
        ({"levels": [0] * 7}, "levels is no list"),
        ({"levels": [256] * 64}, "levels holds something else"),
        ({"levels": [0.5] * 64}, "levels holds something else"),
        ({"separation": 1.5}, "separation is no number"),
        ({"separation": float("nan")}, "separation is no number"),
        ({"reach": 0}, "reach is no number"),
    ],
)
def test_what_is_no_profile_is_refused_in_one_line(tmp_path, change, reason):
    path = tmp_path / "bad.json"
    small = ColourProfile("skin", "nowhere", 0.9, 3.0, np.zeros((4, 4, 4), np.uint8))
    save_profile(path, small)
    path.write_text(json.dumps({**json.loads(path.read_text()), **change}))
    with pytest.raises(ProfileError, match=reason) as caught:
        load_profile(path)
    message = str(caught.value)
    assert "bad.json" in message
    assert "lightgesture calibrate" in message
    assert "\n" not in message


@pytest.mark.parametrize("content", [b"", b"{", b"[1]", b"\xff\xfe", b"[" * 100_000, b" " * 600_000])
def test_bytes_that_are_no_json_are_refused(tmp_path, content):
    path = tmp_path / "bad.json"
    path.write_bytes(content)
    with pytest.raises(ProfileError, match="no valid colour profile"):
        load_profile(path)


def test_a_missing_key_and_a_missing_file_are_named(tmp_path):
    path = tmp_path / "profile.json"
    with pytest.raises(ProfileError, match="cannot be read"):
        load_profile(path)
    path.write_text(json.dumps({"format": "lightgesture colour profile 1", "kind": "skin"}))
    with pytest.raises(ProfileError, match="unknown or missing: bins"):
        load_profile(path)


@pytest.mark.parametrize("glove", [(0.35, 0.12, 0.03), (0.06, 0.35, 0.08)], ids=["blue", "green"])
def test_gloves_of_the_synthetic_diver_are_found_with_their_profile(glove):
    spec = SceneSpec(seed=4, size=(320, 240), diver=DiverSpec(glove=glove))
    scene = Scene(spec)
    frames = [scene.frame(round(scene.frame_count * share)) for share in (0.15, 0.35, 0.55, 0.8)]
    images = [frame.image for frame in frames]
    boxes = [[hand.box for hand in frame.record.hands if hand.reason != "partial"] for frame in frames]
    profile = learn_profile(images[:2], boxes[:2], "glove", "first half")
    assert proposed_share(images[2:], boxes[2:], profile) >= 0.75
    assert proposed_share(images[2:], boxes[2:]) < 0.5
