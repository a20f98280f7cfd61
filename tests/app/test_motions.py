"""Moved cards from pixels to records, and shapes of one's own from a clip."""

import json

import cv2
import numpy as np
import pytest

from lightgesture import Pipeline
from lightgesture.cards.motion_front import UNREAD_S
from lightgesture.cli import main
from lightgesture.features.motion.matching import resampled
from lightgesture.features.motion.shapes import SHAPES
from lightgesture.features.tags.tag import dictionary
from lightgesture.fsm import GrammarError, load_grammar

FPS = 15
SIZE = (200, 320)
TAGS = {
    number: cv2.copyMakeBorder(
        cv2.aruco.generateImageMarker(dictionary("36h11"), number, 32),
        *[8] * 4,
        cv2.BORDER_CONSTANT,
        value=255,
    )
    for number in (50, 51)
}
MOTIONS = {word: pair for pair, word in load_grammar().motions.words.items()}
REST = np.zeros((FPS, 2))


def drawn(name, seconds=1.3, size=60.0):
    """Offsets in the picture of a hand that draws a shape given with the diver's eyes."""
    if name == "still":
        return np.zeros((round(seconds * FPS), 2))
    curve = resampled(SHAPES[name][0], round(seconds * FPS))
    curve = curve / np.ptp(curve, axis=0).max() * size
    return (curve - curve[0]) * (-1, -1)


def picture(left, right):
    """Two cards, tag 50 at image right; None: not in view."""
    image = np.full((*SIZE, 3), 120, np.uint8)
    for number, place, offset in ((50, 230, left), (51, 90, right)):
        if offset is not None:
            x, y = np.rint(np.array([place, 100]) + offset).astype(int)
            image[y - 24 : y + 24, x - 24 : x + 24] = TAGS[number][..., None]
    return image


def pictures(*pairs):
    """Frames of motions, each a pair of shapes, with rest before and after."""
    frames = [picture(*offsets) for offsets in zip(REST, REST, strict=True)]
    for left, right in pairs:
        frames += [picture(*offsets) for offsets in zip(drawn(left), drawn(right), strict=True)]
        frames += [picture(*offsets) for offsets in zip(REST, REST, strict=True)]
    return frames


def play(frames, **options):
    pipeline = Pipeline(front_end="tag-motion", frames=False, **options)
    records = [
        record for index, image in enumerate(frames) for record in pipeline.process(image, index / FPS)
    ]
    return [record for record in [*records, *pipeline.finish()] if record.type != "state"]


def test_a_sentence_of_motions_is_an_instruction():
    records = play(pictures(*(MOTIONS[word] for word in ("STOP", "UP", "1", "GO"))))
    (instruction,) = [record for record in records if record.type == "instruction"]
    assert instruction.text == "STOP UP 1 GO"
    assert 0.7 < instruction.confidence <= 1.0
    assert list(records[-1].stages_ms) == ["tags", "motion", "decode"]


def test_a_motion_that_is_no_word_drops_the_sentence():
    records = play(pictures(MOTIONS["STOP"], ("triangle", "up"), MOTIONS["GO"]))
    assert [record.reason for record in records if record.type == "rejected"] == ["unread_sign"]
    assert not [record for record in records if record.type == "instruction"]
    assert UNREAD_S > 0.5


def test_a_card_that_leaves_in_mid_motion_drops_the_sentence():
    frames = pictures(MOTIONS["STOP"])
    frames += [picture(offset, np.zeros(2)) for offset in drawn("up")[:9]] + [
        picture(None, np.zeros(2))
    ] * FPS
    records = play(frames)
    assert [record.reason for record in records if record.type == "rejected"] == ["unread_sign"]


def test_a_motion_that_never_ends_drops_the_sentence():
    frames = pictures(MOTIONS["STOP"])
    waved = np.vstack([drawn("wave")] * 8)
    frames += [picture(offset, np.zeros(2)) for offset in waved]
    records = play([*frames, *pictures(MOTIONS["GO"])])
    assert [record.reason for record in records if record.type == "rejected"] == ["unread_sign"]
    assert not [record for record in records if record.type == "instruction"]


def test_cards_upside_down_say_nothing():
    frames = [np.ascontiguousarray(image[::-1, ::-1]) for image in pictures(MOTIONS["STOP"], MOTIONS["UP"])]
    assert "word" not in [record.type for record in play(frames)]


def with_another(frames, number):
    """A third card, in the upper corner at image left."""
    tag = cv2.aruco.generateImageMarker(dictionary("36h11"), number, 32)
    for image in frames:
        image[:48, :48] = cv2.copyMakeBorder(tag, *[8] * 4, cv2.BORDER_CONSTANT, value=255)[..., None]
    return frames


def test_a_third_card_is_passed_over_and_a_second_of_one_id_is_not():
    words = [
        record.word for record in play(with_another(pictures(MOTIONS["STOP"]), 7)) if record.type == "word"
    ]
    assert words == ["STOP"]
    assert [record.type for record in play(with_another(pictures(MOTIONS["STOP"]), 51))] == ["summary"]


def test_a_grammar_without_motions(tmp_path):
    path = tmp_path / "bare.toml"
    with open(load_grammar().file, encoding="utf-8") as stream:
        path.write_text(stream.read().partition("[motions]")[0], encoding="utf-8")
    with pytest.raises(
        GrammarError, match=r"bare.toml: has no \[motions\], which --front-end tag-motion reads"
    ):
        Pipeline(front_end="tag-motion", grammar=path)


