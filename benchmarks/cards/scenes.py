"""The paper's sentences shown with cards, or with two cards that are moved, in the difficulties of the suite.

The divers, waters, rooms and cameras are those of `suite.scenarios`; what is a matter of hands there (a hand before the
face, hands partly out of view) is the same of a card here: before the face, and at the picture's edge.
"""

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from lightgesture.benchmarks.suite.scenarios import LAND, WATER, Scenario, scenarios, scene_spec
from lightgesture.benchmarks.suite.takes import drawing_digest
from lightgesture.fsm import load_grammar
from lightgesture.results.atomic import replacing_folder
from lightgesture.synth.card_motion import APART_MM
from lightgesture.synth.cards import CARD_MM
from lightgesture.synth.output import write_scene
from lightgesture.synth.scene import Scene
from lightgesture.synth.spec import CardSpec, SceneSpec

Signing = Literal["tags", "tag-motion"]
SIGNINGS: Final[tuple[Signing, ...]] = ("tags", "tag-motion")
SUITES: Final = (WATER, LAND)

SIZE: Final[dict[Signing, tuple[int, int]]] = {"tags": (640, 480), "tag-motion": (480, 360)}
"""Of the pictures, pixels, at which a card of 80 mm at 1.3 m is about 40 pixels wide, and 30 where it is moved."""

TIMING: Final[dict[Signing, dict[str, Any]]] = {
    # A card is shown for 0.7 to 0.9 s.
    "tags": {"fps": 10.0, "hold": (7, 9), "passage": (2, 3), "pause": (2, 3)},
    # A motion takes 1.1 to 1.6 s.
    "tag-motion": {"fps": 12.0, "hold": (13, 19), "passage": (4, 5), "pause": (4, 5)},
}
"""Frames a second, and frames of each phase: few, because rendering costs more than reading."""

TILTED_DEG: Final = 60.0
"""Most that a card is turned away in clips without another difficulty."""

HEIGHT: Final = 190.0
"""Above the shoulders, where a card hides the face, mm."""

DRIFT_MM: Final = 50.0
"""What divers drift: so near the edge of the picture a card is held that should still be seen."""

REACH: Final = 2.3
"""How far a motion goes from where it begins, in `CardSpec.motion_mm`: twice, and what people stretch it."""

HOLD: Final = 15
"""Frames, of no effect for cards."""


def card_spec(scenario: Scenario, signing: Signing) -> SceneSpec:
    """The scene of a scenario with cards."""
    parts: dict[str, Any] = scene_spec(scenario).model_dump()
    parts |= {"size": SIZE[signing], "signing": signing, **TIMING[signing]}
    cards: dict[str, Any] = {}
    if scenario.difficulty == "clear":
        cards["tilt_deg"] = TILTED_DEG
    elif scenario.difficulty == "face":
        cards["shown_mm"] = (0.0, HEIGHT, 320.0)
    elif scenario.difficulty == "out of view":
        # The sheet all but ends where the picture does. One hand holds it 110 mm to its own side.
        near = parts["diver"]["distance_mm"] - 300.0
        edge = near / (2.0 * parts["camera"]["focal"]) - 0.5 * CARD_MM[0] - 110.0 - DRIFT_MM
        cards |= {"hands": "left", "shown_mm": (float(np.clip(edge, 0.0, 260.0)), 60.0, 300.0)}
    parts["cards"] |= cards
    if signing == "tag-motion":
        height = cards.get("shown_mm", CardSpec().shown_mm)[1]
        parts["cards"] |= {"shown_mm": (0.0, height, CardSpec().shown_mm[2])}
        room = DRIFT_MM if scenario.difficulty == "out of view" else 2.0 * DRIFT_MM
        nearest = distance_for_motions(parts, room) + max(parts["motion"]["approach_mm"], 0.0)
        parts["diver"]["distance_mm"] = max(parts["diver"]["distance_mm"], nearest)
    return SceneSpec.model_validate(parts)


def distance_for_motions(parts: dict[str, Any], room: float) -> float:
    """From where on two cards are in the picture all the time, `room` from its edges, mm: a motion that leaves it is
    refused, and a diver who sees that goes back a little. parts: of a SceneSpec, of motions."""
    cards = CardSpec.model_validate(parts["cards"])
    reach = REACH * cards.motion_mm + 0.5 * cards.side_mm + room
    columns, rows = parts["size"]
    level = abs(parts["diver"]["height_mm"] + cards.shown_mm[1])
    half = max(APART_MM + reach, (level + reach) * columns / rows)
    return float(2.0 * parts["camera"]["focal"] * half + cards.shown_mm[2])


@dataclass(frozen=True, slots=True)
class CardTake:
    """A clip: what is said, how, and the scene."""

    scenario: Scenario
    signing: Signing
    spec: SceneSpec


def takes_of(signing: Signing, suite: str) -> list[CardTake]:
    """The clips of a suite."""
    return [CardTake(scenario, signing, card_spec(scenario, signing)) for scenario in scenarios(suite)]


def clip_of(take: CardTake, folder: Path) -> Path:
    """The video of a take, from `folder`, or rendered now, beside its truth (`.jsonl`)."""
    language = Path(load_grammar().file).read_text(encoding="utf-8")
    recipe = (
        f"{drawing_digest()} {language if take.signing == 'tag-motion' else ''} {take.spec.model_dump_json()}"
    )
    place = folder / f"{take.signing}-{take.scenario.name}-{hashlib.sha256(recipe.encode()).hexdigest()[:16]}"
    if not place.is_dir():
        with replacing_folder(place) as building:
            write_scene(Scene(take.spec), building, "clip", HOLD)
    return place / "clip.mp4"
