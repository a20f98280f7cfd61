"""What begins nothing and what ends a task, each by itself and at its bounds; where sticks are during a push."""

from dataclasses import replace

import pytest

from lightgesture.vehicle import NEUTRAL, Status, Stick
from lightgesture.vehicle.guard import (
    Fault,
    Senses,
    fault,
    is_recent,
    last_of_another,
    obstacle,
    obstacle_to_motion,
)
from lightgesture.vehicle.motion import swing
from lightgesture.vehicle.profile import MotionTable, StickTable
from lightgesture.vehicle.profile_file import load_vehicle
from lightgesture.vehicle.sticks import Sticks, ramped

NOW_S = 64.0
"""With all other times a number that binary fractions have, so that what lies on a bound is exact."""
BEGUN_S = 32.0
WELL = Status(heard_s=NOW_S, mode="A", is_armed=True)
SEEN = Senses(picture_s=NOW_S, hand_s=NOW_S)


@pytest.fixture(scope="module")
def profile():
    bundled = load_vehicle("ardusub")
    safety = bundled.safety.model_copy(update={"stale_s": 0.5, "lost_diver_s": 4.0, "needs_armed": True})
    link = bundled.link.model_copy(update={"timeout_s": 3.0})
    return bundled.model_copy(update={"safety": safety, "link": link})


@pytest.fixture(scope="module")
def lenient(profile):
    """Neither armed nor with a diver in view."""
    safety = profile.safety.model_copy(update={"needs_armed": False, "lost_diver_s": 0.0})
    return profile.model_copy(update={"safety": safety})


@pytest.mark.parametrize(
    ("moment_s", "expected"), [(None, False), (NOW_S, True), (NOW_S - 2, True), (NOW_S - 2.25, False)]
)
def test_what_is_recent(moment_s, expected):
    assert is_recent(moment_s, NOW_S, 2.0) == expected


@pytest.mark.parametrize(
    ("stick_s", "pilot_s", "expected"),
    [
        (None, None, None),
        (1.0, None, 1.0),
        (None, 2.0, 2.0),
        (1.0, 2.0, 2.0),
        (3.0, 2.0, 3.0),
        (0.0, None, 0.0),
    ],
)
def test_when_another_was_last_at_the_sticks(stick_s, pilot_s, expected):
    assert last_of_another(Status(stick_s=stick_s, pilot_s=pilot_s)) == expected


@pytest.mark.parametrize(
    ("status", "senses", "reason"),
    [
        ({}, {}, None),
        ({"trouble": "two vehicles"}, {}, "two vehicles"),
        ({"heard_s": None}, {}, "no vehicle was heard yet"),
        ({"heard_s": NOW_S - 3}, {}, None),
        ({"heard_s": NOW_S - 3.25}, {}, "no heartbeat of the vehicle for 3.2 s"),
        ({"heard_s": 0.0}, {}, "no heartbeat of the vehicle for 64.0 s"),
        ({"rival_s": NOW_S - 5}, {}, "another companion"),
        ({"rival_s": NOW_S - 5.25}, {}, None),
        ({}, {"picture_s": None}, "no fresh picture"),
        ({}, {"picture_s": NOW_S - 0.5}, None),
        ({}, {"picture_s": NOW_S - 0.75}, "no fresh picture"),
    ],
)
def test_what_stands_against_beginning_anything(profile, status, senses, reason):
    found = obstacle(replace(WELL, **status), replace(SEEN, **senses), NOW_S, profile)
    assert found is None if reason is None else found.startswith(reason)


@pytest.mark.parametrize(
    ("status", "uses_sticks", "reason"),
    [
        ({}, True, None),
        ({"is_armed": False}, False, "the vehicle is not armed"),
        ({"pilot_s": NOW_S - 2}, False, "the pilot is steering"),
        ({"pilot_s": NOW_S - 2.25}, True, None),
        ({"stick_s": NOW_S - 1}, True, "another's stick is on the link"),
        ({"stick_s": NOW_S - 1}, False, None),
        ({"stick_s": NOW_S - 1.25}, True, None),
    ],
)
def test_what_stands_against_moving(profile, status, uses_sticks, reason):
    found = obstacle_to_motion(replace(WELL, **status), NOW_S, profile, uses_sticks)
    assert found is None if reason is None else found.startswith(reason)


