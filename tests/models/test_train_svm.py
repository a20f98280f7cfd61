from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from lightgesture.features.vector import block_lengths
from lightgesture.models import ModelError
from lightgesture.models.svm import SvmClassifier
from lightgesture.training.pool.kept_hands import ONE_IN
from lightgesture.training.pool.kept_sources import assign_folds, kept_samples
from lightgesture.training.samples import TrainingSample
from lightgesture.training.svm.machine import (
    UNFITTED_TEMPERATURE,
    SvmSettings,
    sample_weights,
    train_svm,
)
from lightgesture.training.temperature import fit_temperature

NAMES = ("1", "5", "none")


def no_hands(sources: np.ndarray) -> np.ndarray:
    """Numbers of hands of samples that tell none."""
    return np.full(len(sources), -1)


def test_drawings_of_unseen_sources_are_told_apart(
    samples: list[TrainingSample], quick: SvmSettings, draw: Callable[[str, int], np.ndarray]
) -> None:
    model, held_out = train_svm(samples, quick, classes=NAMES)
    assert (held_out.probabilities.argmax(axis=1) == held_out.truth).mean() > 0.95
    classifier = SvmClassifier(model)
    for column, name in enumerate(NAMES):
        probabilities = classifier.probabilities(draw(name, 999), [(5, 5, 50, 50)], ["left"])
        assert probabilities[0].argmax() == column


def test_the_same_seed_gives_the_same_model(samples: list[TrainingSample], quick: SvmSettings) -> None:
    first, again, other = (train_svm(samples, quick, classes=NAMES, seed=seed)[0] for seed in (1, 1, 2))
    assert np.array_equal(first.weights, again.weights)
    assert np.array_equal(first.centres, again.centres)
    assert not np.array_equal(first.centres, other.centres)


def test_what_is_kept_out_changes_nothing_but_the_temperature(
    samples: list[TrainingSample], quick: SvmSettings
) -> None:
    model, plain = train_svm(samples, quick, classes=NAMES)
    sources = np.array([sample.source for sample in samples])
    kept = assign_folds(sources, no_hands(sources), ONE_IN) == ONE_IN - 1
    assert set(plain.sources) == {sample.source for sample, own in zip(samples, kept, strict=True) if own}
    flipped = {"1": "5", "5": "1", "none": "none"}
    changed = [
        replace(sample, token=flipped[sample.token]) if own else sample
        for sample, own in zip(samples, kept, strict=True)
    ]
    other_model, other = train_svm(changed, quick, classes=NAMES)
    assert np.array_equal(model.weights, other_model.weights)
    assert np.array_equal(model.centres, other_model.centres)
    assert np.array_equal(other.probabilities.argmax(axis=1), plain.probabilities.argmax(axis=1))
    assert (other.truth != plain.truth).any()


@pytest.mark.parametrize("alone", range(ONE_IN))
def test_what_alone_shows_a_class_is_not_kept(alone: int) -> None:
    sources = np.repeat(np.arange(ONE_IN), 5).astype(str)
    truth = (sources == str(alone)).astype(int)
    kept = kept_samples(truth, sources, no_hands(sources))
    assert kept.any()
    assert set(truth[~kept]) == {0, 1}


def test_of_few_sources_hands_are_kept_with_all_their_copies() -> None:
    hands = np.array([*range(24), *range(24), *range(24), -1, -1])
    sources = np.array(["one"] * 72 + ["water 0", "water 1"])
    kept = kept_samples(np.zeros(74, int), sources, hands)
    assert set(hands[kept]) == {11, 23}
    assert kept.sum() == 6


def test_of_very_few_samples_none_is_kept(samples: list[TrainingSample], quick: SvmSettings) -> None:
    model, held_out = train_svm([samples[0], samples[40]], quick, classes=NAMES)
    assert held_out.probabilities.shape == (0, 3)
    assert model.temperature == UNFITTED_TEMPERATURE
    classifier = SvmClassifier(model)
    for sample, column in ((samples[0], 0), (samples[40], 1)):
        assert classifier.probabilities(sample.image, [sample.box], ["left"])[0].argmax() == column


