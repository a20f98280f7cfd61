"""What instructions become, on a vehicle that answers as a test tells it."""

import itertools

import pytest

from lightgesture.vehicle import (
    NEUTRAL,
    ReadParameter,
    SendCommand,
    SetMode,
    WriteParameter,
)
from tests.app.vehicle.made_up import BASE, pictured, wait_for


def test_hover_holds_for_its_seconds_and_is_done(world, instruction):
    world.sign(instruction("STOP HOVER 5 GO"))
    assert world.vehicle.orders == [SetMode(names=("POSHOLD", "ALT_HOLD"))]
    assert [(record.state, record.detail) for record in world.records] == [
        ("sent", "mode POSHOLD or ALT_HOLD"),
        ("accepted", "mode POSHOLD"),
        ("executing", "stays for 5 s"),
    ]
    assert {record.instruction for record in world.records} == {"STOP HOVER 5 GO"}
    world.run(4.9)
    assert world.last[0] == "executing"
    world.run(0.2)
    assert world.last == ("done", "stays for 5 s")
    assert world.vehicle.sticks == []


def test_hover_without_seconds_lasts_until_the_next_instruction(world, instruction):
    world.sign(instruction("STOP HOVER GO")).run(100)
    assert world.last == ("executing", "stays until the next instruction")
    world.sign(instruction("STOP HOVER 5 GO"))
    assert ("aborted", "replaced by STOP HOVER 5 GO") in [(one.state, one.detail) for one in world.records]


@pytest.mark.parametrize(
    ("action", "axis", "sign"), [("UP", "z", 1), ("DOWN", "z", -1), ("LEFT", "y", -1), ("RIGHT", "y", 1)]
)
def test_a_push_has_a_ramp_a_cap_and_a_neutral_end(world, instruction, action, axis, sign):
    begun_s = world.now_s
    world.sign(instruction(f"STOP {action} 3 GO")).run(6)
    assert world.vehicle.orders == [SetMode(names=("ALT_HOLD",))]
    ways = [(now_s - begun_s, sign * getattr(stick, axis)) for now_s, stick in world.vehicle.sticks]
    assert max(way for _, way in ways) == pytest.approx(0.4)
    assert min(way for _, way in ways) == 0
    steps = [after[1] - before[1] for before, after in itertools.pairwise(ways)]
    assert max(map(abs, steps)) <= 0.1  # half a second to 0.4, ten times a second
    pushed = [time_s for time_s, way in ways if way > 0.001]
    assert 2.7 < max(pushed) - min(pushed) < 3.0
    tail = [way for time_s, way in ways if time_s > 3.1]
    assert len(tail) >= 9
    assert set(tail) == {0}
    assert ways[-1][0] < 4.3  # then there is silence
    assert all(
        getattr(stick, other) == 0 for _, stick in world.vehicle.sticks for other in "xyzr" if other != axis
    )
    assert world.states() == ["sent", "accepted", "executing", "done"]


def test_a_push_is_never_longer_than_the_profile_says(world, instruction):
    world.sign(instruction("STOP UP 600 GO")).run(30)
    assert world.records[-1].state == "done"
    assert "for 20 s" in world.records[-1].detail


def test_what_the_vehicle_refuses_is_told(world, instruction):
    world.vehicle.answer = lambda order: "POSHOLD failed; ALT_HOLD denied"
    world.sign(instruction())
    assert world.states() == ["sent", "refused"]
    assert world.last[1] == "mode POSHOLD or ALT_HOLD: POSHOLD failed; ALT_HOLD denied"


def test_what_is_refused_after_the_first_step_is_aborted(make_world, instruction):
    world = make_world(
        BASE + '[[instruction]]\naction = "FOLLOW"\nsteps = [{mode = ["A"]}, {command = "MAV_CMD_USER_1"}]\n'
    )
    world.vehicle.answer = lambda order: "unsupported" if isinstance(order, SendCommand) else "accepted"
    world.sign(instruction("STOP FOLLOW GO"))
    assert world.states() == ["sent", "accepted", "aborted"]
    assert world.last[1] == "MAV_CMD_USER_1: unsupported"


