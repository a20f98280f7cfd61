"""The nets of the learned choice: the locator, then refiner and verifier, which learn from what it mistakes."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, Self

from lightgesture.errors import UsageError
from lightgesture.features.archive import read_archive
from lightgesture.features.find.selector_file import LOCATOR, REFINER, VERIFIER, load_nets
from lightgesture.features.net.file import network_from
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.models import load_classifier
from lightgesture.models.cnn import CnnClassifier
from lightgesture.models.loading import SHIPPED
from lightgesture.training.model_files import write_networks
from lightgesture.training.nets.checkpoints import sha256_of
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.real_divers import RealDivers
from lightgesture.training.regions.region_pictures import Material

if TYPE_CHECKING:
    from lightgesture.training.nets.net_training import Precision
    from lightgesture.training.nets.window_samples import SampleSettings, WindowSamples

Progress = Callable[[str], None]

NETS: Final = "nets.npz"
"""Locator and refiner in the folder of a training."""
VERIFIED: Final = "verifier.npz"
"""The verifier there."""


@dataclass(frozen=True, slots=True)
class RegionTraining:
    """How long the nets of the selector are trained."""

    locator_steps: int = 10000
    """Steps of the optimiser, 1 or more."""
    refiner_steps: int = 8000
    """Likewise."""
    verifier_steps: int = 5000
    """Likewise."""
    precision: "Precision" = "float32"
    """In which nets are reckoned while they learn, see `net_training.PRECISIONS`."""
    start: Path | None = None
    """Selector whose nets go on learning; None to begin with random weights."""
    reader: str = "cnn"
    """Model whose first larger net the verifier learns on from: a file, or the name of a bundled one."""

    def of_steps(self, steps: int) -> Self:
        """The same, so many steps of the locator, 2 or more, four fifths as many of the refiner, and half as many of
        the verifier."""
        return replace(
            self, locator_steps=steps, refiner_steps=max(1, steps * 4 // 5), verifier_steps=max(1, steps // 2)
        )

    def start_digest(self) -> str | None:
        """SHA-256 of the file of `start`, which is read here, before hours of work. Raises SelectorError."""
        if self.start is None:
            return None
        load_nets(self.start)
        return sha256_of(self.start)

    def reader_digest(self) -> str:
        """SHA-256 of the reader's file, which is read here, too. Raises ModelError, UsageError."""
        larger_net(self.reader)
        return sha256_of(SHIPPED.get(self.reader, Path(self.reader)))


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
    from lightgesture.training.nets.window_samples import REFINER as REFINER_SAMPLES

    divers = _divers(material)
    first, second = (None, None) if settings.start is None else load_nets(settings.start)
    steps, precision = settings.locator_steps, settings.precision
    samples = LocatorSamples(material.frames, material.empty, composed, divers)
    locator = train_locator(samples, steps, precision, first, seed, folder / "locator.pt", progress)
    windows = window_samples(material, composed, locator, REFINER_SAMPLES, progress)
    steps = settings.refiner_steps
    refiner = train_refiner(windows, steps, precision, second, seed, folder / "refiner.pt", progress)
    write_networks({LOCATOR: locator, REFINER: refiner}, done)
    return locator, refiner


def learn_verifier(
    material: Material,
    composed: list[BoxedPicture],
    locator: IntegerNetwork,
    folder: Path,
    seed: int,
    settings: RegionTraining,
    progress: Progress,
) -> IntegerNetwork:
    """The verifier, learnt from the same pictures and from what the locator mistakes in them. It lies in `folder` when
    it is done, and is not trained again."""
    done = folder / VERIFIED
    if done.is_file():
        _, arrays = read_archive(done)
        return network_from(arrays, VERIFIER)
    from lightgesture.training.nets.verifier import train_verifier
    from lightgesture.training.nets.window_samples import VERIFIER as VERIFIER_SAMPLES

    reader = larger_net(settings.reader)
    windows = window_samples(material, composed, locator, VERIFIER_SAMPLES, progress)
    steps, precision = settings.verifier_steps, settings.precision
    verifier = train_verifier(windows, steps, precision, reader, seed, folder / "verifier.pt", progress)
    write_networks({VERIFIER: verifier}, done)
    return verifier


def larger_net(model: str) -> IntegerNetwork:
    """The first larger net of a reader. Raises ModelError, UsageError."""
    reader = load_classifier(model)
    second = reader.model.second if isinstance(reader, CnnClassifier) else None
    if second is None:
        raise UsageError(f"{model}: has no larger net to learn on from; name one of train look by --reader")
    return second.nets[0].network


def window_samples(
    material: Material,
    composed: list[BoxedPicture],
    locator: IntegerNetwork,
    settings: "SampleSettings",
    progress: Progress,
) -> "WindowSamples":
    """Windows of all pictures, those of the locator's mistakes among them."""
    from lightgesture.training.nets.window_samples import WindowSamples, hard_regions

    progress("searching for what the locator mistakes")
    divers = _divers(material)
    frames, empty, hard = (
        hard_regions(part, locator) for part in (material.frames, material.empty, composed)
    )
    mistaken = [boxes for _, boxes in hard_regions(divers.pictures, locator)] if divers else []
    return WindowSamples(frames, empty, hard, divers, mistaken, settings)


def _divers(material: Material) -> RealDivers | None:
    return RealDivers(material.divers, material.hands) if material.divers else None
