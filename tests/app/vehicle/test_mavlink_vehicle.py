"""A vehicle by MAVLink: what it is asked, how often, and what its answers become."""

import math
import time

import pytest
from pymavlink.dialects.v20 import common

from lightgesture.vehicle import (
    ReadParameter,
    SendCommand,
    SendValue,
    SetMode,
    StartMission,
    Stick,
    StopPictures,
    TakePictures,
    WriteParameter,
)

USER_1 = SendCommand(name="MAV_CMD_USER_1", command=31010, params=(5.0,) + (0.0,) * 6, component=1)


@pytest.fixture
def quick(tmp_path):
    """A profile that waits for nothing longer than it must."""
    path = tmp_path / "quick.toml"
    path.write_text(
        'name = "Q"\n[modes]\nMANUAL = 19\nALT_HOLD = 2\nPOSHOLD = 16\nAUTO = 3\n'
        "[link]\nanswer_s = 0.1\ntries = 3\nprogress_s = 1\ntimeout_s = 1.5\n"
        '[safety]\npilot_channels = [3, 4, 5, 6]\n[[instruction]]\naction = "HOVER"\nsteps = [{wait = 1}]\n'
    )
    return str(path)


@pytest.fixture
def boat(make_boat, quick):
    return make_boat(profile=quick)


def commands(autopilot, number):
    return [message for message in autopilot.of_type("COMMAND_LONG") if message.command == number]


def test_a_mode_is_entered_and_seen(boat, autopilot):
    autopilot.has_position = True
    reply = boat.order(SetMode(names=("POSHOLD", "ALT_HOLD")))
    assert (reply.state, reply.detail) == ("accepted", "mode POSHOLD")
    assert (boat.status.mode, boat.status.foreign_modes) == ("POSHOLD", 0)
    (command,) = commands(autopilot, common.MAV_CMD_DO_SET_MODE)
    assert (command.get_srcSystem(), command.get_srcComponent()) == (1, 191)
    assert (command.target_component, command.param1, command.param2) == (1, 1, 16)


def test_a_heartbeat_is_asked_for_where_a_mode_is_awaited(boat, autopilot, monkeypatch):
    autopilot.BEAT_S = 60
    boat.until(lambda: True)

    def on_command(message):
        if message.command == common.MAV_CMD_REQUEST_MESSAGE and message.param1 == 0:
            autopilot.beat()
        elif message.command == common.MAV_CMD_DO_SET_MODE:
            autopilot.mode = int(message.param2)
            autopilot.acknowledge(message, 0)

    monkeypatch.setattr(autopilot, "_on_command_long", on_command)
    assert boat.order(SetMode(names=("ALT_HOLD",)), seconds=1).state == "accepted"


def test_without_a_position_the_next_mode_is_entered(boat, autopilot):
    reply = boat.order(SetMode(names=("POSHOLD", "ALT_HOLD")))
    assert (reply.state, reply.detail) == ("accepted", "mode ALT_HOLD (POSHOLD failed)")
    assert boat.status.mode == "ALT_HOLD"


def test_the_old_message_where_the_command_is_not_known(boat, autopilot):
    autopilot.knows_set_mode = False
    reply = boat.order(SetMode(names=("ALT_HOLD",)))
    assert (reply.state, reply.detail) == ("accepted", "mode ALT_HOLD by SET_MODE")
    (message,) = autopilot.of_type("SET_MODE")
    assert (message.base_mode, message.custom_mode) == (1, 2)


def test_a_mode_that_is_accepted_and_not_entered(boat, autopilot, monkeypatch):
    monkeypatch.setattr("lightgesture.vehicle.mavlink_modes.SHOWN_S", 0.2)
    autopilot.takes_mode = False
    reply = boat.order(SetMode(names=("ALT_HOLD",)))
    assert (reply.state, reply.detail) == ("refused", "ALT_HOLD is not entered")


def test_a_mode_that_another_changes(boat, autopilot):
    boat.order(SetMode(names=("ALT_HOLD",)))
    autopilot.mode = 0
    boat.until(lambda: boat.status.mode == "0")
    assert boat.status.foreign_modes == 1


def test_a_command_that_nobody_answers_is_sent_again_with_higher_confirmation(boat, autopilot):
    autopilot.results[31010] = []
    reply = boat.order(USER_1)
    assert (reply.state, reply.detail) == ("refused", "no answer to 3 tries")
    assert [message.confirmation for message in commands(autopilot, 31010)] == [0, 1, 2]


