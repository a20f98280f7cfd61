"""Contact sheets of the generator's variety: hands by token, and whole scenes.

Run `python -m lightgesture.synth.sheet hands|scenes OUT.jpg`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.results.atomic import replacing
from lightgesture.synth.crops import NONE, CropMaker, CropSettings
from lightgesture.synth.poses import TOKENS
from lightgesture.synth.scene import Scene
from lightgesture.synth.variety import draw_spec

Picture = NDArray[np.uint8]
TILE_PX, HANDS_A_ROW = 96, 12
SCENE_SIZE, SCENES_A_ROW, SCENE_ROWS = (320, 240), 4, 4
JPEG_QUALITY = 88


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


SHEETS = {"hands": hand_sheet, "scenes": scene_sheet}


def main(words: list[str]) -> None:
    """Write the sheet that is named first to the path that is named second."""
    kind, path = words
    _, coded = cv2.imencode(".jpg", SHEETS[kind](), [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    with replacing(Path(path)) as temporary:
        temporary.write_bytes(coded.tobytes())


if __name__ == "__main__":
    main(sys.argv[1:])
