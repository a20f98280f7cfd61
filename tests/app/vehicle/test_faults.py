"""The table of faults of docs/vehicle.md, a row a test: what the vehicle was sent after the fault, and how soon.

Everything runs in real time, over UDP. The fault comes while the sticks are held; the time is that from the fault,
or from when it could first be known, to the first MANUAL_CONTROL with all sticks in their middle.
"""

import os
import signal
import threading
import time

import pytest
from pymavlink.dialects.v20 import common

from lightgesture.config.settings import DecodeSettings
from lightgesture.fsm import Notice
from lightgesture.vehicle.executor import HELD_UP_S
from lightgesture.vehicle.opening import open_runner
from tests.app.vehicle.fault_times import NEUTRAL_S, PROFILE, first_neutral, is_neutral_after, note_time


class Rig:
    """A runner on the autopilot's link, with pictures twenty times a second until `is_blind`."""

    def __init__(self, autopilot, profile, make_picture, instruction):
        self.autopilot, self.make_picture, self.instruction = autopilot, make_picture, instruction
        self.records, self.said = [], []
        self.is_blind, self.has_hands = False, True
        self.ending = threading.Event()
        settings = DecodeSettings(mavlink=[autopilot.link], obey=profile)
        self.runner = open_runner(
            settings, self.records.append, self.said.append, time.monotonic, self.ending
        )
        self._is_over = threading.Event()
        self._camera = threading.Thread(target=self._show, daemon=True)
        self._camera.start()
        self.runner.start()

    def close(self):
        self._is_over.set()
        self._camera.join()
        self.runner.stop()

    def _show(self):
        while not self._is_over.wait(0.05):
            if not self.is_blind:
                self.runner.show(*self.make_picture(self.has_hands))

    def push(self):
        """Have the sticks held, and wait until the vehicle feels it."""
        self.until(lambda: self.autopilot.peers)
        end_s = time.monotonic() + 10
        while not any(z > 550 for _, z, *_ in self.autopilot.sticks()):
            self.sign("STOP UP 20 GO")
            assert time.monotonic() < end_s, self.records
            time.sleep(0.05)
        return self

    def sign(self, text):
        """Have an instruction carried out, again where it is refused: the watchdog may not be up yet."""
        if not self.records or self.records[-1].state == "refused":
            self.records.clear()
            self.runner.show(*self.make_picture(True, self.instruction(text)))
            self.until(lambda: self.records)

    def until(self, condition, seconds=4.0):
        end_s = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end_s, (self.records[-2:], self.said)
            time.sleep(0.005)

    def neutral_after(self, moment_s):
        """Seconds from then to the first stick in the middle with none but such after it."""
        self.until(lambda: is_neutral_after(self.autopilot, moment_s))
        return first_neutral(self.autopilot, moment_s) - moment_s


@pytest.fixture
def rig(autopilot, tmp_path, make_picture, instruction, request, monkeypatch):
    """A test's parameter is added to [safety]. A busy machine shall not be taken for the fault that is tested."""
    monkeypatch.setattr("lightgesture.vehicle.executor.HELD_UP_S", 5.0)
    path = tmp_path / "vehicle.toml"
    added = getattr(request, "param", "")
    path.write_text(PROFILE.replace("[safety]\n", f"[safety]\n{added}\n"))
    one = Rig(autopilot, str(path), make_picture, instruction)
    yield one
    one.close()


def pilot_moves(rig):
    rig.autopilot.send(common.MAVLink_manual_control_message(1, 400, 0, 500, 0, 0), 255, 190)


def joystick_is_switched_on(rig):
    rig.autopilot.send(common.MAVLink_manual_control_message(1, 0, 0, 500, 0, 0), 255, 190)


def mode_changes(rig):
    rig.autopilot.mode = 0


def vehicle_disarms(rig):
    rig.autopilot.is_armed = False


def vehicle_starts_anew(rig):
    rig.autopilot.boot_s = time.monotonic()


def second_vehicle(rig):
    rig.autopilot.send(common.MAVLink_heartbeat_message(12, 3, 129, 2, 4, 3), system=7)


def second_companion(rig):
    rig.autopilot.send(common.MAVLink_heartbeat_message(18, 8, 0, 0, 4, 3), 1, 191)


def pictures_show_nothing(rig):
    rig.runner.show(
        None, [Notice(source="cam", frame=1, time_s=1.0, reason="gap", detail="frames show nothing")]
    )


def kill_is_signed(rig):
    rig.runner.show(*rig.make_picture(True, rig.instruction("ABORT NOW", kind="kill", action="ABORT")))


def program_is_stopped(rig):
    rig.ending.set()


