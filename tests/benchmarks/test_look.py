"""How hand patches look in numbers: each measure tells what it says, and real hands stand beside the pool's."""

import json

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks.divers import look
from lightgesture.benchmarks.divers.looks import MEASURES, apart, measure, quantiles

SIDE = 36


def grey(values):
    """Patches (1, 36, 36, 3) of one brightness a pixel."""
    plane = np.clip(np.broadcast_to(values, (SIDE, SIDE)), 0, 255).astype(np.uint8)
    return np.repeat(plane[None, :, :, None], 3, axis=3)


def one(patches):
    return {name: float(values[0]) for name, values in measure(patches).items()}


def disc(inside, outside):
    values = np.full((SIDE, SIDE), outside, np.float64)
    cv2.circle(values, (SIDE // 2, SIDE // 2), 12, float(inside), -1)
    return values


def test_a_flat_patch_has_nothing_but_brightness():
    flat = one(grey(100))
    assert flat["brightness"] == pytest.approx(100, abs=0.1)
    for name in ("spread", "stands_out", "lighter", "redder", "plane", "above", "noise", "edges", "cast_a"):
        assert flat[name] == pytest.approx(0.0, abs=0.05), name


def test_a_dark_hand_stands_out_and_is_no_plane():
    dark = one(grey(disc(60, 140)))
    assert dark["lighter"] < -20
    assert dark["stands_out"] == pytest.approx(-dark["lighter"], abs=0.1)
    assert dark["plane"] < 0.01
    assert abs(dark["above"]) < 0.15


def test_light_from_above_is_a_plane():
    gradient = one(grey(np.linspace(200, 60, SIDE)[:, None]))
    assert gradient["plane"] > 0.97
    assert gradient["above"] > 2
    across = one(grey(np.linspace(200, 60, SIDE)[None]))
    assert across["plane"] > 0.97
    assert abs(across["above"]) < 0.05


def test_blur_takes_fine_detail_and_edges():
    sharp = np.random.default_rng(0).integers(0, 255, (SIDE, SIDE)).astype(np.uint8)
    blurred = cv2.GaussianBlur(sharp, (0, 0), 2.0)
    first, second = one(grey(sharp)), one(grey(blurred))
    assert first["fine"] > 3 * second["fine"]
    assert first["edges"] > second["edges"]


@pytest.mark.parametrize("deviation", [2.0, 6.0])
def test_noise_is_measured_beside_edges(deviation):
    random = np.random.default_rng(1)
    halves = np.where(np.arange(SIDE) < SIDE // 2, 60.0, 140.0)
    noisy = halves + random.normal(0, deviation, (SIDE, SIDE))
    assert one(grey(noisy))["noise"] == pytest.approx(deviation, rel=0.25)


def test_colours_are_told_by_channel():
    green = grey(disc(60, 140)).copy()
    green[..., 2] //= 2
    told = one(green)
    assert told["red_spread"] == pytest.approx(0.5, abs=0.02)
    assert told["blue_spread"] == pytest.approx(1.0, abs=0.01)
    assert told["cast_a"] < -5  # less red is more green
    assert one(green[..., ::-1])["cast_b"] > 5  # and less blue more yellow
    assert told["redder"] > 2  # a dark hand in green light is less green than what is behind it


def test_many_patches_are_measured_in_parts(monkeypatch):
    patches = np.concatenate([grey(value) for value in (10, 50, 90)])
    monkeypatch.setattr("lightgesture.benchmarks.divers.looks.CHUNK", 2)
    assert set(measure(patches)) == set(MEASURES)
    assert measure(patches)["brightness"] == pytest.approx([10, 50, 90], abs=0.1)
    assert quantiles(measure(patches), "brightness")[2] == pytest.approx(50, abs=0.1)
    assert measure(patches[:0])["spread"].shape == (0,)


def test_distributions_are_apart_from_none_to_one():
    low, high = np.arange(10.0), np.arange(100.0, 110.0)
    assert apart(low, low[::-1]) == 0.0
    assert apart(low, high) == 1.0
    assert apart(np.array([0.0, 1.0, 2.0, 3.0]), np.array([2.0, 3.0, 4.0, 5.0])) == 0.5


@pytest.fixture
def divers(tmp_path):
    """A picture with a bare and a gloved sign, a hand at rest, and one that nobody could name."""
    folder = tmp_path / "data" / "divers"
    folder.mkdir(parents=True)
    lines = ["file,sequence,kind,x,y,w,h,shape,glove,view"]
    for place, (shape, glove) in enumerate((("5", "bare"), ("ok", "glove"), ("rest", "bare"), ("bad", "?"))):
        lines.append(f"a.png,dive,hand,{10 + 40 * place},20,30,30,{shape},{glove},?")
    (folder / "boxes.csv").write_text("\n".join(lines), encoding="utf-8")
    picture = np.random.default_rng(0).integers(0, 255, (80, 180, 3)).astype(np.uint8)
    (folder / "a.png").write_bytes(cv2.imencode(".png", picture)[1].tobytes())
    return tmp_path / "data"


def kept_pool(folder):
    folder.mkdir()
    patches = np.random.default_rng(0).integers(0, 255, (5, SIDE, SIDE, 3)).astype(np.uint8)
    np.save(folder / "patches.npy", patches)
    names = {
        "tokens": ["5"] * 5,
        "sources": ["a", "a", "synthetic 1", "reef", "reef"],
        "hands": [0, 1, -1, -1, -1],
    }
    (folder / "patches.json").write_text(json.dumps(names), encoding="utf-8")
    return folder


def test_real_hands_are_sorted_by_glove_and_shape(divers):
    groups = look.real_groups(divers)
    assert [(group.name, group.patches.shape) for group in groups] == [
        ("bare other", (1, SIDE, SIDE, 3)),
        ("bare sign", (1, SIDE, SIDE, 3)),
        ("gloved sign", (1, SIDE, SIDE, 3)),
        ("unclear unnamed", (1, SIDE, SIDE, 3)),
    ]


def test_a_kept_pool_stands_beside_real_hands(divers, tmp_path, capsys):
    pool = kept_pool(tmp_path / "cnn.parts")
    out = tmp_path / "out"
    assert look.main(["--data", str(divers), "--pool", str(pool), "--json", "--out", str(out)]) == 0
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    sizes = {row["group"]: row["patches"] for row in rows if row["table"] == "look"}
    assert sizes == {
        **dict.fromkeys(("bare other", "bare sign", "gloved sign", "unclear unnamed"), 1),
        "copies": 2,
        "rendered": 1,
        "others": 2,
    }
    means = {row["group"]: row for row in rows if row["table"] == "look_apart"}
    assert means["bare sign"]["apart_bare"] == 0.0
    assert means["copies"]["apart_glove"] > 0
    assert means["copies"]["real"] == "no"
    drawn = cv2.imdecode(np.frombuffer((out / "look.png").read_bytes(), np.uint8), cv2.IMREAD_COLOR)
    assert drawn is not None
    assert drawn.shape == (4 * (16 + 3 * 96), 2 * 12 * 96 + 8, 3)


def test_a_folder_without_a_pool_is_named(divers, tmp_path, capsys):
    assert look.main(["--data", str(divers), "--pool", str(tmp_path)]) == 1
    assert "holds no pool of `train cnn`" in capsys.readouterr().err


@pytest.mark.slow
def test_a_small_pool_is_drawn_of_every_kind(real_data):
    groups = list(look.drawn_groups(real_data, 12, 0))
    assert {"hands", "mild", "rendered", "regions"} <= {group.name for group in groups}
    assert all(group.patches.shape[1:] == (SIDE, SIDE, 3) for group in groups)
