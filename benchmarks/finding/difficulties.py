"""Short clips of the synthetic diver in which one thing alone is difficult, to see what each costs.

Every clip is a part of a scene of the suite's kind, from the raising of the hands on; two scenes a difficulty. "glare"
is laid over the pictures, as the sun veils what a camera sees against it; the others are the suite's own.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from lightgesture.benchmarks.suite.cache import Take
from lightgesture.benchmarks.suite.scenarios import ALONE, FIRST_SEED, PROFILE, Scenario, scene_spec
from lightgesture.benchmarks.suite.takes import SyntheticTake, drawing_digest
from lightgesture.synth.hand import decode, encode
from lightgesture.synth.raster import Float32
from lightgesture.synth.scene import Scene, SceneFrame
from lightgesture.synth.variety import stream

SENTENCES = ("STOP HOVER 50 GO", "CONTD PARAM 3 DECREASE GO")
"""One scene each."""

GLARE, GLOVES = "glare", "gloves"
DIFFICULTIES = (
    "clear", GLARE, "bubbles", "reflection", "face", "out of view", "turbid", GLOVES, "cast", "far", "bare arms",
    "back light", "skin colours",
)  # fmt: skip
"""Names of `suite.scenarios`, "reflection" being the mirror image in the surface and "out of view" partial hands."""

IN_ROOMS = frozenset({"back light", "skin colours"})


@dataclass(frozen=True, slots=True)
class Excerpt:
    """Frames of a scene: `count` of them from `first` on, every `step`-th."""

    first: int
    count: int
    step: int = 1


SHOWN = Excerpt(15, 75)
"""From the raising of the hands on, through two signs or three."""

LEARNT = Excerpt(100, 10, 6)
"""What a colour profile is learnt from: later frames of the same scene."""


STRENGTH: Final = 0.7
"""Light at the middle of the sun's veil over white."""

REACH: Final = 0.3
"""Standard deviation of the veil over the picture's width."""

HEIGHT: Final = 0.1
"""Of the veil's middle over the picture's height."""

SWAY: Final = 0.08
"""How far the veil moves, over the picture's width."""

FLICKER: Final = 0.3
"""Share of the light that waves take away."""

PERIOD_S: Final = 0.7
"""Of the waves."""


class Glare:
    """The veil of the sun behind the diver, moving as the surface does."""

    def __init__(self, size: tuple[int, int], rng: np.random.Generator) -> None:
        self._size = size
        self._x = float(rng.uniform(0.3, 0.7))
        self._phases = rng.uniform(0.0, 2.0 * np.pi, 2)

    def lay_over(self, picture: Float32, time_s: float) -> Float32:
        """Add the veil to a linear picture, float32 (h, w, 3)."""
        width, height = self._size
        swing = np.sin(2.0 * np.pi * time_s / PERIOD_S * np.array([0.37, 1.0]) + self._phases)
        across = np.arange(width) / width - self._x - SWAY * swing[0]
        down = (np.arange(height) / height - HEIGHT) * height / width
        veil = np.exp(-0.5 * (across[None, :] ** 2 + down[:, None] ** 2) / REACH**2)
        light = STRENGTH * (1.0 - FLICKER * 0.5 * (1.0 + swing[1]))
        return np.asarray(picture + (light * veil)[..., None].astype(np.float32), np.float32)


@dataclass(frozen=True, slots=True)
class ExcerptTake(SyntheticTake):
    """An excerpt of a scenario of the synthetic diver, shown from time 0 on."""

    excerpt: Excerpt

    def frames(self) -> Iterator[SceneFrame]:
        """Pictures with their truth."""
        scene = Scene(scene_spec(self.scenario))
        glare = None
        if self.scenario.difficulty == GLARE:
            glare = Glare(self.size, stream(self.scenario.seed, "suite"))
        for index in range(self.excerpt.count):
            frame = scene.frame(self.excerpt.first + index * self.excerpt.step)
            time_s = index / self.fps
            image = frame.image if glare is None else encode(glare.lay_over(decode(frame.image), time_s))
            yield SceneFrame(image, replace(frame.record, frame=index, time_s=time_s))


def difficulty_takes() -> list[Take]:
    """The clips, two a difficulty."""
    return [_take(scenario, SHOWN) for scenario in _scenarios()]


def profile_take(scenario: Scenario) -> Take:
    """What a colour profile for a clip is learnt from."""
    return _take(replace(scenario, suite=PROFILE), LEARNT)


def _scenarios() -> list[Scenario]:
    named = [(name, sentence) for name in DIFFICULTIES for sentence in SENTENCES]
    return [
        Scenario(ALONE, (sentence,), name, "room" if name in IN_ROOMS else "water", seed)
        for seed, (name, sentence) in enumerate(named, FIRST_SEED[ALONE])
    ]


def _take(scenario: Scenario, excerpt: Excerpt) -> Take:
    spec = scene_spec(scenario)
    recipe = f"{drawing_digest(Path(__file__))} {excerpt} {spec.model_dump_json()}"
    return ExcerptTake(scenario, spec.fps, spec.size, recipe, excerpt)
