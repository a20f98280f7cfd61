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
    """Water between camera and diver."""

    kind: Literal["I", "IA", "IB", "II", "III", "1C", "3C", "5C", "7C", "9C", "none"] = "IB"
    """Jerlov's type, clear ocean to muddy coast, or "none" for a dry room."""
    depth_m: Annotated[float, Field(ge=0.3, le=30.0)] = 2.0
    """Of the camera below the surface, 0.3 to 30 m: deeper is darker and less red."""
    turbidity: Annotated[float, Field(ge=0.02, le=3.0)] = 0.2
    """Scattering, 0.02 to 3 per metre: more veils and blurs more."""


class BackdropSpec(_Part):
    """What stands about under water."""

    floor: Literal["sand", "tiles", "rocks", ""] = "sand"
    """What lies below, "" for open water."""
    floor_m: Annotated[float, Field(ge=0.3, le=20.0)] = 1.6
    """Its distance below the camera, 0.3 to 20 m."""
    surface_m: Annotated[float, Field(ge=0.0, le=10.0)] = 0.0
    """Distance of the surface above the camera, to 10 m; 0: out of view."""
    horizon: Annotated[float, Field(ge=-0.5, le=1.5)] = 0.45
    """Its row as a share of the height, -0.5 to 1.5."""
    caustic: Share = 0.5
    """Contrast of the net of light on the floor, 0 to 1."""
    particles: Annotated[int, Field(ge=0, le=2000)] = 0
    """Number of drifting specks, to 2000."""
    bubbles: Annotated[float, Field(ge=0.0, le=60.0)] = 0.0
    """Bubbles a second from the regulator, to 60."""


class RoomSpec(_Part):
    """A dry room, used where water.kind is "none"."""

    wall: Annotated[int, Field(ge=0, le=5)] = 0
    """Colour of the wall, number 0 to 5 of `room.WALLS`."""
    pieces: Annotated[int, Field(ge=0, le=60)] = 9
    """Furniture and pictures, to 60."""
    window: Annotated[float, Field(ge=0.0, le=6.0)] = 0.0
    """Brightness of the window behind the person against the wall, to 6; 0: no window."""
    lamps: Annotated[int, Field(ge=0, le=10)] = 0
    """Ceiling lights in view, to 10."""
    level: Annotated[float, Field(ge=0.02, le=2.0)] = 1.0
    """Brightness of the room's own light, 0.02 to 2."""


class DiverSpec(_Part):
    """Who signs, and what is worn."""

    monk: Annotated[float, Field(ge=1.0, le=10.0)] = 4.0
    """Skin tone of the Monk scale, 1 very light to 10 very dark."""
    blood: Annotated[float, Field(ge=0.2, le=2.5)] = 1.0
    """Units of haemoglobin in the skin, 0.2 to 2.5: more is redder."""
    glove: Colour | None = None
    """Linear BGR colour of gloves, 0 to 1 each; none for bare hands."""
    suit: Colour = (0.02, 0.017, 0.014)
    """Linear BGR colour, 0 to 1 each."""
    accent: Colour = (0.25, 0.06, 0.02)
    """The same of collar, mask and snorkel."""
    sleeve_mm: Annotated[float, Field(ge=5.0, le=120.0)] | None = 35.0
    """Bare forearm before the sleeve, 5 to 120 mm; none for bare arms."""
    hood: bool = True
    """Neoprene over the hair."""
    mask: bool = True
    """A diving mask."""
    snorkel: bool = False
    """A snorkel beside the head."""
    regulator: bool = True
    """A regulator in the mouth."""
    distance_mm: Annotated[float, Field(ge=500.0, le=6000.0)] = 1300.0
    """To the camera, 500 to 6000 mm."""
    height_mm: Annotated[float, Field(ge=-1500.0, le=1500.0)] = -60.0
    """Of the shoulders above the optical axis, -1500 to 1500 mm."""
    looseness: Annotated[float, Field(ge=0.0, le=2.0)] = 0.8
    """How carelessly signs are made, 0 exact, 1 natural, 2 careless."""
    wrist_mm: tuple[float, float, float] = (300.0, 70.0, 220.0)
    """Where the left wrist is held, body frame: to the left, up, forwards; the right one mirrored."""


