"""Tags against size, blur, contrast and tilt beside both libraries; false tags; time; and how far a card is read.

`python -m lightgesture.benchmarks.cards.reading --data DATA` pastes tags into real frames of `divers`, looks for tags
where there are none (`divers`, `negatives`), and draws cards at growing distances in the waters of the suite.
"""

import argparse
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from statistics import median
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.features.tags.detector import Grey, make_detector
from lightgesture.features.tags.tag import dictionary
from lightgesture.features.types import Image
from lightgesture.sources import read_picture
from lightgesture.synth.body import Camera
from lightgesture.synth.camera import CameraLook, Sensor
from lightgesture.synth.cards import CARD_MM, CardState, draw_card
from lightgesture.synth.shading import daylight
from lightgesture.synth.water import make_water

FAMILY: Final = "36h11"
SIZE: Final = (640, 480)
FOCAL_PX: Final = 560.0
"""Of the camera of the distances, about 60 degrees wide."""

NOISE: Final = 2.0
"""Standard deviation added to every pixel of a pasted tag's frame, grey levels."""

STREAM_HZ: Final = 30.0
"""Pictures a second of what is looked at as a stream."""

Find = Callable[[Grey], set[int]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """How a tag is shown. side_px: of the black square. blur_px: standard deviation. contrast: 1 is black on white.
    tilt_deg: away from the camera."""

    name: str
    side_px: float = 60.0
    blur_px: float = 0.0
    contrast: float = 1.0
    tilt_deg: float = 30.0


CONDITIONS: Final = (
    Condition(name="plain"),
    *(Condition(name=f"{side} px", side_px=side) for side in (32, 24, 20, 16, 12)),
    *(Condition(name=f"blur {blur}", blur_px=blur) for blur in (1.5, 2.5, 3.0, 4.0)),
    *(Condition(name=f"contrast {contrast}", contrast=contrast) for contrast in (0.3, 0.2, 0.1, 0.05)),
    *(Condition(name=f"tilt {tilt}", tilt_deg=tilt) for tilt in (45, 60, 70, 75)),
    Condition(name="contrast 0.1, blur 2", contrast=0.1, blur_px=2.0),
    Condition(name="30 px, blur 1.5", side_px=30.0, blur_px=1.5),
)

WATERS: Final = (
    ("pool, IB, 0.15 /m", "IB", 2.0, 0.15),
    ("suite, mild, II, 0.3 /m", "II", 4.0, 0.3),
    ("suite, cast, 5C, 0.3 /m", "5C", 6.0, 0.3),
    ("suite, turbid, 1C, 1.0 /m", "1C", 4.0, 1.0),
    ("harbour, 7C, 2.0 /m", "7C", 2.0, 2.0),
)
"""Name, Jerlov's type, depth in metres and turbidity of each."""

DISTANCES_M: Final = (0.7, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0)


def opencv_alone(grey: Grey) -> set[int]:
    """OpenCV's detector as it comes."""
    _, ids, _ = cv2.aruco.ArucoDetector(dictionary(FAMILY)).detectMarkers(grey)
    return set() if ids is None else {int(number) for number in ids.ravel()}


def finders() -> dict[str, Find]:
    """Name -> what finds tags: the product's two detectors, each without memory, and OpenCV's as it comes."""

    apriltag = make_detector("apriltag", FAMILY)

    def aruco_fresh(grey: Grey) -> set[int]:
        return {tag.id for tag in make_detector("aruco", FAMILY).process(grey, 0.0)}

    def apriltag_own(grey: Grey) -> set[int]:
        return {tag.id for tag in apriltag.process(grey, 0.0)}

    return {"opencv": opencv_alone, "aruco": aruco_fresh, "apriltag": apriltag_own}


def stream_finder() -> Find:
    """The product's default as it looks at the pictures of one recording."""
    detector, numbers = make_detector("aruco", FAMILY), count()
    return lambda grey: {tag.id for tag in detector.process(grey, next(numbers) / STREAM_HZ)}


def paste_tag(picture: Image, number: int, condition: Condition, rng: np.random.Generator) -> Grey:
    """The grey picture with a tag somewhere, its edge of two cells included, as a condition has it."""
    grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY).astype(np.float32)
    tag = cv2.aruco.generateImageMarker(dictionary(FAMILY), number, 160)
    tag = cv2.copyMakeBorder(tag, 20, 20, 20, 20, cv2.BORDER_CONSTANT, value=255)
    corners = _seen_corners(condition, rng)
    low, high = np.floor(corners.min(axis=0) - 3).astype(int), np.ceil(corners.max(axis=0) + 3).astype(int)
    finer = 4
    source = np.array([[0, 0], [200, 0], [200, 200], [0, 200]], np.float32) - np.float32(0.5)
    to_window = cv2.getPerspectiveTransform(source, ((corners - low) * finer).astype(np.float32))
    size = (int(high[0] - low[0]), int(high[1] - low[1]))
    layers = [
        cv2.resize(
            cv2.warpPerspective(layer, to_window, (size[0] * finer, size[1] * finer)),
            size,
            interpolation=cv2.INTER_AREA,
        ).astype(np.float32)
        for layer in (tag, np.full_like(tag, 255))
    ]
    window = grey[low[1] : high[1], low[0] : high[0]]
    cover = layers[1] / np.float32(255.0)
    # About the middle grey of the place, as far as there is room for the contrast.
    half = 127.5 * condition.contrast
    middle = float(np.clip(window.mean(), half, 255.0 - half))
    window *= 1.0 - cover
    window += cover * (middle + (layers[0] - 127.5) * condition.contrast)
    if condition.blur_px > 0.0:
        grey = np.asarray(cv2.GaussianBlur(grey, (0, 0), condition.blur_px), np.float32)
    return np.asarray(np.clip(grey + rng.normal(0.0, NOISE, grey.shape), 0, 255), np.uint8)


