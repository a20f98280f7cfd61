"""Whether a change of the code changes a record: `python -m lightgesture.benchmarks.records_digest`.

One line an input: the digest of all its records, times apart, and its name. Inputs are the bundled clip, videos named
on the command line (the suite's cached clips, say), the ordered sequences of the data folder as streams, and all its
whole frames as single pictures, each with every selector and classifier and by the rules frames and sentence. Two runs
are compared with --against.
"""

import argparse
import hashlib
import json
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from lightgesture.actions.decode import SAMPLE
from lightgesture.cli import exit_status
from lightgesture.console import native_messages_muted, print_line, say
from lightgesture.errors import ExitStatus, InputError
from lightgesture.pipeline import Pipeline
from lightgesture.records import Record
from lightgesture.sources import open_source, read_picture
from lightgesture.training.datasets import find_data, group_samples, is_sequence, read_frames, read_negatives

METHODS: tuple[dict[str, Any], ...] = (
    {"model": "cnn", "selector": "learned", "rule": "frames"},
    {"model": "svm", "selector": "learned", "rule": "frames"},
    {"model": "cnn", "selector": "classical", "rule": "frames"},
    {"model": "cnn", "selector": "learned", "rule": "sentence"},
)
FPS = 30.0
"""Of the data folder's sequences, frames a second."""
PICTURES = ("frames", "negatives", "divers", "webcam")
"""Folders of the data folder that hold whole frames."""
QUICK_STEP = 25
"""A quick run takes every so many pictures."""


def digest_records(records: Iterable[Record]) -> str:
    """Digest of records as they are printed, without the time of day and the summary, which differ from run to run."""
    digest = hashlib.sha256()
    for record in records:
        if record.type != "summary":
            content = {key: value for key, value in record.to_dict().items() if key != "utc"}
            line = json.dumps(content, ensure_ascii=False, separators=(",", ":"))
            digest.update(line.encode() + b"\n")
    return digest.hexdigest()[:16]


def digest_stream(pipeline: Pipeline, frames: Iterable[tuple[Any, float]]) -> str:
    """Digest of all records of (picture, seconds) in order, through a fresh memory."""
    stream = pipeline.for_stream("stream")

    def records() -> Iterator[Record]:
        for image, time_s in frames:
            yield from stream.process(image, time_s)
        yield from stream.finish()

    return digest_records(records())


def video_frames(path: Path) -> Iterator[tuple[Any, float]]:
    """Pictures and times of a video."""
    with open_source(str(path)) as source:
        for frame in source:
            yield frame.image, frame.time_s


def digests(data: Path | None, videos: Sequence[Path], quick: bool) -> Iterator[tuple[str, str]]:
    """Name and digest of every input, by every method."""
    for options in METHODS:
        pipeline = Pipeline(**options)
        name = " ".join(options.values())
        for path in (SAMPLE, *videos):
            key = path.name if path == SAMPLE else f"{path.parent.name}/{path.name}"
            yield f"{name} {key}", digest_stream(pipeline, video_frames(path))
        if data is None:
            continue
        for group, samples in group_samples([*read_frames(data), *read_negatives(data)]).items():
            if is_sequence(samples):
                frames = ((read_picture(sample.path), i / FPS) for i, sample in enumerate(samples))
                yield f"{name} {group}", digest_stream(pipeline, frames)
        for folder in PICTURES:
            pictures = sorted(path for path in (data / folder).rglob("*") if path.suffix in (".jpg", ".png"))
            step = QUICK_STEP if quick else 1
            records = (pipeline.recognize(read_picture(path)) for path in pictures[::step])
            yield f"{name} {folder}{' quick' * quick}", digest_records(records)


def run(argv: Sequence[str] | None = None) -> int:
    """Print or write the digests; 1 where one differs from those of `--against`."""
    parser = argparse.ArgumentParser(prog="lightgesture.benchmarks.records_digest", description=__doc__)
    parser.add_argument("videos", nargs="*", type=Path, metavar="VIDEO")
    parser.add_argument("--data", metavar="DIR", help="data folder (default: ../shared/data where it is)")
    parser.add_argument("--quick", action="store_true", help="every 25th single picture")
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the lines here too")
    parser.add_argument(
        "--against", type=Path, metavar="FILE", help="lines of another run; tell what differs"
    )
    args = parser.parse_args(argv)
    try:
        data = find_data(args.data)
    except InputError as error:
        if args.data:
            raise
        say(str(error))
        data = None
    known = dict(line.split(maxsplit=1)[::-1] for line in _lines(args.against))
    lines, differing = [], 0
    with native_messages_muted():
        for name, digest in digests(data, args.videos, args.quick):
            is_other = known.get(name, digest) != digest
            differing += is_other
            lines.append(f"{digest} {name}")
            print_line(lines[-1] + ("  DIFFERS" if is_other else ""))
    if args.out:
        args.out.write_text("\n".join(lines) + "\n", encoding="utf-8")
    if args.against:
        say(f"{differing} of {sum(line.split(maxsplit=1)[1] in known for line in lines)} differ")
    return ExitStatus.SOME_FAILED if differing else ExitStatus.OK


def _lines(path: Path | None) -> list[str]:
    if path is None:
        return []
    try:
        return path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); name a file of --out") from error


if __name__ == "__main__":
    sys.exit(exit_status(run, "what was printed stands"))
