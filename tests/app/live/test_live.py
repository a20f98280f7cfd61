"""The command: streams that come and go, signals, results."""

import contextlib
import json
import os
import shlex
import signal
import socket
import subprocess
import sys
import threading
import time

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks.mjpeg_server import MjpegServer
from lightgesture.errors import ExitStatus

FILES = [cv2.imencode(".jpg", np.full((48, 64, 3), 20 * n, np.uint8))[1].tobytes() for n in range(8)]


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


@contextlib.contextmanager
def live(*arguments, stdin=subprocess.DEVNULL):
    """A run of the command in a process of its own; it ends with the block."""
    command = [sys.executable, "-m", "lightgesture", "live", *map(str, arguments)]
    child = subprocess.Popen(
        command, stdin=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8"
    )
    watchdog = threading.Timer(40, child.kill)  # a test shall fail and not wait for ever
    watchdog.start()
    try:
        yield child
    finally:
        watchdog.cancel()
        child.kill()
        child.wait()
        for stream in filter(None, (child.stdin, child.stdout, child.stderr)):
            stream.close()


def records_until(child, condition):
    """Records of standard output up to the first that meets the condition."""
    found = []
    for line in child.stdout:
        found.append(json.loads(line))
        if condition(found[-1]):
            return found
    raise AssertionError(f"ended after {found} with {child.stderr.read()}")


def run_on_standard_input(run, monkeypatch, content, *arguments):
    read, write = os.pipe()
    threading.Thread(target=lambda: (os.write(write, content), os.close(write)), daemon=True).start()
    with os.fdopen(read) as stream:
        monkeypatch.setattr(sys, "stdin", stream)
        return run("live", "-", *arguments)


def test_standard_input_to_its_end(run, fake, monkeypatch):
    result = run_on_standard_input(run, monkeypatch, FILES[0], "--json", "--frames")
    assert result.status == ExitStatus.OK
    assert [json.loads(line)["type"] for line in result.out] == ["frame", "summary"]
    assert result.err == ["lightgesture: -: 1 pictures decoded, 0 passed over for newer ones"]


def test_plain_words_and_quiet(run, fake, monkeypatch):
    result = run_on_standard_input(run, monkeypatch, bytes(range(256)) * 27, "--size", "48x48", "--quiet")
    assert result.status == ExitStatus.OK
    assert result.out[0] == "-"
    assert "1 frame in" in result.out[1]
    assert result.err == []


@pytest.mark.parametrize(
    ("given", "hold", "hold_seconds"),
    [
        ([], None, None),
        (["--hold", 9], 9, None),
        (["--hold-seconds", 0.8], None, 0.8),
        (["--grammar", "my.toml"], None, None),
    ],
)
def test_the_hold_is_the_grammars_unless_the_user_says_otherwise(
    run, fake, monkeypatch, given, hold, hold_seconds
):
    result = run_on_standard_input(run, monkeypatch, FILES[0], "--quiet", *given)
    assert result.status == ExitStatus.OK
    options = fake.made[-1].options
    assert (options["hold"], options["hold_seconds"]) == (hold, hold_seconds)


def test_the_page_is_served_while_it_runs_and_its_address_told(run, fake, monkeypatch):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        busy = run_on_standard_input(run, monkeypatch, FILES[0], "--web", port)
    assert busy.status == ExitStatus.USAGE
    assert len(busy.err) == 1
    assert busy.err[0].startswith(f"lightgesture: --web {port}: cannot listen")
    result = run_on_standard_input(run, monkeypatch, FILES[0], "--web", port)
    assert result.status == ExitStatus.OK
    assert result.err[0] == f"lightgesture: the page is at http://127.0.0.1:{port}/"


