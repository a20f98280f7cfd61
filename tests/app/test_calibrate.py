"""`lightgesture calibrate`: open hands in a video or a folder to a profile, or one line that says why not."""

import cv2
import numpy as np
import pytest

from lightgesture import calibration
from lightgesture.calibration import LEAST_SEPARATION, learn, show_hands
from lightgesture.errors import ExitStatus, InputError
from lightgesture.features.colour import ColourStage
from lightgesture.features.profile import load_profile
from lightgesture.frames import Frame
from lightgesture.synth.scene import Scene
from lightgesture.synth.spec import DiverSpec, SceneSpec

BOXES = ((60, 60, 90, 120), (400, 80, 90, 120))
BLUE_RUBBER, SAND = (200, 90, 40), (120, 150, 160)


def _gloves(seed, hand=BLUE_RUBBER):
    image = np.full((300, 560, 3), SAND, np.uint8)
    cv2.rectangle(image, (200, 60), (350, 299), (40, 45, 50), cv2.FILLED)
    for x, y, width, height in BOXES:
        middle, axes = (x + width // 2, y + height // 2), (width // 2, height // 2)
        cv2.ellipse(image, middle, axes, 0, 0, 360, hand, -1)
    noise = np.random.default_rng(seed).normal(0, 6, image.shape)
    return np.clip(image + noise, 0, 255).astype(np.uint8)


@pytest.fixture
def gloves(make_picture):
    """A folder of six pictures of blue gloves, which no selector takes for hands."""
    for number in range(6):
        path = make_picture(f"gloves/{number}.png", _gloves(number))
    return path.parent


@pytest.fixture
def named():
    """The boxes of both gloves as options."""
    return [word for box in BOXES for word in ("--hands", ",".join(map(str, box)))]


class Stream:
    """Frames, then what the source says of its end."""

    name, frame_count = "stream", None

    def __init__(self, images, step_s=0.1, error=None):
        self.images, self.step_s, self.error = images, step_s, error
        self.given = 0

    def __iter__(self):
        for index, image in enumerate(self.images):
            self.given += 1
            yield Frame(image, index, 100.0 + index * self.step_s)
        if self.error is not None:
            raise self.error


def test_named_boxes_make_a_profile_of_gloves(run, gloves, named, tmp_path):
    out = tmp_path / "glove.json"
    result = run("calibrate", gloves, "--out", out, "--kind", "glove", *named)
    assert result.status == ExitStatus.OK
    assert result.err == []
    profile = load_profile(out)
    assert profile.kind == "glove"
    assert profile.separation > 0.95
    assert str(gloves) in profile.origin
    text = "\n".join(result.out)
    assert "both in 6 of 6 pictures" in text
    assert "1.00 of the hands with this profile, 0.00 with the map" in text
    assert f"--profile {out}" in text
    assert (
        run("recognize", gloves / "0.png", "--profile", out, "--selector", "classical").status
        == ExitStatus.OK
    )


def test_hands_are_found_by_themselves(run, make_picture, tmp_path):
    scene = Scene(SceneSpec(seed=4, size=(320, 240), diver=DiverSpec()))
    for number, share in enumerate((0.15, 0.35, 0.55, 0.8)):
        path = make_picture(f"bare/{number}.png", scene.frame(round(scene.frame_count * share)).image)
    out = tmp_path / "skin.json"
    result = run("calibrate", path.parent, "--out", out)
    assert result.status == ExitStatus.OK
    assert load_profile(out).kind == "skin"
    assert "no profile is needed" in result.out[-2]


@pytest.mark.parametrize("force", [False, True])
def test_what_colour_cannot_tell_is_refused_unless_forced(run, make_picture, named, tmp_path, force):
    for number in range(6):
        path = make_picture(f"sand/{number}.png", _gloves(number, hand=SAND))
    out = tmp_path / "sand.json"
    result = run("calibrate", path.parent, "--out", out, *named, *["--force"] * force)
    assert "poorly" in result.out[1]
    assert out.exists() is force
    assert result.status == (ExitStatus.OK if force else ExitStatus.SOME_FAILED)
    if not force:
        assert len(result.err) == 1
        assert "a separation of" in result.err[0]
        assert "nothing is written" in result.err[0]
        assert not any("written" in line for line in result.out)


def test_hands_that_colour_alone_does_not_lift_out_are_refused(monkeypatch):
    monkeypatch.setattr(calibration, "proposed_share", lambda images, boxes, profile=None: 0.3)
    shown = show_hands(Stream([_gloves(seed) for seed in range(6)]), BOXES, 5.0)
    result = learn(shown, "glove", "drawn")
    assert result.profile.separation > LEAST_SEPARATION
    assert result.lack == "only 0.30 of the hands stand out by it, fewer than 0.5"


def test_no_hands_is_one_line(run, make_folder, tmp_path):
    out = tmp_path / "profile.json"
    result = run("calibrate", make_folder(), "--out", out)
    assert result.status == ExitStatus.SOME_FAILED
    assert result.out == []
    assert len(result.err) == 1
    assert "hands found in 0 of 12 pictures, 4 are needed" in result.err[0]
    assert "--hands" in result.err[0]
    assert not out.exists()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--hands", "1,2,3"], "--hands 1,2,3: is no box"),
        (["--hands", "1,2,3,0"], "is no box"),
        (["--hands=-1,2,3,4"], "is no box"),
        (["--hands", "middle", "--hands", "1,2,3,4"], "goes with no other"),
        (["--hands", "1,2,3,4"] * 3, "3 boxes"),
        (["--seconds", "0"], "argument --seconds: 0 is not above 0"),
        (["--seconds", "nan"], "argument --seconds"),
        (["--seconds", "soon"], "argument --seconds"),
        (["--kind", "mitten"], "argument --kind: mitten: unknown; use skin, glove"),
        (["--size", "640"], "--size: should be WxH, not '640'; change it"),
        (["--size", "0x480"], "--size: should be WxH, not '0x480'"),
    ],
)
def test_wrong_options_are_one_line(run, make_folder, options, message):
    result = run("calibrate", make_folder(), *options)
    assert result.status == ExitStatus.USAGE
    assert len(result.err) == 1
    assert message in result.err[0]


