import numpy as np
import pytest

from lightgesture.synth.backdrop import Backdrop, BackdropLook
from lightgesture.synth.body import Camera
from lightgesture.synth.camera import CameraLook, Sensor
from lightgesture.synth.specks import Bubbles, Particles, mirror_in_surface
from lightgesture.synth.textures import caustics, periodic_noise
from lightgesture.synth.water import JERLOV_BGR, WaterPath, WaterRange, make_water, through_water


@pytest.mark.parametrize("kind", JERLOV_BGR)
def test_distance_takes_the_light_and_gives_the_veil(kind):
    water = make_water(kind, 3.0, 0.3)
    colour, alpha = np.full((1, 1, 3), 0.5, np.float32), np.ones((1, 1), np.float32)
    assert water.see_through(colour, alpha, 0.0) == pytest.approx(colour)
    assert water.see_through(colour, alpha, 1e4)[0, 0] == pytest.approx(water.veil)
    near, far = water.transmission(1.0), water.transmission(3.0)
    assert np.all(far < near)
    points = water.see_points(np.full((2, 3), 0.5, np.float32), np.array([1.0, 3.0], np.float32))
    assert points[1] == pytest.approx(water.see_through(colour, alpha, 3.0)[0, 0])


def test_the_equation_of_the_picture():
    """I = J exp(-c z) + B (1 - exp(-k z)), by hand."""
    light, veil = np.array([0.8, 0.4, 0.2]), np.array([0.1, 0.3, 0.2])
    seen = through_water(light, np.exp(-np.array([0.1, 0.2, 0.7])), np.exp(-0.5), veil)
    share = 1.0 - np.exp(-0.5)
    expected = [0.8 * np.exp(-0.1), 0.4 * np.exp(-0.2), 0.2 * np.exp(-0.7)] + veil * share
    assert seen == pytest.approx(expected)
    half = through_water(0.5 * light, 1.0, np.exp(-0.5), veil, cover=0.5)
    assert half == pytest.approx(0.5 * (light + veil * share))


def test_a_path_is_the_equation_with_scattering_before_absorption():
    absorbed, kept, veil = np.exp(-np.array([0.1, 0.2, 0.7])), np.exp(-0.4), np.array([0.3, 0.4, 0.1])
    picture = np.random.default_rng(0).random((3, 4, 3))
    seen = WaterPath(absorbed, kept, veil).see(picture)
    assert seen == pytest.approx(through_water(picture, absorbed * kept, kept, veil))


def test_a_random_water_keeps_its_range_and_repeats():
    waters = WaterRange(("IB", "3C"), (1.0, 2.0), (0.1, 0.4), weights=(1.0, 0.0))
    drawn = [waters.draw(np.random.default_rng(seed)) for seed in range(50)]
    assert {kind for kind, _, _ in drawn} == {"IB"}
    assert all(1.0 <= depth_m <= 2.0 and 0.1 <= turbidity <= 0.4 for _, depth_m, turbidity in drawn)
    assert drawn == [waters.draw(np.random.default_rng(seed)) for seed in range(50)]


def test_clear_oceans_are_blue_and_coasts_green():
    def colour(kind):
        return int(np.argmax(make_water(kind, 5.0, 0.15).veil))

    assert [colour(kind) for kind in ("I", "5C")] == [0, 1]
    assert make_water("I", 10.0, 0.1).light[2] < make_water("I", 2.0, 0.1).light[2]


def test_an_unknown_water_is_refused_with_the_choice():
    with pytest.raises(ValueError, match="unknown water type 'beer'; choose one of I, IA"):
        make_water("beer", 1.0, 0.1)


