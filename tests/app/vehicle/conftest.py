"""A vehicle that does what a test tells it, and an executor on a clock that a test winds."""

import socket
import threading
import time

import numpy as np
import pytest
from pymavlink.dialects.v20 import common

from lightgesture.records import FrameRecord, Hand, HeartbeatRecord
from lightgesture.sinks.mavlink_link import Link
from lightgesture.vehicle import Reply, SetMode, StartMission, Status
from lightgesture.vehicle.executor import Executor
from lightgesture.vehicle.mavlink_vehicle import MavlinkVehicle
from lightgesture.vehicle.profile_file import load_vehicle
from tests.makers import hover

PICTURE = np.zeros((48, 64, 3), np.uint8)
TICK_S = 0.05


@pytest.fixture
def instruction():
    """Makes an instruction of a sentence; the keywords change its fields."""
    kinds = {"EXEC": "program", "SNAP": "snapshot", "PARAM": "parameter"}

    def make(text="STOP HOVER 5 GO", **changes):
        start, action, *rest = text.split()
        number = next((int(word) for word in rest if word.isdecimal()), None)
        fields = {
            "source": "cam",
            "text": text,
            "kind": kinds.get(action, "task"),
            "action": action,
            "duration_s": None if action in ("EXEC", "PARAM") else number,
            "program": number if action == "EXEC" else None,
            "parameter": number if action == "PARAM" else None,
            "change": next((word for word in rest if word in ("INCREASE", "DECREASE", "DEFAULT")), None),
            "words": (start, action, "GO"),
        }
        return hover(**{**fields, **changes})

    return make


class FakeVehicle:
    """Keeps what it is told. status: what it says of itself; its heartbeat is always fresh unless `is_silent`.

    answer: makes of an order what the reply becomes, "accepted", a reason to refuse it, or None, which leaves it open.
    """

    def __init__(self):
        self.status = {"mode": "MANUAL", "is_armed": True}
        self.is_silent = False
        self.heard_s = 0.0
        self.sticks, self.orders, self.open = [], [], []
        self.answer = lambda order: "accepted"

    def poll(self, now_s):
        if not self.is_silent:
            self.heard_s = now_s
        status = Status(**{"heard_s": self.heard_s, **self.status})
        self.status.pop("pictures", None)
        return status

    def stick(self, stick, now_s):
        self.sticks.append((now_s, stick))

    def order(self, order, now_s):
        reply = Reply()
        self.orders.append(order)
        answer = self.answer(order)
        if answer == "accepted":
            if isinstance(order, SetMode):
                self.status["mode"] = order.names[0]
                reply.accept(f"mode {order.names[0]}")
            elif isinstance(order, StartMission):
                reply.accept(value=order.first + 2 if order.last is None else order.last)
            else:
                reply.accept()
        elif isinstance(answer, float):
            reply.accept(value=answer)
        elif answer is not None:
            reply.refuse(answer)
        self.open.append(reply)
        return reply


def picture_with(has_hands, *records):
    hand = Hand(side="left", token="5", confidence=1.0, box=(0, 0, 9, 9), track=1, reason=None)
    hands = (hand,) if has_hands else ()
    return PICTURE, [FrameRecord(source="cam", frame=1, time_s=1.0, hands=hands), *records]


@pytest.fixture
def make_picture():
    """Makes a picture, with hands or without, and its records."""
    return lambda has_hands, *records: picture_with(has_hands, HEARTBEAT, *records)


class World:
    """Executor, vehicle and clock. `run(s)` lets time pass with pictures, `records` is what was published."""

    def __init__(self, profile):
        self.now_s = 100.0
        self.vehicle, self.records = FakeVehicle(), []
        self.executor = Executor(profile, self.vehicle, self.records.append, lambda: self.now_s)
        self.has_pictures = self.has_hands = True

    def picture(self, *records):
        self.executor.show(*picture_with(self.has_hands, *records))

    def run(self, seconds, each=lambda: None):
        for _ in range(round(seconds / TICK_S)):
            self.now_s += TICK_S
            if self.has_pictures:
                self.picture()
            each()
            self.executor.tick(self.now_s)
        return self

    def sign(self, *records, seconds=TICK_S):
        """The sentences are complete, and some time passes."""
        self.picture(*records)
        return self.run(seconds)

    def states(self, text=None):
        return [record.state for record in self.records if text in (None, record.instruction)]

    @property
    def last(self):
        return self.records[-1].state, self.records[-1].detail


@pytest.fixture
def world():
    """A world with the bundled profile of ArduSub, in which time has passed for a while."""
    return World(load_vehicle("ardusub")).run(0.2)


@pytest.fixture
def make_world(tmp_path):
    """Makes a world with a profile of this text."""

    def make(text):
        path = tmp_path / "vehicle.toml"
        path.write_text(text)
        return World(load_vehicle(str(path))).run(0.2)

    return make


