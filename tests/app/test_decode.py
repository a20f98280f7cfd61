"""`decode`: what is printed and written, for good inputs and bad ones, through the command line."""

import json

import numpy as np
import pytest

from lightgesture.actions import decode as decoding
from lightgesture.errors import ExitStatus

pytestmark = pytest.mark.usefixtures("fake")


def records(lines):
    return [json.loads(line) for line in lines]


def names(folder):
    """The files of results of each input, without the manifest, the lock and the table over all."""
    passed = (".lightgesture", "dives.csv")
    return sorted(path.name for path in folder.iterdir() if not path.name.startswith(passed))


def of(stem):
    return [f"{stem}.csv", f"{stem}.jsonl", f"{stem}.vtt"]


def types(lines):
    return [record["type"] for record in records(lines)]


def test_json_records(run, make_video):
    path = make_video("dive.avi", 4)
    result = run("decode", path, "--json")
    assert result.status == ExitStatus.OK
    assert result.err == []
    assert types(result.out) == ["word", "state", "instruction", "notice", "rejected", "summary"]
    assert {record["source"] for record in records(result.out)} == {str(path)}
    word = records(result.out)[0]
    assert (word["frame"], word["time_s"]) == (1, 0.05)


def test_frame_records_on_request(run, make_folder):
    result = run("decode", make_folder("frames", 3), "--json", "--frames")
    assert types(result.out).count("frame") == 3


def test_plain_words(run, make_video):
    path = make_video("dive.avi", 4)
    result = run("decode", path)
    assert result.err == []
    assert result.out == [
        str(path),
        "     0.10 s  STOP HOVER GO  (confidence 0.95)",
        "     0.10 s  notice: 3,left is no word; repeat it",
        "     0.10 s  rejected: STOP EXEC 5 GO  (no program 5)",
        "  1 instruction, 1 rejected; 4 frames in 0.15 s; 0.50 ms a frame",
    ]


def test_options_reach_the_pipeline(run, make_folder, fake):
    run("decode", make_folder("frames", 2), "--hold", 3, "--mirrored", "--grammar", "my.toml", "--fps", 4)
    assert fake.made[-1].options == {
        "front_end": "hands",
        "tag_detector": "aruco",
        "shapes": None,
        "model": "cnn",
        "selector": "learned",
        "profile": None,
        "rule": None,
        "hold": 3,
        "hold_seconds": None,
        "caution": None,
        "threshold": None,
        "grammar": "my.toml",
        "mirrored": True,
        "rotate": 0,
    }
    assert [time_s for _, time_s, _ in fake.made[-1].seen] == [0.0, 0.25]
    run("decode", make_folder("frames", 2), "--hold-seconds", 0.4)
    assert fake.made[-1].options["hold_seconds"] == 0.4
    run("decode", make_folder("frames", 2), "--rule", "sentence", "--caution", 2, "--threshold", 0.5)
    options = fake.made[-1].options
    assert (options["rule"], options["caution"], options["threshold"]) == ("sentence", 2.0, 0.5)
    run("decode", make_folder("frames", 2))
    assert fake.made[-1].options == {
        "front_end": "hands",
        "tag_detector": "aruco",
        "shapes": None,
        "model": "cnn",
        "selector": "learned",
        "profile": None,
        "rule": None,
        "hold": None,
        "hold_seconds": None,
        "caution": None,
        "threshold": None,
        "grammar": None,
        "mirrored": False,
        "rotate": 0,
    }


def test_files(run, make_video, tmp_path):
    first, second = make_video("a/dive.avi", 4), make_video("b/dive.avi", 2)
    third = make_video("b/reef.avi", 2)
    out = tmp_path / "new" / "out"
    result = run("decode", first, second, third, "--out", out, "--json")
    assert result.status == ExitStatus.OK
    assert names(out) == [*of("a_dive.avi"), *of("b_dive.avi"), *of("reef")]
    lines = [(out / name).read_text().splitlines() for name in ("a_dive.avi.jsonl", "b_dive.avi.jsonl")]
    assert lines[0] + lines[1] == result.out[: len(lines[0]) + len(lines[1])]


