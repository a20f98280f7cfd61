from collections.abc import Callable
from dataclasses import replace

import numpy as np
from sklearn.kernel_approximation import Nystroem
from sklearn.linear_model import Ridge
from sklearn.metrics.pairwise import rbf_kernel
from sklearn.multiclass import OneVsRestClassifier
from sklearn.svm import SVC

from lightgesture.features.patch import cut_patch
from lightgesture.features.vector import block_lengths, feature_vectors
from lightgesture.models import load_classifier
from lightgesture.models.svm import SvmClassifier, radial_kernel, softmax
from lightgesture.models.svm_file import SvmModel
from lightgesture.training.pool.kept_sources import kept_samples
from lightgesture.training.samples import TrainingSample
from lightgesture.training.svm.machine import RIDGE, SvmSettings, sample_weights, train_svm

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
    patches = np.stack([cut_patch(s.image, s.box, s.side, quick.features.patch) for s in samples])
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
    settings = replace(quick, centres=len(samples), steps=0)
    model, _ = train_svm(samples, settings, classes=("1", "5", "none"))
    truth, sources = np.array([s.token for s in samples]), np.array([s.source for s in samples])
    kept = kept_samples(truth, sources, np.full(len(samples), -1))
    samples = [sample for sample, own in zip(samples, kept, strict=True) if not own]
    patches = np.stack([cut_patch(s.image, s.box, s.side, quick.features.patch) for s in samples])
    vectors = feature_vectors(patches, quick.features)
    points = SvmClassifier(model).project(vectors)
    truth = np.array([model.classes.index(sample.token) for sample in samples])
    weights = sample_weights(truth, np.array([sample.source for sample in samples]))
    # All samples as components: Nystroem then needs no random choice to agree with ours.
    features = Nystroem(kernel="rbf", gamma=model.gamma, n_components=len(points)).fit_transform(points)
    targets = np.where(truth[:, None] == np.arange(3), 1.0, -1.0)
    reference = Ridge(alpha=RIDGE * float(weights.sum())).fit(features, targets, sample_weight=weights)
    np.testing.assert_allclose(SvmClassifier(model).scores(vectors), reference.predict(features), atol=5e-3)


def test_probabilities_are_a_softmax_over_the_temperature() -> None:
    scores = np.array([[1.0, -1.0, 0.0], [0.0, 0.0, 0.0]], np.float32)
    expected = np.exp(scores / 0.5) / np.exp(scores / 0.5).sum(axis=1, keepdims=True)
    np.testing.assert_allclose(softmax(scores, 0.5), expected, rtol=1e-6)


def test_the_vector_length_matches_the_shipped_model() -> None:
    classifier = load_classifier("svm")
    assert isinstance(classifier, SvmClassifier)
    model: SvmModel = classifier.model
    assert model.mean.shape == (sum(block_lengths(model.features)),)
