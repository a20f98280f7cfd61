"""`decode --jobs 2` on long videos, watched from outside."""

import json
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from lightgesture.benchmarks.soak.pieces import of_records, unlike
from lightgesture.benchmarks.soak.sampling import (
    Pace,
    Sample,
    children,
    look,
    parts,
    save,
    table,
    together,
    wrong,
)
from lightgesture.benchmarks.tables import Table
from lightgesture.errors import ExitStatus, InputError

JOBS: Final = 2
VIDEOS: Final = 12
"""Among which the frames are parted."""

PROCESSES: Final = JOBS + 2
"""The parent, its workers, and the process by which Python keeps account of what they share."""


def write_rounds(clip: Path, to: Path, rounds: int) -> None:
    """A video of a clip again and again, with stamps that go on; nothing is coded anew. InputError: it has no clock."""
    import av

    with av.open(str(clip)) as source, av.open(str(to), "w") as out:
        shown = source.streams.video[0]
        stream, rate, base = out.add_stream_from_template(shown), shown.average_rate, shown.time_base
        packets = [
            (packet.pts, packet.dts, packet.is_keyframe, bytes(packet))
            for packet in source.demux(shown)
            if packet.size and packet.pts is not None and packet.dts is not None
        ]
        if not rate or not base or not packets:
            raise InputError(f"{clip}: has no clock; name another clip")
        length = max(pts for pts, *_ in packets) + round(1 / rate / base)
        for turn in range(rounds):
            for pts, dts, is_key, content in packets:
                packet = av.Packet(content)
                packet.pts, packet.dts = pts + turn * length, dts + turn * length
                packet.time_base, packet.is_keyframe, packet.stream = base, is_key, stream
                out.mux(packet)


def soak_decode(
    clip: Path, frames: int, count: int, place: Path, pace: Pace, samples_to: Path | None = None
) -> tuple[Table, list[str]]:
    """Decode about `count` frames in VIDEOS videos of a clip of `frames`; the table of what parent and workers took
    together, and what is wrong.

    place: an empty folder. samples_to: folder for the samples, None: they are not kept.
    """
    rounds = max(1, count // VIDEOS // frames)
    videos = [place / f"round_{number}.mp4" for number in range(VIDEOS)]
    write_rounds(clip, videos[0], rounds)
    for video in videos[1:]:
        video.hardlink_to(videos[0])
    _decode([clip], place / "once", "--jobs", "1").wait()
    once = of_records(_records(place / "once" / f"{clip.stem}.jsonl"))
    process = _decode(videos, place / "out", "--jobs", str(JOBS))
    samples = _watch(process, place / "out", frames * rounds * VIDEOS, pace.every_s)
    found = [] if process.wait() == ExitStatus.OK else [f"decode: exit status {process.returncode}"]
    expected = [
        (text, first + turn * frames, last + turn * frames)
        for turn in range(rounds)
        for text, first, last in once
    ]
    for video in videos:
        found += unlike(video.stem, of_records(_records(place / "out" / f"{video.stem}.jsonl")), expected)
    save(samples, "decode", samples_to)
    rows = parts(samples)
    made = table("decode, parent and workers together", rows)
    note = f"videos {VIDEOS} of {rounds} rounds; verdicts {VIDEOS * len(expected)}"
    return Table(made.name, made.title, made.columns, made.rows, note), found + wrong("decode", rows)


def _decode(videos: Sequence[Path], out: Path, *options: str) -> "subprocess.Popen[bytes]":
    command = [sys.executable, "-m", "lightgesture", "decode", *map(str, videos), "--out", str(out), *options]
    return subprocess.Popen([*command, "--quiet"], stdout=subprocess.DEVNULL)


def _records(path: Path) -> list[dict[str, Any]]:
    if not path.exists():
        return []
    return [json.loads(line) for line in path.read_text("utf-8").splitlines()]


def _watch(process: "subprocess.Popen[bytes]", out: Path, frames: int, every_s: float) -> list[Sample]:
    """Looks at the process and its workers together. frames: of all videos; how many are done is estimated by how much
    was written."""
    start_s = time.monotonic()
    looks: list[tuple[list[Sample], int]] = []
    while process.poll() is None:
        time.sleep(every_s)
        written = sum(path.stat().st_size for path in out.iterdir()) if out.exists() else 0
        numbers = [process.pid, *children(process.pid)]
        some = [sample for number in numbers if (sample := look(number, time.monotonic() - start_s, 0))]
        # Not while workers come and go, at the start and at the end.
        if len(some) == PROCESSES and process.poll() is None:
            looks.append((some, written))
    most = max((written for _, written in looks), default=0) or 1
    return [together(some, round(frames * written / most)) for some, written in looks]
