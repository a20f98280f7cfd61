"""The simulated vehicle moves as one in water does, and answers as ArduSub's firmware did when it was tried."""

import math

import pytest
from pymavlink.dialects.v20 import common

ACCEPTED, DENIED, UNSUPPORTED, FAILED = 0, 2, 3, 4
ALT_HOLD, AUTO, GUIDED, POSHOLD = 2, 3, 4, 16
NEUTRAL = (0, 0, 500, 0)


def test_it_floats_upright_and_rises_slowly_without_thrust(talk):
    motion = talk(mode=None).run(20)
    assert 0.5 < 2.0 - motion.depth_m < 2.0
    assert abs(motion.attitude[0]) < 0.02
    assert abs(motion.attitude[1]) < 0.02


def test_it_does_not_leave_the_water(talk):
    assert talk(mode=None).run(60).depth_m > -0.15


def test_it_holds_depth_and_heading_in_a_current_and_drifts_along(talk):
    from lightgesture.synth.pool.body import BodySpec

    motion = talk(spec=BodySpec(current_mps=(0.1, 0.0))).run(20)
    assert motion.depth_m == pytest.approx(2.0, abs=0.05)
    assert motion.heading_deg == pytest.approx(0.0, abs=1.0)
    assert motion.position[0] == pytest.approx(2.0, abs=0.5)


def test_it_holds_its_place_in_a_current(talk):
    from lightgesture.synth.pool.body import BodySpec

    motion = talk(POSHOLD, spec=BodySpec(current_mps=(0.1, -0.1))).run(30)
    assert math.hypot(*motion.position[:2]) < 0.1


@pytest.mark.parametrize(
    ("sticks", "moved"),
    [
        ((0, 0, 1000, 0), (0, 0, -1, 0)),
        ((0, 0, 0, 0), (0, 0, 1, 0)),
        ((600, 0, 500, 0), (1, 0, 0, 0)),
        ((0, 600, 500, 0), (0, 1, 0, 0)),
        ((0, -600, 500, 0), (0, -1, 0, 0)),
        ((0, 0, 500, 1000), (0, 0, 0, 1)),
    ],
)
def test_sticks_move_it_where_they_point_and_neutral_stops_it(talk, sticks, moved):
    one = talk()
    before, after = one.vehicle.motion, one.run(3, sticks)
    change = [now - then for now, then in zip(after.position, before.position, strict=True)]
    change.append(after.attitude[2] - before.attitude[2])
    assert [round(math.copysign(abs(part) > 0.3, part)) for part in change] == list(moved)
    stopped = one.run(4, NEUTRAL)
    assert max(map(abs, stopped.velocity)) < 0.1
    assert abs(stopped.rates[2]) < 0.02


def test_only_the_ground_station_has_sticks(talk):
    one = talk()
    one.run(3, (1000, 0, 500, 0), voice=one.companion)
    one.run(3, (1000, 0, 500, 0), voice=one.voice(7, 1))
    assert abs(one.vehicle.motion.position[0]) < 0.05


@pytest.mark.parametrize(
    ("command", "params", "result"),
    [
        ("MAV_CMD_NAV_LOITER_UNLIM", (), ACCEPTED),
        ("MAV_CMD_CONDITION_YAW", (90, 0, 0, 0), ACCEPTED),
        ("MAV_CMD_CONDITION_YAW", (-5,), FAILED),
        ("MAV_CMD_DO_CHANGE_SPEED", (1, 0.3), ACCEPTED),
        ("MAV_CMD_DO_MOUNT_CONTROL", (), ACCEPTED),
        ("MAV_CMD_NAV_LOITER_TIME", (5,), UNSUPPORTED),
        ("MAV_CMD_DO_PAUSE_CONTINUE", (), UNSUPPORTED),
        ("MAV_CMD_DO_DIGICAM_CONTROL", (), UNSUPPORTED),
        ("MAV_CMD_IMAGE_START_CAPTURE", (0, 1, 1), UNSUPPORTED),
        ("MAV_CMD_VIDEO_START_CAPTURE", (), UNSUPPORTED),
        ("MAV_CMD_USER_1", (), UNSUPPORTED),
        ("MAV_CMD_DO_SET_MODE", (1, GUIDED), ACCEPTED),
        ("MAV_CMD_DO_SET_MODE", (1, 77), FAILED),
        ("MAV_CMD_MISSION_START", (), ACCEPTED),
        ("MAV_CMD_REQUEST_MESSAGE", (148,), ACCEPTED),
    ],
)
def test_commands_are_answered_as_the_firmware_answers(talk, command, params, result):
    assert talk().command(getattr(common, command), *params) == result


