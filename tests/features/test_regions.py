"""Colour map, proposals, wrist and choice on drawn pictures, ugly ones included."""

import time
from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture.features import find_hands
from lightgesture.features.colour import ColourStage, reduce_picture
from lightgesture.features.find import cells, proposals
from lightgesture.features.find.classical import ARMS, STANDING_OUT, Loops, Scene, Scorer
from lightgesture.features.find.forearms import cut_forearm, palm_circle
from lightgesture.features.find.proposals import (
    MOST,
    propose,
)
from lightgesture.features.find.selector import choose, load_selector
from lightgesture.features.find.selector_file import load_classical
from lightgesture.features.find.settings import SelectorSettings
from lightgesture.features.geometry import pairwise_iou
from lightgesture.features.types import Candidates, HandRegion

SKIN, WATER = (110, 140, 200), (150, 120, 40)


def _picture_with_blob(cast=(1.0, 1.0, 1.0)):
    image = np.full((480, 640, 3), WATER, np.uint8)
    cv2.ellipse(image, (200, 200), (45, 60), 0, 0, 360, SKIN, cv2.FILLED)
    return np.clip(image * np.array(cast), 0, 255).astype(np.uint8)


def test_reduced_pictures_have_the_working_area_whatever_the_size():
    for shape in ((480, 640), (1080, 1920), (6000, 8000), (480, 100)):
        small, _ = reduce_picture(np.zeros((*shape, 3), np.uint8), 19200)
        assert small.shape[0] * small.shape[1] == pytest.approx(19200, rel=0.03)
    assert reduce_picture(np.zeros((1, 1, 3), np.uint8), 19200)[0].shape == (1, 1, 3)


@pytest.mark.parametrize("cast", [(1, 1, 1), (1.0, 0.9, 0.35), (0.6, 1.0, 0.4), (0.25, 0.25, 0.25)])
def test_skin_is_proposed_through_any_cast(cast):
    proposals = propose(ColourStage().process(_picture_with_blob(cast)))
    truth = np.array([[155, 140, 91, 121]]) / 4.0
    assert pairwise_iou(proposals.boxes, truth).max() > 0.8


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((480, 640, 3), np.uint8),
        np.full((480, 640, 3), 255, np.uint8),
        np.full((480, 640, 3), SKIN, np.uint8),
        np.zeros((1, 1, 3), np.uint8),
        np.zeros((1, 900, 3), np.uint8),
        np.zeros((6000, 8000, 3), np.uint8),
    ],
    ids=["black", "white", "all skin", "1x1", "line", "8000x6000"],
)
def test_pictures_without_contrast_hold_no_hand(image):
    assert find_hands(image) == []


def test_ten_thousand_specks_take_bounded_time_and_are_no_hands():
    rng = np.random.default_rng(3)
    image = np.full((480, 640, 3), WATER, np.uint8)
    image[rng.integers(0, 480, 10_000), rng.integers(0, 640, 10_000)] = SKIN
    stage = load_selector()
    colour = ColourStage().process(image)
    start = time.perf_counter()
    candidates = stage.process(colour)
    assert time.perf_counter() - start < 2.0
    assert choose(candidates, stage.settings) == []


def _blobs():
    """500 skin-coloured blobs of hand's proportions, many of them touching."""
    rng = np.random.default_rng(5)
    image = np.full((480, 640, 3), WATER, np.uint8)
    for x, y in rng.integers((0, 0), (640, 480), (500, 2)):
        shade = np.array(SKIN) * rng.uniform(0.6, 1.2)
        cv2.ellipse(image, (int(x), int(y)), (11, 16), 0, 0, 360, shade.clip(0, 255).tolist(), cv2.FILLED)
    return image


def _lamp(phase):
    """A pair of hands under a lamp that flickers over the frame."""
    image = _picture_with_blob().astype(np.float32)
    image *= 0.4 + 0.6 * np.abs(np.sin(np.arange(480) / 9.0 + phase))[:, None, None]
    return image.clip(0, 255).astype(np.uint8)


WORST = {
    "noise": lambda: np.random.default_rng(1).integers(0, 256, (480, 640, 3), np.uint8),
    "blobs": _blobs,
    "coarse noise": lambda: cv2.resize(
        np.random.default_rng(2).integers(0, 256, (60, 80, 3), np.uint8), (640, 480)
    ),
    "lamp": lambda: _lamp(0.0),
    "lamp, later": lambda: _lamp(1.5),
}


