"""Nanoseconds a frame that the decoder takes, beside two state-machine libraries that run the same grammar.

`python -m lightgesture.benchmarks.decoder.latency` steps through frames as a diver signs them at 30 a second, by the
rules frames and sentence, with the second core idle and busy. The libraries, where they are installed (`pip install
transitions python-statemachine`), get the grammar's states and words and the dwell of the rule frames. They are
measured twice: asked in every frame that shows a word, with the dwell as the guard of each transition; and asked only
once the dwell says that a sign was held, so that all other frames cost what our dwell costs. They move from state to
state and do nothing else: no records, no time-out, no unread signs, no instruction's arguments.
"""

import argparse
import math
import resource
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from time import perf_counter_ns
from typing import NamedTuple

from lightgesture.benchmarks.decoder.peers import Arguments, Step, statemachine_step, transitions_step
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.console import print_line
from lightgesture.fsm import Decoder, Grammar, Sign, Signs, load_grammar
from lightgesture.fsm.language.settings import Rule

RATE = 30.0
ROUNDS = 3
"""Times that the frames are shown to a fresh decoder."""
RULES: tuple[Rule, ...] = ("frames", "sentence")
SIGNED = (
    "0,0 5,5 ok,5 pic,ok ok,0 ok,ok",
    "pic,0 3,pic left,pic ok,ok",
    "0,0 pic,2 ok,2 ok,ok",
    "pic,0 pic,pic ok,ok",
)
HELD, PASSAGE, PAUSE = 24, 9, 120
"""Frames of a sign, between two, and between two sentences, in which hands are out of view."""

IDLE, COLLECTING, ACCEPTING = "idle", "collecting", "accepting"
BUSY = "while True: pass"
"""What keeps a second core busy."""


class Shown(NamedTuple):
    """One frame. kind: no hands in view, a sign that is held or on its way, or the frame that makes it a word."""

    signs: Signs
    kind: str


def read_sign(token: str | None, chance: float, tokens: Sequence[str]) -> Sign:
    """A hand as a reader tells it: the probabilities of all tokens, those that are not shown sharing the rest."""
    others = (1.0 - chance) / (len(tokens) if token is None else len(tokens) - 1)
    return Sign(token, chance, {name: chance if name == token else others for name in tokens})


def recorded(grammar: Grammar, hold: int = 15) -> list[Shown]:
    """The frames of the sentences; hold: the frames after which a sign is a word."""
    tokens = grammar.tokens
    frames: list[Shown] = []
    for sentence in SIGNED:
        frames += [Shown(Signs(), IDLE)] * PAUSE
        for pair in sentence.split():
            left, right = pair.split(",")
            for _ in range(PASSAGE):
                passing = Signs(read_sign(None, 0.9, tokens), read_sign(None, 0.95, tokens))
                frames.append(Shown(passing, COLLECTING))
            for frame in range(HELD):
                signs = Signs(read_sign(left, 0.9, tokens), read_sign(right, 0.95, tokens))
                frames.append(Shown(signs, ACCEPTING if frame == hold - 1 else COLLECTING))
    return frames


def as_read(frames: Sequence[Shown], decoder: Decoder) -> list[Shown]:
    """The same frames, of which those are accepting in which this decoder tells a word."""
    found = []
    for frame, shown in enumerate(frames):
        is_word = any(event.type == "word" for event in decoder.step(*arguments(shown, frame)))
        kind = ACCEPTING if is_word else COLLECTING if shown.signs.left.seen else IDLE
        found.append(Shown(shown.signs, kind))
    return found


def arguments(shown: Shown, frame: int) -> Arguments:
    """What the pipeline calls the decoder with; made before the clock starts."""
    return shown.signs, frame / RATE, frame


def our_step(grammar: Grammar, rule: Rule) -> Step:
    """The decoder as the pipeline calls it."""
    return Decoder(grammar, rule=rule).step


@contextmanager
def busy_core(is_busy: bool) -> Iterator[None]:
    """A second process that never rests, as the camera's or a detector's may."""
    if not is_busy:
        yield
        return
    other = subprocess.Popen([sys.executable, "-c", BUSY])
    try:
        yield
    finally:
        other.kill()
        other.wait()


