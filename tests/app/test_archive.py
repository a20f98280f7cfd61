"""Many inputs: what is done again, who may write, worker processes, order, pictures named one by one."""

import json
import os
import signal
import subprocess
import sys
import time

import filelock
import pytest

from lightgesture.archive.board import Board, table
from lightgesture.archive.folder import LOCK, MANIFEST
from lightgesture.archive.tasks import Advanced, Done, Opened, Outcome, Printed, make_tasks
from lightgesture.errors import ExitStatus

TIMES = ("ms_per_frame", "stages_ms")


def without_times(path):
    """The content of a file of results; of records all but the fields that tell how long they took."""
    if path.suffix != ".jsonl":
        return path.read_bytes()
    records = [json.loads(line) for line in path.read_text("utf-8").splitlines()]
    return [{key: value for key, value in record.items() if key not in TIMES} for record in records]


def results(folder):
    return {
        path.name: without_times(path)
        for path in folder.iterdir()
        if not path.name.startswith(".lightgesture")
    }


def command(*arguments):
    return [sys.executable, "-m", "lightgesture", "decode", *map(str, arguments)]


@pytest.fixture
def archive(run, make_video, tmp_path, fake):
    """Decodes two videos to a folder and tells which of them were decoded."""
    videos = [make_video("a.avi", 4), make_video("b.avi", 3)]

    def call(*options):
        fake.made.clear()
        result = run("decode", *videos, "--out", tmp_path / "out", *options)
        call.result = result
        return [os.path.basename(pipeline.source) for pipeline in fake.made if pipeline.source]

    call.videos, call.out = videos, tmp_path / "out"
    return call


def test_standard_input_does_not_go_to_other_machines(run):
    result = run("decode", "-", "--cluster", "tcp://127.0.0.1:9")
    assert result.status == ExitStatus.USAGE
    assert result.err == ["lightgesture: -: standard input reaches no other machine; leave out --cluster"]


def test_what_is_done_is_not_done_again(archive):
    assert archive() == ["a.avi", "b.avi"]
    before = results(archive.out)
    assert archive() == []
    assert archive.result.status == ExitStatus.OK
    assert archive.result.out == []
    assert archive.result.err[0] == "lightgesture: 2 of 2 inputs done before and unchanged; not decoded again"
    assert archive.result.err[2].split()[1:] == ["4", "1", "1", "-", "done", "before"]
    assert results(archive.out) == before
    assert archive("--quiet", "--jobs", 2, "--json") == [], "these change no file"


@pytest.mark.parametrize(
    "options", [["--hold", "3"], ["--frames"], ["--mirrored"], ["--grammar", "other.toml"]]
)
def test_another_configuration_does_all_again(archive, options):
    archive()
    assert archive(*options) == ["a.avi", "b.avi"]


def test_a_changed_model_does_all_again(archive, tmp_path):
    model = tmp_path / "model.npz"
    model.write_bytes(b"one")
    archive("--model", model)
    assert archive("--model", model) == []
    model.write_bytes(b"two")
    assert archive("--model", model) == ["a.avi", "b.avi"]


def test_a_changed_input_and_a_lost_result_are_done_again(archive, make_video):
    archive()
    make_video("a.avi", 5)
    assert archive() == ["a.avi"]
    (archive.out / "b.vtt").unlink()
    assert archive() == ["b.avi"]
    assert archive() == []


@pytest.mark.parametrize(
    "content",
    ["", "{", "[]", '{"format": 1, "inputs": {"a": 1}}', '{"format": 99, "inputs": {}}', "[" * 9999],
)
def test_a_damaged_manifest_does_all_again(archive, content):
    archive()
    (archive.out / MANIFEST).write_text(content)
    assert archive() == ["a.avi", "b.avi"]
    assert archive() == []