@pytest.mark.parametrize("floor", ["sand", "tiles", "rocks", ""])
def test_a_backdrop_moves_with_time_and_repeats(floor):
    def build():
        look = BackdropLook(floor, surface_m=0.5)
        return Backdrop(look, make_water("IB", 2.0, 0.2), 100.0, (120, 90), np.random.default_rng(1))

    first = build()
    assert np.array_equal(first.frame(1.0), build().frame(1.0))
    assert not np.array_equal(first.frame(1.0), first.frame(2.0))
    assert first.frame(0.0).shape == (90, 120, 3)
    assert np.all(first.frame(0.0) >= 0.0)


def test_textures_tile_and_have_the_promised_mean():
    field = periodic_noise(np.random.default_rng(0), 64)
    seam = np.abs(field[:, 0] - field[:, -1]).mean()
    assert seam < 2.0 * np.abs(np.diff(field, axis=1)).mean()
    assert caustics(np.random.default_rng(0), 64).mean() == pytest.approx(1.0, rel=1e-4)


def test_bubbles_rise_from_the_mouth():
    bubbles = Bubbles(20.0, Camera(300.0, (80.0, 60.0)), np.random.default_rng(0))
    mouth = np.array([0.0, 0.0, 1000.0])
    seen = [bubble for time_s in np.arange(0.0, 8.0, 0.25) for bubble in bubbles.at(time_s, mouth)]
    assert seen
    assert all(point[1] >= 0.0 and 0.0 <= age <= 1.0 for point, _, age in seen)


def test_specks_only_add_light():
    camera, water = Camera(150.0, (80.0, 60.0)), make_water("II", 2.0, 0.2)
    picture = np.full((120, 160, 3), 0.1, np.float32)
    Particles(50, camera, (160, 120), np.random.default_rng(0)).draw(picture, 1.0, water)
    assert picture.min() >= 0.1
    assert picture.max() > 0.12
    before = picture.copy()
    Bubbles(20.0, camera, np.random.default_rng(1)).draw(picture, 5.0, np.array([0.0, 0.0, 800.0]), water)
    assert np.all(picture >= before - 1e-6)


def test_the_surface_mirrors_what_is_below_it():
    picture, cover = np.zeros((100, 80, 3), np.float32), np.zeros((100, 80), np.float32)
    picture[45:60, 30:50], cover[45:60, 30:50] = 1.0, 1.0
    mirror_in_surface(picture, cover, 40.0, np.zeros((64, 64), np.float32), 0.0)
    assert 0.5 < picture[22:33, 32:48].mean() < 0.7
    assert picture[:18].max() == 0.0
    assert picture[36:44, 5:20].max() == 0.0


def test_noise_repeats_by_frame_number_and_grows_with_light():
    def shot(frame, level):
        sensor = Sensor(CameraLook(drift=0.0, blur_px=0.0, shot=0.003), (40, 40), np.random.default_rng(4))
        sensor.meter(np.full((8, 8, 3), CameraLook().target, np.float32))
        return sensor.expose(np.full((40, 40, 3), level, np.float32), frame, 0.0).astype(float)

    assert np.array_equal(shot(3, 0.2), shot(3, 0.2))
    assert not np.array_equal(shot(3, 0.2), shot(4, 0.2))
    linear = [(shot(0, level) / 255.0) ** 2.2 for level in (0.05, 0.5)]
    assert linear[1].std() > 1.5 * linear[0].std()


def test_exposure_and_white_balance_meet_their_targets():
    cast = np.full((20, 20, 3), (0.1, 0.2, 0.05), np.float32)
    sensor = Sensor(
        CameraLook(target=0.25, balance=1.0, drift=0.0, shot=0.0, read=0.0),
        (20, 20),
        np.random.default_rng(0),
    )
    means = sensor.expose(cast.copy(), 0, 0.0).reshape(-1, 3).mean(axis=0)
    assert means == pytest.approx([255.0 * 0.25 ** (1 / 2.2)] * 3, abs=2.0)
    packed = Sensor(CameraLook(jpeg=30), (20, 20), np.random.default_rng(0)).expose(cast.copy(), 0, 0.0)
    assert packed.shape == (20, 20, 3)
