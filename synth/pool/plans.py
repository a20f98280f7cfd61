"""What is tried in the pool: the six instructions of the paper's study, and sentences drawn by chance.

The study is that of Islam, Ho and Sattar, "Dynamic Reconfiguration of Mission Parameters in Underwater Human-Robot
Collaboration", ICRA 2018: four instructions, and two scenarios of two instructions each.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from lightgesture.synth.spec import SceneSpec
from lightgesture.synth.variety import draw_sentence, draw_spec, stream

STUDY: Final = (
    ("1", ("STOP HOVER 50 GO",)),
    ("2", ("CONTD SNAP 20 GO",)),
    ("3", ("CONTD PARAM 3 DECREASE GO",)),
    ("4", ("STOP EXEC 1 GO",)),
    ("a", ("STOP EXEC 2 GO", "CONTD SNAP GO")),
    ("b", ("CONTD SNAP 50 GO", "STOP FOLLOW GO")),
)
"""Name in the paper and sentences. a: stop, execute program 2 and take pictures meanwhile. b: take pictures for 50
seconds, then follow."""

STUDY_SEED: Final = 2018
"""Of the scenes of the study."""
FPS: Final = 15.0
"""Pictures a second of the vehicle's camera."""
SWIM_MPS: Final = 0.12
"""How fast the diver swims away once the vehicle follows, metres a second."""


@dataclass(frozen=True, slots=True)
class Plan:
    """One trial: its name, what is signed, in which scene; how fast the diver swims away once the vehicle follows,
    m/s."""

    name: str
    sentences: tuple[str, ...]
    scene: SceneSpec
    swim_mps: float


def make_plan(name: str, sentences: tuple[str, ...], seed: int, difficulty: float) -> Plan:
    """A plan whose water, diver and camera are drawn from a seed. difficulty: 0 calm and clear to 1 hard.

    Signs last as long as those of all rendered dives, and the camera takes half as many pictures of them.
    """
    drawn = draw_spec(seed, "demo", "water", sentences, difficulty)
    lengths = {name: _slower(getattr(drawn, name), drawn.fps) for name in ("hold", "passage", "pause")}
    scene = drawn.model_copy(update={"fps": FPS, **lengths})
    is_followed = any("FOLLOW" in sentence for sentence in sentences)
    return Plan(name, sentences, scene, SWIM_MPS if is_followed else 0.0)


def _slower(frames: tuple[int, int], fps: float) -> tuple[int, int]:
    """The same time at the rate of the pool's camera."""
    return round(frames[0] * FPS / fps), round(frames[1] * FPS / fps)


def study_plans(difficulty: float) -> list[Plan]:
    """The six of the study."""
    return [
        make_plan(name, sentences, STUDY_SEED + order, difficulty)
        for order, (name, sentences) in enumerate(STUDY)
    ]


def random_plans(count: int, seed: int, difficulty: float) -> list[Plan]:
    """Sentences and scenes by chance."""
    plans = []
    for order in range(count):
        number = 1000 * seed + order
        sentence = draw_sentence(stream(number, "demo"))
        plans.append(make_plan(f"r{order + 1}", (sentence,), number, difficulty))
    return plans
