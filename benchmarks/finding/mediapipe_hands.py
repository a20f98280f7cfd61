"""MediaPipe Hands on the pictures of the data folder: `python -m lightgesture.benchmarks.finding.mediapipe_hands`.

An optional tool that needs mediapipe in an environment of its own (README.md); the project never depends on it. It
writes the file that `lightgesture evaluate regions --compare FILE` scores beside ours. Boxes go round the 21 landmarks
and are grown to the hand's outline as those of the data folder are.
"""

import argparse
import importlib
import json
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2

from lightgesture.benchmarks.finding.regions import SEQUENCE, SINGLE
from lightgesture.benchmarks.scorer import percentile
from lightgesture.errors import InputError
from lightgesture.sources import read_picture
from lightgesture.training.datasets import (
    LANDMARK_MARGIN,
    Sample,
    find_data,
    group_samples,
    grow_box,
    is_sequence,
    read_frames,
    read_negatives,
    read_webcam,
)


@dataclass(frozen=True, slots=True)
class Setting:
    """How MediaPipe is set up. complexity: 0 lite, 1 full. detection: least confidence of a palm; tracking: of a hand
    that is followed.
    """

    name: str
    complexity: int
    detection: float = 0.5
    tracking: float = 0.5


SETTINGS = (
    Setting("mediapipe lite", 0),
    Setting("mediapipe full, tuned", 1, detection=0.3, tracking=0.3),
)
"""The defaults with the faster net, and what finds most hands without preprocessing."""


def open_hands(setting: Setting, mode: str) -> Any:
    """A detector for pictures without memory, or for a stream. ModuleNotFoundError: mediapipe is not installed."""
    hands: Any = importlib.import_module("mediapipe").solutions.hands
    return hands.Hands(
        static_image_mode=mode == SINGLE,
        max_num_hands=2,
        model_complexity=setting.complexity,
        min_detection_confidence=setting.detection,
        min_tracking_confidence=setting.tracking,
    )


def describe(result: Any, width: int, height: int) -> list[dict[str, Any]]:
    """Boxes and sides of one picture, the surest hand first.

    MediaPipe names sides as in a selfie camera's mirrored picture, so in an unmirrored one its "Left" is a right hand.
    """
    hands = []
    points_of: list[Any] = list(result.multi_hand_landmarks or [])
    sides_of: list[Any] = list(result.multi_handedness or [])
    for landmarks, handedness in zip(points_of, sides_of, strict=True):
        xs = [point.x * width for point in landmarks.landmark]
        ys = [point.y * height for point in landmarks.landmark]
        kind = handedness.classification[0]
        box = grow_box(min(xs), min(ys), max(xs), max(ys), LANDMARK_MARGIN)
        side = "right" if kind.label == "Left" else "left"
        hands.append({"box": box, "side": side, "score": round(float(kind.score), 4)})
    return sorted(hands, key=lambda hand: -hand["score"])


def rows(setting: Setting, mode: str, samples: Sequence[Sample], data: Path) -> Iterator[dict[str, Any]]:
    """One row a picture, in order; a stream starts anew with each call. cpu_ms: of all threads."""
    with open_hands(setting, mode) as hands:
        for sample in samples:
            image = read_picture(sample.path)
            height, width = image.shape[:2]
            wall, cpu = time.perf_counter(), time.process_time()
            result = hands.process(cv2.cvtColor(image, cv2.COLOR_BGR2RGB))
            wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
            yield {
                "method": setting.name,
                "mode": mode,
                "file": sample.path.relative_to(data).as_posix(),
                "hands": describe(result, width, height),
                "ms": round(wall * 1e3, 2),
                "cpu_ms": round(cpu * 1e3, 2),
            }


def record(data: Path, out: Path) -> dict[tuple[str, str], list[float]]:
    """Write the file for all pictures of a data folder; milliseconds of processor time by setting and mode."""
    samples = [*read_webcam(data), *read_webcam(data, "train"), *read_frames(data), *read_negatives(data)]
    times: dict[tuple[str, str], list[float]] = {}
    temporary = out.with_name(out.name + ".part")
    with temporary.open("w", encoding="utf-8") as stream:
        for setting in SETTINGS:
            for members in group_samples(samples).values():
                for mode in (SINGLE, SEQUENCE) if is_sequence(members) else (SINGLE,):
                    for row in rows(setting, mode, members, data):
                        stream.write(json.dumps(row) + "\n")
                        times.setdefault((setting.name, mode), []).append(row["cpu_ms"])
    temporary.replace(out)
    return times


def main(argv: Sequence[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m lightgesture.benchmarks.finding.mediapipe_hands")
    parser.add_argument("--data", metavar="DIR", help="folder of labelled pictures (default: ../shared/data)")
    parser.add_argument("--out", required=True, metavar="FILE", help="JSON Lines to write")
    args = parser.parse_args(argv)
    try:
        times = record(find_data(args.data), Path(args.out))
    except ModuleNotFoundError:
        sys.exit(
            "mediapipe is not installed here; benchmarks/README.md says how to give it an environment of its own"
        )
    except (InputError, OSError) as error:
        sys.exit(str(error))
    for (name, mode), spent in times.items():
        print(f"{name}, {mode}: {percentile(spent, 50):.1f} ms of processor time a picture (median)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
