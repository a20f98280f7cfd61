"""What is read where nobody signs: `python -m lightgesture.benchmarks.false_alarms`.

Frames without a gesturing diver, pictures of divers at work, and an hour of rendered divers who swim, wave and point,
by every rule: instructions, which there must be none of, words and hands a minute, and why the rest was refused. Each
still is shown for a second, which is the worst that can happen: what looks like a hand holds perfectly still for longer
than a sign. Pictures are read once for the rules that go sign by sign and once for the rule `sentence`, which reads
hands in another way; the rules then work on what was read.
"""

import argparse
import random
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from lightgesture.benchmarks.divers.pictures import read_divers
from lightgesture.benchmarks.suite.cache import cache_folder, fetch_clips
from lightgesture.benchmarks.suite.scenarios import NEGATIVE
from lightgesture.benchmarks.suite.takes import takes_of
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.console import messages_shown, print_line, say
from lightgesture.errors import ExitStatus, InputError
from lightgesture.features.types import Image
from lightgesture.fsm import Notice, Rejected, Signs
from lightgesture.fsm.language.settings import SENTENCE, Rule
from lightgesture.pipeline import Pipeline
from lightgesture.records import Hand
from lightgesture.sources import open_source, read_picture
from lightgesture.training.datasets import find_data, read_negatives

RULES: tuple[Rule, ...] = ("frames", "seconds", "evidence", "sentence")
FPS: Final = 30.0
STILL_FRAMES: Final = 30
"""Frames for which a still is shown."""
READ_FRAMES: Final = 10
"""Of these, those that are read; what follows hands has settled by then, and the rest is taken to read alike."""
HOURS: Final = 1.0
SEED: Final = 20261201
"""Of the order in which the clips follow each other."""

REEFS, DIVERS, RENDERED = PARTS = "reefs, pools, robots", "divers at work", "rendered, idle"


@dataclass(frozen=True, slots=True)
class Seen:
    """A frame as it was read."""

    signs: Signs
    hands: tuple[Hand, ...]


@dataclass(frozen=True, slots=True)
class Stream:
    """Pieces that are shown one after the other, each of frames at FPS; one may come more than once."""

    pieces: tuple[tuple[Seen, ...], ...]


def read(pipeline: Pipeline, images: Iterable[Image]) -> Iterator[Seen]:
    """What the front end of a pipeline sees in the frames of a clip."""
    front = pipeline.front.for_stream()
    for index, image in enumerate(images):
        signs = front.process(image, index / FPS)
        yield Seen(signs, tuple(front.shown()["hands"]))


def still(pipeline: Pipeline, path: Path) -> tuple[Seen, ...]:
    """A picture that is shown for STILL_FRAMES."""
    found = tuple(read(pipeline, [read_picture(str(path))] * READ_FRAMES))
    return found + found[-1:] * (STILL_FRAMES - READ_FRAMES)


def _frames(video: Path) -> Iterator[Image]:
    with open_source(str(video)) as source:
        for frame in source:
            yield frame.image


def streams(pipeline: Pipeline, data: Path | None, hours: float) -> Iterator[tuple[str, Stream]]:
    """The three parts as a pipeline reads them; without a data folder the rendered one alone."""
    if data is not None:
        yield REEFS, Stream(tuple(still(pipeline, sample.path) for sample in read_negatives(data)))
        yield DIVERS, Stream(tuple(still(pipeline, frame.path) for frame in read_divers(data)))
    clips = fetch_clips(takes_of(NEGATIVE, None), cache_folder())
    yield RENDERED, going_on([tuple(read(pipeline, _frames(clip.video))) for clip in clips], hours)


def going_on(clips: Sequence[tuple[Seen, ...]], hours: float) -> Stream:
    """Clips in random order until the hours are over."""
    rng, pieces, frames = random.Random(SEED), [], 0
    while frames < hours * 3600 * FPS:
        pieces.append(rng.choice(clips))
        frames += len(pieces[-1])
    return Stream(tuple(pieces))


