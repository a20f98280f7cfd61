"""Missions of the simulated vehicle: items as MAVLink has them, and how they are gone through."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

WAYPOINT, LOITER_UNLIM, DELAY = 16, 17, 93
SET_SPEED, TAKE_PICTURES, JUMP = 178, 2000, 177
"""Commands that the vehicle knows, by their numbers in MAVLink."""

ORIGIN: Final = (44.9740, -93.2277)
"""Where the pool is: latitude and longitude of the start, degrees."""
METRES_A_DEGREE: Final = 111_319.5
"""Of latitude."""
REACHED_M: Final = 0.3
"""A place counts as reached from this distance."""


@dataclass(frozen=True, slots=True)
class Item:
    """One item: command with its parameters; latitude and longitude (degrees) and altitude (m, up)."""

    command: int
    params: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    latitude: float = 0.0
    longitude: float = 0.0
    altitude_m: float = 0.0

    @property
    def place(self) -> tuple[float, float, float]:
        """North, east, down, metres."""
        north, east = to_metres(self.latitude, self.longitude)
        return north, east, -self.altitude_m


def to_metres(latitude: float, longitude: float) -> tuple[float, float]:
    """North and east of the start, metres."""
    north = (latitude - ORIGIN[0]) * METRES_A_DEGREE
    return north, (longitude - ORIGIN[1]) * METRES_A_DEGREE * math.cos(math.radians(ORIGIN[0]))


def to_degrees(north_m: float, east_m: float) -> tuple[float, float]:
    """Latitude and longitude of a place, degrees."""
    latitude = ORIGIN[0] + north_m / METRES_A_DEGREE
    return latitude, ORIGIN[1] + east_m / METRES_A_DEGREE / math.cos(math.radians(ORIGIN[0]))


def waypoint(north_m: float, east_m: float, depth_m: float) -> Item:
    """An item that leads to a place."""
    latitude, longitude = to_degrees(north_m, east_m)
    return Item(WAYPOINT, (0.0, 0.0, 0.0, 0.0), latitude, longitude, -depth_m)


STAY: Final = Item(LOITER_UNLIM)
"""Ends a program: the vehicle stays where it is."""


def programs(depth_m: float) -> tuple[list[Item], tuple[int, ...]]:
    """A mission with four programs behind each other, and the number of the item that each begins at.

    The first item is home, which is never flown to. 0: up and back. 1: a square. 2: a line to and fro. 3: back to
    the start.
    """
    # All lie behind the start, for a diver is before it.
    routes: Sequence[Sequence[tuple[float, float, float]]] = (
        ((0.0, 0.0, depth_m - 0.8), (0.0, 0.0, depth_m)),
        ((0.0, 1.0, depth_m), (-1.0, 1.0, depth_m), (-1.0, 0.0, depth_m), (0.0, 0.0, depth_m)),
        ((-1.5, 0.0, depth_m), (0.0, 0.0, depth_m)),
        ((0.0, 0.0, depth_m),),
    )
    items, starts = [waypoint(0.0, 0.0, 0.0)], []
    for route in routes:
        starts.append(len(items))
        items += [waypoint(*place) for place in route]
        items.append(STAY)
    return items, tuple(starts)
