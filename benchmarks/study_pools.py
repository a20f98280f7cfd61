"""Pools of patches without one alteration each: what `reading_study augmentation` compares."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from lightgesture.training.pool.patch_kinds import PoolSettings

Change = Callable[[PoolSettings], PoolSettings]
EVERYTHING, NOTHING = "everything", "nothing"

WITHOUT: Mapping[str, tuple[Mapping[str, float], Mapping[str, float]]] = {
    "no mirror": ({"mirror": 0.0}, {}),
    "no rotation": ({"rotation": 0.0}, {}),
    "no stretch, no shear": ({"stretch": 0.0, "shear": 0.0}, {}),
    "no other background": ({"background": 0.0}, {}),
    "no error of the box": ({"shift": 0.0, "scale": 0.0}, {}),
    "no tone": ({}, {"gamma": 0.0, "contrast": 0.0, "gain": 0.0, "gradient": 0.0}),
    "no darkness": ({}, {"dark": 0.0, "backlit": 0.0}),
    "no water": ({}, {"water": 0.0}),
    "no blur, no noise": ({}, {"blur": 0.0, "noise": 0.0}),
}
"""Fields of `AugmentSettings` and of `LightSettings` that are set to zero, by the name of the row."""


def changed(pool: PoolSettings, copy: Mapping[str, float], light: Mapping[str, float]) -> PoolSettings:
    """The same pool with other fields of its copies and of their light."""
    changes: dict[str, Any] = {**copy, "light": replace(pool.augment.light, **light)}
    return replace(pool, augment=replace(pool.augment, **changes))


def without_rendered(pool: PoolSettings) -> PoolSettings:
    """The same pool of pictures alone."""
    return replace(pool, rendered=0)


def without_mild(pool: PoolSettings) -> PoolSettings:
    """The same pool without the copies that are hardly altered."""
    return replace(pool, mild_share=0.0)


def with_nothing(pool: PoolSettings) -> PoolSettings:
    """Copies as the pictures are, and no rendered hands."""
    for copy, light in WITHOUT.values():
        pool = changed(pool, copy, light)
    return without_mild(without_rendered(pool))


def _leaving_out(name: str) -> Change:
    return lambda pool: changed(pool, *WITHOUT[name])


POOLS: Mapping[str, Change] = {
    EVERYTHING: lambda pool: pool,
    **{name: _leaving_out(name) for name in WITHOUT},
    "no mild copies": without_mild,
    "no rendered hands": without_rendered,
    NOTHING: with_nothing,
}
"""What becomes of a pool's settings, by the name of the row."""