class FakeAutopilot:
    """An autopilot on UDP that answers as ArduSub does, or as a test wants it, and keeps what it was sent.

    link: where it is found. heard: (seconds of time.monotonic, message) of all that came. results: command -> the
    results that it acknowledges with, one after the other, none being silence; any other command is UNSUPPORTED. It
    is in no position: POSHOLD fails unless `has_position`.
    """

    BEAT_S = 0.02

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(0.01)
        self.link = f"udpout:127.0.0.1:{self.socket.getsockname()[1]}"
        self.parser, self.peers = common.MAVLink(None), set()
        self.system, self.mode, self.is_armed = 1, 19, True
        self.is_silent = self.has_position = False
        self.knows_set_mode, self.takes_mode = True, True
        self.boot_s = time.monotonic() - 100
        self.results, self.params, self.items = {}, {"PILOT_SPEED_UP": 50.0}, 6
        self.heard, self.lock = [], threading.Lock()
        self.packers = {}
        self._is_closed = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self):
        self._is_closed.set()
        self._thread.join()
        self.socket.close()

    def send(self, message, system=None, component=1):
        """As from a system and a component, to all who were heard."""
        key = system or self.system, component
        packer = self.packers.setdefault(key, common.MAVLink(None, *key))
        content = message.pack(packer)
        for peer in list(self.peers):
            self.socket.sendto(content, peer)

    def beat(self, **changes):
        fields = {"type": 12, "autopilot": 3, "mode": self.mode, "armed": self.is_armed, **changes}
        base = 1 | (128 if fields["armed"] else 0)
        message = common.MAVLink_heartbeat_message(
            fields["type"], fields["autopilot"], base, fields["mode"], 4, 3
        )
        self.send(message)

    def of_type(self, *kinds):
        with self.lock:
            return [message for _, message in self.heard if message.get_type() in kinds]

    def sticks(self):
        """(seconds, z, y, message) of each MANUAL_CONTROL."""
        with self.lock:
            return [
                (moment, one.z, one.y, one)
                for moment, one in self.heard
                if one.get_type() == "MANUAL_CONTROL"
            ]

    def _run(self):
        beat_s = 0.0
        while not self._is_closed.is_set():
            if time.monotonic() >= beat_s and not self.is_silent:
                beat_s = time.monotonic() + self.BEAT_S
                self.beat()
                boot_ms = int((time.monotonic() - self.boot_s) * 1e3)
                self.send(common.MAVLink_system_time_message(0, boot_ms))
            try:
                content, peer = self.socket.recvfrom(65536)
            except TimeoutError:
                continue
            self.peers.add(peer)
            for message in self.parser.parse_buffer(content) or []:
                with self.lock:
                    self.heard.append((time.monotonic(), message))
                self._answer(message)

    def _answer(self, message):
        answer = getattr(self, f"_on_{message.get_type().lower()}", None)
        if answer is not None and not self.is_silent:
            answer(message)

    def _on_command_long(self, message):
        if message.command in self.results:
            results = self.results[message.command]
            if results:
                self.acknowledge(message, results.pop(0))
        elif message.command == common.MAV_CMD_DO_SET_MODE and self.knows_set_mode:
            is_entered = int(message.param2) != 16 or self.has_position
            self.acknowledge(message, 0 if is_entered else 4)
            if is_entered and self.takes_mode:
                self.mode = int(message.param2)
        else:
            self.acknowledge(message, 3)

    def acknowledge(self, message, result, component=None, **changes):
        fields = {"target_system": message.get_srcSystem(), "target_component": message.get_srcComponent()}
        ack = common.MAVLink_command_ack_message(message.command, result, 0, 0, **{**fields, **changes})
        self.send(ack, component=message.target_component or 1)

    def _on_set_mode(self, message):
        self.mode = message.custom_mode

    def _on_param_request_read(self, message):
        self._tell_param(message.param_id)

    def _on_param_set(self, message):
        if message.param_id in self.params:
            self.params[message.param_id] = message.param_value
        self._tell_param(message.param_id)

    def _tell_param(self, name):
        if name in self.params:
            self.send(common.MAVLink_param_value_message(name.encode(), self.params[name], 9, 1, 0))

    def _on_mission_request_list(self, message):
        self.send(
            common.MAVLink_mission_count_message(
                message.get_srcSystem(), message.get_srcComponent(), self.items
            )
        )

    def _on_mission_set_current(self, message):
        self.send(common.MAVLink_mission_current_message(message.seq))


@pytest.fixture
def autopilot():
    one = FakeAutopilot()
    yield one
    one.close()


class Boat:
    """A vehicle by MAVLink that is polled until something is so."""

    def __init__(self, autopilot, **options):
        self.profile = load_vehicle(options.pop("profile", "ardusub"))
        link, is_heard = options.pop("link", autopilot.link), options.pop("is_heard", True)
        self.vehicle = MavlinkVehicle(Link(link), self.profile, **options)
        self.autopilot, self.status = autopilot, Status()
        self.vehicle.note(HEARTBEAT)
        if is_heard:
            self.until(lambda: self.status.heard_s is not None, seconds=10)

    def until(self, condition, seconds=3.0):
        end_s = time.monotonic() + seconds
        while time.monotonic() < end_s:
            self.status = self.vehicle.poll(time.monotonic())
            if condition():
                return self
            time.sleep(0.005)
        raise AssertionError(f"it did not come within {seconds} s: {self.status}")

    def order(self, order, seconds=3.0):
        """What became of an order."""
        reply = self.vehicle.order(order, time.monotonic())
        self.until(lambda: reply.state != "pending", seconds)
        return reply


HEARTBEAT = HeartbeatRecord(source="cam", time_s=1.0, frames=1, dropped=0, ms_per_frame=0.8, state="idle")


@pytest.fixture
def make_boat(autopilot):
    """Makes a vehicle by MAVLink that has heard its autopilot."""
    boats = []

    def make(**options):
        boats.append(Boat(autopilot, **options))
        return boats[-1]

    yield make
    for boat in boats:
        boat.vehicle.close()