@pytest.mark.parametrize(
    ("cause", "reason"),
    [
        (pilot_moves, "a pilot moved a stick"),
        (joystick_is_switched_on, "another's stick is on the link"),
        (mode_changes, "someone else changed the mode to 0"),
        (vehicle_disarms, "the vehicle was disarmed"),
        (vehicle_starts_anew, "the vehicle started anew"),
        (second_vehicle, "systems 1 and 7 are on the link; name one by --mavlink-system"),
        (second_companion, "another companion with our number is on the link"),
        (pictures_show_nothing, "the pictures have a hole: frames show nothing"),
        (kill_is_signed, "ABORT NOW was signed"),
        (program_is_stopped, "the decoder ends"),
    ],
)
def test_what_ends_a_task_at_once(rig, cause, reason):
    rig.push()
    moment_s = time.monotonic()
    cause(rig)
    seconds = rig.neutral_after(moment_s)
    note_time(cause.__name__, seconds)
    assert seconds < NEUTRAL_S
    rig.until(lambda: "aborted" in [record.state for record in rig.records])
    assert next(record.detail for record in rig.records if record.state == "aborted") == reason


@pytest.mark.parametrize(
    ("rig", "cause", "known_after_s", "reason"),
    [
        ("", "is_blind", 1.0, "no new picture for 1 s"),
        ("lost_diver_s = 0.5", "has_hands", 0.5, "the diver is lost: no hand for 0.5 s"),
        pytest.param(
            *("", "is_silent", 1.5, "the link is lost: no heartbeat for 1.5 s"), marks=pytest.mark.slow
        ),
    ],
    indirect=["rig"],
)
def test_what_ends_a_task_once_it_has_lasted(rig, autopilot, cause, known_after_s, reason):
    rig.push()
    moment_s = time.monotonic()
    holder = autopilot if cause == "is_silent" else rig
    setattr(holder, cause, cause != "has_hands")
    seconds = rig.neutral_after(moment_s) - known_after_s
    note_time(cause, seconds)
    assert -0.1 < seconds < NEUTRAL_S
    rig.until(lambda: rig.records[-1].state == "aborted")
    assert rig.records[-1].detail == reason


def test_a_pilot_is_left_alone(rig, autopilot):
    rig.push()
    pilot_moves(rig)
    rig.until(lambda: rig.records[-1].state == "aborted")
    time.sleep(0.3)
    count = len(autopilot.sticks())
    time.sleep(0.3)
    assert len(autopilot.sticks()) == count  # no word more, not even the middle
    assert autopilot.mode == 2


def test_a_mission_is_held_after_a_fault_and_left_to_a_pilot(rig, autopilot):
    rig.until(lambda: autopilot.peers)
    rig.until(lambda: rig.sign("STOP EXEC 1 GO") or autopilot.mode == 3)
    rig.until(lambda: rig.records[-1].state == "executing")
    rig.is_blind = True
    rig.until(lambda: autopilot.mode == 2)  # ALT_HOLD, for it is in no position
    assert ("aborted", "no new picture for 1 s") in [(one.state, one.detail) for one in rig.records]
    assert autopilot.sticks() == []


def test_a_thread_that_is_held_up_is_replaced_by_the_watchdog(rig, autopilot, monkeypatch):
    monkeypatch.setattr("lightgesture.vehicle.executor.HELD_UP_S", HELD_UP_S)
    rig.push()
    vehicle = rig.runner.vehicle
    poll = vehicle.poll

    def slow(now_s):
        monkeypatch.setattr(vehicle, "poll", poll)
        time.sleep(0.6)
        return poll(now_s)

    moment_s = time.monotonic()
    monkeypatch.setattr(vehicle, "poll", slow)
    rig.until(lambda: any(z == 500 and at_s > moment_s for at_s, z, *_ in autopilot.sticks()))
    seconds = min(at_s for at_s, z, *_ in autopilot.sticks() if z == 500 and at_s > moment_s) - moment_s
    note_time("held_up", seconds)
    assert seconds < NEUTRAL_S + 0.05  # a tick may just have been
    rig.until(lambda: rig.records[-1].state == "aborted")
    assert rig.records[-1].detail.startswith("the program was held up for 0.")
    assert first_neutral(autopilot, moment_s)


def test_a_watchdog_that_somebody_ends(rig, autopilot):
    rig.push()
    moment_s = time.monotonic()
    os.kill(rig.runner.watchdog_pid, signal.SIGKILL)
    seconds = rig.neutral_after(moment_s)
    note_time("watchdog_ends", seconds)
    assert seconds < NEUTRAL_S
    rig.until(lambda: rig.records[-1].detail == "the watchdog has ended")
    rig.records.clear()
    rig.push()  # there is another


def test_a_watchdog_does_nothing_while_nothing_is_done(rig, autopilot):
    rig.until(lambda: rig.runner.watchdog_pid is not None)
    pid = rig.runner.watchdog_pid
    time.sleep(0.2)
    for number in (signal.SIGTERM, signal.SIGINT):
        os.kill(pid, number)  # what a service manager, or a terminal, sends to all
    rig.runner.stop()
    time.sleep(0.1)
    assert autopilot.sticks() == []
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_a_defect_of_the_executor_lets_go(rig, monkeypatch):
    rig.push()
    moment_s = time.monotonic()
    monkeypatch.setattr(rig.runner.vehicle, "poll", lambda now_s: 1 / 0)
    assert rig.neutral_after(moment_s) < NEUTRAL_S
    rig.until(lambda: rig.said)
    assert "gives up, which is a defect (ZeroDivisionError" in rig.said[0]