def time_steps(make: Callable[[], Step], frames: Sequence[Shown], count: int) -> dict[str, list[int]]:
    """Nanoseconds of `count` calls by the kind of frame, sorted; the clock's own time is taken off.

    make: a fresh decoder. Each frame's time is the least of ROUNDS, for other work on the machine is not the decoder's.
    """
    overhead = min(-(perf_counter_ns() - perf_counter_ns()) for _ in range(1000))
    least = [math.inf] * count
    for _ in range(ROUNDS):
        step = make()
        for frame in range(count):
            given = arguments(frames[frame % len(frames)], frame)
            start = perf_counter_ns()
            step(*given)
            least[frame] = min(least[frame], perf_counter_ns() - start - overhead)
    times: dict[str, list[int]] = {IDLE: [], COLLECTING: [], ACCEPTING: []}
    for frame, time in enumerate(least):
        times[frames[frame % len(frames)].kind].append(int(time))
    return {kind: sorted(found) for kind, found in times.items()}


def rows(name: str, times: dict[str, list[int]]) -> list[dict[str, Cell]]:
    """Median and percentiles by kind, and over all frames."""
    every = {**times, "all": sorted(time for found in times.values() for time in found)}
    return [
        {
            "what": name,
            "frames": kind,
            "count": len(found),
            "median_ns": found[len(found) // 2],
            "p95_ns": found[len(found) * 95 // 100],
            "p99_ns": found[len(found) * 99 // 100],
            "mean_ns": sum(found) // len(found),
        }
        for kind, found in every.items()
    ]


def memory_row(grammar: Grammar, rule: Rule, frames: Sequence[Shown], count: int) -> dict[str, Cell]:
    """Frames a second without a clock around each, and peak memory before and after."""
    step = our_step(grammar, rule)
    for frame in range(len(frames)):
        step(*arguments(frames[frame], frame))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = perf_counter_ns()
    for frame in range(count):
        step(*arguments(frames[frame % len(frames)], frame))
    seconds = (perf_counter_ns() - start) / 1e9
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return {
        "rule": rule,
        "frames": count,
        "seconds": seconds,
        "frames_a_second": int(count / seconds),
        "peak_before_kib": before,
        "peak_after_kib": after,
    }


def measure(count: int, slow_count: int) -> list[Table]:
    """All tables. count: frames by the rule frames; slow_count: by the rule sentence and of the libraries, which take
    longer."""
    grammar = load_grammar()
    frames = recorded(grammar)
    counts = dict(zip(RULES, (count, slow_count), strict=True))
    throughput = [memory_row(grammar, rule, frames, counts[rule]) for rule in RULES]
    found: list[dict[str, Cell]] = []
    for is_busy in (False, True):
        with busy_core(is_busy):
            where = ", second core busy" if is_busy else ""
            for rule in RULES:
                shown = as_read(frames, Decoder(grammar, rule=rule))
                times = time_steps(partial(our_step, grammar, rule), shown, counts[rule])
                found += rows(f"lightgesture, rule {rule}{where}", times)
            found += peer_rows(grammar, frames, slow_count, where)
    return tables(found, throughput)


def peer_rows(grammar: Grammar, frames: Sequence[Shown], count: int, where: str) -> list[dict[str, Cell]]:
    """The libraries that are installed."""
    found: list[dict[str, Cell]] = []
    for name, make in (("transitions", transitions_step), ("python-statemachine", statemachine_step)):
        for always in (True, False):
            with suppress(ImportError):
                asked = name if always else f"{name}, asked at held signs"
                found += rows(f"{asked}{where}", time_steps(partial(make, grammar, always), frames, count))
    return found


def tables(found: Sequence[dict[str, Cell]], throughput: Sequence[dict[str, Cell]]) -> list[Table]:
    """The rows as tables."""
    columns = ("what", "frames", "count", "median_ns", "p95_ns", "p99_ns", "mean_ns")
    note = (
        "accepting: the frame in which a word is told; idle: no hands in view; collecting: all others, with the\n"
        "records for displays that are made five times a second while a hold grows. The least of three rounds counts."
    )
    columns_all = ("rule", "frames", "seconds", "frames_a_second", "peak_before_kib", "peak_after_kib")
    return [
        Table("decoder_latency", "Nanoseconds a frame, one thread", columns, tuple(found), note),
        Table("decoder_throughput", "Many frames in a row", columns_all, tuple(throughput)),
    ]


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.decoder.latency",
        description="Nanoseconds a frame of the decoder and of two state-machine libraries.",
    )
    parser.add_argument("--frames", type=int, default=1_000_000, metavar="N", help="frames (default 1000000)")
    args = parser.parse_args(argv)
    least = len(recorded(load_grammar()))
    count = max(least, args.frames)
    print_line(to_text(measure(count, max(least, count // 20))))
    return 0


if __name__ == "__main__":
    sys.exit(main())