def count(pipeline: Pipeline, stream: Stream) -> tuple[dict[str, Cell], Counter[str]]:
    """What one decoder makes of a stream, and the reasons of all that was refused."""
    decoder, found, reasons = pipeline.decoder.for_stream(None), Counter[str](), Counter[str]()
    index = 0
    for piece in stream.pieces:
        tracks: dict[int | None, bool] = {}
        for seen in piece:
            for event in decoder.step(seen.signs, index / FPS, index):
                found[event.type] += 1
                if isinstance(event, (Rejected, Notice)):
                    reasons[f"{event.type}: {event.reason}"] += 1
            for hand in seen.hands:
                tracks[hand.track] = tracks.get(hand.track, False) or hand.token is not None
                if hand.reason is not None:
                    reasons[f"hand: {hand.reason}"] += 1
            index += 1
        found["hands"] += len(tracks)
        found["read"] += sum(tracks.values())
    minutes = index / FPS / 60
    row: dict[str, Cell] = {"minutes": round(minutes, 1)}
    row |= {f"{name}_a_minute": round(found[kind] / minutes, 2) for name, kind in A_MINUTE.items()}
    return {**row, "words": found["word"], "instructions": found["instruction"]}, reasons


A_MINUTE: Final = {"hands": "hands", "hands_read": "read", "words": "word", "rejected": "rejected"}
"""Column to what is counted."""

COLUMNS: Final = (
    "what",
    "rule",
    "minutes",
    *(f"{name}_a_minute" for name in A_MINUTE),
    "words",
    "instructions",
)
NOTE: Final = (
    "hands: tracks that began, in clips and stills alike; hands_read: those of which a token was read at least once.\n"
    "Of the divers 96 hands do show a sign."
)


def measure(data: Path | None, hours: float) -> list[Table]:
    """The table of what was read and that of why the rest was refused. InputError: the data cannot be read."""
    rows: list[dict[str, Cell]] = []
    why: list[dict[str, Cell]] = []
    pipelines = {rule: Pipeline(rule=rule) for rule in RULES}
    for reading in ("seconds", SENTENCE):
        for what, stream in streams(pipelines[reading], data, hours):
            for rule in (SENTENCE,) if reading == SENTENCE else RULES[:-1]:
                row, reasons = count(pipelines[rule], stream)
                rows.append({"what": what, "rule": rule, **row})
                why += [
                    {"what": what, "rule": rule, "reason": reason, "count": number}
                    for reason, number in reasons.most_common()
                ]
                say(f"{what}, {rule}: {row['instructions']} instructions")
    order = {part: place for place, part in enumerate(PARTS)}
    rows.sort(key=lambda row: order[str(row["what"])])
    why.sort(key=lambda row: order[str(row["what"])])
    return [
        Table("false_alarms", "Where nobody signs", COLUMNS, tuple(rows), NOTE),
        Table(
            "false_alarms_refused",
            "Why the rest was refused",
            ("what", "rule", "reason", "count"),
            tuple(why),
        ),
    ]


@messages_shown()
def main(argv: Sequence[str] | None = None) -> int:
    """The command line; 1 where an instruction was issued."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.false_alarms",
        description="Instructions, words and hands where nobody signs, by every rule.",
    )
    parser.add_argument(
        "--data", metavar="DIR", help="data folder (default: shared/data beside the checkout)"
    )
    parser.add_argument(
        "--rendered-only", action="store_true", help="without the pictures of the data folder"
    )
    parser.add_argument(
        "--hours", type=float, default=HOURS, metavar="H", help=f"of rendered divers (default {HOURS:g})"
    )
    args = parser.parse_args(argv)
    try:
        tables = measure(None if args.rendered_only else find_data(args.data), args.hours)
    except InputError as error:
        say(str(error))
        return ExitStatus.SOME_FAILED
    print_line(to_text(tables))
    is_wrong = any(row["instructions"] for row in tables[0].rows)
    return ExitStatus.SOME_FAILED if is_wrong else ExitStatus.OK


if __name__ == "__main__":
    sys.exit(main())
