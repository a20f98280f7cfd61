"""Disks that are full, read-only or slow, and a loss of power: what is there is whole, the rest is told in a line."""

import contextlib
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from lightgesture.archive.folder import LOCK, MANIFEST
from lightgesture.errors import ExitStatus, UsageError
from lightgesture.results import DebugPictures
from lightgesture.results.atomic import replacing, replacing_folder

SMALL_BYTES = 16 * 1024


@pytest.fixture
def mounted(tmp_path):
    """Mounts a small file system in memory; skips where this user may not."""
    place = tmp_path / "small"
    place.mkdir()
    done = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={SMALL_BYTES}", "tmpfs", str(place)], capture_output=True
    )
    if done.returncode:
        pytest.skip("only root may mount a file system")
    yield place
    subprocess.run(["umount", "--lazy", str(place)], check=True)


@pytest.fixture
def many_frames(run, fake, make_video):
    """Decodes a video whose records of frames are more than a small disk holds."""
    video = make_video("long.avi", 300)
    return lambda out, *options: run("decode", video, "--out", out, "--frames", *options)


def test_a_full_disk_ends_the_run_with_a_line_and_leaves_nothing_half(many_frames, mounted):
    result = many_frames(mounted)
    assert result.status == ExitStatus.USAGE
    assert result.err[-1] == (
        f"lightgesture: {mounted / 'long.jsonl'}: cannot be written (No space left on device); name another folder"
    )
    assert os.listdir(mounted) == [LOCK]


def test_a_full_disk_keeps_what_was_there(run, fake, make_video, many_frames, mounted):
    run("decode", make_video("short.avi", 4), "--out", mounted)
    before = {path.name: path.read_bytes() for path in mounted.iterdir()}
    assert many_frames(mounted).status == ExitStatus.USAGE
    assert {path.name: path.read_bytes() for path in mounted.iterdir()} == before


@pytest.mark.slow
def test_a_full_disk_under_an_annotated_video(run, make_video, mounted):
    result = run("decode", make_video("long.avi", 300), "--out", mounted, "--annotate")
    assert result.status == ExitStatus.USAGE
    assert "No space left on device" in result.err[-1]
    assert os.listdir(mounted) == [LOCK]


def test_a_read_only_disk(many_frames, mounted):
    subprocess.run(["mount", "-o", "remount,ro", str(mounted)], check=True)
    result = many_frames(mounted)
    assert result.status == ExitStatus.USAGE
    assert result.err[-1].startswith(f"lightgesture: {mounted}: cannot be written (Read-only file system)")
    assert result.out == []


