"""Draws whole scenes from a seed: who dives, where, in what water, seen by what camera, signing what.

Purposes keep streams apart: what training draws can never be what a suite draws, whatever the seeds.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from lightgesture.synth.spec import (
    BackdropSpec,
    CameraSpec,
    DiverSpec,
    MotionSpec,
    RoomSpec,
    SceneSpec,
    WaterSpec,
)
from lightgesture.synth.water import WaterRange

Purpose = Literal["demo", "train", "suite"]
_PURPOSE_KEYS: dict[Purpose, int] = {"demo": 1, "train": 2, "suite": 3}
Place = Literal["any", "water", "room"]

SUITS = (
    (0.02, 0.017, 0.014), (0.012, 0.012, 0.012), (0.10, 0.04, 0.02), (0.03, 0.03, 0.12), (0.06, 0.06, 0.06),
    (0.30, 0.12, 0.04), (0.04, 0.25, 0.45), (0.35, 0.35, 0.33),
)  # fmt: skip
ACCENTS = ((0.25, 0.06, 0.02), (0.02, 0.03, 0.35), (0.03, 0.35, 0.5), (0.4, 0.4, 0.4), (0.03, 0.25, 0.06))
GLOVES = ((0.02, 0.02, 0.02), (0.25, 0.08, 0.03), (0.05, 0.06, 0.4), (0.05, 0.5, 0.55))
TASKS = ("HOVER", "FOLLOW", "LEFT", "RIGHT", "UP", "DOWN")
CHANGES = ("INCREASE", "DECREASE", "DEFAULT")
PROGRAMS = (0, 1, 2, 3)
PARAMETERS = (0, 1, 2, 3)


def stream(seed: int, purpose: Purpose) -> np.random.Generator:
    """Generator of one seed of one purpose."""
    return np.random.default_rng(np.random.SeedSequence([_PURPOSE_KEYS[purpose], seed]))


def draw_sentence(rng: np.random.Generator) -> str:
    """A sentence of the bundled grammar's forms; digits are 0 to 5, because hands have five fingers."""
    form = rng.uniform()
    number = f" {int(rng.integers(1, 6))}{int(rng.integers(0, 6))}" if rng.uniform() < 0.5 else ""
    if form < 0.5:
        return f"STOP {rng.choice(TASKS)}{number} GO"
    if form < 0.65:
        return f"STOP EXEC {rng.choice(PROGRAMS)} GO"
    if form < 0.85:
        return f"CONTD PARAM {rng.choice(PARAMETERS)} {rng.choice(CHANGES)} GO"
    return f"CONTD SNAP{number} GO"


def draw_spec(
    seed: int,
    purpose: Purpose = "demo",
    place: Place = "any",
    sentences: tuple[str, ...] | None = None,
    difficulty: float = 0.5,
) -> SceneSpec:
    """A scene from a seed. difficulty 0..1 scales drift, turbidity, noise, blur and carelessness."""
    rng = stream(seed, purpose)
    if sentences is None:
        sentences = tuple(draw_sentence(rng) for _ in range(int(rng.integers(1, 3))))
    dry = place == "room" or (place == "any" and rng.uniform() < 0.25)
    hold = int(rng.integers(20, 30))
    diver = _diver(rng, dry, difficulty)
    return SceneSpec(
        seed=int(rng.integers(2**31)),
        sentences=sentences,
        hold=(hold, hold + 10),
        water=WaterSpec(kind="none") if dry else _water(rng, difficulty),
        backdrop=_backdrop(rng, diver.distance_mm),
        room=_room(rng),
        diver=diver,
        motion=MotionSpec(
            drift=float(rng.uniform(0.2, 0.6 + 1.2 * difficulty)) * (0.4 if dry else 1.0),
            tremor_mm=float(rng.uniform(0.5, 2.0 + 4.0 * difficulty)),
            approach_mm=float(rng.normal(0.0, 300.0 * difficulty)),
        ),
        camera=_camera(rng, difficulty),
    )


