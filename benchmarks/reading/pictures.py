"""Pictures of how hands are read: every error, the confusions, the reliability of the probabilities.

Drawn with OpenCV: it is there wherever the package is, and a diagram of one line a model needs no plotting library.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.contact_sheet import Image, arranged
from lightgesture.benchmarks.reading.hands import HandAnswer
from lightgesture.benchmarks.reading.reliability import calibration_error, reliability_bins
from lightgesture.benchmarks.scorer import confusion
from lightgesture.sources import read_picture
from lightgesture.training.samples import in_order

TILE_WIDTH, PICTURE_HEIGHT = 160, 150
"""Pixels of a tile and of the hand in it: crops are at most 112 wide."""
LINES = ("truth and answers", "source")
LINE_HEIGHT = 14
TILES_IN_A_ROW = 10

SMALL = 0.36
"""Scale of the font: about 8 pixels high."""
BLACK, GREY, PALE, WHITE = (0, 0, 0), (150, 150, 150), (225, 225, 225), (255, 255, 255)
COLOURS = ((180, 90, 20), (40, 40, 200), (50, 140, 30), (160, 40, 150), (20, 130, 200))
"""Of the models, in their order, the first again after the last."""

PLOT, MARGIN = 400, 60
"""Pixels of the diagram's square and of the rim with its numbers."""
CELL = 38
"""Pixels of a cell of the confusions."""


def error_sheet(answers: Sequence[HandAnswer]) -> Image | None:
    """Every hand of the ten tokens that was read as another, the surest error first; None without errors.

    Below each: the truth, then the two likeliest tokens with their probabilities; the end of the source's name.
    """
    errors = [answer for answer in answers if answer.failed]
    errors.sort(key=lambda answer: -answer.likeliest_tokens()[0][1])
    return arranged([_error_tile(answer) for answer in errors], TILES_IN_A_ROW) if errors else None


def _error_tile(answer: HandAnswer) -> Image:
    image = read_picture(answer.sample.path)
    tile = np.zeros((PICTURE_HEIGHT + len(LINES) * LINE_HEIGHT + 4, TILE_WIDTH, 3), np.uint8)
    scale = min(TILE_WIDTH / image.shape[1], PICTURE_HEIGHT / image.shape[0])
    width, height = round(image.shape[1] * scale), round(image.shape[0] * scale)
    left = (TILE_WIDTH - width) // 2
    tile[:height, left : left + width] = cv2.resize(image, (width, height), interpolation=cv2.INTER_AREA)
    x, y, wide, high = (round(value * scale) for value in answer.label.box)
    cv2.rectangle(tile, (left + x, y), (left + x + wide, y + high), (60, 220, 60), 1)
    read = ", ".join(f"{name} {value:.2f}" for name, value in answer.likeliest_tokens(2))
    doubt = "?" if answer.sample.doubtful else ""
    for number, line in enumerate((f"{answer.truth}{doubt}: {read}", answer.sample.source[-24:]), 1):
        _write(tile, line, (3, PICTURE_HEIGHT + number * LINE_HEIGHT), WHITE)
    return tile