def test_a_file_that_may_grow_no_further(many_frames, tmp_path):
    """A quota: as a full disk, wherever this test runs."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (SMALL_BYTES, before[1]))
    try:
        result = many_frames(tmp_path / "out")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    assert result.status == ExitStatus.USAGE
    assert result.err[-1].startswith(
        f"lightgesture: {tmp_path / 'out' / 'long.jsonl'}: cannot be written (File too large)"
    )
    assert os.listdir(tmp_path / "out") == [LOCK]


def test_a_slow_disk_changes_no_result(run, fake, make_video, tmp_path, monkeypatch):
    video, sync = make_video("a.avi", 4), os.fsync
    fast = run("decode", video, "--out", tmp_path / "fast").out
    monkeypatch.setattr(os, "fsync", lambda handle: (time.sleep(0.05), sync(handle)))
    assert run("decode", video, "--out", tmp_path / "slow").out[:-1] == fast[:-1]
    names = {"a.jsonl", "a.csv", "a.vtt", "dives.csv", MANIFEST, LOCK}
    assert set(os.listdir(tmp_path / "slow")) == names == set(os.listdir(tmp_path / "fast"))


def test_a_stream_goes_on_where_its_pictures_of_stages_fill_the_disk(mounted):
    told = []
    debug = DebugPictures(mounted / "live", told.append)
    picture = np.random.default_rng(1).integers(0, 255, (48, 64, 3), np.uint8)
    for index in range(6):
        debug.select(float(index))
        debug.write("mask", index, picture)
    place = mounted / "live" / "mask-000001.png"
    assert told == [
        f"{place}: cannot be written (No space left on device); name another folder; "
        "decoding goes on without pictures of the stages"
    ]
    assert os.listdir(mounted / "live") == ["mask-000000.png"]


@pytest.mark.parametrize("tell", [None, print])
def test_a_place_that_never_took_a_picture_of_a_stage_is_told_at_once(tmp_path, tell):
    (tmp_path / "file").touch()
    debug = DebugPictures(tmp_path / "file" / "live", tell)
    debug.select(0.0)
    with pytest.raises(UsageError, match="cannot be written"):
        debug.write("mask", 0, np.zeros((4, 4, 3), np.uint8))


@pytest.fixture
def done(monkeypatch):
    """What is done to the disk, in order: what is put on it, by kind, and that a name is given."""
    found, sync, rename = [], os.fsync, os.replace

    def note_sync(handle):
        found.append("folder" if os.path.isdir(f"/proc/self/fd/{handle}") else "file")
        sync(handle)

    def note_rename(source, target):
        found.append("rename")
        rename(source, target)

    monkeypatch.setattr(os, "fsync", note_sync)
    monkeypatch.setattr(os, "replace", note_rename)
    return found


@pytest.mark.skipif(sys.platform != "linux", reason="knows by /proc what is synced")
def test_a_loss_of_power_leaves_all_of_a_file_or_nothing(done, tmp_path):
    """The content is on the disk before it has its name, and the name before anybody is told."""
    with replacing(tmp_path / "a.txt") as place:
        place.write_text("whole")
    assert done == ["file", "rename", "folder"]


@pytest.mark.skipif(sys.platform != "linux", reason="knows by /proc what is synced")
def test_a_loss_of_power_leaves_all_of_a_folder_or_nothing(done, tmp_path):
    with replacing_folder(tmp_path / "a") as place:
        (place / "one").write_text("1")
        (place / "in").mkdir()
        (place / "in" / "two").write_text("2")
    before, after = done[: done.index("rename")], done[done.index("rename") + 1 :]
    assert sorted(before) == ["file", "file", "folder", "folder"]
    assert before[-1] == "folder"
    assert after == ["folder"]


def test_a_disk_that_fails_at_the_last_moment_gives_no_name(tmp_path, monkeypatch):
    def fail(handle):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(UsageError, match="Input/output error"), replacing(tmp_path / "a.txt") as place:
        place.write_text("lost")
    assert os.listdir(tmp_path) == []


KILLS = 8
"""Moments at which a run is ended without a word, from its start to beyond its end."""


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_killed_at_any_moment_what_has_its_name_is_whole(make_video, tmp_path, number):
    videos = [make_video(f"{name}.avi", 60) for name in "abc"]
    command = [
        sys.executable,
        "-m",
        "lightgesture",
        "decode",
        *map(str, videos),
        "--jobs",
        "1",
        "--frames",
        "--out",
    ]
    whole = tmp_path / "whole"
    start_s = time.monotonic()
    subprocess.run([*command, str(whole)], check=True, capture_output=True)
    lasts_s = time.monotonic() - start_s
    expected = contents(whole)
    for kill in range(KILLS):
        out = tmp_path / f"{number}-{kill}"
        process = subprocess.Popen([*command, str(out)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(lasts_s * (0.3 + 0.8 * kill / KILLS))
        process.send_signal(number)
        process.wait()
        left = contents(out) if out.is_dir() else {}
        assert set(left) <= set(expected), kill
        for name in set(left) - {"dives.csv"}:
            assert left[name] == expected[name], (kill, name)
        subprocess.run([*command, str(out)], check=True, capture_output=True)
        assert contents(out) == expected
        shutil.rmtree(out)


def contents(folder):
    """Name to content of what has its final name, without the times of records."""
    found = {}
    for path in folder.iterdir():
        if path.name.startswith("."):
            continue
        if path.suffix == ".jsonl":
            lines = [json.loads(line) for line in path.read_text("utf-8").splitlines()]
            found[path.name] = [
                {key: value for key, value in line.items() if key not in ("ms_per_frame", "stages_ms")}
                for line in lines
            ]
        else:
            found[path.name] = path.read_bytes()
    return found