def test_mirrored_pictures_are_turned_back():
    frames = [np.ascontiguousarray(image[:, ::-1]) for image in pictures(MOTIONS["STOP"])]
    assert [record.word for record in play(frames, mirrored=True) if record.type == "word"] == ["STOP"]
    assert [record.type for record in play(frames)] == ["summary"]


def test_frame_records_tell_whose_card_it_is():
    record = Pipeline(front_end="tag-motion").recognize(picture(np.zeros(2), np.zeros(2)))
    assert {(sign.side, sign.id, sign.word) for sign in record.signs} == {
        ("left", 50, None),
        ("right", 51, None),
    }


def test_a_shape_that_nobody_knows(tmp_path):
    path = tmp_path / "odd.toml"
    bundled = load_grammar().file
    with open(bundled, encoding="utf-8") as stream:
        path.write_text(stream.read().replace('"up,up" = "UP"', '"hook,up" = "UP"', 1), encoding="utf-8")
    with pytest.raises(
        GrammarError, match=r"odd.toml: motions: 'hook' is no shape that is known; use one of up, down"
    ):
        Pipeline(front_end="tag-motion", grammar=path)


class TestCommand:
    @pytest.fixture
    def run(self, capsys, monkeypatch, tmp_path):
        """Runs the command line in an empty folder; gives status, lines of output and lines of messages."""
        monkeypatch.chdir(tmp_path)

        def call(*words):
            status = main(["motions", *map(str, words)])
            out, err = capsys.readouterr()
            return status, out.splitlines(), err.splitlines()

        return call

    @pytest.fixture
    def write(self, tmp_path):
        """Makes a video of pictures."""

        def make(frames):
            path = str(tmp_path / "clip.avi")
            writer = cv2.VideoWriter(path, cv2.VideoWriter.fourcc(*"MJPG"), FPS, SIZE[::-1])
            for image in frames:
                writer.write(image)
            writer.release()
            return path

        return make

    @pytest.fixture
    def clip(self, write):
        """Makes a video of motions."""
        return lambda *pairs: write(pictures(*pairs))

    def test_a_recorded_shape_is_read(self, run, clip, tmp_path):
        status, lines, messages = run("record", clip(("still", "zigzag")), "hook")
        assert (status, messages) == (0, [])
        assert (
            lines[0]
            == "shapes.json: hook added, 1 recorded; use it in [motions] and give the file with --shapes"
        )
        assert lines[1].startswith("hook is near to zigzag")
        assert len(json.loads((tmp_path / "shapes.json").read_text())["shapes"]) == 1
        with open(load_grammar().file, encoding="utf-8") as stream:
            text = stream.read().replace('"still,up" = "1"', '"still,hook" = "1"', 1)
        (tmp_path / "my.toml").write_text(text, encoding="utf-8")
        frames = pictures(MOTIONS["STOP"], MOTIONS["UP"], ("still", "zigzag"), MOTIONS["GO"])
        records = play(frames, grammar=tmp_path / "my.toml", shapes=tmp_path / "shapes.json")
        assert [record.text for record in records if record.type == "instruction"] == ["STOP UP 1 GO"]

    @pytest.mark.parametrize(
        ("pairs", "words", "message"),
        [
            ([], (), "has 0 motions; record one, from rest to rest"),
            ([("up", "still"), ("up", "still")], (), "has 2 motions; record one"),
            ([("up", "down")], (), "both hands moved; choose one with --side left or --side right"),
            ([("up", "still")], ("--side", "right"), "the right hand did not move; choose the other one"),
        ],
    )
    def test_a_clip_without_exactly_one(self, run, clip, pairs, words, message):
        path = clip(*pairs)
        status, _, messages = run("record", path, "hook", *words)
        assert status == 1
        assert messages[-1].startswith(f"lightgesture: {path}: {message}")

    @pytest.mark.parametrize(
        ("left", "right", "message"),
        [
            (drawn("up"), [None] * 20, "both cards are never in view; hold both before the camera"),
            (
                [*REST, *np.vstack([drawn("wave")] * 8)],
                [np.zeros(2)] * 200,
                "has 0 motions (it did not come to rest); record one",
            ),
            (
                [*REST, *drawn("up")[:9], *[None] * FPS],
                [np.zeros(2)] * 60,
                "has 0 motions (a card was out of view for too long); record one",
            ),
        ],
    )
    def test_a_clip_says_why_it_has_none(self, run, write, left, right, message):
        path = write([picture(*offsets) for offsets in zip(left, right, strict=False)])
        status, _, messages = run("record", path, "hook")
        assert status == 1
        assert messages[-1].startswith(f"lightgesture: {path}: {message}")

    @pytest.mark.parametrize(
        ("words", "message"),
        [
            (("record", "x.mp4", "Hook"), "Hook: is no name of a shape"),
            (("record", "x.mp4", "still"), "still: is no name of a shape"),
            (("show", "--shapes", "none.json"), "none.json: cannot be read"),
            (("show", "--out", "shapes.svg"), "--out shapes.svg: is drawn as PNG"),
        ],
    )
    def test_bad_input(self, run, words, message):
        status, _, messages = run(*words)
        assert status == 2
        assert messages[0].startswith(f"lightgesture: {message}")

    def test_show_draws_every_shape(self, run, tmp_path):
        status, lines, _ = run("show", "--out", "shapes.png")
        assert status == 0
        assert "  clockwise      8 ways" in lines
        assert "  STOP       left, right" in lines
        assert cv2.imread(str(tmp_path / "shapes.png")).shape == (300, 750, 3)