class CardSpec(_Part):
    """Cards, where `SceneSpec.signing` says so."""

    side_mm: Annotated[float, Field(ge=20.0, le=84.0)] = 80.0
    """Of the black square of a tag, 20 to 84 mm."""
    family: Literal["25h9", "36h10", "36h11"] = "36h11"
    """Of the tags."""
    tilt_deg: Annotated[float, Field(ge=0.0, le=75.0)] = 25.0
    """Most that a card is turned away from the camera, to 75 degrees."""
    roll_deg: Annotated[float, Field(ge=0.0, le=45.0)] = 8.0
    """How far it is turned in its plane, standard deviation, to 45 degrees."""
    hands: Literal["left", "right", "both", "any"] = "any"
    """Which hands hold a card."""
    shown_mm: tuple[float, float, float] = (0.0, 60.0, 300.0)
    """Where a card is shown, body frame: to the left, up, forwards; one hand holds it to its own side of that."""
    motion_mm: Annotated[float, Field(ge=40.0, le=250.0)] = 110.0
    """From the middle of a motion to its sides, 40 to 250 mm."""


class MotionSpec(_Part):
    """How the diver moves."""

    drift: Annotated[float, Field(ge=0.0, le=5.0)] = 1.0
    """Of body and distance, as a multiple of a calm diver's, to 5."""
    tremor_mm: Annotated[float, Field(ge=0.0, le=20.0)] = 3.0
    """Of the hands, standard deviation, to 20 mm."""
    approach_mm: Annotated[float, Field(ge=-3000.0, le=3000.0)] = 0.0
    """How far the diver comes nearer over the scene, to 3000 mm; negative: goes away."""


class CameraSpec(_Part):
    """What films the scene."""

    focal: Annotated[float, Field(ge=0.4, le=3.0)] = 0.875
    """Focal length in picture widths, 0.4 to 3."""
    noise: Annotated[float, Field(ge=0.0, le=20.0)] = 1.0
    """Multiple of a good camera's, to 20."""
    blur_px: Annotated[float, Field(ge=0.0, le=6.0)] = 0.5
    """Standard deviation of the optical blur, to 6 pixels."""
    motion_px: Annotated[float, Field(ge=0.0, le=30.0)] = 0.0
    """Length of the blur along the camera's own motion, to 30 pixels."""
    exposure: Annotated[float, Field(ge=0.02, le=0.8)] = 0.24
    """Mean brightness that the camera aims at, 0.02 to 0.8 of white, linear."""
    balance: Share = 0.3
    """Automatic white balance, 0 none to 1 full."""
    jpeg: Annotated[int, Field(ge=0, le=100)] = 0
    """Quality, 1 to 100; 0: not compressed."""
    drift: Annotated[float, Field(ge=0.0, le=0.3)] = 0.03
    """Of exposure and white balance, standard deviation as a share, to 0.3."""


class SceneSpec(_Part):
    """A whole scene."""

    seed: Annotated[int, Field(ge=0)] = 0
    """Of everything that is drawn by chance."""
    sentences: tuple[str, ...] = ("STOP HOVER 50 GO",)
    """What is signed, in the words of the language, or an activity such as "~wave"."""
    signing: Literal["hands", "tags", "tag-motion"] = "hands"
    """How: with bare hands, with cards, or with two cards that are moved, each for `hold` frames."""
    size: tuple[Annotated[int, Field(ge=64, le=4096)], Annotated[int, Field(ge=64, le=4096)]] = (640, 480)
    """Width and height, 64 to 4096 pixels."""
    fps: Annotated[float, Field(gt=0.0, le=240.0)] = 30.0
    """Frames a second, to 240."""
    hold: Range = (22, 34)
    """Fewest and most frames of a sign, 1 to 600."""
    passage: Range = (7, 12)
    """The same of the way from one sign to the next."""
    pause: Range = (12, 24)
    """The same of lowered hands."""
    water: WaterSpec = WaterSpec()
    backdrop: BackdropSpec = BackdropSpec()
    room: RoomSpec = RoomSpec()
    diver: DiverSpec = DiverSpec()
    cards: CardSpec = CardSpec()
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