def test_a_command_that_is_lost_once_is_done_once(boat, autopilot):
    autopilot.results[31010] = []
    reply = boat.vehicle.order(USER_1, time.monotonic())
    boat.until(lambda: len(commands(autopilot, 31010)) == 1)
    autopilot.results[31010] = [0, 4]  # and then answers twice
    boat.until(lambda: reply.state != "pending")
    boat.until(lambda: True)
    assert reply.state == "accepted"
    assert len(commands(autopilot, 31010)) == 2


@pytest.mark.parametrize(
    ("result", "reason"),
    [(1, "temporarily rejected"), (2, "denied"), (3, "unsupported"), (4, "failed"), (77, "result 77")],
)
def test_refusals_have_names(boat, autopilot, result, reason):
    autopilot.results[31010] = [result]
    reply = boat.order(USER_1)
    assert (reply.state, reply.detail) == ("refused", reason)


def test_in_progress_is_waited_for_and_not_sent_again(boat, autopilot):
    autopilot.results[31010] = [5]
    reply = boat.vehicle.order(USER_1, time.monotonic())
    end_s = time.monotonic() + 0.5
    boat.until(lambda: time.monotonic() > end_s)
    assert reply.state == "pending"
    assert len(commands(autopilot, 31010)) == 1
    autopilot.send(common.MAVLink_command_ack_message(31010, 0, 0, 0, 1, 191))
    boat.until(lambda: reply.state == "accepted")


def test_in_progress_without_an_end(boat, autopilot):
    autopilot.results[31010] = [5]
    reply = boat.order(USER_1)
    assert (reply.state, reply.detail) == ("refused", "in progress, then no further word")
    assert len(commands(autopilot, 31010)) == 1


def test_answers_for_another_or_by_another_do_not_count(boat, autopilot):
    autopilot.results[31010] = []
    reply = boat.vehicle.order(USER_1, time.monotonic())
    ack = common.MAVLink_command_ack_message
    for message, system, component in (
        (ack(31010, 0, 0, 0, 1, 200), 1, 1),  # for another companion
        (ack(31010, 0, 0, 0, 9, 191), 1, 1),  # for another system
        (ack(31010, 0, 0, 0, 1, 191), 1, 100),  # by a camera
        (ack(31010, 0, 0, 0, 1, 191), 7, 1),  # by another vehicle
        (ack(31011, 0, 0, 0, 1, 191), 1, 1),  # to another command
    ):
        autopilot.send(message, system, component)
    boat.until(lambda: reply.state != "pending")
    assert reply.state == "refused"


def test_parameters_are_read_back(boat, autopilot):
    assert boat.order(ReadParameter(name="PILOT_SPEED_UP")).value == 50
    reply = boat.order(WriteParameter(name="PILOT_SPEED_UP", value=60.5))
    assert (reply.state, reply.value) == ("accepted", 60.5)
    assert autopilot.params == {"PILOT_SPEED_UP": 60.5}


def test_a_parameter_that_does_not_exist(boat):
    reply = boat.order(ReadParameter(name="NO_SUCH"))
    assert (reply.state, reply.detail) == ("refused", "no answer; the vehicle may not have such a parameter")


def test_a_parameter_that_does_not_keep_what_is_set(boat, autopilot, monkeypatch):
    monkeypatch.setattr(autopilot, "_on_param_set", lambda message: autopilot._tell_param(message.param_id))
    reply = boat.order(WriteParameter(name="PILOT_SPEED_UP", value=60))
    assert (reply.state, reply.detail) == ("refused", "is 50 after it was set to 60")


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_parameter_that_is_no_number_is_refused(boat, autopilot, value):
    autopilot.params["PILOT_SPEED_UP"] = value
    reply = boat.order(ReadParameter(name="PILOT_SPEED_UP"))
    assert (reply.state, reply.detail) == ("refused", "the vehicle says that it is no number")


def test_a_mission_is_counted_and_begun_at_its_item(boat, autopilot):
    reply = boat.order(StartMission(first=2, last=None, mode="AUTO"))
    assert (reply.state, reply.value) == ("accepted", 5)
    assert autopilot.mode == 3
    assert [message.seq for message in autopilot.of_type("MISSION_SET_CURRENT")] == [2]
    assert len(autopilot.of_type("MISSION_ACK")) == 1
    autopilot.send(common.MAVLink_mission_item_reached_message(5))
    boat.until(lambda: boat.status.item == 5)


