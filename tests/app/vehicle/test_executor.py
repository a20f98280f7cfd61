"""What instructions become, on a vehicle that answers as a test tells it."""

import itertools

import pytest

from lightgesture.vehicle import (
    NEUTRAL,
    ReadParameter,
    SendCommand,
    SetMode,
    StartMission,
    TakePictures,
    WriteParameter,
)

BASE = 'name = "T"\n[modes]\nA = 1\nB = 2\n[safety]\nneeds_armed = false\n'


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


def pictured(number):
    from lightgesture.vehicle import Picture

    return Picture(number=number, place=f"/dcim/{number}.jpg")


def test_a_program_while_taking_pictures(world, instruction):
    """Scenario a of the paper: stop the task and execute a program while taking snapshots."""
    world.sign(instruction("STOP HOVER 50 GO"))
    world.sign(instruction("STOP EXEC 1 GO"))
    world.sign(instruction("CONTD SNAP GO"))
    assert [type(order) for order in world.vehicle.orders] == [SetMode, StartMission, TakePictures]
    assert world.vehicle.orders[2].count == 1
    world.vehicle.status["pictures"] = (pictured(7),)
    world.run(0.05)
    assert world.states("CONTD SNAP GO") == ["sent", "accepted", "executing", "executing", "done"]
    assert world.states("STOP HOVER 50 GO")[-1] == "aborted"
    assert world.executor.goes_on
    world.vehicle.status["item"] = 3
    world.run(0.05)
    assert world.states("STOP EXEC 1 GO") == ["sent", "accepted", "executing", "done"]
    assert world.vehicle.orders[-1] == SetMode(names=("POSHOLD", "ALT_HOLD"))


def test_a_mission_that_ends_in_another_mode_is_done(world, instruction):
    world.sign(instruction("STOP EXEC 1 GO"))
    world.vehicle.status.update(item=3, foreign_modes=1, mode="POSHOLD")
    world.run(0.05)
    assert world.states()[-1] == "done"


def test_pictures_of_one_kind_wait_for_each_other(world, instruction):
    for count in range(7):
        world.sign(instruction(f"CONTD SNAP {count + 1} GO"))
    assert sum(isinstance(order, TakePictures) for order in world.vehicle.orders) == 1
    assert world.states("CONTD SNAP 2 GO") == ["accepted"]
    assert world.last == ("refused", "4 others wait for SNAP already")


def test_a_camera_that_tells_of_no_picture(world, instruction):
    world.sign(instruction("CONTD SNAP 2 GO")).run(6)
    assert world.last == ("aborted", "camera 100 told of 0 of 2 pictures")


def test_own_frames_where_the_camera_takes_none(make_world, instruction, tmp_path):
    world = make_world(
        BASE
        + '[[instruction]]\naction = "SNAP"\nsteps = [{camera = 100, interval_s = 0.5, folder = "shots"}]\n'
    )
    world.vehicle.answer = lambda order: "no answer to 4 tries"
    world.sign(instruction("CONTD SNAP 2 GO")).run(2.2)
    wait_for(lambda: world.run(0.05).records[-1].state == "done")
    files = sorted((tmp_path / "shots").iterdir())
    assert len(files) == 4
    assert all(file.suffix == ".jpg" and file.read_bytes()[:2] == b"\xff\xd8" for file in files)
    details = [record.detail for record in world.records]
    assert "camera 100: no answer to 4 tries; our own frames instead" in details
    assert {str(file) for file in files} <= set(details)
    assert world.last[1] == f"4 of 4 own frames in {tmp_path / 'shots'}"


def test_own_frames_that_cannot_be_written(make_world, instruction, tmp_path):
    (tmp_path / "shots").write_text("a file in the way")
    world = make_world(BASE + '[[instruction]]\naction = "SNAP"\nsteps = [{camera = 0, folder = "shots"}]\n')
    world.sign(instruction("CONTD SNAP GO"))
    wait_for(lambda: world.run(0.05).records[-1].state in ("aborted", "refused"))
    assert "cannot be written" in world.last[1]


def wait_for(condition, tries=200):
    import time

    for _ in range(tries):
        if condition():
            return
        time.sleep(0.01)
    raise AssertionError("it did not come")


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


def test_pictures_of_a_vehicle_that_is_not_armed(world, instruction):
    world.vehicle.status["is_armed"] = False
    world.sign(instruction("CONTD SNAP GO"))
    assert world.states()[0] == "sent"


def test_no_fresh_picture(world, instruction):
    world.run(0.1)
    world.has_pictures = False
    world.run(1.5)
    world.executor.show(None, [instruction("STOP UP 5 GO")])
    world.run(0.05)
    assert world.last == ("refused", "no fresh picture")


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


def test_what_waited_for_pictures_is_refused_where_something_stands_against_it_by_then(world, instruction):
    world.sign(instruction("CONTD SNAP 5 GO")).run(1)
    world.sign(instruction("STOP FOLLOW GO"))
    world.vehicle.status["is_armed"] = False
    for number in range(5):
        world.vehicle.status["pictures"] = (pictured(number),)
        world.run(0.05)
    world.run(0.1)
    assert world.states("STOP FOLLOW GO") == ["accepted", "aborted"]
    assert world.last == ("aborted", "the vehicle is not armed, and only its pilot arms it")


def test_what_waited_for_pictures_is_dropped_by_the_next_instruction(world, instruction):
    world.sign(instruction("CONTD SNAP 5 GO")).run(1)
    world.sign(instruction("STOP FOLLOW GO"))
    world.sign(instruction("STOP HOVER 5 GO"))
    assert world.states("STOP FOLLOW GO") == ["accepted", "aborted"]
    for number in range(5):
        world.vehicle.status["pictures"] = (pictured(number),)
        world.run(0.05)
    assert not any(isinstance(order, SendCommand) for order in world.vehicle.orders)


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


def test_only_what_is_to_wait_for_pictures_does_and_only_where_some_are_taken(world, instruction):
    world.sign(instruction("STOP FOLLOW GO"))
    assert "sent" in world.states("STOP FOLLOW GO")
    world.sign(instruction("CONTD SNAP 5 GO")).sign(instruction("STOP HOVER 5 GO"))
    assert world.states("STOP HOVER 5 GO")[-1] == "executing"


@pytest.mark.parametrize(("ago_s", "is_held"), [(1.0, False), (2.5, True)])
def test_the_word_to_kill_leaves_the_mode_to_a_pilot_who_steers(world, instruction, ago_s, is_held):
    world.vehicle.status["pilot_s"] = world.now_s - ago_s
    world.sign(instruction("ABORT NOW", kind="kill", action="ABORT"))
    assert world.states("ABORT NOW") == ["done"]
    assert bool(world.vehicle.orders) == is_held


def test_pictures_are_refused_where_something_stands_against_them(world, instruction):
    world.vehicle.status["trouble"] = "two vehicles"
    world.sign(instruction("CONTD SNAP 5 GO"))
    assert world.last == ("refused", "two vehicles")
    assert world.vehicle.orders == []


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
