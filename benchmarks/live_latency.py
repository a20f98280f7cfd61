"""How old a frame is when `lightgesture live` prints its record: `python -m lightgesture.benchmarks.live_latency`.

A server sends the frames of a clip as MJPEG at a steady rate and notes when each goes out. The live loop, in a process
of its own and behind the words of `--cage` where its power shall be limited, prints a record for each frame that it
decoded. Both clocks are the system's monotonic one, so their difference is the whole way: network, waiting in the
mailbox, decoding, pipeline, printing. Heartbeats come after each frame here and not each second, for they tell what
its processing took.
"""

import argparse
import json
import shlex
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Final

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.mjpeg_server import MjpegServer, read_jpegs
from lightgesture.benchmarks.scorer import percentile
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.console import messages_shown, native_messages_muted, print_line, say
from lightgesture.errors import ExitStatus, InputError

TITLE = "Live: from the frame to its record"


FPS: Final = 60.0
"""Frames a second that the server sends."""

SECONDS: Final = 600.0
"""Length of the run after the warm-up."""

WARM_UP_S: Final = 10.0
"""Seconds at the start that do not count, in which the program starts and loads its models."""

MEMORY_EVERY_S: Final = 5.0
"""Seconds from one look at the memory to the next."""

HEARTBEAT_S: Final = 0.01
"""Seconds from one heartbeat to the next, less than a frame time."""


@dataclass(slots=True)
class Run:
    """What was seen.

    ages_ms: of each record. pairs_ms: age and processing of the frames that have a heartbeat of their own. waiting:
    ages since the last heartbeat. memory_mib: resident, in the order of time. dropped: frames passed over.
    """

    ages_ms: list[float] = field(default_factory=list)
    pairs_ms: list[tuple[float, float]] = field(default_factory=list)
    waiting: list[float] = field(default_factory=list)
    memory_mib: list[float] = field(default_factory=list)
    dropped: int = 0


def measure(clip: str, cage: Sequence[str], fps: float, seconds: float) -> Run:
    """Run the server and the program. InputError: no clip, or the program ended early."""
    sent_s: dict[int, float] = {}
    pictures = read_jpegs(clip)

    def note(number: int) -> None:
        sent_s[number] = time.monotonic()

    with MjpegServer(pictures, fps, note=note) as server, _live(server.address, cage) as child:
        assert child.stdout is not None
        run = Run()
        start_s, memory_s = time.monotonic(), 0.0
        for line in child.stdout:
            now_s = time.monotonic()
            take(json.loads(line), now_s, sent_s, run, now_s - start_s > WARM_UP_S)
            if now_s - start_s > WARM_UP_S + seconds:
                return run
            if now_s - start_s > WARM_UP_S and now_s - memory_s > MEMORY_EVERY_S:
                memory_s = now_s
                run.memory_mib.append(memory_mib(_find_python(child.pid)))
    raise InputError(f"lightgesture live ended with status {child.returncode}")


def take(
    record: dict[str, object], now_s: float, sent_s: dict[int, float], run: Run, is_counted: bool
) -> None:
    """Note what a record of the program says; of its frames only those that count.

    now_s: when it was read; sent_s: when each frame went out, both of the system's monotonic clock.
    """
    match record:
        case {"type": "frame", "frame": int(index)} if is_counted:
            run.ages_ms.append((now_s - sent_s[index]) * 1e3)
            run.waiting.append(run.ages_ms[-1])
        case {"type": "heartbeat", "ms_per_frame": float(spent_ms), "dropped": int(dropped)}:
            run.dropped = dropped
            if len(run.waiting) == 1:
                run.pairs_ms.append((run.waiting[0], spent_ms))
            run.waiting.clear()


@contextmanager
def _live(address: str, cage: Sequence[str]) -> Iterator["subprocess.Popen[str]"]:
    command = [*cage, sys.executable, "-m", "lightgesture.benchmarks.live_latency", "--decode", address]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        yield child
    finally:
        _end(child)


def decode(address: str) -> int:
    """What the other process does: decode the stream with a heartbeat after each frame."""
    from lightgesture.actions.live import run_live
    from lightgesture.config.settings import DecodeSettings

    options = DecodeSettings.model_validate({"json": True, "frames": True, "quiet": True})
    with native_messages_muted():
        return run_live(address, options, heartbeat_s=HEARTBEAT_S)


def _end(child: "subprocess.Popen[str]") -> None:
    """Ask the program, which may stand behind a cage that ends with it, to end."""
    subprocess.run(["kill", str(_find_python(child.pid))], check=False)
    output: IO[str] | None = child.stdout
    if output is not None:
        output.close()
    child.wait(30)


def _find_python(number: int) -> int:
    """The process that runs the program: itself or the last of its descendants."""
    children = Path(f"/proc/{number}/task/{number}/children")
    below = children.read_text().split() if children.exists() else []
    return _find_python(int(below[-1])) if below else number


def memory_mib(number: int) -> float:
    """Resident memory of a process, MiB (Linux)."""
    lines = Path(f"/proc/{number}/status").read_text().splitlines()
    return next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmRSS:"))


def table(run: Run, fps: float) -> Table:
    """Ages, how many keep the bound of two frame times and the frame's own processing, memory, frames passed over."""
    spare_ms = 2e3 / fps
    processing_ms = [spent_ms for _, spent_ms in run.pairs_ms]
    within = sum(age_ms <= spare_ms + spent_ms for age_ms, spent_ms in run.pairs_ms)
    values: dict[str, Cell] = {
        "frames decoded": len(run.ages_ms),
        "frames passed over": run.dropped,
        "processing, median ms": percentile(processing_ms, 50),
        "processing, 99 % ms": percentile(processing_ms, 99),
        "age, median ms": percentile(run.ages_ms, 50),
        "age, 99 % ms": percentile(run.ages_ms, 99),
        "age, most ms": max(run.ages_ms),
        "age within two frame times and processing, % of frames": 100.0 * within / len(run.pairs_ms),
        "age beyond processing, median ms": percentile([age - spent for age, spent in run.pairs_ms], 50),
        "memory at the start, MiB": run.memory_mib[0],
        "memory at half time, MiB": run.memory_mib[len(run.memory_mib) // 2],
        "memory at the end, MiB": run.memory_mib[-1],
    }
    rows = tuple({"what": what, "value": value} for what, value in values.items())
    return Table("live_latency", TITLE, ("what", "value"), rows)


@messages_shown()
def main(argv: Sequence[str] | None = None) -> int:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False)
    parser.add_argument(
        "clip", nargs="?", default=str(SAMPLE), metavar="CLIP", help="default: the bundled one"
    )
    parser.add_argument("--fps", type=float, default=FPS, metavar="F", help=f"default {FPS:g}")
    parser.add_argument("--seconds", type=float, default=SECONDS, metavar="S", help=f"default {SECONDS:g}")
    parser.add_argument("--cage", default="", metavar="WORDS", help="words that stand before the command")
    parser.add_argument(
        "--decode", metavar="ADDRESS", help="only decode a stream, as the measured process does"
    )
    args = parser.parse_args(argv)
    if args.decode is not None:
        return decode(args.decode)
    try:
        run = measure(args.clip, shlex.split(args.cage), args.fps, args.seconds)
    except InputError as error:
        say(str(error))
        return ExitStatus.SOME_FAILED
    print_line(to_text([table(run, args.fps)]))
    return ExitStatus.OK


if __name__ == "__main__":
    sys.exit(main())