def test_without_a_position_only_what_needs_none(talk):
    one = talk(has_position=False)
    assert [one.command(176, 1, mode) for mode in (POSHOLD, GUIDED, AUTO, ALT_HOLD)] == [FAILED] * 3 + [
        ACCEPTED
    ]
    assert one.command(common.MAV_CMD_NAV_LOITER_UNLIM) == FAILED
    one.run(2)
    assert one.messages("LOCAL_POSITION_NED") == []
    assert len(one.messages("VFR_HUD")) == 20


def test_a_position_that_is_lost_ends_what_needs_it(talk):
    one = talk(POSHOLD)
    one.run(1)
    one.vehicle.pilot.has_position = False
    one.run(2)
    assert one.vehicle.pilot.mode == ALT_HOLD
    assert one.messages("HEARTBEAT")[-2].custom_mode == ALT_HOLD  # the last one is the camera's


def test_the_old_message_for_modes_is_acknowledged_under_its_number(talk):
    one = talk()
    one.companion.set_mode_send(1, 1, POSHOLD)
    (answer,) = one.messages("COMMAND_ACK")
    assert (answer.command, answer.result) == (11, ACCEPTED)
    assert one.vehicle.pilot.mode == POSHOLD


def test_what_is_meant_for_another_vehicle_is_not_taken(talk):
    one = talk(system=4)
    one.companion.command_long_send(1, 1, 176, 0, 1, POSHOLD, 0, 0, 0, 0, 0)
    one.pilot.manual_control_send(1, 1000, 0, 500, 0, 0)
    assert one.messages("COMMAND_ACK") == []
    assert one.vehicle.pilot.sticks.forward == 0.0
    one.run(1)
    assert {message.get_srcSystem() for message in one.messages("HEARTBEAT")} == {4}


def test_it_says_whether_it_is_armed(talk):
    one = talk(mode=None)
    one.run(0.1)
    assert one.command(400, 1, voice=one.pilot) == ACCEPTED
    one.run(1.1)
    first, *_, last = [beat for beat in one.messages("HEARTBEAT") if beat.get_srcComponent() == 1]
    assert [beat.base_mode >> 7 for beat in (first, last)] == [0, 1]
    assert (last.type, last.autopilot) == (common.MAV_TYPE_SUBMARINE, common.MAV_AUTOPILOT_ARDUPILOTMEGA)


def test_parameters(talk):
    one = talk()
    one.companion.param_request_list_send(1, 1)
    every = one.messages("PARAM_VALUE")
    assert [value.param_index for value in every] == list(range(every[0].param_count))
    one.companion.param_set_send(1, 1, b"WPNAV_SPEED", 30, 9)
    one.companion.param_request_read_send(1, 1, b"WPNAV_SPEED", -1)
    assert [value.param_value for value in one.messages("PARAM_VALUE")] == [30, 30]
    one.companion.param_set_send(1, 1, b"NO_SUCH", 30, 9)
    assert one.messages("PARAM_VALUE") == []


def test_a_program_of_the_mission_is_flown_from_its_first_item_to_its_end(talk):
    one = talk()
    start = one.vehicle.program_items[1]
    one.companion.mission_set_current_send(1, 1, start)
    assert one.messages("MISSION_CURRENT")[-1].seq == start
    assert one.command(176, 1, AUTO) == ACCEPTED
    one.run(5)
    assert math.hypot(*one.vehicle.motion.position[:2]) > 0.8
    motion = one.run(20)
    assert math.hypot(*motion.position[:2]) < 0.15
    assert [item.seq for item in one.messages("MISSION_ITEM_REACHED")] == list(range(start, start + 4))
    assert one.vehicle.pilot.mode == AUTO


