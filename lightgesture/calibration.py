"""Some seconds of open hands become a colour profile, judged by what it tells apart."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, Literal

from lightgesture.errors import InputError
from lightgesture.features.colour import ColourMap, ColourStage
from lightgesture.features.find.selector import choose, load_selector
from lightgesture.features.image import as_bgr8, turned
from lightgesture.features.profile import ColourProfile, Kind
from lightgesture.features.profile_learning import learn_profile, proposed_share
from lightgesture.features.types import Box, Image
from lightgesture.frames import Frame
from lightgesture.sources import Source

Middle = Literal["middle"]

Place = tuple[Box, ...] | Middle | None
"""Where the hands are in every frame, source pixels; None to find them."""


PICTURES: Final = 24
"""Most pictures looked at, evenly in time; two dozen are plenty, more only take longer."""

LEAST_PICTURES: Final = 4
"""Fewest pictures with hands that are learnt from: half of them judge the other half."""

LEAST_SEPARATION: Final = 0.85
"""Of a profile that is good, 0.5 to 1, see `ColourProfile.separation`. Rendered divers give 0.99 in clear and turbid
water with bare hands and with blue, green or red gloves, 0.90 with grey and white gloves in turbid water; gloves of the
colour of what is behind them give less than 0.7."""

LEAST_SHARE: Final = 0.5
"""Of hands proposed with a good profile, 0 to 1. Black gloves before a black suit have a separation of 0.92, and yet a
region of their own in 0.3 of the pictures."""

MIDDLE: Final = 0.35
"""Side of the box in the middle of the picture, over the picture's shorter side: where a hand is that the user holds
there, for want of one that is found."""


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """Hands in pictures: working pictures, and for each the boxes of its hands in its own pixels, at least one.

    looked_at: pictures that were searched. hands: how many hands a picture shows, 1 or 2. broke_off: why the source
    gave less than it was asked for, in words; None if it did not.
    """

    images: tuple[Image, ...]
    boxes: tuple[tuple[Box, ...], ...]
    looked_at: int
    hands: int
    broke_off: str | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Calibration:
    """A profile and how well it separates.

    share, share_without: share of hands that have a fitting region on the colour map, 0 to 1, with a profile learnt
        from the other half of the pictures and with the map of skin colours.
    lack: what it lacks, in words; None if it is good.
    """

    profile: ColourProfile
    shown: Shown
    share: float
    share_without: float
    lack: str | None


def calibrate(source: Source, kind: Kind, place: Place, seconds: float, rotate: int = 0) -> Calibration:
    """Learn a profile from an open source. InputError: no hands, or a source that cannot be read.

    seconds: of the source that are looked at, from its first frame, above 0; pictures without hands are passed over.
    rotate: degrees by which they are turned clockwise to stand upright, before `place` is looked at.
    """
    shown = show_hands(source, place, seconds, rotate)
    return learn(shown, kind, f"{source.name}, {len(shown.images)} pictures")


def show_hands(source: Source, place: Place, seconds: float, rotate: int = 0) -> Shown:
    """Pictures of the first seconds, turned upright, that show hands: both where enough pictures do, else one."""
    boxes_in = FoundHands().boxes if place is None else PlacedHands(place, source.name).boxes
    found: list[tuple[Image, tuple[Box, ...]]] = []
    pictures, broke_off = look_at(source, seconds, rotate)
    for colour in pictures:
        boxes = boxes_in(colour)
        if boxes:
            found.append((colour.picture, tuple(_reduced(box, colour.scale) for box in boxes)))
    both = [item for item in found if len(item[1]) == 2]
    chosen = both if len(both) >= LEAST_PICTURES else found
    if len(chosen) < LEAST_PICTURES:
        raise InputError(
            f"{broke_off or source.name}: hands found in {len(found)} of {len(pictures)} pictures, "
            f"{LEAST_PICTURES} are needed; hold both open hands still before the camera, "
            "or say where they are with --hands"
        )
    images, boxes_of = zip(*chosen, strict=True)
    return Shown(images, boxes_of, len(pictures), max(len(boxes) for boxes in boxes_of), broke_off)


def learn(shown: Shown, kind: Kind, origin: str) -> Calibration:
    """The profile of all pictures, judged by what each half of them teaches about the other."""
    profile = learn_profile(shown.images, shown.boxes, kind, origin)
    share = 0.0
    for half in (0, 1):
        taught = learn_profile(shown.images[half::2], shown.boxes[half::2], kind, origin)
        share += proposed_share(shown.images[1 - half :: 2], shown.boxes[1 - half :: 2], taught) / 2
    without = proposed_share(shown.images, shown.boxes)
    return Calibration(profile, shown, share, without, _lack(profile.separation, share))


def _lack(separation: float, share: float) -> str | None:
    if separation < LEAST_SEPARATION:
        return f"a separation of {separation:.2f} is below {LEAST_SEPARATION:g}"
    if share < LEAST_SHARE:
        return f"only {share:.2f} of the hands stand out by it, fewer than {LEAST_SHARE:g}"
    return None


class PlacedHands:
    """Takes the boxes that the user named, the same in every picture."""

    def __init__(self, place: Sequence[Box] | Middle, name: str) -> None:
        self._place, self._name = place, name

    def boxes(self, colour: ColourMap) -> list[Box]:
        """The boxes, source pixels. InputError: one is not within the picture."""
        width, height = colour.source_size
        if isinstance(self._place, str):
            side = max(round(MIDDLE * min(height, width)), 1)
            return [((width - side) // 2, (height - side) // 2, side, side)]
        for x, y, wide, tall in self._place:
            if x + wide > width or y + tall > height:
                raise InputError(
                    f"{self._name}: --hands {x},{y},{wide},{tall} is not within its pictures of "
                    f"{width} x {height} pixels; give left edge, upper edge, width and height in pixels"
                )
        return list(self._place)


class FoundHands:
    """Finds hands picture by picture with the learned choice, which needs no profile."""

    def __init__(self) -> None:
        self._find = load_selector("learned")

    def boxes(self, colour: ColourMap) -> list[Box]:
        """Boxes of both hands, of one, or of none, source pixels."""
        hands = choose(self._find.process(colour), self._find.settings)
        return [hand.box for hand in hands]


def look_at(source: Source, seconds: float, rotate: int = 0) -> tuple[list[ColourMap], str | None]:
    """Working pictures at even distances over the first seconds, and why these are fewer, if the source broke off.

    At most twice as many as are wanted are held: where they overflow, every other one goes, and from there on only one
    frame in twice as many is kept. A source that breaks off is good for what it gave, if that may be enough; else its
    InputError is raised.
    """
    stage = ColourStage()
    kept: list[ColourMap] = []
    broke_off, stride, count = None, 1, 0
    try:
        for frame in _first_seconds(source, seconds):
            if count % stride == 0:
                kept.append(stage.process(turned(as_bgr8(frame.image), rotate)))
            if len(kept) == 2 * PICTURES:
                del kept[1::2]
                stride *= 2
            count += 1
    except InputError as error:
        if count < LEAST_PICTURES:
            raise
        broke_off = str(error)
    taken = min(len(kept), PICTURES)
    return [kept[number * len(kept) // taken] for number in range(taken)], broke_off


def _first_seconds(source: Source, seconds: float) -> Iterator[Frame]:
    start_s = None
    for frame in source:
        start_s = frame.time_s if start_s is None else start_s
        if frame.time_s - start_s > seconds:
            return
        yield frame


def _reduced(box: Box, scale: tuple[float, float]) -> Box:
    """A box of source pixels in working pixels, at least one wide and high."""
    x, y, width, height = box
    across, down = scale
    return (
        round(x / across),
        round(y / down),
        max(round(width / across), 1),
        max(round(height / down), 1),
    )