@pytest.mark.parametrize(("items", "item"), [(0, 2), (2, 2), (4, 4)])
def test_a_mission_that_is_not_loaded(boat, autopilot, items, item):
    autopilot.items = items
    reply = boat.order(StartMission(first=2, last=4, mode="AUTO"))
    assert reply.state == "refused"
    assert reply.detail.endswith(f"of the mission is not loaded; the vehicle has {items}")
    assert autopilot.mode == 19
    assert autopilot.of_type("MISSION_SET_CURRENT") == []


def test_pictures_by_the_camera(boat, autopilot):
    autopilot.results[2000] = [0, 0]
    autopilot.results[2001] = [0]
    assert boat.order(TakePictures(component=100, interval_s=0.5, count=4)).state == "accepted"
    assert boat.order(TakePictures(component=100, interval_s=0.5, count=1)).state == "accepted"
    many, one = commands(autopilot, 2000)
    assert (many.target_component, many.param2, many.param3, many.param4) == (100, 0.5, 4, 0)
    assert (one.param2, one.param3, one.param4) == (0, 1, 2)
    captured = common.MAVLink_camera_image_captured_message(
        *(0, 0, 0, 0, 0, 0, 0, [0] * 4, 3, 1, b"/dcim/3.jpg")
    )
    autopilot.send(captured, component=100)
    boat.until(lambda: boat.status.pictures)
    assert (boat.status.pictures[0].number, boat.status.pictures[0].place) == (3, "/dcim/3.jpg")
    boat.until(lambda: not boat.status.pictures)
    assert boat.order(StopPictures(component=100)).state == "accepted"


def test_a_camera_that_is_not_there(boat, autopilot):
    autopilot.results[2000] = []
    assert boat.order(TakePictures(component=100, interval_s=1, count=1)).detail == "no answer to 3 tries"


def test_values_are_sent_and_not_awaited(boat, autopilot):
    assert boat.order(SendValue(name="LG_FOLLOW", value=3.0)).state == "accepted"
    assert boat.order(SendValue(name="LG_SURE", value=0.5)).state == "accepted"
    boat.until(lambda: len(autopilot.of_type("NAMED_VALUE_INT", "NAMED_VALUE_FLOAT")) == 2)


def test_sticks_are_sent_as_from_the_ground_station(boat, autopilot):
    boat.vehicle.stick(Stick(x=0.5, y=-1, z=0.2, r=0.1), time.monotonic())
    boat.until(lambda: autopilot.sticks())
    ((_, _, _, message),) = autopilot.sticks()
    assert (message.get_srcSystem(), message.get_srcComponent(), message.target) == (255, 191, 1)
    assert (message.x, message.y, message.z, message.r, message.buttons) == (500, -1000, 600, 100, 0)


def pilot(x=0, y=0, z=500, r=0):
    return common.MAVLink_manual_control_message(1, x, y, z, r, 0)


def test_a_pilot_is_seen_by_sticks_and_by_channels(boat, autopilot):
    autopilot.send(pilot(x=50), 255, 190)
    boat.until(lambda: boat.status.stick_s is not None)
    assert boat.status.pilot_s is None
    autopilot.send(pilot(z=700, r=-32768), 255, 190)
    boat.until(lambda: boat.status.pilot_s is not None)
    first_s = boat.status.pilot_s
    channels = [1500] * 18
    channels[2] = 1100  # where it rests without a pilot
    autopilot.send(common.MAVLink_rc_channels_message(199_900, 18, *channels, 0))
    channels[0] = 1900  # pitch, which is not among those of the profile
    autopilot.send(common.MAVLink_rc_channels_message(200_000, 18, *channels, 0))
    channels[4] = 1600
    autopilot.send(common.MAVLink_rc_channels_message(200_100, 18, *channels, 0))
    boat.until(lambda: boat.status.pilot_s > first_s)
    second_s = boat.status.pilot_s
    autopilot.send(common.MAVLink_rc_channels_override_message(1, 1, *[1500] * 5, 1200, 0, 0), 255, 190)
    boat.until(lambda: boat.status.pilot_s > second_s)


