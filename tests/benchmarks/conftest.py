"""A small data folder drawn on the spot, and the real one where it is there."""

import csv
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks.methods import Decoded
from lightgesture.benchmarks.scorer import Reading
from lightgesture.benchmarks.suite.scenarios import Scenario
from lightgesture.records import FrameRecord, Hand
from lightgesture.synth.scene import SceneFrame
from lightgesture.training.datasets import DATA_FOLDER

SKIN = (120, 150, 210)
"""BGR of a pale hand under neutral light: hue 10, saturation 109."""

WATER = (150, 110, 40)

# An open palm, upright, 21 landmarks in a crop of 112 pixels: wrist, then thumb to little finger.
PALM_LANDMARKS = (
    (56, 98), (42, 90), (32, 80), (24, 72), (17, 66), (44, 60), (41, 44), (39, 33), (37, 22), (54, 58),
    (54, 40), (54, 28), (54, 16), (64, 60), (67, 44), (68, 33), (70, 23), (73, 66), (78, 55), (81, 47),
    (84, 39),
)  # fmt: skip


@pytest.fixture(scope="session")
def real_data():
    """The shared data folder beside the checkout."""
    folder = Path(__file__).resolve().parents[3] / DATA_FOLDER
    if not folder.is_dir():
        pytest.skip(f"the shared pictures are not here: {folder}")
    return folder


def _write_table(path, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def _write_image(path, image):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(cv2.imencode(".png", image)[1].tobytes())


def _hand_row(token, source, path, note="", subject="s1"):
    box = dict(zip(("hx0", "hy0", "hx1", "hy1"), (17, 16, 84, 98), strict=True))
    landmarks = ";".join(f"{value:.1f}" for point in PALM_LANDMARKS for value in point)
    return {
        "path": path,
        "set": source,
        "token": token,
        "subject": subject,
        **box,
        "lm": landmarks,
        "note": note,
    }


def _frame_row(file, hand, token, box, sequence="", order=""):
    place = dict(zip("xywh", box, strict=True))
    return {
        "file": file,
        "sequence": sequence,
        "order": order,
        "hand": hand,
        "token": token,
        **place,
        "note": "",
    }


@pytest.fixture
def data(tmp_path):
    """A data folder with two kinds of crops, three frames and two negatives; one name is not ASCII."""
    folder = tmp_path / "data folder"
    crop = np.zeros((112, 112, 3), np.uint8)
    cv2.ellipse(crop, (50, 57), (33, 41), 0, 0, 360, SKIN, -1)
    rows = [
        _hand_row("5", "anna", "val/hånd 1.png"),
        _hand_row("2", "anna", "val/2.png", note="padded doubtful"),
        _hand_row("none", "bert", "val/3.png"),
    ]
    train = [_hand_row("5", "massey", "train/a.png"), _hand_row("left", "carl", "train/b.png", subject="")]
    _write_table(folder / "hands" / "val.csv", rows)
    _write_table(folder / "hands" / "train.csv", train)
    for row in [*rows, *train]:
        _write_image(folder / "hands" / row["path"], crop)

    frame = np.full((120, 160, 3), WATER, np.uint8)
    for x in (20, 110):
        cv2.ellipse(frame, (x + 15, 50), (15, 20), 0, 0, 360, SKIN, -1)
    files = [f"frames/lab/hover/{number}.png" for number in (2, 10)] + ["frames/lab/tank/a.png"]
    left, right = (20, 30, 31, 41), (110, 30, 31, 41)
    labels = [
        _frame_row(files[1], "image-left", "5", left, "hover", "10"),
        _frame_row(files[1], "image-right", "5", right, "hover", "10"),
        _frame_row(files[0], "image-left", "ok", left, "hover", "2"),
        _frame_row(files[0], "image-right", "3b", right, "hover", "2"),
        _frame_row(files[2], "image-left", "1", left),
    ]
    _write_table(folder / "frames" / "labels.csv", labels)
    negatives = [
        {"file": f"negatives/reef{n}.png", "set": "reef", "sequence": "reef_1", "order": n} for n in (0, 1)
    ]
    _write_table(folder / "negatives" / "negatives.csv", negatives)
    for file in files:
        _write_image(folder / file, frame)
    for row in negatives:
        _write_image(folder / row["file"], np.full((120, 160, 3), WATER, np.uint8))
    return folder


class FakeMethod:
    """Finds the image-left hand only, as the diver's right, and reads "5"; two words a sequence."""

    name = "fake"

    def __init__(self):
        self.holds = []
        self.times = []

    def read(self, image):
        assert image.shape == (120, 160, 3)
        is_water = image[50, 35].tolist() == list(WATER)
        return [] if is_water else [Reading((20, 30, 31, 41), "right", "5")]

    def stream(self, hold):
        self.holds.append(hold)
        return self

    def process(self, image, time_s):
        self.times.append(time_s)
        return self.read(image)

    def finish(self):
        return Decoded(("STOP", "HOVER"), ("STOP HOVER GO",), 1)


class FakeClassifier:
    """Says "5" with 0.6, and "none" with 0.3, or with 0.9 for a box at the picture's left edge."""

    classes = ("2", "5", "none")

    def __init__(self):
        self.calls = []

    def probabilities(self, image_bgr, boxes, sides):
        self.calls.append((image_bgr.shape, list(boxes), list(sides)))
        rows = [(0.02, 0.08, 0.9) if box[0] == 0 else (0.1, 0.6, 0.3) for box in boxes]
        return np.asarray(rows, np.float32).reshape(-1, 3)


@pytest.fixture
def fake_method():
    return FakeMethod()


@pytest.fixture
def fake_classifier():
    return FakeClassifier()


@dataclass(frozen=True)
class SignedTake:
    """A small clip of STOP UP GO: sixteen frames a sign, four without hands after each. Counts its renderings."""

    scenario: Scenario
    recipe: str = "drawn"
    rendered: list[int] = field(default_factory=lambda: [0], compare=False)
    fps = 30.0
    size = (64, 48)
    count = 60

    def frames(self):
        self.rendered[0] += 1
        image = np.random.default_rng(0).integers(0, 255, (48, 64, 3), np.uint8)
        for index in range(self.count):
            pair = (("ok", "0"), ("right", "right"), ("ok", "ok"))[index // 20]
            hands = tuple(
                Hand(side=side, token=token, confidence=1.0, box=box, track=None, reason=None)
                for side, token, box in zip(
                    ("left", "right"), pair, ((40, 10, 12, 12), (8, 10, 12, 12)), strict=True
                )
            )
            shown = hands if index % 20 < 16 else ()
            yield SceneFrame(image, FrameRecord(source=None, frame=index, time_s=index / 30.0, hands=shown))


@pytest.fixture
def signed_take():
    return SignedTake(Scenario("water", ("STOP UP GO",), "clear", "water", 7_000_000))
