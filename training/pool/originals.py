"""What copies are made of, and how many of each kind are drawn."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from lightgesture.models import CLASSES, NONE
from lightgesture.training.pictures.augment import AugmentSettings
from lightgesture.training.pictures.light import LightSettings
from lightgesture.training.pool.divers import Divers, read_divers
from lightgesture.training.pool.joints import Poses, fit_poses
from lightgesture.training.pool.negatives import Scene, read_backgrounds, read_scenes
from lightgesture.training.pool.samples import HandRow, LabelledHand, load_hand


@dataclass(frozen=True, slots=True)
class PoolSettings:
    """How much is drawn and how."""

    copies: int = 16
    """Altered copies of each hand, 1 to 100; time and disk grow with them."""
    mild_share: float = 1 / 3
    """Copies of each hand besides that are hardly altered, over `copies`, 0 to 1; none read plain pictures worse."""
    sea_share: float = 1 / 2
    """Copies of each hand besides that look as on real dives, over `copies`, 0 to 1; drawn where divers are given."""
    shown_copies: int = 80
    """Copies of each sign that a real diver shows."""
    resting_copies: int = 8
    """Copies of each hand of a real diver that shows none."""
    rounds: int = 8
    """How often regions that are no hand are drawn from each picture, 1 to 100."""
    rendered: int = 12000
    """Rendered hands beside the real ones, of the signs that both know."""
    posed: int = 0
    """Rendered hands in the poses of real ones whose joints are known, seen from up to 75 degrees, 0 for none; 20,000
    were tried (docs/models.md)."""
    augment: AugmentSettings = field(
        default_factory=lambda: AugmentSettings(
            rotation=18.0,
            scale=0.11,
            shift=0.06,
            narrowed=0.2,
            background=0.6,
            light=LightSettings(grey=0.25, noise=4.0),
        )
    )
    """How far copies go; mild copies go as far as `augment.MILD`."""

    @property
    def mild_copies(self) -> int:
        """Of each hand."""
        return round(self.mild_share * self.copies)

    @property
    def sea_copies(self) -> int:
        """Of each hand, where divers are given."""
        return round(self.sea_share * self.copies)


@dataclass(frozen=True, slots=True, eq=False)
class Originals:
    """What copies are made of. hands: labelled. backgrounds: pictures without hands. scenes: whole pictures.
    divers: real ones. poses: of those hands whose joints are known."""

    hands: Sequence[LabelledHand]
    backgrounds: Sequence[Scene] = ()
    scenes: Sequence[Scene] = ()
    divers: Divers = field(default_factory=Divers)
    poses: Poses = field(default_factory=Poses)

    @property
    def rendered_classes(self) -> frozenset[str]:
        """Classes of which rendered hands can be had, all where there are no hands.

        Beside own signs there is no rendered `none`: shapes that the ten tokens lack may be just these signs.
        """
        found = {hand.token for hand in self.hands}
        known = found & set(CLASSES) if found else set(CLASSES)
        return frozenset(known - {NONE} if found - known else known)


def read_originals(
    rows: Sequence[HandRow],
    backgrounds: Sequence[Path],
    scenes: Path | None,
    divers: Path | None = None,
    without: Collection[str] = (),
) -> Originals:
    """All pictures that a classifier is trained on, read once.

    backgrounds: folders of pictures without hands. scenes: table of whole pictures with boxes of hands and faces.
    divers: table of real divers. without: dives of it that are left out. Raises InputError.
    """
    return Originals(
        [load_hand(row) for row in rows],
        [scene for folder in backgrounds for scene in read_backgrounds(folder)],
        read_scenes(scenes) if scenes else (),
        read_divers(divers, {row.token for row in rows}, without) if divers else Divers(),
        fit_poses([row.joints for row in rows], [row.token for row in rows]),
    )
