import io
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from lightgesture.features.hog import HogSettings
from lightgesture.features.outline.contours import ContourSettings
from lightgesture.features.patch import PatchSettings
from lightgesture.features.vector import VectorSettings
from lightgesture.training.samples import TrainingSample
from lightgesture.training.svm.machine import SvmSettings

SMALL = VectorSettings(PatchSettings(size=24), HogSettings(rim=0, cell=6), ContourSettings(size=24))
"""Features that take little time."""


Change = Callable[[Path, Callable[[dict[str, Any], dict[str, np.ndarray]], None]], Path]
"""Changes header and arrays of a model file."""


@pytest.fixture(autouse=True, scope="module")
def _one_blas_thread() -> Iterator[None]:
    """Trainings as small as these are quicker on one thread, and much quicker where others use the cores."""
    with threadpool_limits(1, "blas"):
        yield


@pytest.fixture
def changed() -> Change:
    """Writes a model file anew with its header and arrays changed, and gives its path back."""

    def rewrite(path: Path, change: Callable[[dict[str, Any], dict[str, np.ndarray]], None]) -> Path:
        with np.load(path) as file:
            arrays = dict(file)
        header = json.loads(arrays.pop("header").tobytes())
        change(header, arrays)
        content = io.BytesIO()
        np.savez(content, header=np.frombuffer(json.dumps(header).encode(), np.uint8), **arrays)
        path.write_bytes(content.getvalue())
        return path

    return rewrite


@pytest.fixture
def quick() -> SvmSettings:
    """Settings that train in well under a second."""
    return SvmSettings(features=SMALL, directions=16, centres=60, steps=15)


@pytest.fixture
def draw() -> Callable[[str, int], np.ndarray]:
    """Draw a picture, uint8 (60, 60, 3): "1" an upright bar, "5" a disc, "none" a lying bar."""

    def drawing(token: str, seed: int) -> np.ndarray:
        random = np.random.default_rng(seed)
        picture = random.normal(90, 8, (60, 60, 3))
        x, y = random.integers(-3, 4, 2)
        rows, columns = np.mgrid[:60, :60]
        if token == "1":
            inside = (abs(columns - 30 - x) < 7) & (abs(rows - 30 - y) < 24)
        elif token == "5":
            inside = (columns - 30 - x) ** 2 + (rows - 30 - y) ** 2 < 20**2
        else:
            inside = (abs(rows - 30 - y) < 7) & (abs(columns - 30 - x) < 24)
        picture[inside] += (30, 50, 90)
        return np.clip(picture, 0, 255).astype(np.uint8)

    return drawing


@pytest.fixture
def samples(draw: Callable[[str, int], np.ndarray]) -> list[TrainingSample]:
    """Ninety drawings of three classes from fifteen sources."""
    return [
        TrainingSample(
            image=draw(token, 100 * number + index),
            box=(5, 5, 50, 50),
            side="left",
            token=token,
            source=f"source {index % 15}",
        )
        for number, token in enumerate(("1", "5", "none"))
        for index in range(30)
    ]


@pytest.fixture
def folder(tmp_path: Path, draw: Callable[[str, int], np.ndarray]) -> Path:
    """Folders of twelve pictures a class."""
    import cv2

    for number, token in enumerate(("1", "5", "none")):
        (tmp_path / "hands" / token).mkdir(parents=True)
        for index in range(12):
            path = tmp_path / "hands" / token / f"{index}.png"
            assert cv2.imwrite(str(path), draw(token, 100 * number + index))
    return tmp_path / "hands"
