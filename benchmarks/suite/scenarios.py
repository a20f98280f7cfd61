"""What the scenario suite shows: the sentences of the paper's table in their difficulties, and dives without any.

Islam, Ho and Sattar (ICRA 2018) tested 30 instructions of 162 gestures under water and 20 of 132 on land, one pair
of hands being one gesture, and name what failed: reflections in the surface, bubbles, a hand before the face or
partly out of view. The sentences here have these numbers; every form of the language, every direction and every
digit that hands can show occurs.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from lightgesture.synth.spec import SceneSpec
from lightgesture.synth.variety import GLOVES, Place, draw_spec, stream

SUITE_SEEDS = range(7_000_000, 7_001_000)
"""Seeds of every scene of the suite. Training must draw from others: neither these seeds nor the purpose "suite"."""

WATER, LAND, REAL, NEGATIVE = "water", "land", "real", "negative"
SUITES = (WATER, LAND, REAL, NEGATIVE)
ALONE, PROFILE = "alone", "profile"
"""Short clips of one difficulty each, and what a colour profile is learnt from (see `difficulties`)."""
FIRST_SEED = {
    WATER: 7_000_000,
    LAND: 7_000_100,
    REAL: 7_000_200,
    NEGATIVE: 7_000_300,
    ALONE: 7_000_500,
    PROFILE: 7_000_500,
}

SIZE = (480, 360)
FPS = 30.0
HOLD_FRAMES = (21, 31)
"""Shortest and longest hold of a sign: people hold it for the 15 frames of the dwell and a little longer."""
EDGE_MM = 46.0
"""From the wrist to the picture's edge where hands are partly out of view: up to a third of a hand, as it drifts."""
CALM = 0.35
"""Difficulty of everything but what a scenario is named after, as `draw_spec` takes it."""

WATER_LIST: tuple[tuple[str, str], ...] = (
    ("STOP HOVER 50 GO", "clear"),
    ("STOP EXEC 1 GO", "clear"),
    ("CONTD SNAP 20 GO", "clear"),
    ("CONTD PARAM 3 DECREASE GO", "clear"),
    ("STOP FOLLOW 120 GO", "reflection"),
    ("STOP LEFT 15 GO", "reflection"),
    ("CONTD PARAM 1 INCREASE GO", "reflection"),
    ("STOP UP GO", "reflection"),
    ("STOP DOWN 30 GO", "bubbles"),
    ("CONTD SNAP GO", "bubbles"),
    ("STOP RIGHT 45 GO", "bubbles"),
    ("STOP EXEC 2 GO", "bubbles"),
    ("STOP HOVER 305 GO", "face"),
    ("STOP FOLLOW 25 GO", "face"),
    ("CONTD PARAM 5 DEFAULT GO", "face"),
    ("STOP RIGHT GO", "face"),
    ("STOP UP 12 GO", "out of view"),
    ("CONTD SNAP 40 GO", "out of view"),
    ("STOP LEFT 3 GO", "out of view"),
    ("STOP DOWN 240 GO", "turbid"),
    ("STOP HOVER 35 GO", "turbid"),
    ("STOP EXEC 3 GO", "turbid"),
    ("CONTD SNAP 510 GO", "cast"),
    ("STOP FOLLOW 54 GO", "cast"),
    ("CONTD PARAM 0 INCREASE GO", "cast"),
    ("STOP HOVER 21 GO", "far"),
    ("STOP DOWN GO", "far"),
    ("STOP RIGHT 32 GO", "bare arms"),
    ("STOP LEFT 103 GO", "bare arms"),
    ("STOP UP 14 GO", "gloves"),
)
LAND_LIST: tuple[tuple[str, str], ...] = (
    ("STOP HOVER 120 GO", "clear"),
    ("CONTD SNAP 30 GO", "clear"),
    ("STOP EXEC 0 GO", "clear"),
    ("CONTD PARAM 2 DECREASE GO", "clear"),
    ("STOP FOLLOW 245 GO", "clear"),
    ("STOP LEFT 315 GO", "back light"),
    ("STOP RIGHT 20 GO", "back light"),
    ("CONTD SNAP 150 GO", "back light"),
    ("STOP UP 403 GO", "back light"),
    ("STOP DOWN 52 GO", "skin colours"),
    ("STOP HOVER 134 GO", "skin colours"),
    ("STOP EXEC 4 GO", "skin colours"),
    ("CONTD SNAP 500 GO", "face"),
    ("STOP FOLLOW 41 GO", "face"),
    ("STOP RIGHT 222 GO", "face"),
    ("STOP UP 35 GO", "out of view"),
    ("STOP LEFT 510 GO", "out of view"),
    ("CONTD PARAM 4 DEFAULT GO", "far"),
    ("STOP DOWN 450 GO", "bare arms"),
    ("CONTD SNAP 13 GO", "bare arms"),
)
NEGATIVE_LIST: tuple[tuple[str, str, str], ...] = (
    ("~swim ~point ~swim ~rest ~wave", "swimming", "water"),
    ("~mask ~rest ~mask ~swim", "mask", "water"),
    ("~point ~rest ~point ~wave ~point", "pointing", "water"),
    ("~wave ~mask ~wave ~rest ~wave", "waving", "water"),
    ("~grip ~fold ~swim ~grip", "holding on", "water"),
    ("~swim ~mask ~wave ~point ~fold", "all", "water"),
    ("~wave ~swim ~grip ~rest ~mask", "all", "water"),
    ("~fold ~point ~swim ~wave ~rest", "all", "water"),
    ("~wave ~point ~fold ~rest ~wave", "waving", "room"),
    ("~point ~mask ~grip ~point", "pointing", "room"),
    ("~fold ~swim ~wave ~mask ~rest", "all", "room"),
    ("~rest ~wave ~grip ~point ~swim", "all", "room"),
)
"""Activities, what stands out among them, and where: what no robot may take for an instruction."""