def test_no_input_is_the_bundled_clip(run, make_video, monkeypatch):
    monkeypatch.setattr(decoding, "SAMPLE", make_video("sample.avi", 3))
    result = run("decode", "--json")
    assert {record["source"] for record in records(result.out)} == {"sample.avi"}
    assert result.err == ["lightgesture: no input named; decoding the bundled clip"]
    assert run("decode", "--quiet").err == []


def _missing(make_video, tmp_path):
    return tmp_path / "gone.avi"


def _zero_byte(make_video, tmp_path):
    path = tmp_path / "zero.mp4"
    path.touch()
    return path


def _empty_folder(make_video, tmp_path):
    path = tmp_path / "no pictures"
    path.mkdir()
    return path


def _truncated(make_video, tmp_path):
    path = make_video("cut.mp4", 20, "mp4v")
    path.write_bytes(path.read_bytes()[:2000])
    return path


def _all_broken(make_video, tmp_path):
    path = tmp_path / "broken"
    path.mkdir()
    (path / "1.png").write_bytes(b"no picture")
    return path


@pytest.mark.parametrize("make_bad", [_missing, _zero_byte, _empty_folder, _truncated, _all_broken])
def test_bad_input_among_good_ones(run, make_video, tmp_path, make_bad):
    bad = make_bad(make_video, tmp_path)
    before, after = make_video("före.avi", 3), make_video("after.avi", 3)
    out = tmp_path / "out"
    result = run("decode", before, bad, after, "--json", "--out", out)
    assert result.status == ExitStatus.SOME_FAILED
    assert result.err[0].startswith(f"lightgesture: {bad}: ")
    assert [line.split()[-1] for line in result.err[1:]] == ["status", "ok", "failed", "ok", "failed"]
    summaries = [record for record in records(result.out) if record["type"] == "summary"]
    assert [(each["source"], each["status"]) for each in summaries] == [
        (str(before), "ok"),
        (str(after), "ok"),
    ]
    assert names(out) == [*of("after"), *of("före")]


def test_video_that_ends_early_keeps_what_was_decoded(run, make_video, tmp_path):
    path = make_video("cut.avi", 60)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    out = tmp_path / "out"
    result = run("decode", path, "--json", "--out", out)
    assert result.status == ExitStatus.SOME_FAILED
    assert len(result.err) == 1
    assert f"{path}: the video ends early" in result.err[0]
    assert types(result.out)[-1] == "summary"
    assert records(result.out)[-1]["status"] == "failed"
    assert "instruction" in types(result.out)
    assert (out / "cut.jsonl").read_text().splitlines() == result.out
    assert run("decode", path).out[-1].endswith("; failed")


def test_picture_that_is_none_in_a_folder(run, make_folder):
    folder = make_folder("frames", 5)
    (folder / "3.png").write_bytes(b"no picture")
    result = run("decode", folder, "--json", "--frames")
    assert result.status == ExitStatus.SOME_FAILED
    assert len(result.err) == 1
    assert str(folder / "3.png") in result.err[0]
    assert [record["frame"] for record in records(result.out) if record["type"] == "frame"] == [0, 1, 3, 4]
    assert records(result.out)[-1]["status"] == "failed"


def test_grey_deep_and_resized_frames(run, make_picture, fake):
    make_picture("frames/1.png", np.full((40, 50), 90, np.uint8))
    make_picture("frames/2.png", np.full((40, 50, 3), 30000, np.uint16))
    folder = make_picture("frames/3.png", np.full((30, 20, 4), 90, np.uint8)).parent
    assert run("decode", folder).status == ExitStatus.OK
    assert [shape for _, _, shape in fake.made[-1].seen] == [(40, 50, 3), (40, 50, 3), (30, 20, 3)]


@pytest.mark.parametrize("name", ["två dykare.avi", "line\nfeed.avi", "100%d [1]*?.avi"])
def test_hostile_names(run, make_video, tmp_path, name):
    path = make_video(name, 3)
    out = tmp_path / "out"
    result = run("decode", path, "--json", "--out", out)
    assert (result.status, result.err) == (ExitStatus.OK, [])
    assert records(result.out)[-1]["source"] == str(path)
    stem = name.removesuffix(".avi")
    assert names(out) == of(stem)
    lines = (out / f"{stem}.jsonl").read_text(encoding="utf-8").splitlines()
    assert lines == result.out
    assert len(run("decode", path).out) == 5
    path.write_bytes(b"")
    assert len(run("decode", path).err) == 1