def test_follow_is_handed_on_and_waits_for_pictures(world, instruction):
    """Scenario b of the paper: take pictures for 5 seconds, then follow."""
    snap, follow = instruction("CONTD SNAP 5 GO"), instruction("STOP FOLLOW GO")
    world.sign(snap).run(1)
    world.sign(follow)
    assert world.last == ("accepted", "begins when the pictures are taken")
    for number in range(5):
        world.vehicle.status["pictures"] = (pictured(number),)
        world.run(0.05)
    assert world.states(snap.text)[-1] == "done"
    world.run(0.1)
    assert world.states(follow.text) == ["accepted", "sent", "accepted", "executing"]
    assert world.vehicle.orders[-1].name == "MAV_CMD_USER_1"


def test_a_parameter_goes_by_its_step_within_its_limits(world, instruction):
    values = {"PILOT_SPEED_UP": 95.0}

    def answer(order):
        if isinstance(order, ReadParameter):
            return values[order.name]
        if isinstance(order, WriteParameter):
            values[order.name] = order.value
        return "accepted"

    world.vehicle.answer = answer
    world.sign(instruction("CONTD PARAM 1 INCREASE GO"), seconds=0.1)
    assert world.last == ("done", "PILOT_SPEED_UP 95 to 100")
    world.sign(instruction("CONTD PARAM 1 INCREASE GO"), seconds=0.1)
    assert world.last == ("refused", "PILOT_SPEED_UP is 100, at its limit already")
    world.sign(instruction("CONTD PARAM 1 DEFAULT GO"), seconds=0.1)
    assert values == {"PILOT_SPEED_UP": 50}
    values["PILOT_SPEED_UP"] = 1e-40
    world.sign(instruction("CONTD PARAM 1 INCREASE GO"), seconds=0.1)
    assert world.last == ("refused", "PILOT_SPEED_UP is 1e-40, outside of 20 to 100")


def test_parameters_of_the_executor(world, instruction):
    world.sign(
        instruction("CONTD PARAM 0 DECREASE GO"), instruction("CONTD PARAM 5 INCREASE GO"), seconds=0.1
    )
    assert [record.detail for record in world.records if record.state == "done"] == [
        "cap 0.4 to 0.3",
        "interval_s 1 to 1.5",
    ]
    world.sign(instruction("STOP UP 3 GO")).run(3)
    assert max(stick.z for _, stick in world.vehicle.sticks) == pytest.approx(0.3)


def test_what_the_profile_does_not_say(world, instruction):
    for text, reason in (
        ("STOP DANCE GO", "the profile of ArduSub does not say what DANCE is"),
        ("STOP EXEC 4 GO", "the profile of ArduSub does not say what EXEC 4 is"),
        ("CONTD PARAM 3 DECREASE GO", "the profile of ArduSub has no parameter 3"),
    ):
        world.sign(instruction(text))
        assert world.last == ("refused", reason)
    assert world.vehicle.orders == []


def test_stop_ends_the_task_even_where_the_next_is_refused(world, instruction):
    world.sign(instruction("STOP UP 10 GO")).run(2)
    assert world.vehicle.sticks[-1][1].z > 0
    world.sign(instruction("STOP EXEC 4 GO"))
    assert world.vehicle.sticks[-1][1] == NEUTRAL
    assert world.states("STOP UP 10 GO")[-1] == "aborted"


def test_two_instructions_at_once_leave_the_last(world, instruction):
    world.sign(instruction("STOP UP 5 GO"), instruction("STOP DOWN 5 GO")).run(2)
    assert world.states("STOP UP 5 GO") == ["sent", "aborted"]
    assert world.states("STOP DOWN 5 GO") == ["sent", "accepted", "executing"]
    assert min(stick.z for _, stick in world.vehicle.sticks) < 0
    assert max(stick.z for _, stick in world.vehicle.sticks) == 0