def _seen_corners(condition: Condition, rng: np.random.Generator) -> NDArray[np.float64]:
    """Corners (4, 2) of the sheet in a picture of SIZE, turned about an axis by chance and seen in perspective."""
    tilt, axis, roll = np.radians(condition.tilt_deg), rng.uniform(0, 2 * np.pi), rng.uniform(-0.4, 0.4)
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], float) * 0.625  # 10 cells of 8
    along = np.array([np.cos(axis), np.sin(axis)])
    part = square @ along
    flat = square - np.outer(part, along) + np.outer(part * np.cos(tilt), along)
    flat *= 6.0 / (6.0 + part * np.sin(tilt))[:, None]
    turn = np.array([[np.cos(roll), -np.sin(roll)], [np.sin(roll), np.cos(roll)]])
    room = 0.8 * condition.side_px + 5.0
    centre = [rng.uniform(room, side - room) for side in SIZE]
    return np.asarray(flat @ turn.T * condition.side_px + centre)


def conditions_table(pictures: Sequence[Image], tags: int) -> Table:
    """Share of tags read by each, and wrong ids. tags: of each condition."""
    finds, rng = finders(), np.random.default_rng(5)
    rows: list[dict[str, Cell]] = []
    for condition in CONDITIONS:
        read, wrong = dict.fromkeys(finds, 0), 0
        for index in range(tags):
            number = int(rng.integers(0, 587))
            grey = paste_tag(pictures[index % len(pictures)], number, condition, rng)
            for name, find in finds.items():
                ids = find(grey)
                read[name] += number in ids
                wrong += len(ids - {number})
        shares: dict[str, Cell] = {name: hits / tags for name, hits in read.items()}
        rows.append({"shown": condition.name, "tags": tags, **shares, "wrong_ids": wrong})
    columns = ("shown", "tags", *finds, "wrong_ids")
    return Table("tags_read", "Share of pasted tags that are read", columns, tuple(rows))


def false_table(groups: dict[str, list[Path]], every: int) -> Table:
    """Tags found where there are none, and the time of a picture. every: others than `aruco` look at one in so many."""
    rows: list[dict[str, Cell]] = []
    for group, files in groups.items():
        finds = {**finders(), "aruco, stream": stream_finder()}
        times: dict[str, list[float]] = {}
        found: dict[str, int] = {}
        for index, file in enumerate(files):
            picture = cv2.resize(read_picture(str(file)), SIZE, interpolation=cv2.INTER_AREA)
            grey = np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), np.uint8)
            for name, find in finds.items():
                if not name.startswith("aruco") and index % every:
                    continue
                start = time.thread_time()
                ids = find(grey)
                times.setdefault(name, []).append((time.thread_time() - start) * 1e3)
                found[name] = found.get(name, 0) + len(ids)
        rows += [
            {
                "pictures": group,
                "detector": name,
                "looked_at": len(taken),
                "false_tags": found[name],
                "ms_median": round(median(taken), 2),
                "ms_p95": round(float(np.quantile(taken, 0.95)), 2),
            }
            for name, taken in times.items()
        ]
    columns = ("pictures", "detector", "looked_at", "false_tags", "ms_median", "ms_p95")
    note = "ms: processor time of one thread at 640 × 480; stream: as of one recording, not of pictures on their own."
    return Table("tags_false", "Tags found where there are none", columns, tuple(rows), note)