def test_where_the_profile_does_not_ask_for_it_a_vehicle_need_not_be_armed(lenient):
    status = replace(WELL, is_armed=False)
    assert obstacle_to_motion(status, NOW_S, lenient, uses_sticks=True) is None
    assert fault(status, status, BEGUN_S, SEEN, NOW_S, lenient) is None


@pytest.mark.parametrize(
    ("status", "senses", "reason", "is_anothers"),
    [
        ({}, {}, None, False),
        ({"pilot_s": BEGUN_S}, {}, None, False),
        ({"pilot_s": BEGUN_S + 0.25}, {}, "a pilot moved a stick", True),
        ({"stick_s": BEGUN_S}, {}, None, False),
        ({"stick_s": BEGUN_S + 0.25}, {}, "another's stick is on the link", True),
        ({"foreign_modes": 1}, {}, "someone else changed the mode to A", True),
        ({"boots": 1}, {}, "the vehicle started anew", True),
        ({"is_armed": False}, {}, "the vehicle was disarmed", True),
        ({"trouble": "two vehicles"}, {}, "two vehicles", False),
        ({"heard_s": NOW_S - 3}, {}, None, False),
        ({"heard_s": NOW_S - 3.25}, {}, "the link is lost: no heartbeat for 3 s", False),
        ({"heard_s": None}, {}, "the link is lost: no heartbeat for 3 s", False),
        ({"rival_s": NOW_S - 5}, {}, "another companion with our number is on the link", False),
        ({"rival_s": NOW_S - 5.25}, {}, None, False),
        ({}, {"hole": "no frame"}, "the pictures have a hole: no frame", False),
        ({}, {"picture_s": NOW_S - 0.5}, None, False),
        ({}, {"picture_s": NOW_S - 0.75}, "no new picture for 0.5 s", False),
        ({}, {"hand_s": NOW_S - 4}, None, False),
        ({}, {"hand_s": NOW_S - 4.25}, "the diver is lost: no hand for 4 s", False),
        ({}, {"hand_s": None}, "the diver is lost: no hand for 4 s", False),
    ],
)
def test_what_ends_a_task(profile, status, senses, reason, is_anothers):
    found = fault(
        replace(WELL, **status), WELL, BEGUN_S, replace(SEEN, **senses), NOW_S, profile, uses_sticks=True
    )
    assert found == (None if reason is None else Fault(reason, is_anothers))


def test_anothers_stick_ends_only_what_holds_sticks(profile):
    status = replace(WELL, stick_s=BEGUN_S + 1)
    assert fault(status, WELL, BEGUN_S, SEEN, NOW_S, profile) is None


def test_a_diver_who_was_there_when_the_sentence_ended_is_not_lost_yet(profile, lenient):
    for hand_s in (None, 8.0):
        senses = Senses(picture_s=NOW_S, hand_s=hand_s)
        assert fault(WELL, WELL, NOW_S - 4, senses, NOW_S, profile) is None
        assert fault(WELL, WELL, NOW_S - 4.25, senses, NOW_S, profile) is not None
        assert fault(WELL, WELL, 0.0, senses, NOW_S, lenient) is None


# Sticks


@pytest.mark.parametrize(
    ("elapsed_s", "expected"),
    [(-0.25, 0), (0, 0), (0.25, 0.5), (0.5, 1), (2, 1), (3.5, 1), (3.75, 0.5), (4, 0), (9, 0)],
)
def test_a_push_rises_and_falls_at_its_ends(elapsed_s, expected):
    assert ramped(elapsed_s, total_s=4.0, ramp_s=0.5) == expected


def test_a_push_without_a_ramp_and_one_that_is_shorter_than_its_ramps():
    assert [ramped(elapsed_s, 1.0, 0.0) for elapsed_s in (-0.5, 0.0, 0.5, 1.0)] == [0, 1, 1, 0]
    assert max(ramped(step / 64, 1.0, 2.0) for step in range(64)) == 0.25


class Recorder:
    """A vehicle that keeps what the sticks did."""

    def __init__(self):
        self.sent = []

    def stick(self, stick, now_s):
        self.sent.append((now_s, stick))


PUSH = Stick(z=0.5)
TABLE = StickTable(rate_hz=8, neutral_s=0.5)


@pytest.fixture
def recorder():
    return Recorder()


