"""What the map of instructions sends by MAVLink, and what is answered to it."""

import time

import pytest
from pymavlink.dialects.v20 import common

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.fsm import Rejected
from lightgesture.sinks import make_sinks
from lightgesture.sinks.mavlink import MavlinkSink
from lightgesture.sinks.mavlink_map import COMMANDS, MavlinkMap, load_map
from tests.app.sinks.mavlink_station import send

FORBIDDEN = (
    "ARM_DISARM",
    "PREARM",
    "FLIGHTTERMINATION",
    "SET_MODE",
    "MISSION_START",
    "REBOOT",
    "AUX_FUNCTION",
    "LAND",
)


def test_values_that_the_map_names(station, instruction, mapping):
    send(station.link, instruction(), instruction(duration_s=None), mapping=mapping)
    values = [message for message in station.messages() if message.get_type() != "STATUSTEXT"]
    assert [message.get_type() for message in values] == ["NAMED_VALUE_INT", "NAMED_VALUE_FLOAT"] * 2
    assert [message.name for message in values] == ["LG_HOVER", "LG_SURE"] * 2
    assert [message.value for message in values] == pytest.approx([50, 0.95, -1, 0.95])
    assert {message.time_boot_ms for message in values} == {4370}


def test_rules_for_one_parameter(station, instruction, mapping):
    setting = {"action": "PARAM", "parameter": 3, "duration_s": None}
    send(
        station.link,
        instruction(**setting, change="INCREASE"),
        instruction(**setting, change="DECREASE"),
        mapping=mapping,
    )
    assert [message.get_type() for message in station.messages()] == [
        "STATUSTEXT",
        "STATUSTEXT",
        "NAMED_VALUE_INT",
    ]


def test_commands_that_the_map_names(station, instruction, mapping):
    send(station.link, instruction(action="SNAP"), instruction(action="EXEC", program=2), mapping=mapping)
    snap, execute = (one for one in station.messages() if one.get_type() == "COMMAND_LONG")
    assert (snap.target_system, snap.target_component, snap.command) == (7, 2, 2000)
    assert [snap.param1, snap.param2, snap.param3, snap.param7] == [0, 0.5, 1, 0]
    assert (execute.command, execute.param1, execute.param2) == (31010, 2, 50)


def test_nothing_that_may_be_sent_arms_or_disarms(tmp_path):
    """Every permitted number is what the dialect calls so; everything else is refused, arming by all its names."""
    assert {name: getattr(common, name) for name in COMMANDS} == COMMANDS
    every = [name for name in vars(common) if name.startswith("MAV_CMD_")]
    dangerous = [name for name in every if any(word in name for word in FORBIDDEN)]
    assert "MAV_CMD_COMPONENT_ARM_DISARM" in dangerous
    assert not set(dangerous) & set(COMMANDS)
    path = tmp_path / "map.toml"
    for name in (*dangerous, "400", "mav_cmd_component_arm_disarm"):
        path.write_text(f'[[command]]\naction = "HOVER"\ncommand = "{name}"\n')
        with pytest.raises(UsageError, match="is not permitted; permitted are"):
            load_map(str(path))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[[command]]\naction = 'A'\ncommand = 400\n", "command.0.command: Input should be a valid string"),
        (
            "[[command]]\naction = 'A'\ncommand = 'MAV_CMD_USER_1'\nparams = [1,2,3,4,5,6,7,8]\n",
            "at most 7 items",
        ),
        ("[[value]]\naction = 'A'\nname = 'ELEVENCHARS'\nvalue = 1\n", "at most 10 characters"),
        ("[[value]]\naction = 'A'\nname = 'N'\nvalue = 'words'\n", "value.0.value"),
        ("[[value]]\naction = 'A'\nname = 'N'\nvalue = nan\n", "finite number"),
        ("[[value]]\nname = 'N'\nvalue = 1\n", "value.0.action: Field required"),
        ("target_sytem = 1\n", "target_sytem: unknown key; did you mean 'target_system'?"),
        ("target_system = 0\n", "target_system"),
        (
            "[[value]]\naction = 'A'\nname = 'N'\nvalue = 1\nprgram = 2\n",
            "value.0.prgram: unknown key; did you mean 'program'?",
        ),
        ("target_system = \n", "TOML syntax"),
    ],
)
def test_maps_that_are_wrong(tmp_path, text, reason):
    path = tmp_path / "map.toml"
    path.write_text(text)
    with pytest.raises(UsageError) as caught:
        load_map(str(path))
    assert str(caught.value).startswith(f"{path}: ")
    assert reason in str(caught.value)
    assert "\n" not in str(caught.value)


def test_no_map(tmp_path):
    with pytest.raises(UsageError, match="no such file; name an existing map"):
        load_map(str(tmp_path / "none.toml"))
    with pytest.raises(UsageError, match="--mavlink-map: is of no use without --mavlink"):
        make_sinks(DecodeSettings(mavlink_map="map.toml"))


