"""A printed card in the scene: a flat sheet with a tag, lit, turned and seen through the water like all else."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Final

import cv2
import numpy as np

from lightgesture.features.tags.tag import cells_of
from lightgesture.synth.body import Camera, to_camera
from lightgesture.synth.raster import Float32
from lightgesture.synth.shading import Light, reflected
from lightgesture.synth.skeleton import FloatArray, rotation_x, rotation_y, rotation_z
from lightgesture.synth.water import Water

CARD_MM: Final = (105.0, 148.0)
"""Width and height of a card, A6; the tag has equal edges above and at the sides, and the hands the strip below."""

DOTS_PER_MM: Final = 2.0
"""Of the picture that is laid on the card."""

FINER: Final = 3
"""How many times finer than the picture a card is drawn, against jagged edges."""

PAPER, INK = 0.8, 0.035
"""Share of light that laminated paper and toner send back."""

GLOSS: Final = 0.05
"""Strength of the highlight of the film."""


@dataclass(frozen=True, slots=True)
class CardState:
    """A card in one moment. side_mm: of the tag. centre (3,): of the tag, body frame, mm. turn: yaw, pitch and roll in
    degrees; at (0, 0, 0) it faces as the body does, upright."""

    id: int
    side_mm: float
    centre: FloatArray
    turn: FloatArray
    family: str = "36h11"


@dataclass(frozen=True, slots=True)
class DrawnCard:
    """Truth of a drawn card: its id, and the corners of its tag (4, 2) in the order in which they are printed, picture
    pixels. facing: cosine of the angle between its face and the line of sight, negative from behind."""

    id: int
    corners: FloatArray
    facing: float


@cache
def card_picture(family: str, number: int, side_mm: float) -> Float32:
    """The printed face as reflectance, (h, w), at DOTS_PER_MM."""
    width, height = (round(side * DOTS_PER_MM) for side in CARD_MM)
    face = np.zeros((height, width), np.uint8)
    cells = cells_of(family, number)
    side = round(side_mm * DOTS_PER_MM)
    edge = (width - side) // 2
    inked = (~cells).astype(np.uint8) * 255
    face[edge : edge + side, edge : edge + side] = cv2.resize(
        inked, (side, side), interpolation=cv2.INTER_NEAREST
    )
    place = (width // 2, height - 20)
    cv2.putText(face, str(number), place, cv2.FONT_HERSHEY_SIMPLEX, 1.0, 255, 2, cv2.LINE_AA)
    return np.asarray(PAPER + (INK - PAPER) * (face / np.float32(255.0)), np.float32)


def turned(turn: FloatArray) -> FloatArray:
    """Rotation (3, 3) of a card in the body frame."""
    yaw, pitch, roll = (float(angle) for angle in turn)
    return np.asarray(rotation_y(yaw) @ rotation_x(pitch) @ rotation_z(roll))


def place_on(card: CardState, x_mm: float, y_mm: float, z_mm: float = 0.0) -> FloatArray:
    """A point of the card, mm right and up of the tag's centre and before its face, in the body frame."""
    return np.asarray(card.centre + turned(card.turn) @ np.array([x_mm, y_mm, z_mm]))


def draw_card(
    picture: Float32,
    cover: Float32,
    card: CardState,
    body: FloatArray,
    position: FloatArray,
    camera: Camera,
    light: Light,
    water: Water | None,
) -> DrawnCard:
    """Draw a card over a linear picture and into the coverage (h, w) of the diver, both in place.

    body (3, 3), position (3,): of the body frame before the camera.
    """
    top = 0.5 * CARD_MM[0]
    sheet = [(-top, top), (top, top), (top, top - CARD_MM[1]), (-top, top - CARD_MM[1])]
    half = 0.5 * card.side_mm
    tag = [(-half, half), (half, half), (half, -half), (-half, -half)]
    points = to_camera(np.array([place_on(card, x, y) for x, y in sheet + tag]), body, position)
    image, _ = camera.project(points)
    normal = body @ turned(card.turn)[:, 2]
    sight = -points[:4].mean(axis=0) * np.array([1.0, 1.0, -1.0])
    facing = float(normal @ sight / max(float(np.linalg.norm(sight)), 1e-6))
    truth = DrawnCard(card.id, image[4:], facing)
    if facing > 0.02 and points[:, 2].min() > 100.0:
        # Image axes: y down.
        shown = _lit(card, normal * np.array([1.0, -1.0, 1.0]), light)
        _lay(picture, cover, shown, image[:4], float(points[:4, 2].mean()) / 1000.0, water)
    return truth


def _lit(card: CardState, normal: FloatArray, light: Light) -> Float32:
    """The face as it sends light to the camera, (h, w, 3)."""
    face = card_picture(card.family, card.id, card.side_mm)
    one = np.ones(1, np.float32)
    sent = reflected(
        np.asarray(normal, np.float32).reshape(3, 1),
        np.ones((1, 3), np.float32),
        GLOSS * one,
        0.0 * one,
        one,
        light,
    )
    return np.asarray(face[..., None] * sent.reshape(1, 1, 3), np.float32)


def _lay(
    picture: Float32,
    cover: Float32,
    face: Float32,
    corners: FloatArray,
    distance_m: float,
    water: Water | None,
) -> None:
    """The face between four corners of the picture, finer first and then made smaller."""
    rows, columns = picture.shape[:2]
    x0, y0 = (max(int(np.floor(low)) - 1, 0) for low in corners.min(axis=0))
    x1, y1 = (
        min(int(np.ceil(high)) + 2, most)
        for high, most in zip(corners.max(axis=0), (columns, rows), strict=True)
    )
    if x0 >= x1 or y0 >= y1:
        return
    height, width = face.shape[:2]
    source = np.array([[0, 0], [width, 0], [width, height], [0, height]], np.float32) - np.float32(0.5)
    target = ((corners - (x0, y0)) * FINER - 0.5).astype(np.float32)
    to_target = cv2.getPerspectiveTransform(source, target)
    size = ((x1 - x0) * FINER, (y1 - y0) * FINER)
    layers = (face, np.ones((height, width), np.float32))
    drawn, alpha = (
        cv2.resize(
            cv2.warpPerspective(layer, to_target, size, flags=cv2.INTER_LINEAR),
            (x1 - x0, y1 - y0),
            interpolation=cv2.INTER_AREA,
        ).astype(np.float32)
        for layer in layers
    )
    if water is not None:
        drawn = water.see_through(drawn, alpha, distance_m)
    window = picture[y0:y1, x0:x1]
    window *= 1.0 - alpha[..., None]
    window += drawn
    np.maximum(cover[y0:y1, x0:x1], alpha, out=cover[y0:y1, x0:x1])
