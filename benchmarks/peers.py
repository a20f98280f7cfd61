"""Times beside MediaPipe Hands, lite and full: `python -m lightgesture.benchmarks.peers --python ENV/bin/python`.

MediaPipe needs an environment of its own (README.md); the project never depends on it. Both programs take the same
few frames in turn, on one core: other work on the machine slows both alike, so that the ratio is worth more than the
times. Times are processor time of all threads. Both follow the hands from frame to frame.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Final

import numpy as np

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.contenders import Contender, Product, interleave, yardsticks
from lightgesture.benchmarks.scorer import percentile
from lightgesture.benchmarks.side_by_side import draw, on_one_core, scaled
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.benchmarks.timing import SIZE, Image, limited_threads
from lightgesture.cli import exit_status
from lightgesture.console import native_messages_muted, print_line
from lightgesture.errors import ExitStatus, InputError
from lightgesture.results.atomic import replacing
from lightgesture.sources import open_source

OURS: Final = "learned, CNN"
PEERS: Final = ("MediaPipe lite", "MediaPipe full")
"""Names in the table, in the order of MediaPipe's complexities 0 and 1."""
SERVER: Final = Path(__file__).with_name("mediapipe_server.py")
FIRST, FRAMES, QUICK_FRAMES, ROUNDS = 30, 150, 40, 3
"""First frame of the clip that is used, for hands to be in view; how many, how many in a quick run, and passes over
them."""


class Peer:
    """A process that tells what each of its nets takes for a frame."""

    def __init__(self, source: IO[str], sink: IO[str]) -> None:
        self._source, self._sink = source, sink

    def ask(self, frame: int) -> list[float]:
        """Milliseconds of each net. InputError: the process ended."""
        self._sink.write(f"{frame}\n")
        self._sink.flush()
        answer = self._source.readline()
        if not answer:
            raise InputError("MediaPipe's process ended; run it alone to see why")
        spent: list[float] = json.loads(answer)
        return spent


@contextmanager
def open_peer(python: str, frames: Sequence[Image]) -> Iterator[Peer]:
    """MediaPipe in the environment of this interpreter, with these frames. InputError: it does not start."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "frames.npy"
        np.save(path, np.array(frames))
        command = [python, str(SERVER), str(path), *(str(number) for number in range(len(PEERS)))]
        try:
            process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
            )
        except OSError as error:
            raise InputError(
                f"{python}: does not start ({error.strerror}); name a Python interpreter"
            ) from error
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            if process.stdout.readline().strip() != "ready":
                raise InputError(
                    f"{python}: has no MediaPipe; README.md of the benchmarks says how to install it"
                )
            yield Peer(process.stdout, process.stdin)
        finally:
            process.kill()
            process.wait()


def measure(frames: Sequence[Image], peer: Peer, rounds: int) -> Table:
    """Ours, the yardsticks and the peers over the frames in turn, with the ratio to ours while it follows."""
    asked: list[list[float]] = []

    def ask(image: Image, time_s: float) -> None:
        del image, time_s
        asked.append(peer.ask(len(asked) % len(frames)))

    contenders = [*yardsticks(), Contender(OURS, Product("cnn").call), Contender("peers", ask)]
    times = interleave(contenders, frames, rounds)
    counted = asked[-len(times.pop("peers")) :]
    for name, spent in zip(PEERS, zip(*counted, strict=True), strict=True):
        times[name] = list(spent)
    ours_ms = percentile(times[OURS], 50)
    width, height = SIZE
    rows: list[dict[str, Cell]] = [
        {
            "size": f"{width}x{height}",
            "what": name,
            "calls": len(spent),
            "median_ms": percentile(spent, 50),
            "p95_ms": percentile(spent, 95),
            "p99_ms": percentile(spent, 99),
            "times_ours": percentile(spent, 50) / ours_ms,
        }
        for name, spent in times.items()
    ]
    columns = ("size", "what", "calls", "median_ms", "p95_ms", "p99_ms", "times_ours")
    note = f"processor time; times_ours: median over that of `{OURS}`, which reads the signs and decodes them besides."
    return Table("peers", "Milliseconds a frame beside MediaPipe Hands", columns, tuple(rows), note)


def run(args: argparse.Namespace) -> int:
    """Measure, print the table, write what was asked for; 0 when all was done."""
    with open_source(SAMPLE) as source:
        last = FIRST + (QUICK_FRAMES if args.quick else FRAMES)
        frames = scaled([frame.image for frame, _ in zip(source, range(last), strict=False)][FIRST:], SIZE)
    with native_messages_muted(), on_one_core(), limited_threads(1), open_peer(args.python, frames) as peer:
        table = measure(frames, peer, 1 if args.quick else ROUNDS)
    print_line(to_text([table]))
    if args.json:
        with replacing(Path(args.json)) as temporary:
            temporary.write_text(json.dumps(table.to_dicts(), indent=1) + "\n", encoding="utf-8")
    if args.picture:
        draw(table.to_dicts(), Path(args.picture))
    return ExitStatus.OK


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.peers",
        description="Milliseconds a frame beside MediaPipe Hands, in turn on one core.",
    )
    parser.add_argument(
        "--python", required=True, metavar="PYTHON", help="interpreter of an environment that has mediapipe"
    )
    parser.add_argument("--json", metavar="FILE", help="write the rows here")
    parser.add_argument("--picture", metavar="FILE.png", help="draw the times (extra plots)")
    parser.add_argument("--quick", action="store_true", help=f"{QUICK_FRAMES} frames, once; under a minute")
    args = parser.parse_args(argv)
    return exit_status(lambda: run(args), "nothing was written")


if __name__ == "__main__":
    sys.exit(main())