def test_a_map_of_nothing_sends_nothing(instruction):
    assert list(MavlinkMap().values(instruction())) == list(MavlinkMap().commands(instruction())) == []


@pytest.fixture
def sink_with_map(station, mapping):
    """A sink on a clock that a test winds, and what it told of the vehicle's answers."""
    now, told = [100.0], []
    sink = MavlinkSink(station.link, mapping, tell=told.append, clock=lambda: now[0])
    sink.open()
    yield sink, now, told
    sink.close()


def test_refusals_of_the_maps_commands_are_told(station, instruction, sink_with_map):
    sink, now, told = sink_with_map
    sink.send(instruction(action="SNAP", text="CONTD SNAP GO"))
    _, address = station.socket.recvfrom(65536)  # the text
    for _ in range(2):
        now[0] += 0.8
        sink.poll()
    sent = [message for message in station.messages() if message.get_type() == "COMMAND_LONG"]
    assert [message.confirmation for message in sent] == [0, 1, 2]
    refusal = common.MAVLink_command_ack_message(2000, 3, 0, 0, 7, 191)
    station.socket.sendto(refusal.pack(common.MAVLink(None, 7, 2)), address)
    time.sleep(0.05)
    sink.poll()
    (record,) = told
    assert (record.state, record.instruction, record.detail) == (
        "refused",
        "CONTD SNAP GO",
        "MAV_CMD_IMAGE_START_CAPTURE: unsupported",
    )
    assert record.time_s == now[0]
    sink.send(record)
    text = station.messages()[-2:]
    assert "".join(message.text for message in text if message.get_type() == "STATUSTEXT").startswith(
        "Vehicle: refused CONTD SNAP GO"
    )


def test_of_two_alike_each_gets_its_own_answer(station, instruction, sink_with_map):
    sink, _, told = sink_with_map
    for text in ("first", "second"):
        sink.send(instruction(action="SNAP", text=text))
    _, address = station.socket.recvfrom(65536)
    for result in (4, 0):
        message = common.MAVLink_command_ack_message(2000, result, 0, 0, 7, 191)
        station.socket.sendto(message.pack(common.MAVLink(None, 7, 2)), address)
    time.sleep(0.05)
    sink.poll()
    assert [(record.state, record.instruction) for record in told] == [
        ("refused", "first"),
        ("accepted", "second"),
    ]


def test_commands_that_nobody_answers_are_told(station, instruction, sink_with_map):
    sink, now, told = sink_with_map
    sink.send(instruction(action="EXEC", program=2, text="STOP EXEC 2 GO"))
    for _ in range(6):
        now[0] += 0.8
        sink.poll()
    assert [(record.state, record.detail) for record in told] == [
        ("refused", "MAV_CMD_USER_1: no answer to 4 tries")
    ]


def test_rejections_are_texts_a_few_at_a_time(station, instruction, sink_with_map):
    sink, now, _ = sink_with_map
    rejection = Rejected(source="cam", frame=1, time_s=1.0, reason="limit", text="STOP GO", detail="why")
    for _ in range(10):
        sink.send(rejection)
        now[0] += 0.5
    sink.send(instruction(action="LEFT", text="STOP LEFT GO"))
    texts = [message.text for message in station.messages() if message.get_type() == "STATUSTEXT"]
    assert texts == ["Diver: rejected: STOP GO (why)"] * 3 + ["Diver: STOP LEFT GO"]


def test_the_vehicles_number_is_learnt(station, heartbeat, instruction):
    sink = MavlinkSink(station.link)
    sink.open()
    sink.send(heartbeat())
    _, address = station.socket.recvfrom(65536)
    beat = common.MAVLink_heartbeat_message(12, 3, 0, 0, 4, 3)
    station.socket.sendto(beat.pack(common.MAVLink(None, 42, 1)), address)
    time.sleep(0.05)
    sink.send(heartbeat())
    assert [message.get_srcSystem() for message in station.messages()] == [42]
    sink.close()


def test_commands_for_cameras_go_to_the_camera(tmp_path, station, instruction):
    path = tmp_path / "map.toml"
    path.write_text(
        '[[command]]\naction = "SNAP"\ncommand = "MAV_CMD_IMAGE_START_CAPTURE"\n'
        '[[command]]\naction = "SNAP"\ncommand = "MAV_CMD_USER_1"\n'
        '[[command]]\naction = "SNAP"\ncommand = "MAV_CMD_USER_2"\ncomponent = 55\n'
    )
    send(station.link, instruction(action="SNAP"), mapping=load_map(str(path)))
    sent = [message for message in station.messages() if message.get_type() == "COMMAND_LONG"]
    assert [message.target_component for message in sent] == [100, 1, 55]
    assert {message.target_system for message in sent} == {1}
