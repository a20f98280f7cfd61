"""An executor that takes pictures or waits for them: with the camera, with its own frames, and where none come."""

from lightgesture.vehicle import (
    SendCommand,
    SetMode,
    StartMission,
    TakePictures,
)
from tests.app.vehicle.made_up import BASE, pictured, wait_for


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


def test_only_what_is_to_wait_for_pictures_does_and_only_where_some_are_taken(world, instruction):
    world.sign(instruction("STOP FOLLOW GO"))
    assert "sent" in world.states("STOP FOLLOW GO")
    world.sign(instruction("CONTD SNAP 5 GO")).sign(instruction("STOP HOVER 5 GO"))
    assert world.states("STOP HOVER 5 GO")[-1] == "executing"


def test_pictures_are_refused_where_something_stands_against_them(world, instruction):
    world.vehicle.status["trouble"] = "two vehicles"
    world.sign(instruction("CONTD SNAP 5 GO"))
    assert world.last == ("refused", "two vehicles")
    assert world.vehicle.orders == []
