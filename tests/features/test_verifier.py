"""The net that looks again at places in doubt."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.features.colour import ColourStage
from lightgesture.features.find import verifier as verifying
from lightgesture.features.find.learned import LearnedSelector
from lightgesture.features.find.selector_file import load_learned
from lightgesture.features.find.verifier import EVEN, MOST_VERIFIED, WEIGHT, Verifier, together
from lightgesture.sources import open_source


def a_map():
    picture = np.random.default_rng(0).integers(0, 255, (240, 320, 3), dtype=np.uint8)
    return ColourStage().process(picture)


def boxes_of(count):
    return np.array([[10 + 12 * i, 20, 20, 24] for i in range(count)], np.float32)


@pytest.fixture(scope="module")
def verifier():
    network = load_learned().verifier
    assert network is not None
    return Verifier(network)


def test_only_places_in_doubt_are_looked_at(verifier):
    scores = np.array([0.95, 0.5, 0.1], np.float32)
    verified = verifier.process(a_map(), boxes_of(3), scores)
    assert verified[0] == scores[0]
    assert verified[2] == scores[2]
    assert verified[1] != scores[1]
    assert verified.dtype == np.float32
    np.testing.assert_array_equal(scores, np.array([0.95, 0.5, 0.1], np.float32))


def test_a_frame_costs_a_bounded_number_of_looks(verifier):
    scores = np.linspace(0.3, 0.7, 7).astype(np.float32)
    verified = verifier.process(a_map(), boxes_of(7), scores)
    assert list(np.flatnonzero(verified != scores)) == list(range(7 - MOST_VERIFIED, 7))


def test_without_doubt_nothing_is_done(verifier):
    for scores in (np.zeros(0, np.float32), np.array([0.05, 0.9], np.float32)):
        np.testing.assert_array_equal(verifier.process(a_map(), boxes_of(len(scores)), scores), scores)


def test_log_odds_add():
    scores = np.array([0.5, 0.5, 0.3, 0.0, 1.0], np.float32)
    logits = np.array([EVEN, EVEN + 2 / WEIGHT, EVEN, 40.0, -40.0], np.float32)
    assert together(scores, logits) == pytest.approx([0.5, 1 / (1 + np.exp(-2)), 0.3, 1.0, 0.0], abs=1e-3)
    assert np.isfinite(together(scores, np.full(5, 80.0, np.float32))).all()


def test_the_learned_selector_asks_its_verifier(monkeypatch):
    with open_source(SAMPLE) as source:
        seen = ColourStage().process(next(frame.image for frame in source if frame.index == 60))
    known = load_learned()
    plain = LearnedSelector(replace(known, verifier=None)).process(seen)
    monkeypatch.setattr(verifying, "DOUBTED", (0.0, 1.0))
    asked = LearnedSelector(known).process(seen)
    assert [one.box for one in plain.regions[:2]] == [one.box for one in asked.regions[:2]]
    assert plain.regions[0].confidence != asked.regions[0].confidence
