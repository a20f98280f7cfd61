"""Faults of the process that holds the sticks: it is killed, stopped, ended, and goes on after a stop.

Everything runs in real time, over UDP, as in `test_faults.py`.
"""

import signal
import subprocess
import sys
import time

import pytest

from lightgesture.vehicle.executor import HELD_UP_S
from tests.app.vehicle.fault_times import NEUTRAL_S, PROFILE, first_neutral, is_neutral_after, note_time

PROGRAM = """
import sys, threading, time
import numpy as np
from lightgesture.config.settings import DecodeSettings
from lightgesture.fsm import Instruction
from lightgesture.interruption import stop_signals
from lightgesture.vehicle.executor import HELD_UP_S
from lightgesture.vehicle.opening import open_runner
link, profile, action, held_up_s = sys.argv[1:]
import lightgesture.vehicle.executor
lightgesture.vehicle.executor.HELD_UP_S = float(held_up_s)
with stop_signals() as stopping:
    settings = DecodeSettings(mavlink=[link], obey=profile)
    told = []
    tell = lambda record: told.append(record.state)
    runner = open_runner(settings, tell, print, time.monotonic, stopping)
    runner.start()
    picture = np.zeros((4, 4, 3), np.uint8)
    order = Instruction(source=None, frame=0, time_s=0.0, start_frame=0, start_time_s=0.0, text=f"STOP {action} 1 GO",
        kind="task", action=action, duration_s=None, program=1, parameter=None, change=None, confidence=1.0,
        words=("STOP",))
    from lightgesture.records import HeartbeatRecord
    beat = HeartbeatRecord(source=None, time_s=0.0, frames=0, dropped=0, ms_per_frame=0.0, state="idle")
    runner.show(picture, [beat])
    while not stopping.is_set():
        is_wanted = not told or told[-1] == "refused"
        runner.show(picture, [beat, order] if is_wanted else [beat])
        time.sleep(0.3 if is_wanted else 0.05)
    runner.stop()
"""


@pytest.fixture
def program(autopilot, tmp_path):
    """Starts the executor in a process of its own that carries an action out."""
    path = tmp_path / "vehicle.toml"
    path.write_text(PROFILE)
    children = []

    def start(action="UP", held_up_s=5.0):
        command = [sys.executable, "-c", PROGRAM, autopilot.link, str(path), action, str(held_up_s)]
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        children.append(child)
        end_s = time.monotonic() + 20
        while not (
            any(z > 550 for _, z, *_ in autopilot.sticks()) if action == "UP" else autopilot.mode == 3
        ):
            assert time.monotonic() < end_s
            time.sleep(0.01)
        return child

    yield start
    for child in children:
        child.kill()
        child.wait()


SLOW_SIGNALS = [
    pytest.param(number, marks=pytest.mark.slow) for number in (signal.SIGSTOP, signal.SIGTERM, signal.SIGINT)
]


@pytest.mark.parametrize("number", [signal.SIGKILL, *SLOW_SIGNALS])
def test_the_end_of_the_process(program, autopilot, number):
    child = program()
    moment_s = time.monotonic()
    child.send_signal(number)
    end_s = moment_s + 3
    while not is_neutral_after(autopilot, moment_s):
        assert time.monotonic() < end_s
        time.sleep(0.005)
    seconds = first_neutral(autopilot, moment_s) - moment_s
    note_time(number.name, seconds)
    assert seconds < NEUTRAL_S
    time.sleep(0.3)
    later = [z for at_s, z, *_ in autopilot.sticks() if at_s > moment_s + seconds]
    assert len(later) >= 2  # repeated, for one may get lost
    assert set(later) == {500}


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_a_mission_is_held_by_the_watchdog(program, autopilot, number):
    child = program("EXEC")
    time.sleep(0.3)
    child.send_signal(number)
    moment_s = time.monotonic()
    while autopilot.mode != 2:
        assert time.monotonic() < moment_s + 2
        time.sleep(0.005)
    assert time.monotonic() - moment_s < 0.5
    assert autopilot.sticks() == []


@pytest.mark.slow
def test_a_process_that_goes_on_after_a_stop_does_not_take_the_sticks_again(program, autopilot):
    child = program(held_up_s=HELD_UP_S)
    child.send_signal(signal.SIGSTOP)
    time.sleep(0.6)
    child.send_signal(signal.SIGCONT)
    moment_s = time.monotonic()
    time.sleep(0.6)
    assert {z for at_s, z, *_ in autopilot.sticks() if at_s > moment_s + 0.05} <= {500}
