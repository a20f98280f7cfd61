"""What stands against a task, ends it or takes its place: the watchdog, the pilot, the word to kill."""

import pytest

from lightgesture.vehicle import (
    NEUTRAL,
    SetMode,
    StartMission,
)


@pytest.mark.parametrize(
    ("status", "reason"),
    [
        ({"is_armed": False}, "the vehicle is not armed, and only its pilot arms it"),
        ({"pilot_s": 100.0}, "the pilot is steering"),
        ({"stick_s": 100.0}, "another's stick is on the link"),
        ({"rival_s": 100.0}, "another companion with our number is on the link"),
        ({"trouble": "two vehicles"}, "two vehicles"),
        ({"heard_s": None}, "no vehicle was heard yet"),
        ({"heard_s": 90.0}, "no heartbeat of the vehicle for 10."),
    ],
)
def test_what_stands_against_a_push(world, instruction, status, reason):
    world.vehicle.status.update(status)
    world.sign(instruction("STOP UP 5 GO")).run(1)
    assert world.states() == ["refused"]
    assert world.last[1].startswith(reason)
    assert world.vehicle.sticks == world.vehicle.orders == []


def test_without_a_watchdog_nothing_moves(world, instruction):
    world.picture(instruction("STOP UP 5 GO"), instruction("CONTD SNAP GO"))
    world.now_s += 0.05
    world.executor.tick(world.now_s, is_watched=False)
    assert world.states("STOP UP 5 GO") == ["refused"]
    assert world.states("CONTD SNAP GO")[0] == "sent"


def test_whether_it_holds_is_told(world, instruction):
    world.sign(instruction("STOP EXEC 1 GO"))
    world.vehicle.answer = lambda order: "POSHOLD failed; ALT_HOLD no answer"
    world.has_pictures = False
    world.run(1.2)
    told = [(record.state, record.instruction, record.detail) for record in world.records[-2:]]
    assert told == [
        ("aborted", "STOP EXEC 1 GO", "no new picture for 1 s"),
        ("refused", None, "holds: POSHOLD failed; ALT_HOLD no answer"),
    ]


def test_the_word_to_kill_ends_everything(world, instruction):
    world.sign(instruction("STOP UP 10 GO"))
    for count in (1, 2):
        world.sign(instruction(f"CONTD SNAP {count} GO"))
    world.run(1)
    world.sign(instruction("ABORT NOW", kind="kill", action="ABORT"))
    assert world.vehicle.sticks[-1][1] == NEUTRAL
    for text in ("STOP UP 10 GO", "CONTD SNAP 1 GO", "CONTD SNAP 2 GO"):
        assert world.states(text)[-1] == "aborted"
    assert world.states("ABORT NOW") == ["done"]
    assert world.vehicle.orders[-1] == SetMode(names=("POSHOLD", "ALT_HOLD"))
    world.executor.answer("nod")
    world.vehicle.sticks.clear()
    world.run(3)
    assert {stick for _, stick in world.vehicle.sticks} <= {NEUTRAL}  # who wanted an end wants no motion


def test_a_hold_up_ends_a_push_and_not_a_hover(world, instruction):
    for text, state in (("STOP HOVER 50 GO", "executing"), ("STOP UP 10 GO", "aborted")):
        world.sign(instruction(text)).run(1)
        world.now_s += 0.3
        world.run(0.05)
        assert world.states(text)[-1] == state
    assert world.last[1] == "the program was held up for 0.35 s"


def test_who_takes_the_sticks_after_a_push_is_left_alone(world, instruction):
    world.sign(instruction("STOP UP 1 GO")).run(1.1)
    assert world.records[-1].state == "done"
    count = len(world.vehicle.sticks)
    world.vehicle.status["stick_s"] = world.now_s
    world.run(1)
    assert len(world.vehicle.sticks) <= count + 2


def test_a_nod_ends_with_the_word_to_kill_and_with_the_next_instruction(world, instruction):
    for record in (instruction("ABORT NOW", kind="kill", action="ABORT"), instruction("STOP HOVER 5 GO")):
        world.executor.answer("nod")
        world.run(0.3)
        assert world.vehicle.sticks[-1][1] != NEUTRAL
        world.sign(record)
        world.vehicle.sticks.clear()
        world.run(3)
        assert {stick for _, stick in world.vehicle.sticks} <= {NEUTRAL}
        world.sign(instruction("STOP HOVER 1 GO")).run(2)  # a nod may come again


