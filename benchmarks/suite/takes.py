"""The clips of the suite, as what can be rendered: those of the synthetic diver and those of real hands."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import lightgesture.synth
from lightgesture.benchmarks.suite.cache import Take, source_digest
from lightgesture.benchmarks.suite.real import real_takes
from lightgesture.benchmarks.suite.scenarios import REAL, SUITE_SEEDS, Scenario, scenarios, scene_spec
from lightgesture.synth.scene import Scene, SceneFrame

QUICK_STEP = 5
"""A quick run takes every fifth clip."""


@dataclass(frozen=True, slots=True)
class SyntheticTake:
    """A scenario of the synthetic diver; the fields are those of `cache.Take`."""

    scenario: Scenario
    fps: float
    size: tuple[int, int]
    recipe: str

    def frames(self) -> Iterator[SceneFrame]:
        """Pictures with their truth."""
        return Scene(scene_spec(self.scenario)).frames()


NO_DIVER = ("command.py", "crops.py", "showcase.py")
"""Modules of the renderer that draw single hands and contact sheets, and nothing of a dive."""


def drawing_digest(*others: Path) -> str:
    """Digest of the code that draws the synthetic diver, and of other source files."""
    package = Path(lightgesture.synth.__file__).parent
    return source_digest([*(path for path in package.rglob("*.py") if path.name not in NO_DIVER), *others])


def takes_of(suite: str, data: Path | None) -> list[Take]:
    """The clips of one of SUITES; none of real hands without a data folder that holds them."""
    if suite != REAL:
        return synthetic_takes(suite)
    return [] if data is None else real_takes(data)


def synthetic_takes(suite: str) -> list[Take]:
    """The clips of a suite that the synthetic diver plays."""
    digest = drawing_digest()
    takes: list[Take] = []
    for scenario in scenarios(suite):
        spec = scene_spec(scenario)
        takes.append(SyntheticTake(scenario, spec.fps, spec.size, f"{digest} {spec.model_dump_json()}"))
    return takes


def choose_takes(takes: Sequence[Take], only: Sequence[str], is_quick: bool) -> list[Take]:
    """The takes whose suite or clip is named in `only` (all if empty); of these every fifth of a suite if quick."""
    named = [take for take in takes if not only or take.scenario.suite in only or take.scenario.name in only]
    return [
        take for take in named if not is_quick or (take.scenario.seed - SUITE_SEEDS.start) % QUICK_STEP == 0
    ]