def test_a_mission_goes_up_and_down(talk):
    one = talk()
    one.companion.mission_count_send(1, 1, 2)
    for number, command in enumerate((16, 93)):
        assert one.messages("MISSION_REQUEST_INT")[-1].seq == number
        one.companion.mission_item_int_send(
            1, 1, number, 3, command, 0, 1, 5, 0, 0, 0, 449740000, -932277000, -2
        )
    assert one.messages("MISSION_ACK")[-1].type == 0
    one.companion.mission_request_list_send(1, 1)
    assert one.messages("MISSION_COUNT")[-1].count == 2
    one.companion.mission_request_int_send(1, 1, 1)
    (item,) = one.messages("MISSION_ITEM_INT")
    assert (item.seq, item.command, item.param1, item.x) == (1, 93, 5, 449740000)
    one.companion.mission_set_current_send(1, 1, 2)
    assert one.messages("MISSION_ACK")[-1].type == common.MAV_MISSION_INVALID_SEQUENCE
    one.companion.mission_clear_all_send(1, 1)
    assert one.command(176, 1, AUTO) == FAILED


def test_the_camera_is_a_component_of_its_own(talk):
    one = talk()
    assert one.command(common.MAV_CMD_IMAGE_START_CAPTURE, 0, 0, 0, component=100) == DENIED
    assert one.command(common.MAV_CMD_IMAGE_START_CAPTURE, 0, 0.5, 3, component=100) == ACCEPTED
    assert one.command(common.MAV_CMD_NAV_LOITER_UNLIM, component=100) == UNSUPPORTED
    one.run(5)
    pictures = one.messages("CAMERA_IMAGE_CAPTURED")
    assert [picture.image_index for picture in pictures] == [0, 1, 2]
    assert {picture.get_srcComponent() for picture in pictures} == {100}
    times_s = [picture.time_s for picture in one.vehicle.front.camera.taken]
    assert [time_s - times_s[0] for time_s in times_s] == pytest.approx([0.0, 0.5, 1.0], abs=0.03)
    one.command(common.MAV_CMD_IMAGE_START_CAPTURE, 0, 1, 0, component=100)
    one.run(3.5)
    one.command(common.MAV_CMD_IMAGE_STOP_CAPTURE, component=100)
    one.run(3)
    assert len(one.messages("CAMERA_IMAGE_CAPTURED")) == 4


@pytest.mark.parametrize(
    ("action", "mode", "is_armed"), [(0, 16, True), (1, 16, True), (2, 16, False), (3, 2, True), (4, 9, True)]
)
def test_the_ground_station_is_lost(talk, action, mode, is_armed):
    one = talk(POSHOLD)
    one.vehicle.pilot.parameters["FS_GCS_ENABLE"] = action
    one.pilot.heartbeat_send(6, 8, 0, 0, 4)
    one.run(4.5)
    assert (one.vehicle.pilot.mode, one.vehicle.pilot.is_armed) == (POSHOLD, True)
    one.run(1)
    assert (one.vehicle.pilot.mode, one.vehicle.pilot.is_armed) == (mode, is_armed)
    assert len(one.messages("STATUSTEXT")) == (action > 0)
    one.pilot.heartbeat_send(6, 8, 0, 0, 4)
    one.run(1)
    assert one.vehicle.pilot.mode == mode  # it does not go back by itself


def test_sticks_that_fall_silent_become_neutral(talk):
    one = talk()
    one.run(1, (1000, 0, 500, 0))
    one.run(2.5)
    assert one.vehicle.motion.velocity[0] > 0.4
    one.run(4)
    assert one.vehicle.motion.velocity[0] < 0.1
    assert [text.text for text in one.messages("STATUSTEXT")] == ["Lost manual control"]


def test_bytes_that_are_no_packets(talk):
    one = talk()
    for content in (b"", b"\xfd" * 300, bytes(range(256)) * 4):
        one.write(content)
    assert one.command(common.MAV_CMD_NAV_LOITER_UNLIM) == ACCEPTED
