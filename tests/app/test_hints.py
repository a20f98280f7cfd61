"""Hints of a mirrored or turned picture: told when the signs say so, and only then."""

import cv2
import numpy as np
import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.errors import ExitStatus
from lightgesture.features.geometry import turn_box
from lightgesture.features.image import turned
from lightgesture.fsm import State, load_grammar
from lightgesture.fsm.events import Growth
from lightgesture.hints import MirrorHint
from lightgesture.pipeline import Pipeline
from lightgesture.sources import open_source

EVERY = 5
"""One in so many frames of the bundled clip is enough to read it."""


@pytest.fixture(scope="module")
def frames():
    with open_source(str(SAMPLE)) as source:
        return [(frame.image, frame.time_s) for frame in source if frame.index % EVERY == 0]


@pytest.fixture
def folder(frames, tmp_path):
    """Writes the frames of the bundled clip as they are changed, as a folder."""

    def write(change):
        for number, (image, _) in enumerate(frames):
            cv2.imwrite(str(tmp_path / f"{number}.png"), change(image), [cv2.IMWRITE_PNG_COMPRESSION, 0])
        return tmp_path

    return write


def held(*pairs):
    """The states of holds, each of which is let go."""
    for pair in pairs:
        growth = Growth(pair=pair, word=None, progress=0.8)
        for dwell in (growth, growth, None):
            yield State(source="a", frame=0, time_s=0.0, state="idle", sentence="", dwell=dwell)


@pytest.mark.parametrize(
    ("pairs", "is_told"),
    [
        ((("0", "ok"), ("5", "ok"), ("3", "ok")), True),
        ((("0", "ok"), ("5", "ok")), False),
        ((("0", "ok"), ("5", "ok"), ("3", "ok"), ("ok", "3"), ("ok", "1")), False),
        ((("ok", "0"), ("ok", "5"), ("pic", "2"), ("5", "5"), ("ok", "pic")), False),
        ((("3", "left"), ("2", "1"), ("right", "1"), ("4", "2")), False),
    ],
)
def test_mirrored_pairs_are_told_where_they_prevail(pairs, is_told):
    hint = MirrorHint(load_grammar())
    hint.hear(held(*pairs))
    assert (hint.text() is not None) is is_told


@pytest.mark.parametrize(
    ("change", "remedy"),
    [
        (lambda image: image[:, ::-1], "read as a mirror image?"),
        (lambda image: turned(image, 180), "upside down?"),
        pytest.param(lambda image: turned(image, 270), "on its side?", marks=pytest.mark.slow),
    ],
    ids=["mirrored", "upside down", "on its side"],
)
def test_what_the_hint_says_helps(run, folder, change, remedy):
    place = folder(change)
    options = ["--fps", 30 / EVERY, "--hold", 15 // EVERY]
    first = run("decode", place, *options)
    assert first.out[-1].startswith("  0 instructions")
    (line,) = first.err
    assert remedy in line
    again = run("decode", place, *options, *line.rpartition(": try ")[2].split())
    assert (again.status, again.err) == (ExitStatus.OK, [])
    assert "STOP HOVER 50 GO" in again.out[1]
    assert run("decode", place, *options, "--quiet").err == []


@pytest.mark.parametrize("degrees", [90, 180, 270])
@pytest.mark.parametrize("mirrored", [False, True])
def test_boxes_of_a_turned_picture_are_told_as_it_came(frames, degrees, mirrored):
    image = next(image for image, time_s in frames if time_s > 1.0)
    size = image.shape[1], image.shape[0]
    upright = Pipeline().recognize(image).hands
    flipped = np.ascontiguousarray(image[:, ::-1]) if mirrored else image
    found = Pipeline(rotate=360 - degrees, mirrored=mirrored).recognize(turned(flipped, degrees)).hands
    assert len(upright) == 2
    expected = {hand.side: hand.box for hand in upright}
    for hand in found:
        x, y, width, height = expected[hand.side]
        box = (size[0] - x - width, y, width, height) if mirrored else (x, y, width, height)
        assert hand.box == turn_box(box, size, degrees)


def test_degrees_between_are_refused(run, make_video):
    result = run("decode", make_video(), "--rotate", 45)
    assert result.status == ExitStatus.USAGE
    assert result.err[0].startswith("lightgesture: --rotate: should be a multiple of 90, not '45'")
    with pytest.raises(ValueError, match="rotate is 45"):
        Pipeline(rotate=45)
