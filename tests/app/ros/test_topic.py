"""What is the same in ROS 1 and 2, without either: pictures in, records out, parameters."""

import json
import threading
import time
from types import SimpleNamespace

import cv2
import numpy as np
import pytest

from lightgesture.cli import main
from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import ExitStatus, UsageError
from lightgesture.fsm import Notice, State
from lightgesture.records import FrameRecord, HeartbeatRecord
from lightgesture.ros.listener import OK, STALE, WARN, RosListener
from lightgesture.ros.running import parameter_names, refuse_useless, run_topic, settings_with
from lightgesture.ros.source import HEADERS_KEPT, TopicSource
from tests.makers import hover

GREY = np.full((48, 64, 3), 90, np.uint8)
JPEG = cv2.imencode(".jpg", GREY)[1].tobytes()


def header(number):
    return SimpleNamespace(stamp=SimpleNamespace(sec=number, nanosec=5), frame_id="camera")


def compressed(number=0, content=JPEG):
    return SimpleNamespace(header=header(number), format="jpeg", data=content)


def raw(number=0, **changes):
    fields = {
        "height": 48,
        "width": 64,
        "step": 192,
        "encoding": "rgb8",
        "is_bigendian": 0,
        "data": GREY.tobytes(),
    }
    return SimpleNamespace(header=header(number), **{**fields, **changes})


class Wire:
    """Keeps what is published."""

    def __init__(self, is_watched=False):
        self.is_watched = is_watched
        self.published, self.pictures, self.health = [], [], []
        self.drawn = threading.Event()

    def text(self, name, value):
        self.published.append((name, value))

    number = text

    def picture(self, jpeg, header):
        self.pictures.append((jpeg, header))
        self.drawn.set()

    def diagnostics(self, level, message, values):
        self.health.append((level, message, values))


@pytest.fixture
def source():
    told = []
    one = TopicSource("/camera", told.append)
    one.told = told
    return one


def beat(frames, dropped=0):
    return HeartbeatRecord(
        source="s", time_s=1.0, frames=frames, dropped=dropped, ms_per_frame=2.0, state="idle"
    )


def test_only_the_newest_message_is_taken(source):
    for number in range(3):
        source.put(compressed(number))
    stream = iter(source)
    assert next(stream) == JPEG
    assert source.header_of(0).stamp.sec == 2
    source.end()
    assert list(stream) == []


def test_raw_pictures_are_converted_and_what_is_none_is_told_once(source):
    stream = iter(source)
    source.put(raw())
    assert next(stream).tolist() == GREY.tolist()
    for number in range(3):
        source.put(raw(encoding="hsv8"))
        threading.Timer(0.05, source.put, [raw(number)]).start()
        assert next(stream).shape == GREY.shape
    assert len(source.told) == 1
    assert source.told[0].startswith("/camera: a picture has encoding 'hsv8', known are")


def test_headers_of_old_pictures_are_forgotten(source):
    stream = iter(source)
    for number in range(HEADERS_KEPT + 2):
        source.put(compressed(number))
        next(stream)
    assert source.header_of(0) is source.header_of(None) is None
    assert source.header_of(HEADERS_KEPT + 1).stamp.sec == HEADERS_KEPT + 1


@pytest.mark.parametrize(
    ("changes", "number"),
    [
        ({}, 50),
        ({"duration_s": None}, -1),
        ({"action": "EXEC", "duration_s": None, "program": 0}, 0),
        ({"action": "PARAM", "duration_s": None, "parameter": 3, "change": "DECREASE"}, 3),
    ],
)
def test_an_instruction_is_published_whole_and_in_parts(source, changes, number):
    wire = Wire()
    source.put(compressed(7))
    next(iter(source))
    RosListener(wire, source).show(None, [hover(frame=0, **changes)])
    parts = dict(wire.published)
    record = json.loads(parts.pop("instruction"))
    assert (record["text"], record["stamp"], record["frame_id"]) == ("STOP HOVER 50 GO", [7, 5], "camera")
    assert parts == {
        "text": "STOP HOVER 50 GO",
        "action": changes.get("action", "HOVER"),
        "number": number,
        "change": changes.get("change", ""),
    }


def test_other_records(source):
    wire = Wire()
    at = {"source": "s", "frame": 99, "time_s": 1.0}
    records = [
        FrameRecord(**at),
        State(state="idle", sentence="", dwell=None, **at),
        Notice(reason="gap", detail="", **at),
    ]
    RosListener(wire, source).show(None, records)
    assert [(name, json.loads(value)["type"]) for name, value in wire.published] == [
        ("state", "state"),
        ("event", "notice"),
    ]
    assert json.loads(wire.published[0][1])["stamp"] is None


def test_health(source):
    now, wire = [0.0], Wire()
    listener = RosListener(wire, source, lambda: now[0])
    listener.show(None, [beat(0)])
    listener.show(GREY, [])
    listener.show(None, [beat(30)])
    listener.show(None, [beat(35, dropped=25)])
    now[0] = 5.0
    listener.show(None, [beat(35, dropped=25)])
    assert [level for level, _, _ in wire.health] == [STALE, OK, WARN, STALE]
    assert wire.health[1][2]["pictures in the last second"] == "30"


def test_pictures_are_drawn_for_who_subscribes_under_their_own_header(source):
    source.put(compressed(3))
    next(iter(source))
    for is_watched in (False, True):
        wire = Wire(is_watched)
        listener = RosListener(wire, source)
        listener.start()
        listener.show(GREY, [FrameRecord(source="s", frame=0, time_s=0.0)])
        assert wire.drawn.wait(5 if is_watched else 0.1) == is_watched
        listener.stop()
    ((jpeg, drawn_header),) = wire.pictures
    assert cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR).shape == GREY.shape
    assert drawn_header.stamp.sec == 3


def test_parameters_go_before_the_command_line():
    settings = settings_with(
        DecodeSettings(model="svm", hold=9), {"hold_seconds": 0.4, "model": "", "web": None}
    )
    assert (settings.model, settings.hold, settings.hold_seconds) == ("svm", None, 0.4)
    with pytest.raises(UsageError, match=r"parameter threshold: .* less than or equal to 1, not 7"):
        settings_with(DecodeSettings(), {"threshold": 7})
    assert {"model", "json", "mavlink", "hook"} < set(parameter_names())
    assert not {"size", "jobs", "out"} & set(parameter_names())


def test_options_of_other_sources_are_refused():
    with pytest.raises(UsageError, match="--give-up: of no use for a topic; leave it out"):
        refuse_useless(DecodeSettings(give_up=3))


def test_a_topic_is_decoded_until_it_ends(source, fake, capsys):
    wire = Wire()

    def publish():
        for number in range(4):
            source.put(compressed(number))
            time.sleep(0.05)
        source.end()

    threading.Thread(target=publish).start()
    assert run_topic(DecodeSettings(quiet=True), source, wire) == ExitStatus.OK
    assert [json.loads(value)["text"] for name, value in wire.published if name == "instruction"] == [
        "STOP HOVER GO"
    ]
    assert "STOP HOVER GO" in capsys.readouterr().out


@pytest.mark.parametrize(("command", "package"), [("ros2", "rclpy"), ("ros1", "rospy")])
def test_without_ros(command, package, monkeypatch, capsys):
    monkeypatch.setitem(__import__("sys").modules, package, None)
    assert main([command]) == ExitStatus.USAGE
    assert f"{command}: {package} is not there" in capsys.readouterr().err
