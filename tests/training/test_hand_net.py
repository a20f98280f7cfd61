"""A hand net in floating point and in integers: both see the same patches and answer alike."""

import numpy as np
import pytest

from lightgesture.features.outline.contours import ContourSettings, contour_length, contour_vectors
from lightgesture.models.cnn import CnnClassifier
from lightgesture.training.nets.cnn import CnnTraining, in_integers
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.pool.patch_pool import PatchPool

pytest.importorskip("torch")

CLASSES = ("1", "5", "none")
CONTOUR = ContourSettings()
SIZE = 32


@pytest.mark.parametrize("looks_at_the_outline", [False, True])
def test_integers_answer_as_floating_point_does(looks_at_the_outline):
    from lightgesture.training.nets.architectures import hand_nodes
    from lightgesture.training.nets.hand_net import LearntNet, OutlineScale, make_net

    random = np.random.default_rng(4)
    # Chequers of random colours: patches of noise all look alike to a net.
    patches = np.kron(random.integers(0, 256, (24, 3, 3, 3), np.uint8), np.ones((1, 12, 12, 1), np.uint8))
    contours = contour_vectors(np.ascontiguousarray(patches[:, 2:-2, 2:-2]), CONTOUR)
    pool = PatchPool(
        patches,
        contours.astype(np.float16),
        np.array(CLASSES * 8),
        np.array(["somebody"] * 24),
        np.arange(24),
    )
    samples = HandSamples(pool, np.ones(24, bool), CLASSES, 2)
    length = contour_length(CONTOUR) if looks_at_the_outline else 0
    scale = OutlineScale(contours[:, :length].mean(axis=0), contours[:, :length].std(axis=0) + 1e-3)
    learnt = LearntNet(make_net(hand_nodes(3, length, "small"), SIZE, length, 0).eval(), samples, scale)
    training = CnnTraining("unused", contours=looks_at_the_outline, steps=1)

    seen = np.ascontiguousarray(patches[:, 2:-2, 2:-2])
    floats = learnt.scores(seen, CONTOUR)
    integers = CnnClassifier(in_integers(learnt, training)).scores(seen)
    assert floats.shape == (24, 3)
    assert np.abs(floats - integers).max() < 0.15 * np.ptp(floats)
    for one, other in zip(floats.T, integers.T, strict=True):
        assert np.corrcoef(one, other)[0, 1] > 0.9
