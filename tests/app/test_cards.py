"""Cards from pixels to records: what is read, what is refused, and what the diver is told."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from lightgesture import Pipeline
from lightgesture.cards.memory import KEPT_S, ShownCards
from lightgesture.cli import main
from lightgesture.features.tags.tag import dictionary
from lightgesture.fsm import GrammarError, load_grammar
from lightgesture.results.overlay import Overlay
from lightgesture.results.text import describe_hands

SIZE = (240, 320)
FPS = 30
IDS = {word: number for number, word in load_grammar().tags.words.items()}


def picture(*cards, size=SIZE, side=64):
    """Cards, words or ids, beside each other on grey, the first at image left."""
    image = np.full((*size, 3), 128, np.uint8)
    image[0] = 64  # frames of one value would be a hole
    for place, card in enumerate(cards):
        number = IDS.get(card, card)
        tag = cv2.aruco.generateImageMarker(dictionary("36h11"), number, side)
        tag = cv2.copyMakeBorder(tag, *[side // 6] * 4, cv2.BORDER_CONSTANT, value=255)
        row, column = divmod(place, 3)
        top, left = 10 + row * (side + 36), 10 + column * (side + 36)
        image[top : top + len(tag), left : left + len(tag)] = tag[..., None]
    return image


def play(shown, frames=14, **options):
    """Records of pictures that are each shown for so many frames."""
    pipeline = Pipeline(front_end="tags", frames=False, **options)
    images = [image for image in shown for _ in range(frames)]
    records = [
        record for index, image in enumerate(images) for record in pipeline.process(image, index / FPS)
    ]
    return [record for record in [*records, *pipeline.finish()] if record.type != "state"]


def sentence(*words):
    return [image for word in words for image in (picture(word), picture())]


def told(records, *fields):
    told = [record for record in records if record.type not in ("summary", "rejected")]
    return [tuple(getattr(record, name) for name in fields) for record in told]


def test_a_sentence_of_cards_is_an_instruction():
    *_, instruction, summary = play(sentence("CONTD", "PARAM 3", "DECREASE", "GO"))
    assert (instruction.text, instruction.parameter, instruction.confidence) == (
        "CONTD PARAM 3 DECREASE GO",
        3,
        1.0,
    )
    assert list(summary.stages_ms) == ["tags", "decode"]


@pytest.mark.parametrize("name", ["aruco", "apriltag"])
def test_upside_down_is_the_same_card(name):
    records = play([np.ascontiguousarray(picture("STOP")[::-1, ::-1])], tag_detector=name)
    assert told(records, "type", "word") == [("word", "STOP")]


def test_a_card_in_a_mirror_is_none_unless_the_camera_mirrors():
    mirrored = np.ascontiguousarray(picture("STOP")[:, ::-1])
    assert told(play([mirrored]), "type") == []
    assert told(play([mirrored], mirrored=True), "type", "word") == [("word", "STOP")]
    record = Pipeline(front_end="tags", mirrored=True).recognize(mirrored)
    left, top = record.signs[0].corners[0]
    assert left > SIZE[1] / 2
    assert top < SIZE[0] / 2


def test_two_cards_are_no_word_and_two_of_one_word_are_it():
    (notice,) = told(play([picture("STOP", "GO")]), "type", "reason", "detail")
    assert notice == ("notice", "two_cards", "GO and STOP are two cards at once; show one")
    assert told(play([picture("STOP", "STOP")]), "type", "word") == [("word", "STOP")]


def test_a_card_that_says_nothing_is_told_and_is_passed_over_beside_one_that_does():
    (notice,) = told(play([picture(300)]), "reason", "detail")
    assert notice == ("unknown_pair", "tag 300 is no word; repeat it")
    assert told(play([picture(300, "STOP", 301)]), "type", "word") == [("word", "STOP")]


def test_a_page_of_ten_cards_says_nothing():
    cards = [*IDS][:10]
    records = play([picture(*cards, size=(480, 640))])
    assert [record.reason for record in records[:-1]] == ["two_cards"]


def test_cancel_drops_the_sentence():
    records = play(sentence("STOP", "HOVER", "CANCEL", "GO"))
    (rejected,) = [record for record in records if record.type == "rejected"]
    assert (rejected.reason, rejected.text) == ("cancelled", "STOP HOVER")
    assert "instruction" not in [record.type for record in records]


def test_the_same_card_again_needs_a_release():
    held = play([picture("STOP"), picture("HOVER"), picture("5"), picture("5"), picture("GO")])
    assert held[-2].text == "STOP HOVER 5 GO"
    again = play(
        [picture("STOP"), picture("HOVER"), picture("5"), *[picture()] * 2, picture("5"), picture("GO")]
    )
    assert again[-2].text == "STOP HOVER 55 GO"


def test_a_glimpse_is_no_word():
    assert told(play([picture("STOP"), picture()], frames=3), "type") == []


@pytest.mark.parametrize("rule", ["frames", "evidence", "sentence"])
def test_cards_by_any_rule(rule):
    shown = sentence("STOP", "UP", "1", "GO")
    records = play(shown, frames=24, rule=rule)
    assert [record.text for record in records if record.type == "instruction"] == ["STOP UP 1 GO"]


class TestMemory:
    def test_a_card_counts_from_its_second_sighting_on(self):
        memory = ShownCards()
        assert memory.process({"STOP": 1.0}, 0.0) == {}
        assert memory.process({"STOP": 0.9}, 0.5) == {"STOP": 0.9}  # the next frame, however late

    def test_what_is_missed_for_a_moment_is_there(self):
        memory = ShownCards()
        for time_s in (0.0, 0.1):
            memory.process({"STOP": 1.0}, time_s)
        assert memory.process({}, 0.1 + KEPT_S - 0.01) == {"STOP": 1.0}
        assert memory.process({}, 0.1 + KEPT_S + 0.01) == {}

    def test_another_card_takes_its_place(self):
        memory = ShownCards()
        for time_s in (0.0, 0.1):
            memory.process({"STOP": 1.0}, time_s)
        assert memory.process({"GO": 1.0}, 0.15) == {}
        assert memory.process({"GO": 1.0}, 0.2) == {"GO": 1.0}

    def test_a_clock_that_is_set_back_begins_anew(self):
        memory = ShownCards()
        for time_s in (5.0, 5.1):
            memory.process({"STOP": 1.0}, time_s)
        assert memory.process({}, 1.0) == {}


class TestOptions:
    def test_a_grammar_without_tags(self, tmp_path):
        path = tmp_path / "bare.toml"
        bundled = Path(load_grammar().file).read_text(encoding="utf-8")
        start, end = bundled.index("[tags]"), bundled.index("[motions]")
        path.write_text(bundled[:start] + bundled[end:], encoding="utf-8")
        assert load_grammar(path).tags is None
        with pytest.raises(
            GrammarError, match=r"bare.toml: has no \[tags\], which --front-end tags reads; add it"
        ):
            Pipeline(front_end="tags", grammar=path)

    def test_cards_without_the_end_word(self, tmp_path):
        path = tmp_path / "endless.toml"
        bundled = Path(load_grammar().file).read_text(encoding="utf-8")
        path.write_text(bundled.replace('2 = "GO"\n', "", 1), encoding="utf-8")
        with pytest.raises(
            GrammarError, match=r"endless.toml: tags: nothing says GO; without it nothing is issued"
        ):
            Pipeline(front_end="tags", grammar=path)

    @pytest.mark.parametrize(
        ("options", "message"),
        [
            ({"front_end": "tags", "model": "svm"}, "model: of no effect beside the front end tags"),
            ({"tag_detector": "apriltag"}, "tag_detector: of no effect beside the front end hands"),
        ],
    )
    def test_options_of_the_other_front_end_are_refused(self, options, message):
        with pytest.raises(ValueError, match=message):
            Pipeline(**options)

    def test_streams_do_not_share_what_they_remember(self):
        first = Pipeline(front_end="tags")
        for index in range(9):
            first.process(picture("STOP"), index / FPS)
        other = first.for_stream("other")
        assert other.process(picture(), 0.3)[0].signs == ()
        assert [
            event.type for index in range(9) for event in other.process(picture(), 0.4 + index / FPS)
        ] == ["frame"] * 9


class TestResults:
    def test_a_frame_record_has_signs_in_place_of_hands(self):
        record = Pipeline(front_end="tags").process(picture("HOVER", 300), 0.0)[0].to_dict()
        assert "hands" not in record
        known, unknown = sorted(record["signs"], key=lambda sign: sign["id"])
        assert list(known) == ["side", "id", "word", "corners", "margin"]
        assert (known["side"], known["id"], known["word"], unknown["word"]) == (None, 4, "HOVER", None)
        assert np.abs(np.array(known["corners"][0]) - 20).max() < 1
        assert json.loads(json.dumps(record)) == record

    def test_overlay_draws_the_card(self):
        image, overlay = picture("HOVER"), Overlay()
        drawn = overlay.draw(image, Pipeline(front_end="tags").process(image, 0.0))
        green = (drawn[..., 1] > 150) & (drawn[..., 2] < 100)
        assert green[18:82, 18:82].sum() > 100

    def test_recognize_says_what_is_on_a_picture(self, tmp_path, capsys):
        path = str(tmp_path / "card.png")
        cv2.imwrite(path, picture("HOVER", 300))
        assert main(["recognize", path, "--front-end", "tags"]) == 0
        lines = capsys.readouterr().out.splitlines()
        assert lines[0] == path
        assert [line.split(": ")[1].split("  ")[0] for line in sorted(lines[1:])] == [
            "no word of the grammar",
            "HOVER",
        ]

    def test_no_card_is_said_too(self):
        assert describe_hands(Pipeline(front_end="tags").recognize(picture())) == ["  no card found"]

    def test_decode_writes_all_results(self, tmp_path):
        folder = tmp_path / "dive"
        folder.mkdir()
        shown = sentence("STOP", "DOWN", "GO")
        for index, image in enumerate(image for image in shown for _ in range(14)):
            cv2.imwrite(str(folder / f"{index:03d}.png"), image)
        out = str(tmp_path / "out")
        arguments = [
            "decode",
            str(folder),
            "--front-end",
            "tags",
            "--frames",
            "--out",
            out,
            "--annotate",
            "--plot",
        ]
        assert main([*arguments, "--debug-dir", str(tmp_path / "stages"), "--quiet"]) == 0
        records = [json.loads(line) for line in (tmp_path / "out" / "dive.jsonl").read_text().splitlines()]
        assert [record["text"] for record in records if record["type"] == "instruction"] == ["STOP DOWN GO"]
        assert {name.name for name in (tmp_path / "out").iterdir()} >= {
            "dive.vtt",
            "dive.csv",
            "dive.png",
            "dive_annotated.mp4",
        }
        assert (tmp_path / "stages" / "dive" / "tags-000000.png").is_file()