def test_where_to_write_is_checked_before_the_source_is_opened(run, tmp_path):
    places = [
        (tmp_path / "none" / "p.json", "no such folder"),
        (tmp_path, "is a folder"),
        ("/proc/p.json", "/proc/p.json: cannot be written ("),
    ]
    for out, message in places:
        result = run("calibrate", tmp_path / "missing.mp4", "--out", out)
        assert result.status == ExitStatus.USAGE
        assert message in result.err[0]


def test_a_box_outside_the_picture_is_told(run, gloves):
    result = run("calibrate", gloves, "--hands", "500,0,90,90")
    assert result.status == ExitStatus.SOME_FAILED
    assert "--hands 500,0,90,90 is not within its pictures of 560 x 300 pixels" in result.err[0]


def test_the_middle_box_is_square_and_central(monkeypatch):
    monkeypatch.setattr(calibration, "MIDDLE", 0.2)
    colour = ColourStage().process(np.zeros((300, 560, 3), np.uint8))
    placer = calibration.PlacedHands("middle", "a")
    assert placer.boxes(colour) == [(250, 120, 60, 60)]


@pytest.mark.parametrize("frames", [4, 10, 11, 19, 20, 21, 47, 200])
def test_pictures_are_taken_evenly_and_the_source_is_left_after_the_seconds(monkeypatch, frames):
    monkeypatch.setattr(calibration, "PICTURES", 10)
    images = [np.full((12, 16, 3), index, np.uint8) for index in range(frames)]
    stream = Stream(images, step_s=0.1)
    taken, broke_off = calibration.look_at(stream, 4.95)
    assert broke_off is None
    in_time = min(frames, 50)
    assert stream.given == min(frames, 51)
    assert len(taken) == min(in_time, 10)
    places = [int(colour.picture[0, 0, 0]) for colour in taken]
    steps = np.diff([*places, in_time])
    assert places[0] == 0
    assert steps.min() >= 1
    assert steps.max() <= 2 * in_time / len(taken)


def test_a_source_that_breaks_off_serves_if_enough_was_seen():
    cut = InputError("stream: ended early")
    images = [_gloves(seed) for seed in range(5)]
    shown = show_hands(Stream(images, error=cut), BOXES, 5.0)
    assert (shown.looked_at, shown.broke_off) == (5, "stream: ended early")
    with pytest.raises(InputError, match="ended early"):
        show_hands(Stream(images[:3], error=cut), BOXES, 5.0)


def test_pictures_of_both_hands_go_before_those_of_one(monkeypatch):
    counts = iter([1, 2, 2, 1, 2, 2, 0])
    monkeypatch.setattr(calibration.FoundHands, "boxes", lambda self, colour: list(BOXES[: next(counts)]))
    shown = show_hands(Stream([_gloves(seed) for seed in range(7)]), None, 5.0)
    assert (shown.hands, len(shown.images), shown.looked_at) == (2, 4, 7)
    counts = iter([1, 2, 1, 0, 1])
    shown = show_hands(Stream([_gloves(seed) for seed in range(5)]), None, 5.0)
    assert (shown.hands, len(shown.images)) == (2, 4)


def test_a_file_that_is_no_profile_is_not_replaced(run, tmp_path):
    video = tmp_path / "hands.mp4"
    video.write_bytes(b"mine")
    result = run("calibrate", video, "--out", video)
    assert (result.status, len(result.err)) == (ExitStatus.USAGE, 1)
    assert f"{video}: is no profile and would be replaced; name another file with --out" in result.err[0]
    assert video.read_bytes() == b"mine"


def test_a_turned_camera_is_turned_back():
    images = [_gloves(seed) for seed in range(6)]
    upright = show_hands(Stream(images), BOXES, 5.0)
    lying = [np.ascontiguousarray(np.rot90(image)) for image in images]
    shown = show_hands(Stream(lying), BOXES, 5.0, rotate=90)
    assert shown.boxes == upright.boxes
    assert all((one == other).all() for one, other in zip(shown.images, upright.images, strict=True))
