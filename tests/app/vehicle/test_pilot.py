"""Who counts as a pilot: each bound of the sticks and channels of another, without a link."""

from types import SimpleNamespace

import pytest

from lightgesture.vehicle import Status
from lightgesture.vehicle.mavlink_pilot import ECHO_S, PilotWatch
from lightgesture.vehicle.profile_file import load_vehicle
from lightgesture.vehicle.runs import MissionRun, StickRun, WaitRun
from lightgesture.vehicle.steps import MissionStep, StickStep, WaitStep

NOW_S = 50.0
SYSTEM, COMPONENT = 1, 191
"""The vehicle's number, and ours as a component of it."""


def message(kind, source=(255, 190), **fields):
    fields = {"target": SYSTEM, "target_system": SYSTEM, "x": 0, "y": 0, "z": 500, "r": 0, **fields}
    return SimpleNamespace(
        get_type=lambda: kind, get_srcSystem=lambda: source[0], get_srcComponent=lambda: source[1], **fields
    )


@pytest.fixture
def make_watch():
    def make(channels=()):
        bundled = load_vehicle("ardusub")
        safety = bundled.safety.model_copy(update={"pilot_channels": list(channels), "deadband": 0.125})
        profile = bundled.model_copy(update={"safety": safety})
        return PilotWatch(profile, SimpleNamespace(system=SYSTEM, component=COMPONENT))

    return make


def seen(watch, *messages):
    """When a stick of another was last heard, and last seen away from its middle."""
    for one in messages:
        watch.note(one, NOW_S)
    return watch.stick_s, watch.pilot_s


@pytest.mark.parametrize(
    ("fields", "is_moved"),
    [
        ({}, False),
        *(({axis: 125}, False) for axis in "xyr"),
        *(({axis: 126}, True) for axis in "xyr"),
        ({"x": -126}, True),
        ({"z": 562}, False),
        ({"z": 563}, True),
        ({"z": 437}, True),
        ({"z": 0}, True),
        ({"x": 1000}, True),
        ({"x": 1500}, True),
        ({"x": 1501}, False),
        ({"x": -32768}, False),  # an axis that the joystick lacks
    ],
)
def test_a_stick_beyond_the_deadband_is_a_pilot(make_watch, fields, is_moved):
    assert seen(make_watch(), message("MANUAL_CONTROL", **fields)) == (NOW_S, NOW_S if is_moved else None)


@pytest.mark.parametrize(
    ("target", "source", "is_heard"),
    [
        (SYSTEM, (255, 190), True),
        (0, (255, 190), True),
        (2, (255, 190), False),
        (SYSTEM, (255, COMPONENT), False),  # as our own sticks are sent
        (SYSTEM, (254, COMPONENT), True),
    ],
)
def test_sticks_count_that_are_for_the_vehicle_and_not_our_own(make_watch, target, source, is_heard):
    told = seen(make_watch(), message("MANUAL_CONTROL", source, target=target, x=500))
    assert told == ((NOW_S, NOW_S) if is_heard else (None, None))


@pytest.mark.parametrize(
    ("fields", "is_moved"),
    [
        ({"chan1_raw": 1500}, False),
        ({"chan1_raw": 1550}, False),
        ({"chan1_raw": 1551}, True),
        ({"chan8_raw": 1449}, True),
        ({"chan9_raw": 1900}, False),
        ({"chan3_raw": 799}, False),  # no pulse at all
        ({"chan3_raw": 800}, True),
        ({"chan3_raw": 2200}, True),
        ({"chan3_raw": 2201}, False),
        ({"chan3_raw": 0}, False),
        ({}, False),
    ],
)
def test_channels_that_are_overridden(make_watch, fields, is_moved):
    told = seen(make_watch(), message("RC_CHANNELS_OVERRIDE", **fields))
    assert told == (NOW_S, NOW_S if is_moved else None)
    assert seen(make_watch(), message("RC_CHANNELS_OVERRIDE", target_system=2, **fields)) == (None, None)
    assert seen(make_watch(), message("RC_CHANNELS_OVERRIDE", target_system=0, **fields))[0] == NOW_S