def test_interrupted(run, make_video, tmp_path, fake):
    fake.interrupt_at = 5
    out = tmp_path / "out"
    result = run("decode", make_video("a.avi", 4), make_video("b.avi", 4), "--out", out)
    assert result.status == ExitStatus.INTERRUPTED
    assert len(result.err) == 1
    assert names(out) == of("a")


def test_model_that_is_damaged(run, make_video):
    result = run("decode", make_video(), "--model", "broken.npz")
    assert result.status == ExitStatus.USAGE
    assert result.out == []
    assert result.err == ["lightgesture: broken.npz: is damaged (no scores); restore it or train it again"]


def test_out_that_is_a_file(run, make_video, tmp_path):
    (tmp_path / "out").write_text("a file")
    result = run("decode", make_video(), "--out", tmp_path / "out")
    assert result.status == ExitStatus.USAGE
    assert result.err == [
        f"lightgesture: {tmp_path / 'out'}: is no folder that can be written (File exists); name another"
    ]


def test_result_that_cannot_be_replaced(run, make_video, tmp_path):
    (tmp_path / "out" / "dive.jsonl").mkdir(parents=True)
    result = run("decode", make_video("dive.avi"), "--out", tmp_path / "out")
    assert result.status == ExitStatus.USAGE
    assert "dive.jsonl: cannot be written" in result.err[0]
    assert len(result.err) == 1
    assert names(tmp_path / "out") == ["dive.jsonl"]


def test_debug_pictures_once_a_second(run, make_video, make_folder, tmp_path):
    folder = tmp_path / "debug"
    run("decode", make_video("dive.avi", 42), make_folder("frames", 3), "--debug-dir", folder)
    names = sorted(str(path.relative_to(folder)) for path in folder.rglob("mask-*.png"))
    assert names == [
        "dive/mask-000000.png",
        "dive/mask-000020.png",
        "dive/mask-000040.png",
        "frames/mask-000000.png",
    ]


def test_globs_in_natural_order(run, make_video, tmp_path):
    for number in (10, 9):
        make_video(f"dive{number}.avi", 2)
    result = run("decode", tmp_path / "dive*.avi", tmp_path / "dive9.avi", "--json")
    sources = [record["source"] for record in records(result.out) if record["type"] == "summary"]
    assert sources == [str(tmp_path / "dive9.avi"), str(tmp_path / "dive10.avi")]


def test_a_remark_of_all_inputs_is_told_once(run, make_video, monkeypatch, fake):
    monkeypatch.setattr(fake, "unknown", True)
    videos = [make_video(name) for name in ("a.avi", "b.avi")]
    result = run("decode", *videos)
    assert [line for line in result.err if "does not know: shaka" in line] == [
        "lightgesture: classes of the model that the grammar does not know: shaka"
    ]
    assert not [line for line in run("decode", *videos, "--quiet").err if "shaka" in line]


def test_a_stage_that_raises_fails_its_input_in_one_line(run, make_video, monkeypatch, fake, tmp_path):
    process = fake.process

    def raise_once(self, image, time_s, index=None):
        if self.source.endswith("a.avi") and index == 1:
            raise ZeroDivisionError("of a stage")
        return process(self, image, time_s, index)

    monkeypatch.setattr(fake, "process", raise_once)
    videos = [make_video(name) for name in ("a.avi", "b.avi")]
    result = run("decode", *videos, "--out", tmp_path / "out")
    assert result.status == ExitStatus.SOME_FAILED
    (line,) = [line for line in result.err if "a.avi: " in line]
    assert "broke off at a defect (ZeroDivisionError: of a stage; test_decode.py, line " in line
    assert sorted(path.stem for path in (tmp_path / "out").glob("*.jsonl")) == ["b"]
    assert not list((tmp_path / "out").glob("*a*"))
