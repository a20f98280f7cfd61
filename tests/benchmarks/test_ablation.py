"""Variants of the product: each differs in the one stage that it names, and the table shows what that costs."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.finding.ablation import ablation_table
from lightgesture.benchmarks.finding.ablation_stages import (
    ONE_THRESHOLD,
    ChangedStage,
    ClassicalSearch,
    LearnedSearch,
    Memoryless,
    PlainColourStage,
    ablations,
    bank_scores,
    level_scores,
    lower_of_both,
    tree_scores,
    without_pairs,
)
from lightgesture.benchmarks.finding.clips import FindingAnswer
from lightgesture.benchmarks.finding.regions import Run, make_answer
from lightgesture.benchmarks.scorer import Reading, score_frame
from lightgesture.features.colour import ColourStage
from lightgesture.features.find.classical import ClassicalSelector
from lightgesture.features.find.learned import Places
from lightgesture.features.find.proposals import propose
from lightgesture.features.find.selector import load_selector
from lightgesture.features.find.selector_file import load_classical, load_learned
from lightgesture.features.find.settings import SelectorSettings
from lightgesture.features.types import Candidates, HandRegion
from lightgesture.sources import open_source
from lightgesture.training.datasets import Label, Sample


@pytest.fixture(name="scene", scope="module")
def _scene():
    """Two skin-coloured palms with fingers, before water with a reddish gradient."""
    image = np.full((480, 640, 3), (150, 110, 40), np.uint8)
    image[..., 2] += np.arange(640, dtype=np.uint8)[None, :] // 16
    for x in (170, 430):
        cv2.ellipse(image, (x, 260), (34, 40), 0, 0, 360, (120, 150, 210), -1)
        for angle in (-40, -15, 10, 35):
            end = round(x + 95 * np.sin(np.radians(angle))), round(250 - 95 * np.cos(np.radians(angle)))
            cv2.line(image, (x, 250), end, (120, 150, 210), 16)
    return image


@pytest.fixture(name="colour", scope="module")
def _colour(scene):
    return ColourStage().process(scene)


@pytest.fixture(name="frame", scope="module")
def _frame():
    """A frame of the bundled clip."""
    with open_source(SAMPLE) as source:
        return next(frame.image for frame in source if frame.index == 60)


@pytest.fixture(name="diver", scope="module")
def _diver(frame):
    return ColourStage().process(frame)


@pytest.fixture(name="parts", scope="module")
def _parts():
    return load_classical()


def hand(box, confidence):
    return HandRegion(box, np.zeros((0, 2), np.int32), None, confidence)


HANDS = (hand((0, 0, 40, 40), 0.9), hand((100, 0, 40, 40), 0.4), hand((10, 0, 40, 40), 0.6))


def test_the_search_without_a_change_is_the_products(colour, parts):
    ours = ClassicalSearch(parts, tree_scores(parts))(colour)
    product = ClassicalSelector(parts).process(colour)
    assert len(product.regions) >= 2
    assert [(r.box, r.confidence, r.alternatives) for r in ours.regions] == [
        (r.box, r.confidence, r.alternatives) for r in product.regions
    ]
    assert np.array_equal(ours.pairs, product.pairs)


def test_one_threshold_proposes_less(colour):
    assert 0 < len(propose(colour, ONE_THRESHOLD)) < len(propose(colour))


def test_two_hands_go_together_as_well_as_the_worse(parts):
    together = lower_of_both(HANDS)
    assert together == pytest.approx(np.array([[0, 0.4, 0], [0.4, 0, 0.4], [0, 0.4, 0]], np.float32))
    assert not lower_of_both(HANDS, least=0.5).any()
    assert lower_of_both(()).shape == (0, 0)


def test_without_pairs_a_partner_helps_nobody():
    found = Candidates(HANDS, np.full((3, 3), 0.9, np.float32), (640, 480))
    assert not without_pairs(SelectorSettings())(found).pairs.any()
    surer = replace(found, regions=(HANDS[0], replace(HANDS[1], confidence=0.8)))
    assert without_pairs(SelectorSettings())(surer).pairs[0, 1] == pytest.approx(0.8)


def test_scores_other_than_the_trees(colour, parts):
    proposals = propose(colour)
    for regions, scores in (bank_scores(parts)(colour), level_scores(colour)):
        assert np.array_equal(regions.boxes, proposals.boxes)
        assert scores.shape == (len(proposals),)
        assert scores.dtype == np.float32
        assert (scores >= 0).all()
        assert (scores <= 1).all()
    assert level_scores(colour)[1].argmax() == proposals.levels.argmax()


def test_nothing_is_found_where_nothing_is(parts):
    water = ColourStage().process(np.full((120, 160, 3), (150, 110, 40), np.uint8))
    found = ClassicalSearch(parts, tree_scores(parts))(water)
    assert found.regions == ()
    assert found.pairs.shape == (0, 0)


def test_plain_colours_keep_the_cast(scene):
    # Balancing undoes what a filter before the lens does; without it the map changes with the filter.
    filtered = (scene * np.array([1.0, 0.6, 1.0])).astype(np.uint8)

    def change(stage):
        first, second = (stage.process(image).skin.astype(float) for image in (scene, filtered))
        return np.abs(first - second).mean()

    assert change(PlainColourStage()) > 2 * change(ColourStage())


def test_each_net_alone_has_its_own_boxes(diver):
    parts = load_learned()
    nets = Places(parts.locator, parts.refiner)
    peaks, refined = nets.find(diver)
    for refines, boxes, scores in ((False, peaks.boxes, peaks.heat), (True, refined.boxes, refined.hand)):
        best = LearnedSearch(nets, refines)(diver).regions[0]
        expected = boxes[scores.argmax()] * np.tile(diver.scale, 2)
        assert best.box == pytest.approx(tuple(expected), abs=1.0)


def test_a_changed_stage_changes_what_is_followed_too(diver, frame):
    predicted = [region.box for region in load_selector("learned").process(diver).regions[:2]]

    def forget(found):
        return replace(found, regions=found.regions[:1], pairs=found.pairs[:1, :1])

    own = load_selector("learned").follow(frame, predicted)
    assert own is not None
    changed = ChangedStage("learned", change=forget)
    assert len(changed.follow(frame, predicted).regions) == min(len(own.regions), 1)
    assert len(changed.process(diver).regions) == 1
    assert ChangedStage("learned", follows=False).follow(frame, predicted) is None
    nothing = Candidates((), np.zeros((0, 0), np.float32), (640, 480))
    assert ChangedStage("classical", lambda _: nothing).process(diver) is nothing


def test_without_memory_every_frame_is_a_picture(fake_method):
    method = Memoryless(fake_method, "no tracks")
    image = np.zeros((120, 160, 3), np.uint8)
    stream = method.stream(3)
    assert stream.process(image, 1.0) == method.read(image) == fake_method.read(image)
    assert stream.finish().words == ()
    assert fake_method.times == []
    assert fake_method.holds == []


def test_every_variant_reads_a_picture(scene):
    methods = ablations()
    assert len({method.name for method in methods}) == len(methods) == 14
    assert [method.name for method in methods if ":" not in method.name] == ["learned", "classical"]
    for method in methods:
        assert all(reading.token is None for reading in method.read(scene))


def test_a_row_for_each_variant(tmp_path, signed_take):
    square = (0, 0, 100, 100)
    labels = (Label(square, "right", "5"), Label((200, 0, 100, 100), "left", None))
    sample = Sample(tmp_path / "a.png", labels, "a", "rooms")
    empty = Sample(tmp_path / "b.png", (), "b", "reef")
    right = Reading((0, 0, 100, 80), "right", None)
    found = [
        Run("whole", "rooms", "single", None, (make_answer(sample, [right]),), None),
        Run("whole", "rooms", "sequence", None, (make_answer(sample, []),), None),
        Run("part", "rooms", "single", None, (make_answer(sample, []),), None),
    ]
    negatives = [
        Run("whole", "reef", "single", None, (make_answer(empty, [right]), make_answer(empty, [])), None),
        Run("whole", "reef", "sequence", None, (make_answer(empty, [right, right]),), None),
        Run("part", "reef", "single", None, (make_answer(empty, [right, right]),), None),
    ]
    whole, part = ablation_table(found, negatives, []).to_dicts()
    assert (whole["rooms"], whole["rooms, sequence"], whole["median_iou"]) == (0.5, 0.0, 0.8)
    assert (whole["pair"], whole["any_hand"], part["pair"], part["any_hand"]) == (0, 1, 1, 1)
    assert (part["rooms"], part["rooms, sequence"], part["median_iou"]) == (0.0, None, None)
    clip = FindingAnswer("part", signed_take.scenario, score_frame(labels, [right], True), (0.8,), 2, 1, ())
    whole, part = ablation_table(found, negatives, [clip]).to_dicts()
    assert (part["clips"], part["switches"]) == (0.5, 2)
    assert whole["clips"] is None