def reliability_diagram(answers: Mapping[str, Sequence[HandAnswer]]) -> Image:
    """Share of right answers over confidence, a line a model; on the grey diagonal a probability means what it says.

    answers: by the model's name. The area of a point grows with the number of hands in its bin.
    """
    side = PLOT + 2 * MARGIN
    image = np.full((side, side, 3), 255, np.uint8)
    for step in range(11):
        value = step / 10
        x, y = _place(value, 0.0)[0], _place(0.0, value)[1]
        cv2.line(image, (x, MARGIN), (x, MARGIN + PLOT), PALE, 1)
        cv2.line(image, (MARGIN, y), (MARGIN + PLOT, y), PALE, 1)
        _write(image, f"{value:.1f}", (x - 9, MARGIN + PLOT + 16), BLACK)
        _write(image, f"{value:.1f}", (MARGIN - 26, y + 4), BLACK)
    cv2.line(image, _place(0.0, 0.0), _place(1.0, 1.0), GREY, 1, cv2.LINE_AA)
    cv2.rectangle(image, (MARGIN, MARGIN), (MARGIN + PLOT, MARGIN + PLOT), BLACK, 1)
    _write(image, "probability of the likeliest class", (MARGIN + 110, side - 18), BLACK)
    _write(image, "share of right answers", (MARGIN, MARGIN - 12), BLACK)
    for number, (name, own) in enumerate(answers.items()):
        colour = COLOURS[number % len(COLOURS)]
        bins = reliability_bins(own)
        points = [_place(one.confidence, one.right) for one in bins]
        for first, second in pairwise(points):
            cv2.line(image, first, second, colour, 2, cv2.LINE_AA)
        for one, point in zip(bins, points, strict=True):
            radius = 3 + round(9 * (one.hands / max(len(own), 1)) ** 0.5)
            cv2.circle(image, point, radius, colour, -1, cv2.LINE_AA)
        text = f"{name[-30:]}: error {calibration_error(bins) or 0.0:.3f}, {len(own)} hands"
        # The lower right corner is empty unless a model is far too sure of itself.
        _write(image, text, (MARGIN + 170, MARGIN + PLOT - 12 - 16 * (len(answers) - 1 - number)), colour)
    return image


def confusion_picture(answers: Mapping[str, Sequence[HandAnswer]]) -> Image:
    """Counts of truth (down) and likeliest class (across), `none` included, the models side by side.

    A cell is the darker the larger its share of its row is: blue on the diagonal, red beside it.
    """
    return np.hstack([_confusion(name, own) for name, own in answers.items()])


def _confusion(name: str, answers: Sequence[HandAnswer]) -> Image:
    truth, read = [answer.truth for answer in answers], [answer.best for answer in answers]
    names = in_order([*truth, *read])
    pairs = confusion(truth, read)
    sums: NDArray[np.int64] = np.array([[pairs[row, column] for column in names] for row in names])
    side = CELL * len(names)
    image = np.full((side + MARGIN + 16, side + MARGIN + 16, 3), 255, np.uint8)
    _write(image, f"{name[-40:]}: truth down, read as across", (8, 16), BLACK)
    for row, own in enumerate(names):
        _write(image, own, (8, MARGIN + CELL * row + 23), BLACK)
        _write(image, own, (MARGIN + CELL * row + 6, MARGIN - 8), BLACK)
        for column in range(len(names)):
            count = int(sums[row, column])
            part = count / max(int(sums[row].sum()), 1)
            corner = MARGIN + CELL * column, MARGIN + CELL * row
            opposite = corner[0] + CELL - 1, corner[1] + CELL - 1
            cv2.rectangle(image, corner, opposite, _shade(part, row == column), -1)
            cv2.rectangle(image, corner, opposite, PALE, 1)
            if count:
                ink = WHITE if part > 0.5 else BLACK
                _write(image, str(count), (corner[0] + 19 - 4 * len(str(count)), corner[1] + 23), ink)
    return image


def _shade(part: float, is_right: bool) -> tuple[int, int, int]:
    """White for none; a share of a quarter of the row is already the full red of an error."""
    strength = part if is_right else min(1.0, 4.0 * part)
    full = (150, 70, 20) if is_right else (60, 60, 220)
    blue, green, red = (round(255 + strength * (value - 255)) for value in full)
    return blue, green, red


def _place(across: float, up: float) -> tuple[int, int]:
    return MARGIN + round(PLOT * across), MARGIN + round(PLOT * (1.0 - up))


def _write(image: Image, text: str, place: tuple[int, int], colour: tuple[int, int, int]) -> None:
    cv2.putText(image, text, place, cv2.FONT_HERSHEY_SIMPLEX, SMALL, colour, 1, cv2.LINE_AA)