def test_a_failed_input_is_tried_again(archive, make_video):
    video = make_video("a.avi", 60)
    video.write_bytes(video.read_bytes()[: video.stat().st_size // 2])
    archive()
    assert (archive.out / "a.jsonl").exists()
    assert archive() == ["a.avi"]
    assert archive.result.status == ExitStatus.SOME_FAILED


def test_results_of_another_input_are_not_overwritten(run, make_video, tmp_path):
    out = tmp_path / "out"
    run("decode", make_video("x/dive.avi", 4), "--out", out)
    before = results(out)
    other = make_video("y/dive.avi", 5)
    result = run("decode", other, "--out", out)
    assert result.status == ExitStatus.SOME_FAILED
    assert f"{other}: {out / 'dive'}.* are the results of {tmp_path / 'x' / 'dive.avi'}" in result.err[0]
    assert results(out) == before


def test_two_runs_into_one_folder(archive):
    archive()
    with filelock.FileLock(archive.out / LOCK):
        assert archive() == []
    assert archive.result.status == ExitStatus.USAGE
    assert archive.result.err == [
        f"lightgesture: {archive.out}: another run writes into this folder; "
        "wait for its end or name another --out"
    ]
    archive.videos[0].touch()
    assert archive() == ["a.avi"], "the lock is free again"


def test_what_a_killed_run_left_is_removed(archive):
    archive.out.mkdir()
    (archive.out / f".{'0' * 32}.part").touch()
    (archive.out / "mine.part").touch()
    archive()
    assert sorted(name for name in os.listdir(archive.out) if name.endswith(".part")) == ["mine.part"]


def test_pictures_of_one_folder_are_one_input(run, make_folder, make_video, fake):
    folder = make_folder("frames", 12)
    result = run("decode", make_video("a.avi", 2), folder / "1*.png", "--json")
    assert (result.status, fake.made[-1].source) == (ExitStatus.OK, str(folder))
    assert [index for index, _, _ in fake.made[-1].seen] == [0, 1, 2, 3]
    result = run("decode", *sorted(folder.iterdir()), "--fps", 4)
    assert [time_s for _, time_s, _ in fake.made[-1].seen][:3] == [0.0, 0.25, 0.5]
    assert len(fake.made[-1].seen) == 12


def test_tasks_of_pictures(tmp_path, monkeypatch, make_picture):
    monkeypatch.chdir(tmp_path)
    for name in ("f/10.png", "f/9.png", "g/1.png", "1.png", "2.png"):
        make_picture(name)
    tasks = make_tasks(["f/10.png", "a.mp4", "f/9.png", "g/1.png", "1.png", "f/gone.png", "2.png"])
    assert [(task.path, task.stem, task.pictures) for task in tasks] == [
        ("f", "f", ("9.png", "10.png")),
        ("a.mp4", "a", ()),
        ("g/1.png", "1", ()),
        (".", tmp_path.name, ("1.png", "2.png")),
        ("f/gone.png", "gone", ()),
    ]
    assert [task.place for task in tasks] == [0, 1, 2, 3, 4]


def test_a_single_picture_is_told_where_it_belongs(run, make_picture):
    assert "use `lightgesture recognize`" in run("decode", make_picture("a.png")).err[0]


def test_results_come_in_the_order_of_the_inputs(capsys):
    board = Board(make_tasks(["a", "b", "c"]), quiet=True)
    with board:
        board.hear(Printed(1, ("b1",)))
        board.hear(Done(2, Outcome("failed", "c: broken")))
        board.hear(Printed(0, ("a1",)))
        assert capsys.readouterr().out == "a1\n", "the first one's at once"
        board.hear(Done(1, Outcome("ok")))
        assert capsys.readouterr() == ("", "")
        board.hear(Done(0, Outcome("ok")))
    assert capsys.readouterr() == ("b1\n", "lightgesture: c: broken\n")


def test_progress_has_a_line_for_each_running_input_and_one_for_all(capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    with Board(make_tasks(["a.mp4", "b\n.mp4"]), quiet=False) as board:
        board.hear(Opened(1, 100))
        board.hear(Advanced(1, 25))
        board.hear(Opened(0, 300))
        board.hear(Printed(0, ("result",)))
        board.hear(Done(1, Outcome("ok", frames=100)))
        board.hear(Done(0, Outcome("ok", frames=300)))
    out, err = capsys.readouterr()
    assert out == "result\n"
    for text in ("all inputs", "a.mp4", r"b\n.mp4", "/400", "/100"):
        assert text in err


def test_table():
    tasks = make_tasks(["a.mp4", "line\nfeed.mp4"])
    outcomes = {0: Outcome("ok", None, 300, 2, 1, seconds=2.0), 1: Outcome("failed", "broken")}
    assert table(tasks, outcomes) == [
        "input           frames  instructions  rejected  frames/s  status",
        "a.mp4              300             2         1     150.0  ok",
        "line\\nfeed.mp4       0             0         0         -  failed",
        "2 inputs           300             2         1         -  1 failed",
    ]


@pytest.mark.parametrize("options", [["--jobs", "0"], ["--jobs", "some"], ["--annotate"], ["--plot"]])
def test_wrong_use(run, make_video, options):
    result = run("decode", make_video(), *options)
    assert (result.status, len(result.err)) == (ExitStatus.USAGE, 1)


def test_an_extra_that_is_not_there(run, make_video, tmp_path, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    result = run("decode", make_video(), "--plot", "--out", tmp_path / "out")
    assert result.status == ExitStatus.USAGE
    assert "--plot needs" in result.err[0]
    assert "pip install 'lightgesture[" in result.err[0]


def test_workers_give_the_same_results(run, make_video, make_folder, tmp_path):
    """The real pipeline, by one process and by two."""
    inputs = [make_video("a.avi", 4), tmp_path / "gone.avi", make_folder("frames", 3)]
    found = []
    for jobs in (1, 2):
        out = tmp_path / f"out{jobs}"
        result = run("decode", *inputs, "--jobs", jobs, "--out", out, "--frames", "--json")
        printed = [{**json.loads(line), **dict.fromkeys(TIMES)} for line in result.out]
        found.append((result.status, printed, result.err[0], results(out)))
    assert found[0] == found[1]
    assert found[0][0] == ExitStatus.SOME_FAILED
    assert [record["type"] for record in found[0][1]].count("frame") == 7


def test_a_wrong_model_is_told_once_by_workers(run, make_video, tmp_path):
    model = tmp_path / "model.npz"
    model.write_bytes(b"no model")
    result = run("decode", make_video("a.avi"), make_video("b.avi"), "--jobs", 2, "--model", model)
    assert (result.status, len(result.err)) == (ExitStatus.USAGE, 1)
    assert str(model) in result.err[0]


def test_a_folder_that_cannot_be_written(run, make_video):
    result = run("decode", make_video(), "--out", "/proc")
    assert result.status == ExitStatus.USAGE
    assert len(result.err) == 1
    assert result.err[0].startswith("lightgesture: /proc: cannot be written (")


@pytest.fixture
def start(make_folder, tmp_path):
    """Starts the command in a group of its own on long inputs and waits until `jobs` of them are at work."""
    inputs = [make_folder(name, 200) for name in ("one", "two", "three")]
    out = tmp_path / "out"

    def call(jobs, count=3):
        process = subprocess.Popen(
            command(*inputs[:count], "--jobs", jobs, "--out", out),
            stderr=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
            start_new_session=True,
        )
        wait_for(lambda: len(list(out.glob(".*.part"))) == 3 * jobs)
        return process

    call.out = out
    return call


@pytest.mark.slow
@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_leaves_nothing_half_written(start, jobs, stop):
    process = start(jobs)
    # A terminal sends Ctrl-C to the whole group, a service manager's signal may reach the parent alone.
    if stop == signal.SIGINT:
        os.killpg(process.pid, stop)
    else:
        process.send_signal(stop)
    _, err = process.communicate(timeout=120)
    assert process.returncode == ExitStatus.INTERRUPTED
    assert err == "lightgesture: interrupted; the results of finished inputs are kept\n"
    assert os.listdir(start.out) == [LOCK]


@pytest.mark.slow
def test_workers_die_with_their_parent(start):
    process = start(2)
    process.kill()
    process.wait()
    wait_for(lambda: os.listdir(start.out) == [LOCK])  # they clean up
    wait_for(lambda: not _workers(process.pid, group=True))  # and are gone


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="finds the workers through /proc")
def test_a_worker_that_dies_costs_its_own_input(start):
    process = start(2)
    os.kill(_workers(process.pid)[0], signal.SIGKILL)
    _, err = process.communicate(timeout=500)
    assert process.returncode == ExitStatus.SOME_FAILED
    (told,) = [line for line in err.splitlines() if line.startswith("lightgesture: ")]
    assert "the process that decoded it ended (signal 9)" in told
    names = os.listdir(start.out)
    assert len([name for name in names if name.endswith(".jsonl")]) == 2
    assert not [name for name in names if name.endswith(".part")]


def _workers(parent, group=False):
    """Processes that were spawned by `parent`, or that are of its group, to decode."""
    found = []
    for place in (path for path in os.listdir("/proc") if path.isdigit()):
        try:
            with open(f"/proc/{place}/stat") as stat, open(f"/proc/{place}/cmdline") as line:
                fields = stat.read().rpartition(")")[2].split()
                is_worker = "spawn_main" in line.read()
        except OSError:
            continue
        if is_worker and int(fields[2 if group else 1]) == parent:
            found.append(int(place))
    return sorted(found)


def wait_for(condition, seconds=120.0):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "never came about"
        time.sleep(0.02)
