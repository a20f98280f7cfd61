"""The worst frame: `python -m lightgesture.benchmarks.bad_frames` times both selectors on what no diver should show.

Each clip is played by a new stream some times; a frame's time is the least of its passes, so that what another program
costs drops out and what the frame itself costs stays.
"""

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from time import process_time
from typing import Final

import cv2
import numpy as np

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.scorer import percentile
from lightgesture.benchmarks.side_by_side import on_one_core
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.benchmarks.timing import SIZE, Image, limited_threads
from lightgesture.cli import exit_status
from lightgesture.config.parsers import positive
from lightgesture.console import native_messages_muted, print_line
from lightgesture.errors import ExitStatus
from lightgesture.features.compiled.loops import best_loops
from lightgesture.features.find.classical import Loops
from lightgesture.features.find.selector import SELECTORS, SelectorName
from lightgesture.pipeline import Pipeline
from lightgesture.sources import DEFAULT_FPS, open_source

FIRST, COUNT = 30, 30
"""Frames of the bundled clip that the scenes are made of: both hands come into view."""
ROUNDS: Final = 5
"""Passes over each scene."""
BLOBS: Final = 500
"""Skin-coloured discs in one picture."""


def crossing(clip: Sequence[Image]) -> list[Image]:
    """Hands that change sides in every frame."""
    return [image if index % 2 else np.ascontiguousarray(image[:, ::-1]) for index, image in enumerate(clip)]


def flickering(clip: Sequence[Image]) -> list[Image]:
    """A lamp that flickers: every other frame has a quarter of the light."""
    return [image if index % 2 else np.asarray(image // 4, np.uint8) for index, image in enumerate(clip)]


def noise(clip: Sequence[Image]) -> list[Image]:
    """Nothing but noise, another one in every frame."""
    rng = np.random.default_rng(0)
    return [rng.integers(0, 256, image.shape, np.uint8) for image in clip]


def blobs(clip: Sequence[Image]) -> list[Image]:
    """Discs in the colour of skin all over the picture, which drift."""
    rng = np.random.default_rng(1)
    picture = np.full_like(clip[0], (140, 100, 50))
    for x, y in rng.integers(0, min(picture.shape[:2]), (BLOBS, 2)).tolist():
        cv2.circle(picture, (x, y), 9, (120, 150, 210), -1)
    return [np.roll(picture, 7 * index, axis=1) for index in range(len(clip))]


SCENES: Final[Mapping[str, Callable[[Sequence[Image]], list[Image]]]] = {
    f"{BLOBS} skin-coloured blobs": blobs,
    "noise": noise,
    "flickering lamp": flickering,
    "hands cross each frame": crossing,
}
"""What is shown, by its name in the table."""


def read_clip(path: Path = SAMPLE) -> list[Image]:
    """The frames that the scenes are made of, of the size of the published figures."""
    with open_source(path) as source:
        images = [frame.image for frame, _ in zip(source, range(FIRST + COUNT), strict=False)]
    return [
        np.asarray(cv2.resize(one, SIZE, interpolation=cv2.INTER_AREA), np.uint8) for one in images[FIRST:]
    ]


def frame_times(pipeline: Pipeline, frames: Sequence[Image], rounds: int) -> list[float]:
    """Milliseconds of processor time of each frame of a new stream, the least of some passes."""
    passes = []
    for _ in range(rounds):
        stream = pipeline.for_stream(None)
        times = []
        for index, image in enumerate(frames):
            start = process_time()
            stream.process(image, index / DEFAULT_FPS)
            times.append((process_time() - start) * 1e3)
        passes.append(times)
    return [min(times) for times in zip(*passes, strict=True)]


def measure(clip: Sequence[Image], rounds: int = ROUNDS) -> Table:
    """One row for each selector and scene."""
    rows: list[dict[str, Cell]] = []
    with on_one_core(), limited_threads(1):
        for selector in SELECTORS:
            pipeline = Pipeline(selector=selector)
            pipeline.process(clip[0], 0.0)
            for name, scene in SCENES.items():
                times = frame_times(pipeline, scene(clip), rounds)
                rows.append(
                    {
                        "selector": _told(selector),
                        "scene": name,
                        "frames": len(times),
                        "median_ms": percentile(times, 50),
                        "worst_ms": max(times),
                    }
                )
    columns = ("selector", "scene", "frames", "median_ms", "worst_ms")
    title = f"Milliseconds of processor time a frame at {SIZE[0]} x {SIZE[1]}, the least of {rounds} passes"
    return Table("bad_frames", title, columns, tuple(rows))


def _told(selector: SelectorName) -> str:
    """The selector, and by which loops it runs."""
    if selector == "learned":
        return selector
    return f"{selector}, {'NumPy' if best_loops() == Loops() else 'numba'}"


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.bad_frames",
        description="The worst frame of blobs, noise, flicker and crossing hands, by both selectors.",
    )
    parser.add_argument("--rounds", type=positive, default=ROUNDS, metavar="N", help="passes over each scene")
    args = parser.parse_args(argv)

    def run() -> int:
        with native_messages_muted():
            table = measure(read_clip(), args.rounds)
        print_line(to_text([table]))
        return ExitStatus.OK

    return exit_status(run, "nothing was timed")


if __name__ == "__main__":
    sys.exit(main())
