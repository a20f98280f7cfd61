"""What both shipped classifiers promise."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lightgesture.models import CLASSES, ModelError, check_classes, load_classifier
from lightgesture.models.loading import DEFAULT, SHIPPED, Classifier
from lightgesture.training.samples import in_order

Draw = Callable[[str, int], np.ndarray]
LARGEST = {"cnn": 900_000, "svm": 800_000}
"""Bytes; the selector besides, all of them make 3 million at most."""


@pytest.fixture(scope="module", params=sorted(SHIPPED))
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def classifier(name: str) -> Classifier:
    return load_classifier(name)


def test_the_shipped_model_knows_all_classes_and_is_small(name: str, classifier: Classifier) -> None:
    assert classifier.classes == CLASSES
    assert SHIPPED[name].stat().st_size <= LARGEST[name]
    assert SHIPPED[name].with_suffix(".json").is_file()


def test_a_path_does_what_a_name_does(name: str, classifier: Classifier, draw: Draw) -> None:
    box = [(5, 5, 50, 50)]
    by_path = load_classifier(SHIPPED[name]).probabilities(draw("1", 0), box, ["left"])
    np.testing.assert_array_equal(by_path, classifier.probabilities(draw("1", 0), box, ["left"]))


def test_a_mirrored_hand_of_the_other_side_reads_the_same(classifier: Classifier, draw: Draw) -> None:
    picture = draw("1", 0)
    # A box of which both squares begin at whole pixels, mirrored or not.
    left = classifier.probabilities(picture, [(10, 10, 30, 40)], ["left"])
    mirrored = np.ascontiguousarray(picture[:, ::-1])
    right = classifier.probabilities(mirrored, [(60 - 40, 10, 30, 40)], ["right"])
    np.testing.assert_allclose(left, right, atol=0.02)


def test_rows_are_distributions_in_the_order_of_the_boxes(classifier: Classifier, draw: Draw) -> None:
    picture = np.concatenate([draw("1", 1), draw("5", 2)], axis=1)
    boxes = [(5, 5, 50, 50), (65, 5, 50, 50)]
    both = classifier.probabilities(picture, boxes, ["right", "left"])
    assert both.shape == (2, 11)
    assert both.dtype == np.float32
    np.testing.assert_allclose(both.sum(axis=1), 1.0, atol=1e-5)
    second = classifier.probabilities(picture, boxes[1:], ["left"])
    np.testing.assert_allclose(both[1:], second, atol=1e-5)
    assert classifier.probabilities(picture, [], []).shape == (0, 11)


def test_a_hand_too_small_to_be_read_is_none(classifier: Classifier, draw: Draw) -> None:
    probabilities = classifier.probabilities(draw("5", 0), [(20, 20, 8, 8)], ["left"])
    assert probabilities[0, CLASSES.index("none")] == 1.0


def test_grey_pictures_are_read(classifier: Classifier, draw: Draw) -> None:
    grey = draw("5", 0)[..., 0]
    assert classifier.probabilities(grey, [(5, 5, 50, 50)], ["left"]).shape == (1, 11)


def test_a_flat_picture_gives_finite_probabilities(classifier: Classifier) -> None:
    for level in (0, 128, 255):
        flat = np.full((60, 60, 3), level, np.uint8)
        assert np.isfinite(classifier.probabilities(flat, [(5, 5, 50, 50)], ["left"])).all()


def test_boxes_outside_the_picture_are_refused(classifier: Classifier, draw: Draw) -> None:
    with pytest.raises(ValueError, match="outside"):
        classifier.probabilities(draw("5", 0), [(90, 5, 50, 50)], ["left"])


def test_without_a_name_it_is_the_default(draw: Draw) -> None:
    arguments = draw("5", 0), [(5, 5, 50, 50)], ["left"]
    expected = load_classifier(DEFAULT).probabilities(*arguments)
    np.testing.assert_array_equal(load_classifier().probabilities(*arguments), expected)


@pytest.mark.parametrize("classes", [CLASSES, CLASSES[:-1]])
def test_a_model_and_a_grammar_of_the_same_tokens_agree(classes: tuple[str, ...]) -> None:
    assert check_classes(classes, CLASSES[:-1]) is None


def test_classes_that_the_grammar_does_not_know_are_told() -> None:
    warning = check_classes((*CLASSES, "shaka", "wave"), CLASSES[:-1])
    assert warning is not None
    assert warning.startswith("classes of the model that the grammar does not know: shaka, wave; ")
    assert check_classes(CLASSES, ("0", "1", "ok")) is not None


def test_tokens_that_the_model_cannot_read_are_refused() -> None:
    with pytest.raises(
        ModelError, match="tokens of the grammar that the model cannot read: wave, shaka; take"
    ):
        check_classes(CLASSES, ("wave", "ok", "shaka"))
    with pytest.raises(ModelError, match="cannot read: none"):
        check_classes(CLASSES, CLASSES)


def test_names_come_in_the_order_of_the_language_and_own_ones_by_name() -> None:
    assert in_order(["none", "wave", "ok", "0", "Up", "ok"]) == ("0", "ok", "Up", "wave", "none")
    assert in_order(CLASSES) == CLASSES
    assert in_order([]) == ()


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="no such thing"):
        load_classifier(tmp_path / "no such thing.npz")