def test_our_own_push_is_no_pilot(boat, autopilot):
    boat.vehicle.stick(Stick(z=1), time.monotonic())
    autopilot.send(pilot(z=1000), 255, 191)
    autopilot.send(common.MAVLink_rc_channels_message(200_000, 18, *[1900] * 18, 0))
    autopilot.mode = 2
    boat.until(lambda: boat.status.mode == "ALT_HOLD")
    assert boat.status.pilot_s is None


def test_the_vehicle_has_any_number(make_boat, autopilot, quick):
    autopilot.system = 42
    boat = make_boat(profile=quick)
    assert boat.order(SetMode(names=("ALT_HOLD",))).state == "accepted"
    command = autopilot.of_type("COMMAND_LONG")[0]
    assert (command.target_system, command.get_srcSystem()) == (42, 42)


def test_two_vehicles_unless_one_is_named(make_boat, autopilot, quick):
    boat, named = make_boat(profile=quick), make_boat(profile=quick, system=1)
    other = common.MAVLink_heartbeat_message(12, 3, 1, 0, 4, 3)
    autopilot.send(other, system=7)
    boat.until(lambda: boat.status.trouble)
    assert boat.status.trouble == "systems 1 and 7 are on the link; name one by --mavlink-system"
    named.until(lambda: True)
    assert named.status.trouble == ""


def test_a_vehicle_that_changes_its_number(boat, autopilot):
    autopilot.system = 9
    boat.until(lambda: boat.status.trouble)
    boat.until(lambda: not boat.status.trouble)
    assert boat.order(SetMode(names=("ALT_HOLD",))).state == "accepted"
    assert autopilot.of_type("COMMAND_LONG")[-1].target_system == 9


def test_a_ground_station_and_a_camera_are_no_vehicles(boat, autopilot):
    autopilot.send(common.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3), 255, 190)
    autopilot.send(common.MAVLink_heartbeat_message(30, 8, 0, 0, 4, 3), 1, 100)
    autopilot.mode = 2
    boat.until(lambda: boat.status.mode == "ALT_HOLD")
    assert boat.status.trouble == ""
    assert boat.status.rival_s is None


def test_a_second_companion_with_our_number(boat, autopilot):
    autopilot.send(common.MAVLink_heartbeat_message(18, 8, 0, 0, 4, 3), 1, 191)
    boat.until(lambda: boat.status.rival_s is not None)


def test_a_vehicle_that_starts_anew(boat, autopilot):
    boat.until(lambda: boat.status.boots == 0)
    autopilot.boot_s = time.monotonic()
    boat.until(lambda: boat.status.boots == 1)


def test_a_clock_that_jumps_changes_nothing(boat, autopilot, monkeypatch):
    real = time.time
    monkeypatch.setattr(time, "time", lambda: real() - 86_400)
    assert boat.order(SetMode(names=("ALT_HOLD",))).state == "accepted"
    monkeypatch.setattr(time, "time", lambda: real() + 86_400)
    assert boat.order(SetMode(names=("MANUAL",))).state == "accepted"


def test_noise_on_the_link_is_passed_over(boat, autopilot):
    for peer in autopilot.peers:
        autopilot.socket.sendto(b"\xfd\x09garbage" * 20, peer)
    assert boat.order(SetMode(names=("ALT_HOLD",))).state == "accepted"


def test_nothing_that_is_sent_arms_or_disarms(boat, autopilot):
    autopilot.knows_set_mode = False
    boat.order(SetMode(names=("ALT_HOLD",)))
    boat.order(StartMission(first=0, last=None, mode="AUTO"))
    sent = [message for _, message in autopilot.heard]
    assert common.MAV_CMD_COMPONENT_ARM_DISARM not in {getattr(one, "command", None) for one in sent}
    assert not any(getattr(one, "base_mode", 0) & 128 for one in sent)
    assert not any(getattr(one, "buttons", 0) for one in sent)


@pytest.mark.parametrize(
    ("first", "last", "items", "state"),
    [(2, 2, 3, "accepted"), (2, 2, 2, "refused"), (2, None, 3, "accepted"), (0, 0, 1, "accepted")],
)
def test_a_part_of_a_mission_may_be_one_item(boat, autopilot, first, last, items, state):
    autopilot.items = items
    assert boat.order(StartMission(first=first, last=last, mode="AUTO")).state == state
