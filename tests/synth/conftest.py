"""One small scene, rendered once for all tests of this folder."""

import pytest

from lightgesture.synth.scene import Scene
from lightgesture.synth.spec import DiverSpec, SceneSpec

SMALL = SceneSpec(
    seed=11,
    sentences=("STOP LEFT 5 GO",),
    size=(192, 144),
    hold=(16, 16),
    passage=(3, 3),
    diver=DiverSpec(looseness=0.2),
)


@pytest.fixture(scope="session")
def scene():
    return Scene(SMALL)