def channels(pulse, source=SYSTEM):
    return message("RC_CHANNELS", (source, 1), chan2_raw=pulse, chan3_raw=1900)


@pytest.mark.parametrize(
    ("pulses", "is_moved"),
    [
        ([1500, 1500], False),
        ([1500, 1551], True),
        ([1500, 1550], False),
        ([1100, 1100], False),  # where it rests
        ([1100, 1151], True),
        ([1100, 1150], False),
        ([1100, 1500], False),
        ([1551], False),
    ],
)
def test_a_channel_is_moved_away_from_its_middle_and_from_where_it_rests(make_watch, pulses, is_moved):
    told = seen(make_watch([2]), *map(channels, pulses))
    assert told == (None, NOW_S if is_moved else None)
    assert seen(make_watch(), *map(channels, pulses)) == (None, None)  # no channels are named
    assert seen(make_watch([2]), *(channels(pulse, source=2) for pulse in pulses)) == (None, None)


@pytest.mark.parametrize(
    ("pushed_s", "is_middle", "is_moved"),
    [
        (NOW_S - ECHO_S - 0.01, False, True),
        (NOW_S - ECHO_S, False, False),
        (NOW_S, False, False),
        (NOW_S, True, True),
    ],
)
def test_our_own_push_shows_in_the_channels_for_a_while(make_watch, pushed_s, is_middle, is_moved):
    watch = make_watch([2])
    watch.note_own(is_middle, pushed_s)
    assert seen(watch, channels(1500), channels(1900))[1] == (NOW_S if is_moved else None)


# What a step does as time passes


class Sticks:
    def __init__(self):
        self.held = []

    def hold(self, stick):
        self.held.append(stick.z)


def bench(cap=0.5, ramp_s=0.5):
    stick = SimpleNamespace(ramp_s=ramp_s, cap=cap)
    return SimpleNamespace(sticks=Sticks(), cap=cap, profile=SimpleNamespace(stick=stick), status=Status())


def test_a_push_ends_with_its_seconds(instruction):
    run, own = StickRun(instruction("STOP UP 4 GO"), StickStep(stick={"z": 1.0})), bench()
    run.begin(own, 8.0)
    assert run.detail == "sticks z +0.50 for 4 s"
    outcomes = [run.tick(own, 8.0 + after_s) for after_s in (0.0, 0.25, 2.0, 3.75, 3.99, 4.0, 9.0)]
    assert outcomes == ["going"] * 5 + ["done"] * 2
    assert own.sticks.held == pytest.approx([0.0, 0.25, 0.5, 0.25, 0.01])


def test_a_wait_ends_with_its_seconds_or_never(instruction):
    for text, outcomes in (("STOP HOVER 4 GO", ["going", "going", "done"]), ("STOP HOVER GO", ["going"] * 3)):
        run = WaitRun(instruction(text), WaitStep(wait="duration_s"))
        run.begin(bench(), 8.0)
        assert [run.tick(bench(), 8.0 + after_s) for after_s in (0.0, 3.99, 4.0)] == outcomes


@pytest.mark.parametrize(
    ("last", "item", "expected"),
    [(4.0, 3, False), (4.0, 4, True), (4.0, 5, True), (4.0, None, False), (None, 4, False)],
)
def test_a_mission_is_over_with_its_last_item(instruction, last, item, expected):
    run = MissionRun(instruction("STOP EXEC 1 GO"), MissionStep(mission=2, last=4, mode="AUTO"))
    answered = SimpleNamespace(
        order=lambda order, now_s: SimpleNamespace(state="accepted", value=last, detail="")
    )
    own = SimpleNamespace(vehicle=answered, status=Status(item=item))
    run.begin(own, 8.0)
    assert run.is_over(own.status) is expected
    assert run.tick(own, 9.0) == ("done" if expected else "going")