def test_previous_mode(make_world, instruction):
    world = make_world(
        BASE
        + '[[instruction]]\naction = "HOVER"\nsteps = [{mode = ["A"]}, {wait = 1}, {mode = ["previous"]}]\n'
    )
    world.vehicle.status["mode"] = "B"
    world.sign(instruction("STOP HOVER GO")).run(1.2)
    assert world.vehicle.orders == [SetMode(names=("A",)), SetMode(names=("B",))]


def test_a_hook_answers_by_its_status(make_world, instruction, tmp_path):
    hook = tmp_path / "hook.sh"
    hook.write_text("#!/bin/sh\ngrep -q '\"duration_s\":7'\n")
    hook.chmod(0o755)
    world = make_world(BASE + f'[[instruction]]\naction = "FOLLOW"\nsteps = [{{hook = "{hook}"}}]\n')
    world.sign(instruction("STOP FOLLOW 7 GO"))
    wait_for(lambda: world.run(0.05).records[-1].state == "done")
    world.sign(instruction("STOP FOLLOW 8 GO"))
    wait_for(lambda: world.run(0.05).records[-1].state == "refused")
    assert world.last[1] == f"hook {hook}: failed with status 1"


def test_values_and_commands_take_the_fields_of_the_instruction(make_world, instruction):
    world = make_world(
        BASE
        + '[[instruction]]\naction = "FOLLOW"\nsteps = [{value = "duration_s", name = "LG", missing = -1}, '
        + '{command = "MAV_CMD_IMAGE_START_CAPTURE", params = [0, "duration_s"]}]\n'
    )
    world.sign(instruction("STOP FOLLOW GO"))
    value, command = world.vehicle.orders
    assert (value.name, value.value) == ("LG", -1)
    assert (command.component, command.params) == (100, (0, 0, 0, 0, 0, 0, 0))


def test_the_middle_between_tasks_only_where_it_is_asked_for(make_world, instruction):
    up = '[[instruction]]\naction = "UP"\nsteps = [{stick = {z = 1}, seconds = 1}]\n'
    world = make_world(BASE + "[stick]\nbetween = true\n" + up)
    world.vehicle.sticks.clear()
    world.run(2)
    assert len(world.vehicle.sticks) == 20
    assert {stick for _, stick in world.vehicle.sticks} == {NEUTRAL}
    world.vehicle.sticks.clear()
    world.vehicle.status["stick_s"] = world.now_s + 10
    world.run(2)
    assert world.vehicle.sticks == []


def test_nod_and_shake_only_while_nothing_is_done(world, instruction):
    world.executor.answer("nod")
    world.run(3)
    ways = [stick.z for _, stick in world.vehicle.sticks]
    assert max(ways) == pytest.approx(0.4, abs=0.05)
    assert min(ways) == pytest.approx(-0.4, abs=0.05)
    assert ways[-1] == 0
    assert sum(ways) == pytest.approx(0, abs=0.3)
    world.vehicle.sticks.clear()
    world.sign(instruction("STOP HOVER 5 GO"))
    world.executor.answer("shake")
    world.run(3)
    assert world.vehicle.sticks == []


def test_an_instruction_that_waited_is_not_begun(world, instruction):
    """The executor may have been held up, by a link that was opened or by a machine that stood still."""
    world.picture(instruction("STOP UP 5 GO"))
    world.now_s += 1.5
    world.run(0.05)
    assert world.last == ("refused", "it waited for more than 1 s; sign it again")
    assert world.vehicle.orders == []


def test_a_sentence_that_leaves_the_task_running_does_not_steer(make_world, instruction):
    world = make_world(
        BASE
        + '[[instruction]]\naction = "SNAP"\nsteps = [{mode = ["A"]}, {camera = 100}]\n'
        + '[[instruction]]\naction = "UP"\nsteps = [{stick = {z = 1}}]\n'
    )
    for text in ("CONTD SNAP GO", "CONTD UP 5 GO"):
        world.sign(instruction(text))
        assert world.last == ("refused", "it steers the vehicle, which CONTD leaves alone")
    assert world.vehicle.orders == world.vehicle.sticks == []