def test_standard_input_without_a_picture(run, fake, monkeypatch):
    result = run_on_standard_input(run, monkeypatch, b"no picture", "--json", "--quiet")
    assert result.status == ExitStatus.SOME_FAILED
    assert len(result.err) == 1
    assert result.err[0].startswith("lightgesture: standard input: held no whole JPEG picture")


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["no_such_thing"], "no_such_thing: is no stream; name a camera"),
        (["-", "--size", "640"], "--size: should be WxH, not '640'; change it"),
        (["-", "--udp", "host"], "--udp host: is no HOST:PORT"),
        (["-", "--mavlink", "nowhere"], "--mavlink nowhere: is no link"),
        (["-", "--hook", "no-such-program"], "--hook no-such-program: no such command"),
        (["-", "--mavlink-map", "a.toml"], "--mavlink-map: is of no use without --mavlink"),
        (["-", "--model", "broken.npz"], "broken.npz: is damaged"),
        (["v4l2src ! appsink"], "v4l2src ! appsink: this OpenCV has no GStreamer"),
    ],
)
def test_wrong_usage_is_one_line(run, fake, monkeypatch, arguments, reason):
    monkeypatch.setattr(cv2.videoio_registry, "getStreamBackends", list)
    result = run("live", *arguments)
    assert result.status == ExitStatus.USAGE
    assert result.out == []
    assert len(result.err) == 1
    assert result.err[0].startswith(f"lightgesture: {reason}")


@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGTERM, ExitStatus.OK), (signal.SIGINT, ExitStatus.INTERRUPTED)]
)
def test_signals_end_it_with_the_summary_last(number, status):
    with MjpegServer(FILES, fps=50) as server, live(server.address, "--json") as child:
        beats = records_until(child, lambda record: record["type"] == "heartbeat" and record["frames"] > 3)
        keys = ["type", "source", "time_s", "utc", "frames", "dropped", "ms_per_frame", "state"]
        assert list(beats[-1]) == keys
        assert beats[-1]["source"] == server.address
        child.send_signal(number)
        rest = [json.loads(line) for line in child.stdout]
        assert child.wait(20) == status
        assert rest[-1]["type"] == "summary"
        assert rest[-1]["status"] == "ok"
        assert child.stderr.read().count("\n") == 1


def test_a_server_that_goes_and_comes_back():
    port = free_port()
    with live(f"http://127.0.0.1:{port}/", "--json") as child:
        records_until(child, lambda record: record["type"] == "heartbeat" and record["frames"] == 0)
        seen = 0
        for _ in range(2):
            with MjpegServer(FILES, fps=50, port=port):
                beats = records_until(child, lambda record: record.get("frames", 0) > seen + 5)  # noqa: B023
            seen = beats[-1]["frames"]
        child.send_signal(signal.SIGTERM)
        assert child.wait(20) == ExitStatus.OK
        said = child.stderr.read().splitlines()
    assert "cannot be opened (Connection refused)" in said[0]
    assert said[0].endswith("trying again until it works")
    assert sum("pictures again" in line for line in said) == 2


def feed_in_step(fake, write):
    """Write pictures, each after the last one was decoded, so that none is passed over."""
    with os.fdopen(write, "wb") as stream:
        for count in range(4):
            stream.write(FILES[count])
            stream.flush()
            while not fake.made or len(fake.made[0].seen) <= count:
                time.sleep(0.002)


def test_sinks_at_once_and_one_that_fails(run, fake, monkeypatch, tmp_path):
    """Standard output, UDP, a hook, and a MAVLink peer that is not there."""
    read, write = os.pipe()
    threading.Thread(target=feed_in_step, args=(fake, write), daemon=True).start()
    code = "import sys; open(sys.argv[1], 'a').write(sys.stdin.read())"
    hook = shlex.join([sys.executable, "-S", "-c", code, str(tmp_path / "hooked")])
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver, os.fdopen(read) as stream:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(20)
        monkeypatch.setattr(sys, "stdin", stream)
        udp = f"127.0.0.1:{receiver.getsockname()[1]}"
        sinks = ["--udp", udp, "--mavlink", f"tcp:127.0.0.1:{free_port()}", "--hook", hook]
        result = run("live", "-", "--json", *sinks)
        datagrams = [json.loads(receiver.recv(65536)) for _ in result.out]
    assert result.status == ExitStatus.OK
    printed = [json.loads(line) for line in result.out]
    assert printed == datagrams
    assert "instruction" in [record["type"] for record in printed]
    assert [json.loads(line) for line in (tmp_path / "hooked").read_text().splitlines()] == [
        record for record in printed if record["type"] == "instruction"
    ]
    assert sum("cannot be opened (Connection refused); trying again" in line for line in result.err) == 1


