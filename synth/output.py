"""Scenes to files: MPEG-4 video or a folder of PNG pictures, and the truth beside it as JSON lines.

The truth is what a flawless pipeline would have said, frame by frame. Frames depend on nothing but the spec and their
number, so that several processes may share a scene.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.cards import FrontEndName, language_of_cards
from lightgesture.errors import UsageError
from lightgesture.fsm import Decoder, Grammar, Signs
from lightgesture.records import Record
from lightgesture.results.atomic import replacing, replacing_folder
from lightgesture.results.writers import open_json_lines
from lightgesture.synth.scene import Scene, SceneFrame
from lightgesture.synth.spec import SceneSpec

Put = Callable[[NDArray[np.uint8]], None]
DISPLAY_ONLY = "state"
"""Records of this type serve displays and are left out of the truth."""
FRAMES_A_TASK = 8
_scene: Scene | None = None
"""The worker's own copy; None in every other process."""


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
        truth_of = with_truth(render_frames(scene, jobs), scene.grammar, hold, path.name, scene.spec.signing)
        for frame, records in truth_of:
            put(frame.image)
            for record in records:
                truth.write(record)
            if advance is not None:
                advance()
    return path


def with_truth(
    frames: Iterable[SceneFrame],
    grammar: Grammar,
    hold: int,
    source: str | None = None,
    signing: FrontEndName = "hands",
) -> Iterator[tuple[SceneFrame, list[Record]]]:
    """Each frame with its records: the frame's own first, then the words, instructions and rejections it completes.

    hold: frames that a pair must be held; cards are held for the seconds of the grammar. What ends with the last frame
    is given with it.
    """
    if signing == "hands":
        decoder = Decoder(grammar, hold=hold, source=source)
    else:
        decoder = Decoder(language_of_cards(grammar, signing), source=source)
    waiting: tuple[SceneFrame, list[Record]] | None = None
    for frame in frames:
        if waiting is not None:
            yield waiting
        waiting = frame, [replace(frame.record, source=source), *_events(decoder, frame)]
    if waiting is not None:
        waiting[1].extend(event for event in decoder.finish() if event.type != DISPLAY_ONLY)
        yield waiting


def _events(decoder: Decoder, frame: SceneFrame) -> Iterator[Record]:
    record = frame.record
    tokens = {hand.side: hand.token for hand in record.hands}
    time_s = record.time_s if record.time_s is not None else 0.0
    signs = frame.signs or Signs.of_tokens(tokens.get("left"), tokens.get("right"))
    for event in decoder.step(signs, time_s, frame=record.frame):
        if event.type != DISPLAY_ONLY:
            yield event


def render_frames(scene: Scene, jobs: int = 1) -> Iterator[SceneFrame]:
    """All frames in order, rendered by `jobs` processes of one thread each (1: in this one)."""
    if jobs <= 1:
        yield from scene.frames()
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, context, _start, (scene.spec,)) as pool:
        yield from pool.map(_frame, range(scene.frame_count), chunksize=FRAMES_A_TASK)


def _start(spec: SceneSpec) -> None:
    global _scene
    cv2.setNumThreads(1)
    _scene = Scene(spec)


def _frame(index: int) -> SceneFrame:
    if _scene is None:
        raise RuntimeError("the worker has no scene; call render_frames")
    return _scene.frame(index)
