"""The command itself: signed before a camera, obeyed by a vehicle; and nothing of it where nobody asks for it."""

import contextlib
import json
import signal
import subprocess
import sys
import threading
import time
from importlib.resources import files

import av
import cv2
import pytest

from lightgesture.benchmarks.mjpeg_server import MjpegServer
from lightgesture.errors import ExitStatus

PROFILE = """
name = "Live"
[modes]
ALT_HOLD = 2
[stick]
rate_hz = 20
[[instruction]]
action = "HOVER"
steps = [{ mode = ["ALT_HOLD"] }, { stick = { z = 1 }, seconds = 60 }]
"""


@pytest.fixture(scope="module")
def pictures():
    """The bundled clip, in which STOP HOVER 50 GO is signed, as JPEG files."""
    with av.open(str(files("lightgesture") / "data" / "sample.mp4")) as clip:
        images = [frame.to_ndarray(format="bgr24") for frame in clip.decode(video=0)]
    return [cv2.imencode(".jpg", image)[1].tobytes() for image in images]


@contextlib.contextmanager
def live(address, link, profile):
    """A run of the command with its records, once the vehicle is pushed."""
    command = [sys.executable, "-m", "lightgesture", "live", address, "--json", "--quiet"]
    child = subprocess.Popen(
        [*command, "--mavlink", link, "--obey", profile], stdout=subprocess.PIPE, encoding="utf-8"
    )
    records = []
    reader = threading.Thread(target=lambda: records.extend(map(json.loads, child.stdout)), daemon=True)
    reader.start()
    try:
        yield child, records, reader
    finally:
        child.kill()
        child.wait()
        reader.join()
        child.stdout.close()


def wait_until(condition, seconds):
    end_s = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end_s
        time.sleep(0.005)


def is_let_go(autopilot, moment_s):
    at_s, z, *_ = autopilot.sticks()[-1]
    return at_s > moment_s and z == 500


def pushes(autopilot):
    return [at_s for at_s, z, *_ in autopilot.sticks() if z > 550]


@pytest.mark.slow
@pytest.mark.parametrize("cause", ["SIGKILL", "SIGTERM", "SIGSTOP", "camera"])
def test_a_signed_sentence_moves_the_vehicle_and_its_end_stops_it(autopilot, tmp_path, pictures, cause):
    profile = tmp_path / "vehicle.toml"
    profile.write_text(PROFILE)
    with contextlib.ExitStack() as camera, contextlib.ExitStack() as stack:
        server = camera.enter_context(MjpegServer(pictures, fps=30))
        child, records, reader = stack.enter_context(live(server.address, autopilot.link, str(profile)))
        wait_until(lambda: len(pushes(autopilot)) > 5, 60)
        moment_s = time.monotonic()
        camera.close() if cause == "camera" else child.send_signal(getattr(signal, cause))
        wait_until(lambda: is_let_go(autopilot, moment_s), 3)
        last_s = max(pushes(autopilot))
        print(f"{cause}: last push {last_s - moment_s:.3f} s after it")
        assert last_s - moment_s < (1.3 if cause == "camera" else 0.3)
        assert autopilot.sticks()[-1][1] == 500
        if cause in ("SIGTERM", "camera"):
            child.send_signal(signal.SIGTERM)
            assert child.wait(10) == ExitStatus.OK
            reader.join()
            told = [(one["state"], one["instruction"]) for one in records if one["type"] == "vehicle"]
            assert [state for state, _ in told] == ["sent", "accepted", "executing", "aborted"]
            assert {text for _, text in told} == {"STOP HOVER 50 GO"}
            assert all(
                one["source"] and one["utc"] and one["time_s"] > 0
                for one in records
                if one["type"] == "vehicle"
            )
    texts = [message.text for message in autopilot.of_type("STATUSTEXT")]
    assert texts[0] == "Diver: STOP HOVER 50 GO"


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["--obey", "ardusub"], "--obey: there is no link to a vehicle; name it by --mavlink"),
        (["--obey", "none.toml", "--mavlink", "udpout:127.0.0.1:9"], "none.toml: no such file"),
        (["--mavlink-system", "300"], "--mavlink-system: should be less than or equal to 255"),
        (["--answer", "motion"], "--answer motion: moves nothing without --obey"),
    ],
)
def test_options_that_are_wrong(run, fake, arguments, reason):
    result = run("live", "-", *arguments)
    assert result.status == ExitStatus.USAGE
    assert reason in result.err[0]


def test_nothing_is_loaded_that_is_not_asked_for():
    """A decoder without a vehicle starts as ever."""
    program = (
        "import sys; import lightgesture.actions.live, lightgesture.web; "
        "print([name for name in sys.modules if name.startswith(('pymavlink', 'gpiozero', 'lightgesture.vehicle', "
        "'lightgesture.sinks.mavlink_', 'lightgesture.sinks.lamp')) and not name.endswith('mavlink_map')])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
