"""Clips that the synthetic diver plays, as what can be rendered."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import lightgesture.synth
from lightgesture.benchmarks.suite_cache import source_digest
from lightgesture.benchmarks.suite_scenarios import Scenario, scene_spec
from lightgesture.synth.scene import Scene, SceneFrame


@dataclass(frozen=True, slots=True)
class SyntheticTake:
    """A scenario of the synthetic diver; the fields are those of `suite_cache.Take`."""

    scenario: Scenario
    fps: float
    size: tuple[int, int]
    recipe: str

    def frames(self) -> Iterator[SceneFrame]:
        """Pictures with their truth."""
        return Scene(scene_spec(self.scenario)).frames()


NO_DIVER = ("command.py", "crops.py", "sheet.py")
"""Modules of the renderer that draw single hands and contact sheets, and nothing of a dive."""


def drawing_digest(*others: Path) -> str:
    """Digest of the code that draws the synthetic diver, and of other source files."""
    package = Path(lightgesture.synth.__file__).parent
    return source_digest([*(path for path in package.glob("*.py") if path.name not in NO_DIVER), *others])
