"""Frames of one scene by several processes; frames depend on nothing but the spec and their number."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor

import cv2

from lightgesture.synth.scene import Scene, SceneFrame
from lightgesture.synth.spec import SceneSpec

FRAMES_A_TASK = 8
_scene: Scene | None = None
"""The worker's own copy; None in every other process."""


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
