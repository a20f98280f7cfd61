"""What a scene is made of: a small TOML or a seed, checked before anything is drawn.

Every number has its unit and range beside it. `variety.draw_spec` draws a whole scene from a seed; a TOML starts from
the defaults written here and pins down what it names.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from lightgesture.fsm.toml_file import TomlError, read_toml

Share = Annotated[float, Field(ge=0.0, le=1.0)]
Colour = tuple[Share, Share, Share]
Range = tuple[Annotated[int, Field(ge=1, le=600)], Annotated[int, Field(ge=1, le=600)]]


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class WaterSpec(_Part):
    """kind: Jerlov type I..9C, or "none" for a dry room. depth_m: 0.3..30. turbidity: scattering, 0.02..3 per metre."""

    kind: Literal["I", "IA", "IB", "II", "III", "1C", "3C", "5C", "7C", "9C", "none"] = "IB"
    depth_m: Annotated[float, Field(ge=0.3, le=30.0)] = 2.0
    turbidity: Annotated[float, Field(ge=0.02, le=3.0)] = 0.2


class BackdropSpec(_Part):
    """floor: what lies below, "" for open water. floor_m, surface_m: metres below and above the camera (surface 0: out
    of view). horizon: its row as a share of the height. caustic: contrast of the net of light. particles: number
    of drifting specks. bubbles: bubbles a second from the regulator.
    """

    floor: Literal["sand", "tiles", "rocks", ""] = "sand"
    floor_m: Annotated[float, Field(ge=0.3, le=20.0)] = 1.6
    surface_m: Annotated[float, Field(ge=0.0, le=10.0)] = 0.0
    horizon: Annotated[float, Field(ge=-0.5, le=1.5)] = 0.45
    caustic: Share = 0.5
    particles: Annotated[int, Field(ge=0, le=2000)] = 0
    bubbles: Annotated[float, Field(ge=0.0, le=60.0)] = 0.0


class RoomSpec(_Part):
    """Used where water.kind is "none". wall, pieces, window, lamps, level: as `room.RoomLook`."""

    wall: Annotated[int, Field(ge=0, le=5)] = 0
    pieces: Annotated[int, Field(ge=0, le=60)] = 9
    window: Annotated[float, Field(ge=0.0, le=6.0)] = 0.0
    lamps: Annotated[int, Field(ge=0, le=10)] = 0
    level: Annotated[float, Field(ge=0.02, le=2.0)] = 1.0


class DiverSpec(_Part):
    """monk: skin tone 1 (very light) .. 10 (very dark). blood: units of haemoglobin. glove: linear BGR colour, none
    for bare hands. suit, accent: linear BGR. sleeve_mm: bare forearm before the sleeve, none for bare arms.
    distance_mm: to the camera. height_mm: of the shoulders above the optical axis. looseness: how carelessly signs
    are made, 0..2. wrist_mm: where the left wrist is held (body frame, the right one mirrored). The rest: what is
    worn.
    """

    monk: Annotated[float, Field(ge=1.0, le=10.0)] = 4.0
    blood: Annotated[float, Field(ge=0.2, le=2.5)] = 1.0
    glove: Colour | None = None
    suit: Colour = (0.02, 0.017, 0.014)
    accent: Colour = (0.25, 0.06, 0.02)
    sleeve_mm: Annotated[float, Field(ge=5.0, le=120.0)] | None = 35.0
    hood: bool = True
    mask: bool = True
    snorkel: bool = False
    regulator: bool = True
    distance_mm: Annotated[float, Field(ge=500.0, le=6000.0)] = 1300.0
    height_mm: Annotated[float, Field(ge=-1500.0, le=1500.0)] = -60.0
    looseness: Annotated[float, Field(ge=0.0, le=2.0)] = 0.8
    wrist_mm: tuple[float, float, float] = (300.0, 70.0, 220.0)


class MotionSpec(_Part):
    """drift: of body and distance, as a multiple of a calm diver's. tremor_mm: of the hands. approach_mm: how far the
    diver comes nearer (negative: goes away) over the scene.
    """

    drift: Annotated[float, Field(ge=0.0, le=5.0)] = 1.0
    tremor_mm: Annotated[float, Field(ge=0.0, le=20.0)] = 3.0
    approach_mm: Annotated[float, Field(ge=-3000.0, le=3000.0)] = 0.0


class CameraSpec(_Part):
    """focal: in picture widths. noise: multiple of a good camera's. blur_px, motion_px: pixels. exposure: target mean
    brightness. balance: automatic white balance, 0 none .. 1 full. jpeg: quality, 0 for none. drift:
    of exposure and white balance, share of their value.
    """

    focal: Annotated[float, Field(ge=0.4, le=3.0)] = 0.875
    noise: Annotated[float, Field(ge=0.0, le=20.0)] = 1.0
    blur_px: Annotated[float, Field(ge=0.0, le=6.0)] = 0.5
    motion_px: Annotated[float, Field(ge=0.0, le=30.0)] = 0.0
    exposure: Annotated[float, Field(ge=0.02, le=0.8)] = 0.24
    balance: Share = 0.3
    jpeg: Annotated[int, Field(ge=0, le=100)] = 0
    drift: Annotated[float, Field(ge=0.0, le=0.3)] = 0.03


class SceneSpec(_Part):
    """A whole scene.

    sentences: what is signed, in the words of the language, or an activity such as "~wave". size: width and height
    in pixels. fps: frames a second. hold, passage, pause: frames, each drawn from its range.
    """

    seed: Annotated[int, Field(ge=0)] = 0
    sentences: tuple[str, ...] = ("STOP HOVER 50 GO",)
    size: tuple[Annotated[int, Field(ge=64, le=4096)], Annotated[int, Field(ge=64, le=4096)]] = (640, 480)
    fps: Annotated[float, Field(gt=0.0, le=240.0)] = 30.0
    hold: Range = (22, 34)
    passage: Range = (7, 12)
    pause: Range = (12, 24)
    water: WaterSpec = WaterSpec()
    backdrop: BackdropSpec = BackdropSpec()
    room: RoomSpec = RoomSpec()
    diver: DiverSpec = DiverSpec()
    motion: MotionSpec = MotionSpec()
    camera: CameraSpec = CameraSpec()


def load_scene_spec(path: str | Path) -> SceneSpec:
    """Read a scene from TOML. Raises ValueError, in one line, for anything that is not a scene."""
    try:
        return SceneSpec.model_validate(read_toml(path, "scene", "lightgesture.synth.spec"))
    except TomlError as error:
        raise ValueError(f"{path}: {error}") from None
    except ValidationError as error:
        first = error.errors()[0]
        place, message = ".".join(str(part) for part in first["loc"]), first["msg"]
        raise ValueError(
            f"{path}: {place}: {message[0].lower()}{message[1:]}; see lightgesture.synth.spec"
        ) from None
