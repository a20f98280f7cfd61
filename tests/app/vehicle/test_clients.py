"""MAVProxy and MAVSDK, which others wrote, between us and the vehicle: what they saw, and what their pilots did.

They are no dependencies: `pip install mavsdk`, and `pip install --no-deps MAVProxy`, which would else bring another
OpenCV.
"""

import contextlib
import socket
import subprocess
import sys
import threading
import time
from importlib.util import find_spec

import pytest

from lightgesture.records import VehicleRecord
from lightgesture.vehicle import SetMode

pytestmark = pytest.mark.slow

REFUSED = VehicleRecord(
    time_s=1.0,
    state="refused",
    instruction="STOP HOVER 50 GO",
    detail="mode POSHOLD or ALT_HOLD: POSHOLD failed; ALT_HOLD no answer to 4 tries",
)
TEXT = f"Vehicle: refused STOP HOVER 50 GO ({REFUSED.detail})"


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@contextlib.contextmanager
def mavproxy(folder, *options):
    """MAVProxy with its lines so far; it takes commands."""
    command = [sys.executable, "-u", "-m", "MAVProxy.mavproxy", f"--state-basedir={folder}", *options]
    child = subprocess.Popen(
        command,
        cwd=folder,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    lines = []
    reader = threading.Thread(target=lambda: lines.extend(child.stdout), daemon=True)
    reader.start()
    try:
        yield child, lines
    finally:
        child.kill()
        child.wait()
        reader.join()
        child.stdin.close()
        child.stdout.close()


def until(condition, seconds=30.0):
    end_s = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end_s
        time.sleep(0.05)


@pytest.mark.skipif(find_spec("MAVProxy") is None, reason="MAVProxy is not installed")
def test_mavproxy_between_us_and_the_vehicle(autopilot, make_boat, tmp_path):
    autopilot.BEAT_S, port = 0.25, free_port()
    options = f"--master={autopilot.link}", f"--out=udpin:127.0.0.1:{port}", "--default-modules=mode"
    with mavproxy(tmp_path, *options) as (child, lines):
        until(lambda: any("online system 1" in line for line in lines))
        boat = make_boat(link=f"udpout:127.0.0.1:{port}")
        reply = boat.order(SetMode(names=("POSHOLD", "ALT_HOLD")), seconds=10)
        assert (reply.state, reply.detail) == ("accepted", "mode ALT_HOLD (POSHOLD failed)")
        until(lambda: any("Mode ALT_HOLD" in line for line in lines))
        assert any("DO_SET_MODE: FAILED" in line for line in lines)
        child.stdin.write("mode STABILIZE\n")  # its pilot
        child.stdin.flush()
        boat.until(lambda: boat.status.foreign_modes == 1, seconds=10)
        assert boat.status.mode == "STABILIZE"


@pytest.mark.skipif(find_spec("MAVProxy") is None, reason="MAVProxy is not installed")
def test_mavproxy_reads_what_was_refused(make_boat, tmp_path):
    port = free_port()
    options = f"--master=udpin:127.0.0.1:{port}", "--daemon", "--non-interactive", "--default-modules="
    with mavproxy(tmp_path, *options) as (_, lines):
        until(lambda: any("Waiting for heartbeat" in line for line in lines))
        boat = make_boat(link=f"udpout:127.0.0.1:{port}", is_heard=False)
        end_s = time.monotonic() + 1
        boat.until(lambda: time.monotonic() > end_s)
        boat.vehicle.note(REFUSED)
        boat.until(lambda: any(TEXT in line for line in lines), seconds=10)
        assert any("Detected vehicle 1:191" in line for line in lines)


@pytest.mark.skipif(find_spec("mavsdk") is None, reason="mavsdk is not installed")
def test_mavsdk_between_us_and_the_vehicle(autopilot, make_boat):
    from mavsdk import ComponentType, Configuration, ForwardingOption, Mavsdk
    from mavsdk.plugins.manual_control import ManualControl
    from mavsdk.plugins.telemetry import Telemetry

    port = free_port()
    station = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    for address in (autopilot.link.replace("udpout:", "udpout://"), f"udpin://127.0.0.1:{port}"):
        station.add_any_connection_with_forwarding(address, ForwardingOption.ON)
    boat = make_boat(link=f"udpout:127.0.0.1:{port}")
    (system,) = station.get_systems()
    texts = []
    Telemetry(system).subscribe_status_text(lambda text, _: texts.append(text.text))
    assert boat.order(SetMode(names=("ALT_HOLD",)), seconds=10).state == "accepted"
    boat.vehicle.note(REFUSED)
    boat.until(lambda: TEXT in texts, seconds=10)
    assert {1, 191} <= set(system.component_ids())
    pilot = ManualControl(system)
    pilot.set_manual_control_input(0.0, 0.0, 0.5, 0.0)
    boat.until(lambda: boat.status.stick_s is not None)
    assert boat.status.pilot_s is None
    pilot.set_manual_control_input(0.5, 0.0, 0.5, 0.0)
    boat.until(lambda: boat.status.pilot_s is not None)
    station.destroy()
