"""The nets of the learned choice: the locator, then the refiner, which learns from what the locator mistakes."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, Self

from lightgesture.features.archive import read_archive
from lightgesture.features.find.selector_file import LOCATOR, REFINER, SelectorError, load_nets
from lightgesture.features.net.file import network_from
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.training.model_files import write_networks
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.real_divers import RealDivers
from lightgesture.training.regions.region_pictures import Material

if TYPE_CHECKING:
    from lightgesture.training.nets.net_training import Precision

Progress = Callable[[str], None]

NETS: Final = "nets.npz"
"""Both nets in the folder of a training."""


@dataclass(frozen=True, slots=True)
class RegionTraining:
    """How long the nets of the selector are trained."""

    locator_steps: int = 10000
    """Steps of the optimiser, 1 or more."""
    refiner_steps: int = 8000
    """Likewise."""
    precision: "Precision" = "float32"
    """In which nets are reckoned while they learn, see `net_training.PRECISIONS`."""
    start: Path | None = None
    """Selector whose nets go on learning; None to begin with random weights."""

    def of_steps(self, steps: int) -> Self:
        """The same, so many steps of the locator, 2 or more, and four fifths as many of the refiner."""
        return replace(self, locator_steps=steps, refiner_steps=max(1, steps * 4 // 5))

    @property
    def origin(self) -> str | None:
        """SHA-256 of that file. Raises SelectorError."""
        if self.start is None:
            return None
        try:
            return hashlib.sha256(self.start.read_bytes()).hexdigest()
        except OSError as error:
            raise SelectorError(f"{self.start}: cannot be read ({error.strerror})") from error


def learn_nets(
    material: Material,
    composed: list[BoxedPicture],
    folder: Path,
    seed: int,
    settings: RegionTraining,
    progress: Progress,
) -> tuple[IntegerNetwork, IntegerNetwork]:
    """Locator and refiner, learnt from the material and from composed pictures. What is done lies in `folder`: where
    both are, they are not trained again."""
    done = folder / NETS
    if done.is_file():
        _, arrays = read_archive(done)
        return network_from(arrays, LOCATOR), network_from(arrays, REFINER)
    from lightgesture.training.nets.locator import train_locator
    from lightgesture.training.nets.locator_samples import LocatorSamples
    from lightgesture.training.nets.refiner import train_refiner
    from lightgesture.training.nets.refiner_samples import RefinerSamples, hard_regions

    divers = RealDivers(material.divers, material.hands) if material.divers else None
    first, second = (None, None) if settings.start is None else load_nets(settings.start)
    steps, precision = settings.locator_steps, settings.precision
    samples = LocatorSamples(material.frames, material.empty, composed, divers)
    locator = train_locator(samples, steps, precision, first, seed, folder / "locator.pt", progress)
    progress("searching for what the locator mistakes")
    frames, empty, hard = (
        hard_regions(part, locator) for part in (material.frames, material.empty, composed)
    )
    mistaken = [boxes for _, boxes in hard_regions(divers.pictures, locator)] if divers else []
    windows = RefinerSamples(frames, empty, hard, divers, mistaken)
    steps = settings.refiner_steps
    refiner = train_refiner(windows, steps, precision, second, seed, folder / "refiner.pt", progress)
    write_networks({LOCATOR: locator, REFINER: refiner}, done)
    return locator, refiner
