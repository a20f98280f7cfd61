"""Scenes to files: MPEG-4 video or a folder of PNG pictures, and the truth beside it as JSON lines."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import UsageError
from lightgesture.results.atomic import replacing, replacing_folder
from lightgesture.results.writers import open_json_lines
from lightgesture.synth.parallel import render_frames
from lightgesture.synth.scene import Scene
from lightgesture.synth.truth import with_truth

Put = Callable[[NDArray[np.uint8]], None]


@contextmanager
def video_writer(path: Path, fps: float, size: tuple[int, int]) -> Iterator[Put]:
    """A function that appends one picture; the video appears under its name only when complete."""
    with replacing(path, path.suffix) as partial:
        writer = cv2.VideoWriter(str(partial), cv2.VideoWriter.fourcc(*"mp4v"), fps, size)
        if not writer.isOpened():
            raise UsageError(f"{path}: OpenCV cannot write a video there; name a folder that can be written")
        try:
            yield _without_result(writer)
        finally:
            writer.release()


def _without_result(writer: cv2.VideoWriter) -> Put:
    def put(image: NDArray[np.uint8]) -> None:
        writer.write(image)

    return put


@contextmanager
def picture_folder(path: Path) -> Iterator[Put]:
    """A function that writes one numbered PNG; the folder appears under its name only when complete."""
    count = 0
    with replacing_folder(path) as partial:

        def put(image: NDArray[np.uint8]) -> None:
            nonlocal count
            cv2.imwrite(str(partial / f"{count:06d}.png"), image)
            count += 1

        yield put


def write_scene(
    scene: Scene,
    folder: Path,
    stem: str,
    hold: int,
    pictures: bool = False,
    jobs: int = 1,
    advance: Callable[[], None] | None = None,
) -> Path:
    """Write frames and truth of a scene; returns the video's (or picture folder's) path.

    hold: frames a pair must be held to count in the truth. jobs: processes. advance: called after each frame.
    """
    path = folder / stem if pictures else folder / f"{stem}.mp4"
    sink = picture_folder(path) if pictures else video_writer(path, scene.spec.fps, scene.spec.size)
    with open_json_lines(folder / f"{stem}.jsonl") as truth, sink as put:
        for frame, records in with_truth(render_frames(scene, jobs), scene.grammar, hold, path.name):
            put(frame.image)
            for record in records:
                truth.write(record)
            if advance is not None:
                advance()
    return path