def test_a_sample_of_no_weight_teaches_nothing(samples: list[TrainingSample], quick: SvmSettings) -> None:
    """All of class 5 that is learnt from is called 1 as well, but without weight."""
    lies = [replace(sample, token="1", weight=0.0) for sample in samples if sample.token == "5"]
    settings = replace(quick, steps=100)
    _, held_out = train_svm([*samples, *lies], settings, classes=NAMES)
    honest = held_out.truth == 1
    assert (held_out.probabilities.argmax(axis=1)[honest] == 1).mean() > 0.9


def test_folds_hold_whole_sources_of_like_size() -> None:
    random = np.random.default_rng(0)
    sources = np.array([f"s{number}" for number in random.integers(0, 40, 2000)])
    folds = assign_folds(sources, no_hands(sources), 5)
    for source in np.unique(sources):
        assert len(np.unique(folds[sources == source])) == 1
    assert np.ptp(np.bincount(folds)) < 60


def test_a_single_source_is_dealt_out() -> None:
    one = np.array(["one"] * 10)
    assert np.bincount(assign_folds(one, no_hands(one), 5)).tolist() == [2] * 5


def test_weights_grow_with_the_square_root_of_a_source() -> None:
    truth = np.array([0] * 16 + [0] * 4 + [1] * 4)
    sources = np.array(["many"] * 16 + ["few"] * 4 + ["few"] * 4)
    weights = sample_weights(truth, sources)
    assert weights.mean() == pytest.approx(1.0)
    assert weights[:16].sum() == pytest.approx(2 * weights[16:20].sum(), rel=1e-5)
    assert weights[:20].sum() == pytest.approx(np.sqrt(3) * weights[20:].sum(), rel=1e-5)


@pytest.mark.parametrize("scale", [0.05, 1.0, 4.0])
def test_the_temperature_undoes_a_scale(scale: float) -> None:
    random = np.random.default_rng(0)
    logits = random.normal(0, 1.5, (20000, 4))
    odds = np.exp(logits)
    cumulated = (odds / odds.sum(axis=1, keepdims=True)).cumsum(axis=1)
    truth = (random.random((20000, 1)) > cumulated).sum(axis=1).clip(0, 3)
    scores = (logits * scale).astype(np.float32)
    assert fit_temperature(scores, truth) == pytest.approx(scale, rel=0.06)


@pytest.mark.parametrize("count", [30, 1000])
def test_right_answers_alone_are_no_reason_to_be_sure(count: int) -> None:
    scores = np.tile(np.array([[1.0, -1.0, -1.0]], np.float32), (count, 1))
    temperature = fit_temperature(scores, np.zeros(count, int))
    sure = 1.0 / (1.0 + 2.0 * np.exp(-2.0 / temperature))
    assert sure == pytest.approx((count + 1) / (count + 2), abs=0.2 / count)


def test_wrong_samples_are_refused(samples: list[TrainingSample], quick: SvmSettings) -> None:
    with pytest.raises(ModelError, match="no samples"):
        train_svm([], quick)
    with pytest.raises(ModelError, match="at least two"):
        train_svm([sample for sample in samples if sample.token == "1"], quick)
    with pytest.raises(ModelError, match="'7' is no class"):
        train_svm([replace(samples[0], token="7")], quick)
    with pytest.raises(ModelError, match="source 0: box"):
        train_svm([replace(samples[0], box=(500, 0, 9, 9))], quick)


def test_without_gradients_the_outline_alone_decides(
    samples: list[TrainingSample], quick: SvmSettings
) -> None:
    model, held_out = train_svm(samples, replace(quick, directions=0), classes=NAMES)
    gradients, contour = block_lengths(model.features)
    assert model.projection.shape == (gradients + contour, contour)
    assert not model.projection[:gradients].any()
    assert (held_out.probabilities.argmax(axis=1) == held_out.truth).mean() > 0.9
    vectors = np.tile(model.mean, (2, 1))
    vectors[1, :gradients] += np.float32(0.3)
    first, other = SvmClassifier(model).scores(vectors)
    assert np.array_equal(first, other)