def distance_table(cards: int, side_mm: float = 80.0) -> Table:
    """Share of cards read by distance in each water. cards: of each."""
    finds = finders()
    rows: list[dict[str, Cell]] = []
    for water_name, kind, depth_m, turbidity in WATERS:
        shown = {
            distance_m: list(_cards_at(distance_m, side_mm, cards, kind, depth_m, turbidity))
            for distance_m in DISTANCES_M
        }
        for name in ("aruco", "apriltag"):
            row: dict[str, Cell] = {"water": water_name, "detector": name}
            for distance_m, pictures in shown.items():
                hits = [number in finds[name](grey) for number, grey in pictures]
                row[f"{distance_m:g} m"] = sum(hits) / len(hits)
            rows.append(row)
    columns = ("water", "detector", *(f"{distance_m:g} m" for distance_m in DISTANCES_M))
    title = f"Share of cards of {side_mm:g} mm that are read, by distance"
    return Table(
        "tags_distance", title, columns, tuple(rows), "640 × 480, 60 degrees wide, turned up to 30 degrees."
    )


def _cards_at(
    distance_m: float, side_mm: float, cards: int, kind: str, depth_m: float, turbidity: float
) -> Iterator[tuple[int, Grey]]:
    """Ids and pictures of single cards in open water."""
    water = make_water(kind, depth_m, turbidity)
    light = daylight(water, (-0.25, -0.85, 0.55))
    camera = Camera(FOCAL_PX, (SIZE[0] / 2, SIZE[1] / 2))
    rng = np.random.default_rng(round(distance_m * 100))
    for _ in range(cards):
        number = int(rng.integers(0, 587))
        picture = np.full((SIZE[1], SIZE[0], 3), water.veil, np.float32)
        blur = float(np.hypot(0.7, water.blur_sigma(distance_m, SIZE[0])))
        sensor = Sensor(CameraLook(blur_px=blur), SIZE, rng, margin=0)
        sensor.meter(picture)
        turn = np.array([*rng.uniform(-30, 30, 2), rng.normal(0, 8)])
        card = CardState(number, side_mm, np.array([0.0, 0.5 * (CARD_MM[1] - CARD_MM[0]), 0.0]), turn)
        cover = np.zeros(picture.shape[:2], np.float32)
        place = np.array([*rng.uniform(-0.15, 0.15, 2) * distance_m * 1000, distance_m * 1000])
        draw_card(picture, cover, card, np.eye(3), place, camera, light, water)
        image = sensor.expose(picture, 0, 0.0)
        yield number, np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), np.uint8)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument(
        "--data", type=Path, metavar="DIR", help="folder of real pictures; without it distances alone"
    )
    parser.add_argument("--count", type=int, default=60, metavar="N", help="tags a condition; default 60")
    parser.add_argument(
        "--every", type=int, default=1, metavar="N", help="look for false tags in one picture of N"
    )
    args = parser.parse_args()
    cv2.setNumThreads(1)
    for table in _tables(args.data, args.count, args.every):
        print(table.to_text() + "\n", flush=True)


def _tables(data: Path | None, tags: int, every: int) -> Iterator[Table]:
    """What is asked for, each as soon as it is made."""
    if data is not None:
        suffixes = (".jpg", ".jpeg", ".png")
        groups = {
            name: sorted(file for file in (data / name).rglob("*") if file.suffix.lower() in suffixes)
            for name in ("divers", "negatives")
        }
        yield false_table({name: files[::every] for name, files in groups.items()}, 10)
        shown = [read_picture(str(file)) for file in groups["divers"][:: max(len(groups["divers"]) // 24, 1)]]
        pictures = [np.asarray(cv2.resize(picture, SIZE), np.uint8) for picture in shown]
        yield conditions_table(pictures, tags)
    yield distance_table(max(tags // 6, 1))


if __name__ == "__main__":
    main()
