"""Decoding on a Dask cluster: a scheduler and two workers, each a process of its own, on loopback."""

import json
import os
import socket
import subprocess
import sys
import time

import pytest

from lightgesture.errors import ExitStatus

TIMES = ("ms_per_frame", "stages_ms")


def results(folder):
    found = {}
    for path in folder.iterdir():
        if path.suffix == ".jsonl":
            records = [json.loads(line) for line in path.read_text("utf-8").splitlines()]
            found[path.name] = [{k: v for k, v in each.items() if k not in TIMES} for each in records]
        elif not path.name.startswith(".lightgesture"):
            found[path.name] = path.read_bytes()
    return found


def wait_for(condition, seconds=240.0):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "never came about"
        time.sleep(0.02)


def decode(*arguments):
    command = [sys.executable, "-m", "lightgesture", "decode", *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.fixture
def dask(tmp_path):
    """Starts a program of Dask in another folder."""
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    processes = []

    def start(*arguments):
        command = [sys.executable, "-m", "dask", *map(str, arguments), "--no-dashboard"]
        processes.append(
            subprocess.Popen(command, cwd=elsewhere, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        )
        return processes[-1]

    yield start
    for process in processes:
        process.kill()
        process.wait()


def start_worker(dask, address):
    return dask("worker", address, "--no-nanny", "--nthreads", "1", "--host", "127.0.0.1")


@pytest.fixture
def cluster(dask, tmp_path):
    """Address of the scheduler, and the processes of its two workers."""
    file = tmp_path / "scheduler.json"
    dask("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", file)
    wait_for(file.exists)
    address = json.loads(file.read_text())["address"]
    return address, [start_worker(dask, address) for _ in range(2)]


@pytest.mark.slow
def test_same_results_as_here_and_a_killed_workers_video_is_done_by_the_other(cluster, make_video, tmp_path):
    address, workers = cluster
    videos = [make_video(f"dive{number}.avi", 250) for number in range(3)]
    broken = tmp_path / "zero.avi"
    broken.touch()
    inputs = [os.path.relpath(path) for path in videos]  # the workers run in another folder
    here = decode(
        *inputs, broken, "--out", tmp_path / "here", "--frames", "--annotate", "--plot", "--jobs", 1
    )
    out_here, err_here = here.communicate(timeout=500)
    out = tmp_path / "there"
    there = decode(*inputs, broken, "--out", out, "--frames", "--annotate", "--plot", "--cluster", address)
    wait_for(lambda: len(list(out.glob(".*.part"))) >= 8)  # four open files of a video: both are at work
    workers[0].kill()
    out_there, err_there = there.communicate(timeout=500)
    assert (here.returncode, there.returncode) == (ExitStatus.SOME_FAILED, ExitStatus.SOME_FAILED)
    assert workers[1].poll() is None
    assert results(out) == results(tmp_path / "here")
    assert len(results(out)) == 15
    assert not list(out.glob(".*.part"))
    assert err_there.splitlines()[0] == err_here.splitlines()[0], "the broken one is named alike"
    assert [line for line in out_there.splitlines() if "ms a frame" not in line] == [
        line for line in out_here.splitlines() if "ms a frame" not in line
    ]


@pytest.mark.slow
def test_a_scheduler_that_is_lost_and_comes_back(dask, make_video, tmp_path):
    """The run ends with a line, keeps what is finished, and goes on where a scheduler is there again."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    address, out = f"tcp://127.0.0.1:{port}", tmp_path / "out"
    inputs = [make_video("first.avi", 20), make_video("second.avi", 2000)]
    scheduler = dask("scheduler", "--host", "127.0.0.1", "--port", port)
    worker = start_worker(dask, address)
    run = decode(*inputs, "--out", out, "--cluster", address)
    wait_for(lambda: (out / ".lightgesture.json").exists())  # the first is done and noted
    scheduler.kill()
    _, err = run.communicate(timeout=200)
    worker.kill()
    assert run.returncode == ExitStatus.SOME_FAILED
    assert [line for line in err.splitlines() if "scheduler" in line] == [
        f"lightgesture: --cluster: the scheduler at {address} was lost; the results of finished inputs are kept: "
        "run again when it is back"
    ]
    assert "Traceback" not in err
    dask("scheduler", "--host", "127.0.0.1", "--port", port)
    start_worker(dask, address)
    before = (out / "first.jsonl").stat().st_mtime_ns
    inputs[1].unlink()
    make_video("second.avi", 20)
    run = decode(*inputs, "--out", out, "--cluster", address)
    _, err = run.communicate(timeout=200)
    assert run.returncode == ExitStatus.OK, err
    assert "1 of 2 inputs done before" in err
    assert (out / "first.jsonl").stat().st_mtime_ns == before
    assert (out / "second.jsonl").exists()


def test_no_scheduler_there(run, make_video, monkeypatch):
    monkeypatch.setattr("lightgesture.archive.cluster.CONNECT_S", 0.3)
    result = run("decode", make_video(), "--cluster", "tcp://127.0.0.1:9")
    assert result.status == ExitStatus.USAGE
    assert result.err == [
        "lightgesture: --cluster: no scheduler answers at tcp://127.0.0.1:9; "
        "check the address, such as tcp://HOST:8786"
    ]
    assert run("decode", make_video(), "--cluster", "some where:x").status == ExitStatus.USAGE


def test_dask_is_not_there(run, make_video, monkeypatch):
    monkeypatch.setitem(sys.modules, "dask.distributed", None)
    result = run("decode", make_video(), "--cluster", "tcp://127.0.0.1:9")
    assert result.err == ["lightgesture: --cluster needs Dask; pip install 'lightgesture[cluster]'"]
