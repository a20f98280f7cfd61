"""Which functions of this repository a frame goes through, told by `sys.setprofile`."""

import sys
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median_low
from types import FrameType
from typing import Final

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.census.sources import PACKAGE, ROOMS

FRAMES: Final = range(30, 201)
"""Of the bundled clip: both hands are up and followed."""

PREDICTION: Final = ("kalman.py", "predict")
"""File and function of one step of one coordinate's filter; a box has four coordinates."""

GENERATED: Final = "<string>"
"""File of the code that dataclasses and named tuples make of text."""


@dataclass(frozen=True, slots=True)
class FrameCounts:
    """What one frame, or the median of many, goes through."""

    files: int
    """Python files of this repository."""
    functions: int
    """Distinct functions, comprehensions and lambdas among them."""
    named_functions: int
    """Distinct functions that have a name of their own."""
    calls: int
    """Calls, steps of generators and of comprehensions among them."""
    named_calls: int
    """Calls of functions that have a name of their own."""
    generated_calls: int
    """Calls of constructors that dataclasses and named tuples have made of text, in no file; `calls` has none."""
    predictions: int
    """Steps of the tracker's filters."""


Calls = Mapping[tuple[str, str], int]
"""How often each function was entered, by file and qualified name."""


def count_calls(calls: Calls) -> FrameCounts:
    """Sum up the calls of a frame."""
    own = {place: count for place, count in calls.items() if place[0] != GENERATED}
    named = {place: count for place, count in own.items() if not place[1].endswith(">")}
    return FrameCounts(
        files=len({file for file, _ in own}),
        functions=len(own),
        named_functions=len(named),
        calls=sum(own.values()),
        named_calls=sum(named.values()),
        generated_calls=sum(calls.values()) - sum(own.values()),
        predictions=sum(
            count for (file, name), count in own.items() if (Path(file).name, name) == PREDICTION
        ),
    )


def called(call: Callable[[], object], package: Path = PACKAGE) -> Calls:
    """The functions of the package that a call enters, and generated ones that these call."""
    folders = [package.resolve(), *((package / room).resolve() for room in ROOMS)]
    is_own: dict[str, bool] = {}
    calls: Counter[tuple[str, str]] = Counter()

    def is_of_package(file: str) -> bool:
        if file not in is_own:
            is_own[file] = any(Path(file).resolve().is_relative_to(folder) for folder in folders)
        return is_own[file]

    def profile(frame: FrameType, event: str, _argument: object) -> None:
        if event != "call":
            return
        code, caller = frame.f_code, frame.f_back
        if is_of_package(code.co_filename):
            calls[str(Path(code.co_filename).resolve()), code.co_qualname] += 1
        elif code.co_filename == GENERATED and caller and is_of_package(caller.f_code.co_filename):
            calls[GENERATED, code.co_qualname] += 1

    sys.setprofile(profile)
    try:
        call()
    finally:
        sys.setprofile(None)
    return calls


def frame_counts(clip: Path = SAMPLE, frames: range = FRAMES) -> FrameCounts:
    """Median over the frames of a clip, each number for itself. Raises InputError where the clip cannot be read."""
    from lightgesture.pipeline import Pipeline
    from lightgesture.sources import open_source

    pipeline = Pipeline(source=clip.name, rule="frames", frames=True)
    found = []
    with open_source(str(clip)) as source:
        for shown in source:
            if shown.index >= frames.stop:
                break
            process = partial(pipeline.process, shown.image, shown.time_s, shown.index)
            if shown.index in frames:
                found.append(count_calls(called(process)))
            else:
                process()
    names = FrameCounts.__slots__
    return FrameCounts(*(median_low([getattr(one, name) for one in found]) for name in names))