def test_a_nod_ends_where_the_watchdog_does(world, instruction):
    world.executor.answer("nod")
    world.run(0.3)
    world.now_s += 0.05
    world.picture()
    world.executor.tick(world.now_s, is_watched=False)
    assert world.vehicle.sticks[-1][1] == NEUTRAL


def test_a_mission_whose_vehicle_started_anew_is_no_done_one(world, instruction):
    world.sign(instruction("STOP EXEC 1 GO")).run(1)
    world.vehicle.status |= {"item": 99, "boots": 1, "mode": "MANUAL"}
    world.run(0.1)
    assert world.states()[-1] == "aborted"


@pytest.mark.parametrize(("gap_s", "state"), [(0.24, "executing"), (0.26, "aborted")])
def test_how_long_a_tick_may_be_late(world, instruction, gap_s, state):
    world.sign(instruction("STOP UP 10 GO")).run(1)
    world.now_s += gap_s
    world.picture()
    world.executor.tick(world.now_s)
    assert world.last[0] == state


@pytest.mark.parametrize(("age_s", "states"), [(1.0, ["sent", "accepted", "executing"]), (1.01, ["refused"])])
def test_how_long_an_instruction_may_wait(world, instruction, age_s, states):
    world.picture(instruction("STOP HOVER 5 GO"))
    world.now_s += age_s
    world.executor.tick(world.now_s)
    assert world.states() == states


def test_what_replaces_a_mission_begins_without_a_hold_in_between(world, instruction):
    world.sign(instruction("STOP EXEC 1 GO")).sign(instruction("STOP UP 5 GO")).run(0.5)
    assert [type(order) for order in world.vehicle.orders] == [StartMission, SetMode]
    assert world.vehicle.orders[1].names == ("ALT_HOLD",)


def test_a_mission_is_held_where_what_replaces_it_is_refused(world, instruction):
    world.sign(instruction("STOP EXEC 1 GO"))
    world.vehicle.status["is_armed"] = False
    world.sign(instruction("STOP HOVER 5 GO"))
    assert world.states("STOP EXEC 1 GO")[-1] == "aborted"
    assert world.vehicle.orders[1:] == []  # who disarmed it has it
    world.vehicle.status["is_armed"] = True
    world.sign(instruction("STOP EXEC 1 GO")).sign(instruction("STOP EXEC 4 GO"))
    assert world.states("STOP EXEC 4 GO") == ["refused"]
    assert world.vehicle.orders[-1] == SetMode(names=("POSHOLD", "ALT_HOLD"))


@pytest.mark.parametrize(("ago_s", "is_held"), [(1.0, False), (2.5, True)])
def test_the_word_to_kill_leaves_the_mode_to_a_pilot_who_steers(world, instruction, ago_s, is_held):
    world.vehicle.status["pilot_s"] = world.now_s - ago_s
    world.sign(instruction("ABORT NOW", kind="kill", action="ABORT"))
    assert world.states("ABORT NOW") == ["done"]
    assert bool(world.vehicle.orders) == is_held


def test_the_end_sends_the_middle_at_once_and_again(world, instruction):
    world.sign(instruction("STOP UP 10 GO")).run(1)
    world.vehicle.sticks.clear()
    end_s = world.now_s + 0.01
    world.executor.close("the decoder ends", end_s)
    assert world.vehicle.sticks == [(end_s, NEUTRAL)]
    assert world.states()[-1] == "aborted"
    for tick in range(1, 7):
        world.executor.settle(end_s + tick * 0.05)
    assert len(world.vehicle.sticks) == 4
    assert {stick for _, stick in world.vehicle.sticks} == {NEUTRAL}
    assert world.executor.task is None


def test_a_push_that_is_replaced_leaves_no_stick_behind(world, instruction):
    world.sign(instruction("STOP UP 10 GO")).run(1)
    world.vehicle.sticks.clear()
    world.sign(instruction("STOP HOVER 5 GO")).run(2)
    assert {stick for _, stick in world.vehicle.sticks} == {NEUTRAL}
    assert not world.executor.holds_sticks
