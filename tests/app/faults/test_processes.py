"""Memory that is not there, a clock that is set back, a hook that hangs: told in a line, and nothing else suffers."""

import contextlib
import json
import os
import resource
import subprocess
import sys
import threading
import time
from datetime import UTC, datetime, timedelta
from types import SimpleNamespace

import av
import cv2
import numpy as np
import pytest

from lightgesture.errors import ExitStatus, is_out_of_memory
from lightgesture.sources.decoding import StreamDecoder

MEBIBYTE = 1 << 20
JPEG = cv2.imencode(".jpg", np.full((48, 64, 3), 90, np.uint8))[1].tobytes()

NO_MEMORY = [
    MemoryError(),
    np.exceptions.AxisError("Unable to allocate 1.0 GiB for an array"),
    cv2.error("OpenCV(4.10.0) alloc.cpp:73: error: (-4:Insufficient memory) Failed to allocate 9 bytes"),
    ImportError("libx265.so: failed to map segment from shared object"),
    RuntimeError("std::bad_alloc"),
    OSError(12, "Cannot allocate memory"),
]
"""As the libraries tell it."""


@pytest.mark.parametrize("error", NO_MEMORY, ids=lambda error: type(error).__name__)
def test_a_memory_that_is_too_small_costs_its_input_and_is_no_defect(
    run, fake, make_video, monkeypatch, error
):
    process = fake.process

    def fail_on_the_first(pipeline, *frame):
        if "first" in (pipeline.source or ""):
            raise error
        return process(pipeline, *frame)

    monkeypatch.setattr(fake, "process", fail_on_the_first)
    result = run("decode", make_video("first.avi", 4), make_video("second.avi", 4), "--json", "--quiet")
    assert result.status == ExitStatus.SOME_FAILED
    assert len(result.err) == 1
    assert "first.avi: the memory is too small (" in result.err[0]
    assert [json.loads(line)["type"] for line in result.out][-1] == "summary"


def test_other_errors_are_not_blamed_on_the_memory():
    assert not is_out_of_memory(ValueError("no such mode"))
    assert not is_out_of_memory(OSError(28, "No space left on device"))


@pytest.mark.parametrize(
    "error",
    [
        av.error.MemoryError(12, "Cannot allocate memory"),
        av.error.BlockingIOError(11, "Resource temporarily unavailable"),  # of threads
    ],
)
def test_a_frame_for_which_there_is_no_memory_is_not_taken_for_a_damaged_one(error):
    """It would be left out, and a sign with it."""

    def decode(packet):
        raise error

    stream = SimpleNamespace(
        codec_context=SimpleNamespace(name="mpeg4", decode=decode, is_open=False, options={})
    )
    decoder = StreamDecoder(SimpleNamespace(format=SimpleNamespace(name="mp4")), stream, print)
    with pytest.raises(MemoryError):
        decoder.decode(None)


@pytest.mark.slow
@pytest.mark.parametrize("limit_mib", [250, 320, 380, 420, 440, 460, 500])
def test_under_a_limit_it_decodes_rightly_or_says_so(limit_mib):
    """Some of these limits are met while libraries are loaded, some while frames are decoded.

    Matrix products run in one thread, for OpenBLAS crashes where it gets no memory for more, while it is loaded.
    """

    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (limit_mib * MEBIBYTE, limit_mib * MEBIBYTE))

    command = [sys.executable, "-m", "lightgesture", "decode", "--json", "--quiet"]
    env = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, capture_output=True, text=True, preexec_fn=limit, env=env, timeout=200)
    issued = [
        one["text"] for one in map(json.loads, done.stdout.splitlines()) if one["type"] == "instruction"
    ]
    told = [line for line in done.stderr.splitlines() if line.startswith("lightgesture: ")]
    if done.returncode == ExitStatus.OK:
        assert issued == ["STOP HOVER 50 GO"]
        assert told == []
    else:
        assert done.returncode == ExitStatus.SOME_FAILED
        assert issued in ([], ["STOP HOVER 50 GO"])
        assert len(told) == 1
        assert "the memory is too small" in told[0]


def live(run, monkeypatch, fake, *options):
    """`live` on four pictures, each of which waits for the one before it to be decoded."""
    read, write = os.pipe()

    def feed():
        with os.fdopen(write, "wb") as stream, contextlib.suppress(BrokenPipeError):
            for count in range(4):
                stream.write(JPEG)
                stream.flush()
                while not fake.made or len(fake.made[0].seen) <= count:
                    time.sleep(0.002)

    threading.Thread(target=feed, daemon=True).start()
    with os.fdopen(read) as stream:
        monkeypatch.setattr(sys, "stdin", stream)
        return run("live", "-", "--json", *options)


def test_a_clock_that_is_set_back_changes_no_record(run, fake, monkeypatch):
    """By an hour each time that somebody asks it."""

    class Clock(datetime):
        asked = 0

        @classmethod
        def now(cls, zone=None):
            cls.asked += 1
            return datetime(2026, 5, 4, 12, tzinfo=UTC) - timedelta(hours=cls.asked)

    start_s = time.time()
    moments = iter(range(10**6))
    monkeypatch.setattr(time, "time", lambda: start_s - 3600 * next(moments))
    monkeypatch.setattr("lightgesture.actions.live.datetime", Clock)
    result = live(run, monkeypatch, fake)
    assert result.status == ExitStatus.OK
    records = [json.loads(line) for line in result.out]
    times = [record["time_s"] for record in records if "time_s" in record]
    assert times == sorted(times)
    assert "instruction" in [record["type"] for record in records]
    assert fake.made[0].start_utc == pytest.approx(
        datetime(2026, 5, 4, 11, tzinfo=UTC), abs=timedelta(seconds=5)
    )
    assert Clock.asked == 1


def test_a_hook_that_hangs_is_ended_and_the_rest_goes_on(run, fake, monkeypatch, tmp_path):
    monkeypatch.setattr("lightgesture.sinks.hook.TIMEOUT_S", 0.3)
    start_s = time.monotonic()
    result = live(run, monkeypatch, fake, "--hook", "sleep 60", "--hook", f"tee {tmp_path / 'other'}")
    assert time.monotonic() - start_s < 20
    assert result.status == ExitStatus.OK
    assert [line for line in result.err if "hook" in line] == [
        "lightgesture: hook sleep 60: killed after 0.3 s"
    ]
    issued = [line for line in result.out if '"type":"instruction"' in line]
    assert (tmp_path / "other").read_text().splitlines() == issued
    assert len(issued) == 1
