"""A folder of generated clips, some broken, decoded and interrupted: `python -m lightgesture.benchmarks.archive`.

Shows that every whole clip has its results and every broken one its error line, whatever happens: a run that is told to
stop (SIGTERM) or killed (SIGKILL) in the middle and started again does no clip twice, loses none, and the files are the
same byte by byte as those of an undisturbed run, but for the fields that tell how long things took.
"""

import argparse
import json
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from lightgesture.archive.folder import MANIFEST
from lightgesture.console import print_line
from lightgesture.errors import ExitStatus

TIMES = ("ms_per_frame", "stages_ms")
"""Fields of a summary that differ from run to run."""

BROKEN = ("broken_cut.mp4", "broken_empty.mp4", "broken_text.mp4")


CLIPS: Final = 37
"""Whole clips; the broken ones come besides."""

FRAMES, STEP = 16, 6
"""Of each clip every sixth frame of a rendered dive, so that a few hold several signs."""

SIZE: Final = (320, 240)
"""Width and height, pixels."""

HOLD: Final = 2
"""Frames that make a sign, few as the clips are short."""

DONE_SHARE: Final = 0.3
"""Part of the clips that is done when a run is broken off."""


def make_clips(folder: Path, count: int) -> None:
    """Render the whole clips, `clip_<n>.mp4`, and make the broken ones of the first."""
    from lightgesture.synth.output import video_writer
    from lightgesture.synth.scene import Scene
    from lightgesture.synth.variety import draw_spec

    for number in range(count):
        spec = draw_spec(number, "demo", "water", None, 0.1).model_copy(update={"size": SIZE})
        scene = Scene(spec)
        with video_writer(folder / f"clip_{number}.mp4", spec.fps, spec.size) as put:
            for index in range(0, FRAMES * STEP, STEP):
                put(scene.frame(index).image)
    whole = (folder / "clip_0.mp4").read_bytes()
    for name, content in zip(BROKEN, (whole[: len(whole) // 2], b"", b"no video\n"), strict=True):
        (folder / name).write_bytes(content)


def start(clips: Path, out: Path, *options: str) -> "subprocess.Popen[str]":
    """A process that decodes all clips to `out`."""
    inputs = [*sorted(str(path) for path in clips.glob("*.mp4"))]
    command = [sys.executable, "-m", "lightgesture", "decode", *inputs, "--out", str(out)]
    command += ["--hold", str(HOLD), "--frames", *options]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def results(out: Path) -> dict[str, Any]:
    """Name to content of every file of results, hidden ones too, without times and without manifest and lock."""
    files = [path for path in out.iterdir() if not path.name.startswith(".lightgesture")]
    return {path.name: _without_times(path) for path in files}


def done(out: Path) -> dict[str, float]:
    """The clips that the manifest calls done, with the time at which their records were written."""
    manifest = out / MANIFEST
    stems = json.loads(manifest.read_text())["inputs"] if manifest.exists() else {}
    return {stem: (out / f"{stem}.jsonl").stat().st_mtime_ns for stem in stems}


def check_whole_run(clips: Path, out: Path, count: int, *options: str) -> list[str]:
    """What is wrong with an undisturbed run; nothing when all is as promised."""
    process = start(clips, out, *options)
    _, errors = process.communicate()
    wrong = []
    if process.returncode != ExitStatus.SOME_FAILED:
        wrong.append(f"exit status {process.returncode}, not {int(ExitStatus.SOME_FAILED)}")
    named = [line for line in errors.splitlines() if line.startswith(f"lightgesture: {clips}")]
    if len(named) != len(BROKEN) or any(name not in line for name, line in zip(BROKEN, named, strict=False)):
        wrong.append(f"failures named: {named}")
    stems = {f"clip_{number}" for number in range(count)}
    expected = {f"{stem}{suffix}" for stem in stems for suffix in (".jsonl", ".csv", ".vtt")}
    if set(results(out)) != expected:
        wrong.append(f"files: {sorted(set(results(out)) ^ expected)} missing or too many")
    return wrong


def check_broken_off(
    clips: Path, out: Path, count: int, stop: signal.Signals, expected: dict[str, Any]
) -> tuple[int, list[str]]:
    """Break a run off in the middle and run again: how many clips were done by then, and what is wrong."""
    process = start(clips, out)
    while len(done(out)) < DONE_SHARE * count and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(stop)
    process.communicate()
    before = done(out)
    wrong = []
    if not 0 < len(before) < count:
        wrong.append(f"{len(before)} of {count} clips done: not broken off in the middle")
    if stop == signal.SIGTERM and process.returncode != ExitStatus.INTERRUPTED:
        wrong.append(f"exit status {process.returncode}, not {int(ExitStatus.INTERRUPTED)}")
    wrong += check_whole_run(clips, out, count)
    after = done(out)
    twice = [stem for stem, written in before.items() if after.get(stem) != written]
    if twice:
        wrong.append(f"done twice: {twice}")
    if results(out) != expected:
        wrong.append("the results differ from those of an undisturbed run")
    return len(before), wrong


def main(argv: Sequence[str] | None = None) -> int:
    """Run all checks; 0 when all hold."""
    parser = argparse.ArgumentParser(prog="lightgesture.benchmarks.archive", description=__doc__)
    parser.add_argument("--clips", type=int, default=CLIPS, metavar="N", help="whole clips")
    parser.add_argument(
        "--keep", type=Path, metavar="DIR", help="folder of the clips, made where it is missing"
    )
    args = parser.parse_args(argv)
    with tempfile.TemporaryDirectory() as temporary:
        place = Path(temporary)
        clips = args.keep or place / "clips"
        if not clips.is_dir():
            clips.mkdir(parents=True)
            make_clips(clips, args.clips)
        wrong = _told("undisturbed", "", check_whole_run(clips, place / "whole", args.clips))
        expected = results(place / "whole")
        wrong += _told("one job", "", check_whole_run(clips, place / "one", args.clips, "--jobs", "1"))
        if results(place / "one") != expected:
            wrong += _told("one job", "", ["other results than with several"])
        for stop in (signal.SIGTERM, signal.SIGKILL):
            count, found = check_broken_off(clips, place / stop.name, args.clips, stop, expected)
            wrong += _told(stop.name, f" after {count} clips, run again", found)
    return ExitStatus.SOME_FAILED if wrong else ExitStatus.OK


def _told(name: str, detail: str, wrong: list[str]) -> list[str]:
    print_line(f"{name}{detail}: {'; '.join(wrong) or 'as promised'}")
    return wrong


def _without_times(path: Path) -> Any:
    if path.suffix != ".jsonl":
        return path.read_bytes()
    records = [json.loads(line) for line in path.read_text("utf-8").splitlines()]
    return [{key: value for key, value in record.items() if key not in TIMES} for record in records]


if __name__ == "__main__":
    sys.exit(main())
