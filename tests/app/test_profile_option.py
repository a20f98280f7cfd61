"""`--profile`: a colour profile takes the place of the skin map, in every command that finds hands."""

import cv2
import numpy as np
import pytest

from lightgesture.errors import ExitStatus
from lightgesture.features.profile import save_profile
from lightgesture.features.profile_learning import learn_profile
from lightgesture.pipeline import Pipeline

BOXES = [(60, 60, 90, 120), (400, 80, 90, 120)]


@pytest.fixture(scope="module")
def gloves():
    """Blue gloves before sand."""
    image = np.full((300, 560, 3), (120, 150, 160), np.uint8)
    for x, y, width, height in BOXES:
        middle, axes = (x + width // 2, y + height // 2), (width // 2, height // 2)
        cv2.ellipse(image, middle, axes, 0, 0, 360, (200, 90, 40), -1)
    noise = np.random.default_rng(1).normal(0, 6, image.shape)
    return np.clip(image + noise, 0, 255).astype(np.uint8)


@pytest.fixture
def profile(gloves, tmp_path):
    path = tmp_path / "glove.json"
    save_profile(path, learn_profile([gloves], [BOXES], "glove", "drawn"))
    return path


class Stages:
    """Keeps the picture of each stage."""

    is_selected = True

    def __init__(self):
        self.pictures = {}

    def write(self, stage, index, picture):
        self.pictures[stage] = picture


def test_the_profile_makes_the_colour_map(gloves, profile):
    shown = {}
    for name in (None, profile):
        stages = Stages()
        Pipeline(profile=name, debug=stages).recognize(gloves)
        shown[name] = stages.pictures["colour"]
    assert shown[None].shape == shown[profile].shape
    assert (shown[None] != shown[profile]).mean() > 0.2


@pytest.mark.parametrize("command", ["decode", "recognize"])
def test_a_wrong_profile_is_one_line(run, make_picture, tmp_path, command):
    wrong = tmp_path / "wrong.json"
    wrong.write_text("{}")
    result = run(command, make_picture("frames/a.png").parent, "--profile", wrong)
    assert result.status == ExitStatus.USAGE
    assert result.out == []
    assert len(result.err) == 1
    assert result.err[0].startswith(f"lightgesture: {wrong}: no valid colour profile")
