from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sklearn.kernel_approximation import Nystroem
from sklearn.linear_model import Ridge
from sklearn.metrics.pairwise import rbf_kernel
from sklearn.multiclass import OneVsRestClassifier
from sklearn.svm import SVC

from lightgesture.features.vector import block_lengths, feature_vectors
from lightgesture.models import CLASSES, ModelError, TrainingSample, load_classifier
from lightgesture.models import train_svm as training
from lightgesture.models.loading import SHIPPED_SVM
from lightgesture.models.store import SvmModel
from lightgesture.models.svm import SvmClassifier, radial_kernel, softmax
from lightgesture.models.train_svm import SvmSettings, train_svm

Draw = Callable[[str, int], np.ndarray]


def test_the_kernel_is_scikit_learns() -> None:
    random = np.random.default_rng(0)
    points = random.normal(size=(40, 12)).astype(np.float32)
    centres = random.normal(size=(30, 12)).astype(np.float32)
    np.testing.assert_allclose(
        radial_kernel(points, centres, 0.07), rbf_kernel(points, centres, gamma=0.07), atol=1e-6
    )


def test_scores_are_those_of_scikit_learns_svc(samples: list[TrainingSample], quick: SvmSettings) -> None:
    """One-against-rest machines of scikit-learn, put into a model, score the same to 1e-4."""
    model, _ = train_svm(samples, quick, classes=("1", "5", "none"))
    patches = np.stack([training.cut_patch(s.image, s.box, s.side, quick.features.patch) for s in samples])
    vectors = feature_vectors(patches, quick.features)
    points = SvmClassifier(model).project(vectors)
    truth = np.array([model.classes.index(sample.token) for sample in samples])
    machine = OneVsRestClassifier(SVC(kernel="rbf", gamma=model.gamma, C=3.0)).fit(points, truth)
    weights = np.zeros((len(points), 3), np.float32)
    for column, single in enumerate(machine.estimators_):
        weights[single.support_, column] = single.dual_coef_[0]
    bias = np.array([single.intercept_[0] for single in machine.estimators_], np.float32)
    ours = SvmClassifier(replace(model, centres=points, weights=weights, bias=bias))
    np.testing.assert_allclose(ours.scores(vectors), machine.decision_function(points), atol=1e-4)


def test_training_is_ridge_regression_on_the_nystroem_features_of_scikit_learn(
    samples: list[TrainingSample], quick: SvmSettings
) -> None:
    settings = replace(quick, centres=len(samples))
    model, _ = train_svm(samples, settings, classes=("1", "5", "none"))
    patches = np.stack([training.cut_patch(s.image, s.box, s.side, quick.features.patch) for s in samples])
    vectors = feature_vectors(patches, quick.features)
    points = SvmClassifier(model).project(vectors)
    truth = np.array([model.classes.index(sample.token) for sample in samples])
    weights = training.sample_weights(truth, np.array([sample.source for sample in samples]))
    # All samples as components: Nystroem then needs no random choice to agree with ours.
    features = Nystroem(kernel="rbf", gamma=model.gamma, n_components=len(points)).fit_transform(points)
    targets = np.where(truth[:, None] == np.arange(3), 1.0, -1.0)
    reference = Ridge(alpha=settings.ridge * float(weights.sum())).fit(
        features, targets, sample_weight=weights
    )
    np.testing.assert_allclose(SvmClassifier(model).scores(vectors), reference.predict(features), atol=5e-3)


def test_probabilities_are_a_softmax_over_the_temperature() -> None:
    scores = np.array([[1.0, -1.0, 0.0], [0.0, 0.0, 0.0]], np.float32)
    expected = np.exp(scores / 0.5) / np.exp(scores / 0.5).sum(axis=1, keepdims=True)
    np.testing.assert_allclose(softmax(scores, 0.5), expected, rtol=1e-6)


def test_the_shipped_model_knows_all_classes_and_is_small() -> None:
    assert load_classifier("svm").classes == CLASSES
    assert SHIPPED_SVM.stat().st_size <= 2e6
    assert SHIPPED_SVM.with_suffix(".json").is_file()


def test_a_mirrored_hand_of_the_other_side_reads_the_same(draw: Draw) -> None:
    picture = draw("1", 0)
    classifier = load_classifier()
    left = classifier.probabilities(picture, [(10, 5, 30, 50)], ["left"])
    mirrored = np.ascontiguousarray(picture[:, ::-1])
    right = classifier.probabilities(mirrored, [(60 - 40, 5, 30, 50)], ["right"])
    np.testing.assert_allclose(left, right, atol=1e-5)


def test_rows_are_distributions_in_the_order_of_the_boxes(draw: Draw) -> None:
    picture = np.concatenate([draw("1", 1), draw("5", 2)], axis=1)
    classifier = load_classifier()
    boxes = [(5, 5, 50, 50), (65, 5, 50, 50)]
    both = classifier.probabilities(picture, boxes, ["right", "left"])
    assert both.shape == (2, 11)
    assert both.dtype == np.float32
    np.testing.assert_allclose(both.sum(axis=1), 1.0, atol=1e-5)
    second = classifier.probabilities(picture, boxes[1:], ["left"])
    np.testing.assert_allclose(both[1:], second, atol=1e-5)
    assert classifier.probabilities(picture, [], []).shape == (0, 11)


def test_a_hand_too_small_to_be_read_is_none(draw: Draw) -> None:
    probabilities = load_classifier().probabilities(draw("5", 0), [(20, 20, 8, 8)], ["left"])
    assert probabilities[0, CLASSES.index("none")] == 1.0


def test_grey_pictures_are_read(draw: Draw) -> None:
    grey = draw("5", 0)[..., 0]
    assert load_classifier().probabilities(grey, [(5, 5, 50, 50)], ["left"]).shape == (1, 11)


def test_boxes_outside_the_picture_are_refused(draw: Draw) -> None:
    with pytest.raises(ValueError, match="outside"):
        load_classifier().probabilities(draw("5", 0), [(90, 5, 50, 50)], ["left"])


def test_the_cnn_is_refused_with_the_remedy() -> None:
    with pytest.raises(ModelError, match="not built yet; use --model svm"):
        load_classifier("cnn")


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="no such thing"):
        load_classifier(tmp_path / "no such thing.npz")


def test_the_vector_length_matches_the_shipped_model() -> None:
    classifier = load_classifier()
    assert isinstance(classifier, SvmClassifier)
    model: SvmModel = classifier.model
    assert model.mean.shape == (sum(block_lengths(model.features)),)
