"""The film of the trials: what the camera sees, the vehicle from outside, depth and heading over time, the sentence."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import UsageError
from lightgesture.features.types import Image
from lightgesture.results.overlay import Overlay
from lightgesture.synth.output import Put
from lightgesture.synth.pool.body import Body, import_mujoco
from lightgesture.synth.pool.plans import Plan
from lightgesture.synth.pool.trial import Seen

SIZE: Final = (1280, 720)
"""Width and height of the film."""
FILM_FPS: Final = 5.0
"""Pictures of the film a second, of simulated time and of the film's own."""
SPAN_S: Final = 60.0
"""Time that the curves show."""

Colour = tuple[int, int, int]
_DARK, _LIGHT, _GRID = (40, 32, 24), (235, 235, 235), (90, 80, 70)
_DEPTH, _HEADING = (90, 200, 255), (130, 230, 130)
_STATES: dict[str, Colour] = {
    "refused": (90, 90, 255),
    "aborted": (90, 90, 255),
    "done": (130, 230, 130),
}
_FONT = cv2.FONT_HERSHEY_SIMPLEX
_VIEW = (640, 480)
_DRAWN = (480, 360)  # of the view from outside, which takes most of the film's time


class Film:
    """Composes pictures and hands them to `put`; `begin` a trial, then show it what was seen."""

    def __init__(self, put: Put) -> None:
        self._put = put
        self._outside: Outside | None = None

    def begin(self, plan: Plan, body: Body) -> Callable[[Seen], None]:
        """What watches the next trial."""
        if self._outside is not None:
            self._outside.close()
        outside = self._outside = Outside(body)
        overlay = Overlay()
        title = f"{plan.name}: {' / '.join(plan.sentences)}"
        shown = 0

        def watch(seen: Seen) -> None:
            nonlocal shown
            drawn = overlay.draw(seen.image, seen.records)
            due = math.ceil((seen.moments[-1].time_s - seen.moments[0].time_s) * FILM_FPS) - shown
            if due <= 0:
                return
            picture = compose(drawn, outside.picture(), title, seen)
            for _ in range(due):
                self._put(picture)
            shown += due

        return watch

    def close(self) -> None:
        """Give the drawing back."""
        if self._outside is not None:
            self._outside.close()
            self._outside = None


class Outside:
    """The pool as somebody beside it sees it, drawn by MuJoCo. UsageError: this machine cannot draw it."""

    def __init__(self, body: Body) -> None:
        mujoco = import_mujoco()
        self._body = body
        try:
            self._renderer = mujoco.Renderer(body.model, _DRAWN[1], _DRAWN[0])
        except Exception as error:  # OpenGL's loaders have errors of many kinds
            raise UsageError(
                f"simulate: the film cannot be drawn here ({type(error).__name__}: {error}); install libegl1 and "
                "libgl1-mesa-dri, or libosmesa6 with MUJOCO_GL=osmesa, or leave the film out by --no-film"
            ) from None
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
            self._renderer.scene.flags[flag] = False
        self._camera: Any = mujoco.MjvCamera()
        self._camera.azimuth, self._camera.elevation, self._camera.distance = 62.0, -18.0, 4.2

    def picture(self) -> Image:
        """The pool now, uint8 (480, 640, 3), BGR."""
        data = self._body.data
        self._camera.lookat[:] = 0.5 * (data.body("vehicle").xpos + data.body("diver").xpos)
        self._renderer.update_scene(data, self._camera)
        picture = cv2.cvtColor(self._renderer.render(), cv2.COLOR_RGB2BGR)
        return np.asarray(cv2.resize(picture, _VIEW, interpolation=cv2.INTER_LINEAR), np.uint8)

    def close(self) -> None:
        """Give back what OpenGL holds."""
        self._renderer.close()


def compose(drawn: Image, outside: Image, title: str, seen: Seen) -> Image:
    """One picture of the film."""
    canvas = np.full((SIZE[1], SIZE[0], 3), _DARK, np.uint8)
    canvas[: _VIEW[1], : _VIEW[0]] = cv2.resize(drawn, _VIEW)
    canvas[: _VIEW[1], _VIEW[0] :] = outside
    now = seen.moments[-1]
    _text(canvas, title, (14, 506), 0.55, _LIGHT)
    heading = round(now.motion.heading_deg) % 360
    state = f"{now.time_s:5.1f} s   {now.mode.name}   {now.motion.depth_m:.2f} m   {heading} deg"
    _text(canvas, f"{state}   {now.pictures} pictures", (14, 532), 0.55, _LIGHT)
    for row, record in enumerate(seen.said[-6:]):
        words = f"{record.time_s:5.1f}  {record.state}: {record.detail or record.instruction}"
        _text(canvas, words[:62], (14, 564 + 24 * row), 0.5, _STATES.get(record.state, _LIGHT))
    depths = [(moment.time_s, moment.motion.depth_m) for moment in seen.moments]
    headings = [(moment.time_s, _signed(moment.motion.heading_deg)) for moment in seen.moments]
    _curve(canvas, (660, 492, 610, 106), depths, "depth, m", _DEPTH, is_down=True, least=1.0)
    _curve(canvas, (660, 608, 610, 106), headings, "heading, deg", _HEADING, is_down=False, least=40.0)
    return canvas


def _signed(degrees: float) -> float:
    return (degrees + 180.0) % 360.0 - 180.0


def _text(canvas: NDArray[np.uint8], words: str, place: tuple[int, int], size: float, colour: Colour) -> None:
    plain = words.encode("ascii", "replace").decode("ascii")  # what OpenCV's letters have
    cv2.putText(canvas, plain, place, _FONT, size, colour, 1, cv2.LINE_AA)


def _curve(
    canvas: NDArray[np.uint8],
    box: tuple[int, int, int, int],
    values: Sequence[tuple[float, float]],
    label: str,
    colour: Colour,
    *,
    is_down: bool,
    least: float,
) -> None:
    """A curve over the last SPAN_S seconds; least: smallest range of the axis."""
    x, y, width, height = box
    end_s = max(values[-1][0], SPAN_S)
    recent = [(time_s, value) for time_s, value in values if time_s >= end_s - SPAN_S]
    low, high = min(value for _, value in recent), max(value for _, value in recent)
    middle, half = 0.5 * (low + high), 0.5 * max(high - low, least) * 1.1
    cv2.rectangle(canvas, (x, y), (x + width, y + height), _GRID, 1)
    shares = np.array([((t - end_s + SPAN_S) / SPAN_S, (v - middle + half) / (2 * half)) for t, v in recent])
    rows = shares[:, 1] if is_down else 1.0 - shares[:, 1]
    points = np.stack([x + width * shares[:, 0], y + height * rows], axis=1).round().astype(np.int32)
    cv2.polylines(canvas, [points.reshape(-1, 1, 2)], False, colour, 2, cv2.LINE_AA)
    top, bottom = (middle - half, middle + half) if is_down else (middle + half, middle - half)
    _text(canvas, f"{label}   {values[-1][1]:.2f}", (x + 8, y + 18), 0.45, colour)
    _text(canvas, f"{top:.1f}", (x + width - 48, y + 14), 0.4, _LIGHT)
    _text(canvas, f"{bottom:.1f}", (x + width - 48, y + height - 6), 0.4, _LIGHT)