@pytest.mark.parametrize("name", WORST)
def test_the_work_for_the_worst_frames_is_bounded(name, monkeypatch):
    looked_at, outlines = [], []

    def counted(boxes, most):
        looked_at.append(len(boxes))
        return proposals.plain_distinct(boxes, most)

    found = cv2.findContours

    def counted_contours(*args, **options):
        answer = found(*args, **options)
        outlines.append(len(answer[0]))
        return answer

    colour = ColourStage().process(WORST[name]())
    scene = Scene.of(colour, Loops())
    monkeypatch.setattr(proposals.cv2, "findContours", counted_contours)
    regions = proposals.plain_whole(scene.skin, proposals.LEVELS, counted)
    assert looked_at[0] <= proposals.MOST_LOOKED_AT
    # One level may go over the bound before it is seen.
    assert sum(outlines[:-1]) < proposals.MOST_OUTLINES
    assert len(regions) <= MOST
    parts = load_classical()
    seen, scores = Scorer(parts.glance, parts.regions, parts.bank, Loops()).process(scene)
    assert len(seen) == len(scores) <= STANDING_OUT + ARMS
    rows = cells.describe(scene.sums, regions, scene.size)
    assert rows.shape == (len(regions), cells.COLUMNS)
    assert np.isfinite(rows).all()


def test_the_forearm_is_cut_off_below_the_palm():
    mask = np.zeros((120, 90), np.uint8)
    cv2.circle(mask, (40, 35), 22, 255, cv2.FILLED)
    cv2.rectangle(mask, (30, 35), (50, 110), 255, cv2.FILLED)
    contour = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0][0].reshape(-1, 2)
    box = cv2.boundingRect(contour)
    hand = cut_forearm(contour.astype(np.int32), box)
    assert hand is not None
    assert hand[:, 1].max() == pytest.approx(35 + 1.1 * 22, abs=3)
    assert cut_forearm(hand, cv2.boundingRect(hand)) is None


def test_the_palm_circle_is_the_largest_inside():
    mask = np.zeros((60, 60), np.uint8)
    cv2.circle(mask, (30, 25), 18, 255, cv2.FILLED)
    (x, y), radius = palm_circle(mask)
    assert abs(x - 30) <= 1
    assert abs(y - 25) <= 1
    assert radius == pytest.approx(18, abs=1.5)


def _candidates(scores, together):
    regions = []
    for index, score in enumerate(scores):
        x = 100 + 150 * index
        contour = np.array([[x, 100], [x + 80, 100], [x + 80, 180]], np.int32)
        regions.append(HandRegion((x, 100, 80, 80), contour, None, score))
    return Candidates(tuple(regions), np.array(together, np.float32), (640, 480))


def test_a_pair_is_believed_before_a_single_region():
    hands = choose(_candidates([0.9, 0.3, 0.3], [[0, 0, 0], [0, 0, 0.5], [0, 0.5, 0]]), SelectorSettings())
    assert [(hand.side, hand.box[0]) for hand in hands] == [("right", 250), ("left", 400)]


def test_one_hand_takes_the_side_of_its_half_at_lowered_confidence():
    hands = choose(_candidates([0.9], [[0]]), SelectorSettings())
    assert [(hand.side, hand.confidence) for hand in hands] == [("right", pytest.approx(0.72))]


def test_two_hands_that_are_no_pair_are_each_believed_alone():
    settings = SelectorSettings(pair_score=0.3, single_score=0.5)
    hands = choose(_candidates([0.9, 0.6, 0.55], np.zeros((3, 3))), settings)
    assert [(hand.side, hand.box[0]) for hand in hands] == [("right", 100), ("left", 250)]
    assert [hand.confidence for hand in hands] == pytest.approx([0.72, 0.48])
    assert [hand.certainty for hand in hands] == [0.8, 0.8]


def test_a_second_region_on_the_first_is_no_second_hand():
    found = _candidates([0.9, 0.6], [[0, 0], [0, 0]])
    near = replace(found.regions[1], box=(150, 100, 80, 80))
    hands = choose(replace(found, regions=(found.regions[0], near)), SelectorSettings())
    assert [hand.box[0] for hand in hands] == [100]


def test_nothing_is_chosen_below_the_thresholds():
    settings = SelectorSettings(pair_score=0.3, single_score=0.5)
    assert choose(_candidates([0.4, 0.3], [[0, 0.2], [0.2, 0]]), settings) == []


def test_the_working_picture_and_the_one_before_have_the_same_shape():
    colour = ColourStage().process(_picture_with_blob())
    assert colour.picture.shape[:2] == (120, 160)
    assert colour.detail.shape[:2] == (240, 320)
    assert colour.scale == (4.0, 4.0)
    assert colour.source_size == (640, 480)