@dataclass(frozen=True, slots=True)
class Scenario:
    """One clip. sentences: what is signed, or activities (~wave). difficulty: what makes it hard. place: "water" or
    "room". seed: one of SUITE_SEEDS.
    """

    suite: str
    sentences: tuple[str, ...]
    difficulty: str
    place: Place
    seed: int

    @property
    def name(self) -> str:
        """Name of the clip, e.g. "water-03"."""
        return f"{self.suite}-{self.seed - FIRST_SEED[self.suite] + 1:02d}"


def scenarios(suite: str) -> tuple[Scenario, ...]:
    """The clips of one of SUITES, in order; REAL signs the sentences of WATER."""
    first = FIRST_SEED[suite]
    if suite == NEGATIVE:
        return tuple(
            Scenario(
                suite, tuple(activities.split()), difficulty, "room" if place == "room" else "water", seed
            )
            for seed, (activities, difficulty, place) in enumerate(NEGATIVE_LIST, first)
        )
    place: Place = "room" if suite == LAND else "water"
    listed = LAND_LIST if suite == LAND else WATER_LIST
    if suite == REAL:
        listed = tuple((sentence, "real hands") for sentence, _ in WATER_LIST)
    return tuple(
        Scenario(suite, (sentence,), difficulty, place, seed)
        for seed, (sentence, difficulty) in enumerate(listed, first)
    )


def scene_spec(scenario: Scenario) -> SceneSpec:
    """The scene of a scenario: drawn from its seed, rid of other difficulties, then given its own."""
    spec = draw_spec(scenario.seed, "suite", scenario.place, scenario.sentences, CALM)
    parts: dict[str, Any] = spec.model_dump()
    parts |= {"size": SIZE, "fps": FPS, "hold": HOLD_FRAMES}
    parts["diver"] |= {
        "glove": None,
        "distance_mm": float(np.clip(parts["diver"]["distance_mm"], 1050.0, 1500.0)),
    }
    parts["camera"] |= {"focal": min(parts["camera"]["focal"], 0.9)}
    parts["backdrop"] |= {"surface_m": 0.0, "bubbles": 0.0}
    parts["room"] |= {"window": 0.0, "level": max(parts["room"]["level"], 0.5)}
    parts["motion"] |= {"approach_mm": float(np.clip(parts["motion"]["approach_mm"], -150.0, 150.0))}
    rng = stream(scenario.seed + SUITE_SEEDS.stop, "suite")
    for part, values in _difficulty(scenario.difficulty, parts, rng).items():
        parts[part] |= values
    return SceneSpec.model_validate(parts)


def _difficulty(name: str, parts: dict[str, Any], rng: np.random.Generator) -> dict[str, dict[str, Any]]:
    """What a difficulty changes, by part of the spec; nothing for one that is only a heading."""
    near = float(rng.uniform(950.0, 1150.0))
    focal = float(rng.uniform(0.8, 0.95))
    # The hands are 220 mm nearer than the body.
    edge = (near - 220.0) / (2.0 * focal) - EDGE_MM
    waterline_m = parts["diver"]["distance_mm"] / 1000.0 * float(rng.uniform(0.2, 0.3))
    changes: dict[str, dict[str, dict[str, Any]]] = {
        "clear": {},
        "reflection": {"backdrop": {"surface_m": waterline_m}},
        "bubbles": {"backdrop": {"bubbles": float(rng.uniform(25.0, 45.0))}, "diver": {"regulator": True}},
        "face": {"diver": {"wrist_mm": (float(rng.uniform(75.0, 110.0)), float(rng.uniform(60.0, 110.0)), 250.0)}},
        "out of view": {
            "diver": {"wrist_mm": (edge, 60.0, 220.0), "distance_mm": near},
            "camera": {"focal": focal},
            "motion": {"drift": 0.3, "approach_mm": 0.0},
        },
        "turbid": {"water": {"turbidity": float(rng.uniform(0.8, 1.2))}},
        "cast": {"water": {"kind": str(rng.choice(("III", "5C", "7C"))), "depth_m": float(rng.uniform(5.0, 8.0))},
                 "camera": {"balance": 0.0}},
        "far": {"diver": {"distance_mm": float(rng.uniform(2000.0, 2400.0))}, "camera": {"focal": 0.85}},
        "bare arms": {"diver": {"sleeve_mm": None}},
        "gloves": {"diver": {"glove": GLOVES[int(rng.integers(1, len(GLOVES)))]}},
        "back light": {"room": {"window": float(rng.uniform(2.0, 3.5)), "level": float(rng.uniform(0.15, 0.3))}},
        "skin colours": {"room": {"wall": int(rng.choice((1, 2, 5))), "pieces": 18}},
    }  # fmt: skip
    return changes.get(name, {})
