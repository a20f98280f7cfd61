import math

import numpy as np
import pytest

from lightgesture.features.hog import HogSettings, hog, hog_length


def reference(patch: np.ndarray, settings: HogSettings) -> np.ndarray:
    """One patch, one pixel and one vote at a time."""
    patch = patch[settings.rim : len(patch) - settings.rim, settings.rim : len(patch) - settings.rim]
    size, cells = len(patch), len(patch) // settings.cell
    values = np.sqrt(patch / 255.0)
    histograms = np.zeros((cells, cells, settings.bins))
    for y in range(size):
        for x in range(size):
            gradients = []
            for channel in range(patch.shape[2]):
                dx = values[y, x + 1, channel] - values[y, x - 1, channel] if 0 < x < size - 1 else 0.0
                dy = values[y + 1, x, channel] - values[y - 1, x, channel] if 0 < y < size - 1 else 0.0
                gradients.append((dx, dy))
            dx, dy = max(gradients, key=lambda g: g[0] ** 2 + g[1] ** 2)
            turn = 2 * math.pi if settings.signed else math.pi
            position = (math.atan2(dy, dx) % turn) / turn * settings.bins
            lower = math.floor(position)
            for bin_, share in ((lower, 1 - position + lower), (lower + 1, position - lower)):
                for row in range(cells):
                    for column in range(cells):
                        near_y = 1 - abs((y + 0.5) / settings.cell - row - 0.5)
                        near_x = 1 - abs((x + 0.5) / settings.cell - column - 0.5)
                        if near_x > 0 and near_y > 0:
                            vote = share * math.hypot(dx, dy) * near_x * near_y
                            histograms[row, column, bin_ % settings.bins] += vote
    vector = []
    for row in range(cells - 1):
        for column in range(cells - 1):
            block = histograms[row : row + 2, column : column + 2].reshape(-1)
            block = np.minimum(block / math.sqrt((block**2).sum() + settings.floor**2), settings.clip)
            vector.append(block / math.sqrt((block**2).sum() + 1e-6))
    return np.concatenate(vector)


@pytest.mark.parametrize(
    "settings",
    [
        HogSettings(),
        HogSettings(rim=0, cell=6, bins=9),
        HogSettings(rim=0, cell=4, bins=6),
        HogSettings(rim=0, cell=4, bins=12, signed=True),
    ],
)
def test_equals_the_slow_reference(settings: HogSettings) -> None:
    random = np.random.default_rng(3)
    coarse = random.integers(0, 256, (2, 6, 6, 3)).repeat(4, axis=1).repeat(4, axis=2)
    patches = np.clip(coarse + random.integers(-9, 9, (2, 24, 24, 3)), 0, 255).astype(np.uint8)
    expected = np.stack([reference(patch, settings) for patch in patches])
    assert hog(patches, settings).shape == (2, hog_length(24, settings))
    np.testing.assert_allclose(hog(patches, settings), expected, atol=2e-5)


def test_a_batch_gives_what_each_patch_alone_gives() -> None:
    patches = np.random.default_rng(0).integers(0, 256, (5, 32, 32, 3)).astype(np.uint8)
    alone = np.concatenate([hog(patch[None]) for patch in patches])
    np.testing.assert_allclose(hog(patches), alone, atol=1e-6)


def test_a_flat_patch_has_no_gradients() -> None:
    assert not hog(np.full((1, 32, 32, 3), 90, np.uint8)).any()


def test_an_edge_votes_for_its_normal_whichever_side_is_bright() -> None:
    patch = np.zeros((1, 24, 24, 3), np.uint8)
    patch[:, :, 12:] = 200
    settings = HogSettings(rim=0, cell=6)
    blocks = hog(patch, settings).reshape(3, 3, 2, 2, 8)
    assert blocks[1, 1, 0, 0].argmax() == 0
    np.testing.assert_allclose(hog(255 - patch, settings), hog(patch, settings), atol=0.35)
    assert hog(255 - patch, settings).reshape(3, 3, 2, 2, 8)[1, 1, 0, 0].argmax() == 0


def test_darkening_hardly_changes_a_patch_of_strong_contrast() -> None:
    random = np.random.default_rng(1)
    patch = random.integers(0, 256, (1, 8, 8, 3)).repeat(4, axis=1).repeat(4, axis=2).astype(np.uint8)
    bright, dark = hog(patch), hog((patch * 0.4).astype(np.uint8))
    assert np.linalg.norm(bright - dark) < 0.1 * np.linalg.norm(bright)


@pytest.mark.parametrize(("size", "cell"), [(32, 6), (12, 6), (47, 4), (8, 4)])
def test_cells_that_do_not_fit_are_refused(size: int, cell: int) -> None:
    with pytest.raises(ValueError, match="whole cells"):
        hog_length(size, HogSettings(cell=cell))
