"""What the package shows of its generator: the bundled clip, sheets of hands by token and of scenes, and what the
decoder sees in the clip.

Run `python -m lightgesture.synth.showcase clip OUT.mp4`, or `hands`, `scenes` or `decoded` and OUT.jpg.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.actions.decode import SAMPLE
from lightgesture.pipeline import Pipeline
from lightgesture.results.atomic import replacing
from lightgesture.results.overlay import Overlay
from lightgesture.sources import open_source
from lightgesture.synth.crops import NONE, CropMaker, CropSettings
from lightgesture.synth.output import video_writer
from lightgesture.synth.poses import TOKENS
from lightgesture.synth.scene import Scene
from lightgesture.synth.spec import BackdropSpec, CameraSpec, DiverSpec, MotionSpec, SceneSpec, WaterSpec
from lightgesture.synth.variety import draw_spec

Picture = NDArray[np.uint8]
TILE_PX, HANDS_A_ROW = 96, 12
SCENE_SIZE, SCENES_A_ROW, SCENE_ROWS = (320, 240), 4, 4
JPEG_QUALITY = 88
HELD_SHARE = 0.4
"""How far the hold of the digit has grown where it is shown."""
SAMPLE_SPEC = SceneSpec(
    seed=4,
    sentences=("STOP HOVER 50 GO",),
    hold=(32, 35),
    passage=(9, 10),
    water=WaterSpec(kind="III", depth_m=4.0, turbidity=0.16),
    backdrop=BackdropSpec(floor="sand", floor_m=1.7, caustic=0.25),
    diver=DiverSpec(monk=3.6, blood=1.1, distance_mm=1150.0, looseness=0.15, sleeve_mm=25.0),
    motion=MotionSpec(drift=0.6, tremor_mm=1.5),
    camera=CameraSpec(noise=0.3, balance=0.35, drift=0.008),
)
"""The clip that comes with the package: one diver, one sentence, one seed."""


def hand_sheet(seed: int = 0) -> Picture:
    """One row a token and a last one of other shapes, each hand another person, light and water."""
    maker = CropMaker(seed, "demo", CropSettings(size=(TILE_PX, TILE_PX)))
    rows = [np.hstack([maker.sample(token).image for _ in range(HANDS_A_ROW)]) for token in (*TOKENS, NONE)]
    return np.asarray(np.vstack(rows), np.uint8)


def scene_sheet(first_seed: int = 0) -> Picture:
    """The middle of one sign of each of the first scenes from `first_seed` on."""
    tiles = []
    for seed in range(first_seed, first_seed + SCENES_A_ROW * SCENE_ROWS):
        scene = Scene(draw_spec(seed).model_copy(update={"size": SCENE_SIZE}))
        signs = [hold for hold in scene.timeline if hold.pair]
        hold = signs[len(signs) // 2]
        tiles.append(scene.frame((hold.start + hold.end) // 2).image)
    rows = [np.hstack(tiles[start : start + SCENES_A_ROW]) for start in range(0, len(tiles), SCENES_A_ROW)]
    return np.asarray(np.vstack(rows), np.uint8)


def write_clip(path: Path) -> None:
    """Render the clip that comes with the package to `path`."""
    scene = Scene(SAMPLE_SPEC)
    with video_writer(path, scene.spec.fps, scene.spec.size) as put:
        for frame in scene.frames():
            put(frame.image)


def decoded_sheet() -> Picture:
    """Two frames of the bundled clip as the decoder sees them, side by side: a digit held, and the instruction."""
    overlay = Overlay()
    shown: list[Picture] = []
    with open_source(SAMPLE) as frames, Pipeline(source=SAMPLE.name) as pipeline:
        for frame in frames:
            records = pipeline.process(frame.image, frame.time_s, frame.index)
            picture = overlay.draw(frame.image, records)
            dwell = overlay.state.dwell
            is_digit = not shown and dwell is not None and dwell.word == "5" and dwell.progress >= HELD_SHARE
            if is_digit or any(record.type == "instruction" for record in records):
                shown.append(picture)
    return np.asarray(np.hstack(shown), np.uint8)


def write_sheet(picture: Picture, path: Path) -> None:
    """A contact sheet as JPEG."""
    _, coded = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    with replacing(path) as temporary:
        temporary.write_bytes(coded.tobytes())


SHOWN: dict[str, Callable[[Path], None]] = {
    "clip": write_clip,
    "hands": lambda path: write_sheet(hand_sheet(), path),
    "scenes": lambda path: write_sheet(scene_sheet(), path),
    "decoded": lambda path: write_sheet(decoded_sheet(), path),
}


def main(words: list[str]) -> None:
    """Write what is named first to the path that is named second."""
    if len(words) != 2 or words[0] not in SHOWN:
        sys.exit(f"name one of {', '.join(SHOWN)} and the file to write it to")
    SHOWN[words[0]](Path(words[1]))


if __name__ == "__main__":
    main(sys.argv[1:])
