from functools import partial

import cv2
import numpy as np
import pytest

from lightgesture.synth import crops as crop_module
from lightgesture.synth import showcase
from lightgesture.synth.crops import MARGIN, NONE, CropMaker, CropSettings
from lightgesture.synth.poses import TOKENS


@pytest.fixture(autouse=True)
def _few_backdrops(monkeypatch):
    monkeypatch.setattr(crop_module, "CropSettings", partial(CropSettings, backdrops=1))


@pytest.fixture
def crops():
    maker = CropMaker(1)
    return [maker.sample(token) for token in ("0", "3", "left", "right", "pic", "ok", "none")]


def test_crops_have_the_form_of_the_real_ones(crops):
    for crop in crops:
        side = crop.image.shape[0]
        assert crop.image.shape == (side, side, 3)
        assert 40 <= side <= 112
        extent = np.ptp(crop.landmarks, axis=0).max()
        assert side / extent == pytest.approx(MARGIN, rel=0.06)
        x, y, width, height = crop.box
        assert (x + width / 2, y + height / 2) == pytest.approx((side / 2, side / 2), abs=0.25 * side)
        assert max(width, height) >= 0.9 * extent


@pytest.mark.parametrize("token", ["left", "right"])
def test_left_and_right_say_where_the_thumb_points(token):
    maker = CropMaker(2, settings=CropSettings(roll=0.0, yaw=0.0))
    sides = set()
    for _ in range(10):
        crop = maker.sample(token)
        sides.add(crop.left)
        thumb, knuckles = crop.landmarks[4, 0], crop.landmarks[[5, 9, 13, 17], 0].mean()
        assert (thumb < knuckles) == (token == "left")
        assert crop.palm == (crop.left == (token == "left"))
    assert sides == {True, False}


def test_fingers_lie_side_by_side_where_they_shall():
    def gap(together):
        maker = CropMaker(4, settings=CropSettings(yaw=0.0, together=together))
        crops = [maker.sample("2") for _ in range(12)]
        tips = [abs(crop.landmarks[8, 0] - crop.landmarks[12, 0]) for crop in crops]
        return np.median([tip / np.ptp(crop.landmarks[:, 1]) for tip, crop in zip(tips, crops, strict=True)])

    # A finger's width apart, and a V.
    assert gap(1.0) < 0.17
    assert gap(0.0) > 0.22


def test_a_stream_repeats_by_seed_and_differs_by_purpose():
    first, again = ([crop.image for crop in CropMaker(7).samples(4)] for _ in range(2))
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))
    other = next(CropMaker(7, "suite").samples(1)).image
    assert other.shape != first[0].shape or not np.array_equal(other, first[0])


def test_all_tokens_come_in_turn_with_other_shapes_between():
    tokens = [crop.token for crop in CropMaker(3).samples(44)]
    in_turn = [TOKENS[index % len(TOKENS)] for index in range(44)]
    assert all(token in (NONE, expected) for token, expected in zip(tokens, in_turn, strict=True))
    assert 0 < tokens.count(NONE) < 16


def test_a_sheet_has_a_row_for_every_token(monkeypatch):
    monkeypatch.setattr(showcase, "HANDS_A_ROW", 1)
    picture = showcase.hand_sheet(1)
    assert picture.shape == (11 * showcase.TILE_PX, showcase.TILE_PX, 3)
    assert all(row.std() > 2.0 for row in picture.reshape(11, -1))


def test_a_sheet_is_written_whole(tmp_path, monkeypatch):
    drawn = np.full((20, 30, 3), 90, np.uint8)
    monkeypatch.setattr(showcase, "hand_sheet", lambda: drawn)
    showcase.main(["hands", str(tmp_path / "a.jpg")])
    assert [path.name for path in tmp_path.iterdir()] == ["a.jpg"]
    assert cv2.imread(str(tmp_path / "a.jpg")).shape == (20, 30, 3)


def test_a_showcase_names_what_it_has():
    with pytest.raises(SystemExit, match="name one of clip, hands, scenes, decoded"):
        showcase.main(["feet"])


def test_the_bundled_clip_as_the_decoder_sees_it():
    assert showcase.decoded_sheet().shape == (480, 2 * 640, 3)
