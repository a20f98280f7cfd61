"""What real divers add to a pool: their hands, and copies of dry ones that look as theirs do."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from lightgesture.features.types import Float, Image
from lightgesture.training.pictures.augment import CANVAS, REACH, AugmentSettings
from lightgesture.training.pictures.light import LightSettings, relight
from lightgesture.training.pictures.sea import SeaLook, submerge
from lightgesture.training.pool.altered import altered
from lightgesture.training.pool.divers import Divers
from lightgesture.training.pool.originals import Originals, PoolSettings
from lightgesture.training.samples import TrainingSample

Random = np.random.Generator

REAL_LIGHT: Final = LightSettings(
    gamma=0.2,
    contrast=0.25,
    gain=0.1,
    gradient=0.35,
    dark=0.1,
    backlit=0.0,
    water=0.0,
    blur=0.15,
    widest_blur=0.7,
    noise=3.0,
)
"""Of copies of real divers' hands, which are under water already."""
REAL: Final = AugmentSettings(
    rotation=14.0, stretch=0.12, narrowed=0.1, background=0.0, shift=0.06, scale=0.11, light=REAL_LIGHT
)
"""How far these copies go: turned, mirrored, scaled, but before what stood behind them."""
BEFORE_SUBMERGING: Final = LightSettings(gradient=0.5, dark=0.0, backlit=0.2, water=0.0, blur=0.0, noise=0.0)
"""Light on a dry hand before it looks as on a dive."""
BACKGROUND: Final = 0.8
"""Share of such copies before another background, which is more often a dark suit than a room."""
TURN: Final = 20.0
"""Standard deviation of their turn, degrees: divers hold signs more askew than people before a webcam."""
LYING: Final = 0.2
"""Share of them that lie on their side, as a fifth of real divers' signs do."""
SIGN_LOOK: Final = 0.7
"""Share of copies that take the look of a sign, which is larger and clearer than that of a hand at rest."""
LEAST_SPREAD: Final = 7.0
"""Deviation of green in a look, grey levels, below which a hand hardly shows."""


@dataclass(frozen=True, slots=True, eq=False)
class DiveLooks:
    """Looks of hands on real dives. faint: of hands at rest. clear: of signs."""

    faint: Sequence[SeaLook]
    clear: Sequence[SeaLook]

    @staticmethod
    def of(divers: Divers) -> "DiveLooks":
        """Those that show a hand at all."""
        faint, clear = (
            [look for look in looks if look.deviation[1] >= LEAST_SPREAD]
            for looks in (divers.looks, divers.sign_looks)
        )
        return DiveLooks(faint, clear)

    def give(self, image: Image, mask: Float | None, side: float, random: Random) -> Image:
        """A dry hand in one of the looks, which must be there; see `sea.submerge`."""
        lit = relight(image, mask, BEFORE_SUBMERGING, random)
        of_sign = self.clear and (not self.faint or random.random() < SIGN_LOOK)
        return submerge(lit, mask, side, self.clear if of_sign else self.faint, random)

    def __len__(self) -> int:
        return len(self.faint) + len(self.clear)


def sea(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    """A copy of each hand as a real dive would show it."""
    looks = DiveLooks.of(originals.divers)

    def finish(image: Image, mask: Float | None, random: Random) -> Image:
        return looks.give(image, mask, CANVAS / REACH, random)

    how = replace(settings.augment, rotation=TURN, background=BACKGROUND, lying=LYING)
    yield from altered(originals, originals.hands[first:last], how, random, finish)


def shown(
    originals: Originals, _settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    """A copy of each sign that a real diver shows."""
    yield from altered(originals, originals.divers.shown[first:last], REAL, random)


def resting(
    originals: Originals, _settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    """A copy of each hand of a real diver that shows none."""
    yield from altered(originals, originals.divers.resting[first:last], REAL, random)