@pytest.mark.slow
def test_an_instruction_over_the_network_and_by_mavlink():
    """The bundled clip, with a hold that forgives the pictures that a busy machine passes over."""
    from pymavlink.dialects.v20 import common

    from lightgesture.actions.decode import SAMPLE
    from lightgesture.benchmarks.mjpeg_server import read_jpegs

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as station:
        station.bind(("127.0.0.1", 0))
        station.settimeout(1)
        link = f"udpout:127.0.0.1:{station.getsockname()[1]}"
        with (
            MjpegServer(read_jpegs(str(SAMPLE)), fps=30) as server,
            live(server.address, "--json", "--hold", 8, "--mavlink", link) as child,
        ):
            printed = records_until(child, lambda record: record["type"] == "instruction")
            child.send_signal(signal.SIGTERM)
            assert child.wait(20) == ExitStatus.OK
        parser, messages = common.MAVLink(None), []
        with contextlib.suppress(TimeoutError):
            while True:
                messages += parser.parse_buffer(station.recv(65536)) or []
    assert printed[-1]["text"] == "STOP HOVER 50 GO"
    texts = [message.text for message in messages if message.get_type() == "STATUSTEXT"]
    assert texts == ["Diver: STOP HOVER 50 GO"]
    assert sum(message.get_type() == "HEARTBEAT" for message in messages) > 5


def test_a_silent_standard_input_does_not_keep_it_from_ending():
    """A thread that waits for a picture must hold nothing that the end of the program needs."""
    with live("-", "--json", stdin=subprocess.PIPE) as child:
        records_until(child, lambda record: record["type"] == "heartbeat")
        child.send_signal(signal.SIGTERM)
        assert [json.loads(line)["type"] for line in child.stdout][-1] == "summary"
        assert child.wait(20) == ExitStatus.OK
        assert child.stderr.read().count("\n") == 1


def test_a_reader_who_reads_nothing_does_not_keep_it_from_ending():
    read, write = os.pipe()
    os.set_blocking(write, False)
    with contextlib.suppress(BlockingIOError):
        while True:
            os.write(write, b"x" * 4096)
    os.set_blocking(write, True)
    asked = threading.Event()
    with MjpegServer(FILES, fps=50, note=lambda number: asked.set()) as server:
        command = [sys.executable, "-m", "lightgesture", "live", server.address, "--json", "--frames"]
        child = subprocess.Popen(command, stdout=write, stderr=subprocess.PIPE, encoding="utf-8")
        assert asked.wait(30)
        time.sleep(0.5)
        child.send_signal(signal.SIGTERM)
        said = child.communicate(timeout=40)[1]
    os.close(read)
    os.close(write)
    assert child.returncode == ExitStatus.OK
    assert "records were dropped" in said
    assert "Fatal" not in said


def test_a_reader_of_the_results_who_leaves():
    with MjpegServer(FILES, fps=50) as server, live(server.address, "--json", "--frames") as child:
        child.stdout.readline()
        child.stdout.close()
        assert child.wait(20) == ExitStatus.SOME_FAILED


def test_options_of_the_command_may_stand_in_a_file(tmp_path, run, fake, monkeypatch):
    config = tmp_path / "live.toml"
    config.write_text('udp = ["127.0.0.1:9"]\nhook = ["true"]\nsize = "16x16"\njson = true\nquiet = true\n')
    result = run_on_standard_input(run, monkeypatch, bytes(768), "--config", config)
    assert (result.status, result.err) == (ExitStatus.OK, [])
    assert fake.made[0].seen[0][2] == (16, 16, 3)
