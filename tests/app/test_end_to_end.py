"""The real pipeline behind the command line: what is wrong with its files, and that nothing else speaks."""

import json
import subprocess
import sys

import cv2
import numpy as np
import pytest

from lightgesture.errors import ExitStatus

NOISE = np.random.default_rng(1)


@pytest.mark.parametrize("command", ["decode", "recognize"])
@pytest.mark.parametrize("content", [None, b"", b"PK\x03\x04 cut off", b"no model" * 100])
def test_bad_model_file(run, make_picture, make_video, tmp_path, command, content):
    model = tmp_path / "my model.npz"
    if content is not None:
        model.write_bytes(content)
    path = make_video() if command == "decode" else make_picture("a.png")
    result = run(command, path, "--model", model)
    assert (result.status, result.out) == (ExitStatus.USAGE, [])
    assert len(result.err) == 1
    assert result.err[0].startswith(f"lightgesture: {model}: ")


def test_a_model_that_is_missing_leaves_no_results(run, make_video, tmp_path):
    result = run("decode", make_video(), "--model", tmp_path / "no.npz", "--out", tmp_path / "out")
    assert (result.status, result.out) == (ExitStatus.USAGE, [])
    assert len(result.err) == 1
    assert result.err[0].startswith(f"lightgesture: {tmp_path / 'no.npz'}: cannot be read")
    assert [path.name for path in (tmp_path / "out").iterdir()] == [".lightgesture.lock"]


@pytest.mark.parametrize("content", [None, "", "[dwell]\nhodl = 3\n", "= no TOML"])
def test_bad_grammar(run, make_video, tmp_path, content):
    grammar = tmp_path / "my grammar.toml"
    if content is not None:
        grammar.write_text(content)
    result = run("decode", make_video(), "--grammar", grammar)
    assert (result.status, result.out) == (ExitStatus.USAGE, [])
    assert len(result.err) == 1
    assert result.err[0].startswith(f"lightgesture: {grammar}: ")


def test_nothing_but_our_own_lines_on_standard_error(make_video, tmp_path):
    """FFmpeg and libpng complain about these inputs by themselves."""
    folder = tmp_path / "broken"
    folder.mkdir()
    content = cv2.imencode(".png", NOISE.integers(0, 255, (60, 60, 3), dtype=np.uint8))[1].tobytes()
    (folder / "1.png").write_bytes(content[: len(content) // 2])
    cut = make_video("cut.mp4", 20, "mp4v")
    cut.write_bytes(cut.read_bytes()[:2000])
    good = make_video("good.avi", 3)
    command = [sys.executable, "-m", "lightgesture", "decode", str(folder), str(cut), str(good), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == ExitStatus.SOME_FAILED
    lines = done.stderr.splitlines()
    assert len(lines) == 7, "two errors and the table"
    for line, path in zip(lines[:2], (folder, cut), strict=True):
        assert line.startswith(f"lightgesture: {path}: ")
    summary = json.loads(done.stdout.splitlines()[-1])
    assert (summary["source"], summary["frames"], summary["status"]) == (str(good), 3, "ok")


def test_frames_of_any_size_and_depth(run, make_picture):
    for number, shape in enumerate([(48, 64, 3), (480, 640, 3), (1, 1, 3), (2, 300, 3), (300, 2), (7, 7)]):
        picture = NOISE.integers(0, 255, shape, dtype=np.uint8)
        folder = make_picture(f"frames/{number}.png", picture).parent
    make_picture("frames/9.png", NOISE.integers(0, 65535, (50, 50), dtype=np.uint16))
    result = run("decode", folder, "--json", "--frames")
    assert (result.status, result.err) == (ExitStatus.OK, [])
    assert sum(json.loads(line)["type"] == "frame" for line in result.out) == 7
    assert run("recognize", *sorted(folder.iterdir()), "--json").status == ExitStatus.OK