def times(recorder, stick):
    return [now_s for now_s, sent in recorder.sent if sent == stick]


def test_sticks_are_sent_at_their_rate_while_they_are_held_and_the_middle_for_a_while_after(recorder):
    sticks = Sticks(recorder, TABLE)
    for step in range(8):
        sticks.tick(step / 16)
    assert (recorder.sent, sticks.is_sent, sticks.is_held) == ([], False, False)
    sticks.hold(PUSH)
    for step in range(16, 32):
        sticks.tick(step / 16)
    assert times(recorder, PUSH) == [1 + step / 8 for step in range(8)]
    assert (sticks.is_sent, sticks.is_held) == (True, True)
    sticks.release(2.0)
    assert times(recorder, NEUTRAL) == [2.0]  # at once
    assert (sticks.is_sent, sticks.is_held) == (True, False)
    for step in range(32, 64):
        sticks.tick(step / 16)
    assert times(recorder, NEUTRAL) == [2.0, 2.125, 2.25, 2.375, 2.5]
    assert not sticks.is_sent
    sticks.release(9.0)
    assert len(times(recorder, NEUTRAL)) == 5


def test_a_message_may_come_a_little_early(recorder):
    sticks = Sticks(recorder, TABLE)
    sticks.hold(PUSH)
    for now_s in (1.0, 1.119, 1.1201, 1.2):
        sticks.tick(now_s)
    assert times(recorder, PUSH) == [1.0, 1.1201]


def test_the_middle_is_brief_where_another_holds_the_sticks(recorder):
    sticks = Sticks(recorder, TABLE)
    sticks.hold(PUSH)
    sticks.release(2.0, to_another=True)
    for step in range(32, 64):
        sticks.tick(step / 16)
    assert times(recorder, NEUTRAL) == [2.0, 2.125]


@pytest.mark.parametrize(("other_s", "count"), [(None, 5), (1.9, 5), (2.0, 2), (2.125, 3)])
def test_the_middle_ends_soon_after_another_took_the_sticks(recorder, other_s, count):
    sticks = Sticks(recorder, TABLE)
    sticks.hold(PUSH)
    sticks.release(2.0)
    for step in range(32, 64):
        now_s = step / 16
        sticks.tick(now_s, other_s if other_s is not None and now_s >= other_s else None)
    assert len(times(recorder, NEUTRAL)) == count


def test_the_middle_between_tasks_is_the_profiles_to_ask_for_and_gives_way_to_another(recorder):
    sticks = Sticks(recorder, StickTable(rate_hz=8, neutral_s=0.5, between=True))
    sticks.tick(1.0)
    sticks.tick(2.0, other_s=0.0)
    sticks.tick(3.0, other_s=0.5)
    sticks.tick(4.0, other_s=3.5)
    assert times(recorder, NEUTRAL) == [1.0, 3.0]


# A nod and a shake


def motion_table(**changes):
    return MotionTable(**{"nod": {"z": 0.4}, "shake": {"r": -0.2}, "beat_s": 1.0, "times": 2, **changes})


def test_a_nod_swings_to_one_side_and_to_the_other_some_times():
    table = motion_table()
    beats = [swing(table, "nod", beat + 0.5, 0.25, 1.0) for beat in range(5)]
    assert [None if stick is None else stick.z for stick in beats] == pytest.approx(
        [0.4, -0.4, 0.4, -0.4, None]
    )
    assert swing(table, "shake", 0.5, 0.25, 1.0) == Stick(r=-0.2)
    assert [swing(table, "nod", float(beat), 0.25, 1.0) for beat in range(4)] == [Stick()] * 4
    assert swing(table, "nod", 1.125, 0.25, 1.0).z == pytest.approx(-0.2)


def test_a_swing_is_bounded_by_the_cap_and_its_ramp_by_the_beat():
    assert swing(motion_table(), "nod", 0.5, 0.25, 0.1).z == pytest.approx(0.1)
    assert swing(motion_table(), "nod", 0.5, 0.25, 0.4).z == pytest.approx(0.4)
    assert swing(motion_table(), "nod", 0.125, 9.0, 1.0).z == pytest.approx(0.2)
    assert swing(motion_table(nod={"z": 0.0}), "nod", 0.5, 0.25, 0.1) == Stick()
