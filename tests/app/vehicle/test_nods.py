"""A nod and a shake, under the guard."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from lightgesture.vehicle import (
    NEUTRAL,
    Status,
)
from lightgesture.vehicle.guard import Senses
from lightgesture.vehicle.motion import Motion
from lightgesture.vehicle.profile_file import load_vehicle
from tests.app.vehicle.step_bench import START_S


class Rig:
    """A motion of the bundled profile on a vehicle that says what a test tells it."""

    def __init__(self, **status):
        profile = load_vehicle("ardusub")
        self.sticks, self.held = Recorder(), []
        known = {"heard_s": START_S, "is_armed": True, **status}
        self.bench = SimpleNamespace(profile=profile, sticks=self.sticks, cap=0.4, status=Status(**known))
        self.motion = Motion(self.bench)

    def tick(self, after_s, **status):
        now_s = START_S + after_s
        self.bench.status = replace(self.bench.status, heard_s=now_s, **status)
        self.motion.tick(Senses(picture_s=now_s, hand_s=now_s), now_s)
        return self.sticks.now


class Recorder:
    """now: what the sticks are held at; None: not held."""

    now = None
    releases = 0

    def hold(self, stick):
        self.now = stick

    def release(self, now_s, to_another=False):
        self.now = None
        self.releases += 1


def test_a_nod_begins_in_the_middle_and_comes_to_its_end():
    rig = Rig()
    assert rig.tick(0.0) is None
    rig.motion.ask("nod")
    assert rig.tick(0.1) == NEUTRAL
    assert rig.tick(0.3).z > 0
    table = rig.bench.profile.motion
    assert rig.tick(0.1 + table.beat_s * 1.5).z < 0
    assert rig.tick(0.1 + table.beat_s * 2 * table.times - 0.01) is not None
    assert rig.tick(0.1 + table.beat_s * 2 * table.times + 0.01) is None
    assert rig.tick(9.0) is None
    assert rig.sticks.releases == 1


@pytest.mark.parametrize(
    "status",
    [
        {"trouble": "two vehicles"},
        {"is_armed": False},
        {"pilot_s": START_S + 0.1},
        {"stick_s": START_S + 0.1},
    ],
)
def test_what_stands_against_a_nod_forgets_it_and_what_comes_ends_it(status):
    rig = Rig()
    rig.motion.ask("nod")
    assert rig.tick(0.1, **status) is None
    cleared = {"trouble": "", "is_armed": True, "pilot_s": None, "stick_s": None}
    assert rig.tick(0.2, **cleared) is None
    rig.motion.ask("nod")
    assert rig.tick(0.3) == NEUTRAL
    later = {key: START_S + 0.4 if key.endswith("_s") else value for key, value in status.items()}
    assert rig.tick(0.5, **later) is None
    assert rig.tick(0.6, **cleared) is None


def test_a_nod_is_not_asked_for_twice_nor_where_it_is_not_allowed():
    rig = Rig()
    rig.motion.ask("nod")
    rig.motion.ask("shake")
    rig.tick(0.0)
    assert rig.tick(0.25).r == 0
    rig.motion.stop(START_S)
    rig.motion.is_allowed = False
    rig.motion.ask("nod")
    assert rig.tick(0.5) is None
    releases = rig.sticks.releases
    rig.motion.stop(START_S)
    assert rig.sticks.releases == releases


def test_a_nod_that_was_asked_for_and_stopped_before_it_began_does_not_begin():
    rig = Rig()
    rig.motion.ask("nod")
    rig.motion.stop(START_S)
    assert rig.tick(0.1) is None