def _water(rng: np.random.Generator, difficulty: float) -> WaterSpec:
    waters = WaterRange(
        kinds=("I", "IA", "IB", "II", "III", "1C", "3C", "5C", "7C"),
        weights=(1, 1, 4, 3, 3, 2, 2, 1, difficulty),
        depth_m=(0.6, 8.0),
        turbidity=(0.05, 0.15 + 0.75 * difficulty),
    )
    kind, depth_m, turbidity = waters.draw(rng)
    return WaterSpec.model_validate({"kind": kind, "depth_m": depth_m, "turbidity": turbidity})


def _backdrop(rng: np.random.Generator, distance_mm: float) -> BackdropSpec:
    # As high above the camera as puts the waterline behind or just above the diver's head.
    surface_m = float(rng.uniform(0.18, 0.38)) * distance_mm / 1000.0
    return BackdropSpec.model_validate(
        {
            "floor": str(rng.choice(("sand", "tiles", "rocks", ""), p=(0.3, 0.3, 0.2, 0.2))),
            "floor_m": float(rng.uniform(0.8, 4.0)),
            "surface_m": surface_m if rng.uniform() < 0.4 else 0.0,
            "horizon": float(rng.uniform(0.3, 0.6)),
            "caustic": float(rng.uniform(0.0, 0.9)),
            "particles": int(rng.integers(0, 160)) if rng.uniform() < 0.6 else 0,
            "bubbles": float(rng.uniform(8.0, 30.0)) if rng.uniform() < 0.4 else 0.0,
        }
    )


def _room(rng: np.random.Generator) -> RoomSpec:
    return RoomSpec(
        wall=int(rng.integers(0, 6)),
        pieces=int(rng.integers(2, 16)),
        window=float(rng.uniform(0.8, 3.0)) if rng.uniform() < 0.4 else 0.0,
        lamps=int(rng.integers(0, 4)),
        level=float(rng.uniform(0.25, 1.2)),
    )


def _diver(rng: np.random.Generator, dry: bool, difficulty: float) -> DiverSpec:
    glove = GLOVES[int(rng.integers(len(GLOVES)))] if not dry and rng.uniform() < 0.08 else None
    regulator = not dry and rng.uniform() < 0.6
    bare = rng.uniform() < 0.35
    reach = rng.normal([300.0, 60.0, 220.0], [35.0, 55.0, 40.0])
    return DiverSpec(
        monk=float(rng.uniform(1.5, 9.0)),
        blood=float(rng.uniform(0.5, 1.6)),
        glove=glove,
        suit=SUITS[int(rng.integers(len(SUITS)))],
        accent=ACCENTS[int(rng.integers(len(ACCENTS)))],
        sleeve_mm=None if bare else float(rng.uniform(8.0, 60.0)),
        hood=not dry and rng.uniform() < 0.55,
        mask=not dry,
        snorkel=not dry and not regulator and rng.uniform() < 0.7,
        regulator=regulator,
        distance_mm=float(rng.uniform(950.0, 1500.0 + 700.0 * difficulty)),
        height_mm=float(rng.normal(-60.0, 50.0)),
        looseness=float(rng.uniform(0.2, 0.5 + 0.8 * difficulty)),
        wrist_mm=(float(reach[0]), float(reach[1]), float(reach[2])),
    )


def _camera(rng: np.random.Generator, difficulty: float) -> CameraSpec:
    return CameraSpec(
        focal=float(rng.uniform(0.75, 1.1)),
        noise=float(rng.uniform(0.3, 1.0 + 4.0 * difficulty)),
        blur_px=float(rng.uniform(0.3, 0.8 + 0.8 * difficulty)),
        motion_px=float(rng.uniform(0.0, 4.0)) * difficulty,
        exposure=float(rng.uniform(0.14, 0.32)),
        balance=float(rng.uniform(0.0, 0.7)),
        jpeg=int(rng.integers(35, 95)) if rng.uniform() < 0.5 else 0,
        drift=float(rng.uniform(0.0, 0.05)),
    )
