"""`lightgesture grammar`: init, check, show, draw and explain."""

import json
from pathlib import Path
from xml.etree import ElementTree

import cv2
import numpy as np
import pytest

from lightgesture.errors import ExitStatus
from lightgesture.fsm import load_grammar
from lightgesture.grammar.drawing import to_svg
from lightgesture.grammar.graph import RADIUS, lay_out
from lightgesture.grammar.labels import labels_of
from lightgesture.grammar.report import merge_words
from lightgesture.records import FrameRecord, Hand

BUNDLED = Path(load_grammar().file).read_text(encoding="utf-8")
EXAMPLES = Path(__file__).parents[2] / "docs" / "grammars"


@pytest.fixture
def write(tmp_path):
    """A function that writes the bundled grammar with changes and returns its path."""

    def change(*replacements):
        text = BUNDLED
        for old, new in replacements:
            assert old in text
            text = text.replace(old, new, 1)
        path = tmp_path / "my.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return change


class TestInit:
    def test_what_is_written_is_sound_and_never_overwritten(self, run, tmp_path):
        path = tmp_path / "my.toml"
        assert run("grammar", "init", path).status == ExitStatus.OK
        assert load_grammar(path).table == load_grammar().table
        path.write_text("mine")
        result = run("grammar", "init", path)
        assert result.status == ExitStatus.USAGE
        assert result.err == [f"lightgesture: {path}: is there already; name a new file"]
        assert path.read_text() == "mine"

    def test_a_place_that_cannot_be_written(self, run, tmp_path):
        result = run("grammar", "init", tmp_path / "none" / "my.toml")
        assert result.status == ExitStatus.USAGE
        assert "cannot be written" in result.err[0]


class TestCheck:
    def test_bundled_grammar_is_sound(self, run):
        result = run("grammar", "check")
        assert result.status == ExitStatus.OK
        assert result.out == ["bundled grammar: sound; 27 words, 4 forms, 18 states"]

    @pytest.mark.parametrize("name", ["sonar", "repeat"])
    def test_examples_are_sound(self, run, name):
        result = run("grammar", "check", EXAMPLES / f"{name}.toml")
        assert result.status == ExitStatus.OK

    def test_all_defects_are_named_at_once(self, run, write):
        path = write(
            ("hold = 15", 'hold = "15"'),
            ('"5,5" = "HOVER"', '"5,6" = "HOVER"\n"4,4" = "X"'),
            ("min_seconds = 1", "min_seconds = 700"),
            ("CONTD SNAP [seconds] GO", "CONTD SNAP [second] GO"),
        )
        result = run("grammar", "check", path)
        assert result.status == ExitStatus.USAGE
        places = [line.removeprefix(f"{path}: ").split(": ")[0] for line in result.out]
        assert places[:-1] == ["dwell.hold", 'pairs."5,6"', "limits.min_seconds", "forms[3].sentence"]
        assert result.out[-1] == f"{path}: 4 defects; it cannot be used"

    def test_what_can_be_used_in_part_is_no_success_either(self, run, write):
        path = write(('0 = "surface"', '9 = "surface"'), ('3 = "turning rate"\n', ""))
        result = run("grammar", "check", "--grammar", path)
        assert result.status == ExitStatus.USAGE
        assert result.out == [
            f"{path}: programs.9: no sign for the digit 9; use other digits or add a pair for it",
            f"{path}: parameters.3: is signed and not listed; add it, or remove the pair that carries it",
            f"{path}: 2 defects; it can be used, but not all of it",
        ]

    def test_file_that_is_no_toml(self, run, tmp_path):
        path = tmp_path / "my.toml"
        path.write_text("tokens = ", encoding="utf-8")
        result = run("grammar", "check", path)
        assert result.status == ExitStatus.USAGE
        assert result.out == []
        assert result.err[0].startswith(f"lightgesture: {path}: TOML syntax: ")

    def test_two_files_are_one_too_many(self, run):
        result = run("grammar", "check", "a.toml", "--grammar", "b.toml")
        assert result.status == ExitStatus.USAGE
        assert result.err == ["lightgesture: a.toml, b.toml: two grammars; name one"]


class TestShow:
    def test_all_that_a_grammar_holds(self, run):
        out = run("grammar", "show", EXAMPLES / "sonar.toml").out
        assert "  STOP  ok,0  0,0" in out
        assert "  SONAR     4,4" in out
        assert "  SELECT 1  1,1" in out
        assert "  idle  CONTD -> 1" in out
        assert [line for line in out if "complete: program, to be confirmed" in line]
        assert "  1  depth, unit m, step 0.5, minimum 0.0, maximum 40.0, default 2.0" in out
        assert "  1  surface" in out
        assert [line.split() for line in out[-4:]] == [
            ["cancel", "CANCEL"],
            ["kill", "ABORT"],
            ["confirm", "SONAR"],
            ["confirm_unknown", "False"],
        ]
        assert "  sentence.caution       1.0" in out

    def test_empty_parts_are_said_to_be_empty(self, run, write):
        out = run("grammar", "show", write(('3 = "circle the diver"\n', ""))).out
        assert [line for line in out if line.endswith(": none")] == ["Signs in the menu: none"]
        path = write(("[idle_pairs]\n", '[idle_pairs]\n"1,1" = "STOP"\n'))
        assert "  STOP  ok,0  1,1  0,0" in run("grammar", "show", path).out

    def test_words_in_short(self):
        assert merge_words(["GO", "5", "4", "PARAM 1", "PARAM 2", "AND"]) == ["AND", "GO", "PARAM n", "4..5"]
        assert merge_words(["1", "3"]) == ["1", "3"]
        assert merge_words(["1"]) == ["1"]


class TestExplain:
    def test_step_by_step(self, run):
        result = run("grammar", "explain", "ok,0 5,5 3,left ok,5 ok,ok")
        assert result.status == ExitStatus.OK
        assert result.out == [
            "1. ok,0: STOP",
            "   STOP; expected: DOWN or EXEC or FOLLOW or HOVER or LEFT or RIGHT or UP",
            "2. 5,5: HOVER",
            "   STOP HOVER; expected: GO or a digit",
            "3. 3,left: unknown_pair: 3,left is no word; repeat it",
            "   STOP HOVER; expected: GO or a digit",
            "4. ok,5: 5",
            "   STOP HOVER 5; expected: AND or GO or a digit",
            "5. ok,ok: GO; issued: STOP HOVER 5 GO (task)",
            "   idle; expected: CONTD or STOP",
        ]

    def test_rejections_and_confirmation(self, run):
        out = run("grammar", "explain", "0,0 ok,ok", EXAMPLES / "sonar.toml").out
        assert out[2].startswith("2. ok,ok: rejected: out_of_order, GO cannot follow STOP; expected EXEC or")
        out = run("grammar", "explain", "0,0 4,4 ok,ok", EXAMPLES / "sonar.toml").out
        assert out[-2:] == [
            "3. ok,ok: GO; confirm: STOP SONAR GO: sign GO again to confirm",
            "   STOP SONAR GO; expected: GO",
        ]

    @pytest.mark.parametrize(
        ("sequence", "expected"),
        [
            ("", 'no pairs; give some, such as "ok,0 5,5 ok,ok"'),
            ("ok", 'ok: is no pair; write "left hand,right hand", such as ok,5'),
            ("ok,6", "ok,6: unknown token '6'; use one of 0, 1, 2, 3, 4, 5, left, right, pic, ok"),
        ],
    )
    def test_wrong_sequence(self, run, sequence, expected):
        result = run("grammar", "explain", sequence)
        assert (result.status, result.err) == (ExitStatus.USAGE, [f"lightgesture: {expected}"])


class TestExplainRecords:
    PAIRS = ("0,0", "5,5", "ok,5", "ok,ok")

    @pytest.fixture
    def recorded(self, tmp_path):
        """A function that records these pairs, held, with this chance of each token."""

        def write(chance, probabilities=True):
            lines, frame = [], 0
            for pair in self.PAIRS:
                for token in (pair, None):
                    for _ in range(24 if token else 6):
                        names = token.split(",") if token else ("none", "none")
                        hands = [
                            Hand(
                                side=side,
                                token=None if token is None else name,
                                confidence=chance,
                                box=(0, 0, 9, 9),
                                track=1,
                                reason=None,
                                probabilities={name: chance},
                            )
                            for side, name in zip(("left", "right"), names, strict=True)
                        ]
                        lines.append(
                            FrameRecord(
                                source="a",
                                frame=frame,
                                time_s=frame / 30,
                                hands=hands,
                                probabilities=probabilities,
                            )
                        )
                        frame += 1
            path = tmp_path / "dive.jsonl"
            path.write_text("\n".join(json.dumps(line.to_dict()) for line in lines))
            return path

        return write

    def test_an_instruction_with_its_readings(self, run, recorded):
        result = run("grammar", "explain", recorded(0.9))
        assert result.status == ExitStatus.OK
        assert [line for line in result.out if line.endswith("issued: STOP HOVER 5 GO (task)")]
        assert [line for line in result.out if "STOP 0.90, HOVER 0.90, 5 0.90, GO 0.90" in line]

    def test_why_a_sentence_was_lost(self, run, recorded):
        out = run("grammar", "explain", recorded(0.21)).out
        assert not [line for line in out if "issued" in line]

    @pytest.mark.parametrize("text", ["", "{", '{"type": "frame"}', '{"type": "state"}'])
    def test_what_is_no_recording(self, run, tmp_path, text):
        path = tmp_path / "a.jsonl"
        path.write_text(text)
        result = run("grammar", "explain", path)
        assert result.status == ExitStatus.USAGE
        assert len(result.err) == 1

    def test_records_without_probabilities_and_no_file(self, run, recorded, tmp_path):
        result = run("grammar", "explain", recorded(0.9, probabilities=False))
        assert "no frame record with probabilities; record some" in result.err[0]
        assert "cannot be read" in run("grammar", "explain", tmp_path / "none.jsonl").err[0]


class TestDraw:
    def test_svg_has_every_state_and_word(self, run, tmp_path):
        out = tmp_path / "graph.svg"
        result = run("grammar", "draw", "--out", out)
        assert (result.status, result.out) == (ExitStatus.OK, [f"{out}: 18 states"])
        root = ElementTree.parse(out).getroot()
        texts = [element.text for element in root.iter() if element.tag.endswith("text")]
        assert {"idle", "17", "STOP", "PARAM n", "0..5", "task", "program"} <= set(texts)
        assert sum(element.tag.endswith("circle") for element in root) == 18 + 4

    def test_png_is_a_picture_of_the_same_size(self, run, tmp_path):
        out = tmp_path / "graph.png"
        assert run("grammar", "draw", EXAMPLES / "repeat.toml", "--out", out).status == ExitStatus.OK
        picture = cv2.imread(str(out))
        graph = lay_out(load_grammar(EXAMPLES / "repeat.toml"))
        assert picture.shape == (graph.size[1] * 2, graph.size[0] * 2, 3)
        assert 0.01 < float(np.mean(picture < 128)) < 0.2

    def test_nothing_leaves_the_picture_and_no_states_overlap(self):
        for path in (None, EXAMPLES / "sonar.toml", EXAMPLES / "repeat.toml"):
            graph = lay_out(load_grammar(path))
            points = [point for arrow in graph.arrows for point in arrow] + [
                place for place, _ in graph.circles
            ]
            assert all(0 <= x <= graph.size[0] and 0 <= y <= graph.size[1] for x, y in points)
            places = {place for place, _ in graph.circles}
            assert min(abs(a[0] - b[0]) + abs(a[1] - b[1]) for a in places for b in places if a != b) > 60

    @pytest.mark.parametrize("name", [None, "sonar.toml", "repeat.toml"])
    def test_no_label_covers_another_one_or_a_state(self, name):
        graph = lay_out(load_grammar(None if name is None else EXAMPLES / name))
        rects = [placed.rect for placed in graph.labels]
        rects += [(x - RADIUS, y - RADIUS, 2 * RADIUS, 2 * RADIUS) for x, y in graph.states]
        crossing = [
            (one, other)
            for place, one in enumerate(rects)
            for other in rects[:place]
            if one[0] < other[0] + other[2]
            and other[0] < one[0] + one[2]
            and one[1] < other[1] + other[3]
            and other[1] < one[1] + one[3]
        ]
        assert crossing == []
        assert all(x >= 0 and y >= 0 for x, y, _, _ in rects)
        assert all(x + w <= graph.size[0] and y + h <= graph.size[1] for x, y, w, h in rects)

    def test_labels_tell_the_signs(self):
        rows = {
            row.text or row.pair: row.pair
            for state in labels_of(load_grammar())
            for one in state.values()
            for row in one
        }
        assert rows["HOVER"] == ("5", "5")
        assert rows["STOP"] == ("ok", "0")
        assert rows["PARAM n"] == ("n", "pic")
        assert ("ok", "0..5") in rows

    def test_own_tokens_stand_as_words(self, tmp_path):
        path = tmp_path / "own.toml"
        path.write_text(
            'tokens = ["fist", "five"]\n[sentinels]\nstart = ["STOP"]\nend = "GO"\n[pairs]\n'
            '"fist,fist" = "STOP"\n"five,five" = "HOVER"\n"five,fist" = "GO"\n'
            '[[forms]]\nkind = "task"\nsentence = "STOP HOVER GO"\n'
        )
        svg = to_svg(lay_out(load_grammar(path))).decode()
        assert svg.count(">fist</text>") == 3
        assert "<use" not in svg

    def test_other_suffix_is_refused(self, run):
        result = run("grammar", "draw", "--out", "graph.gif")
        assert result.err == [
            "lightgesture: graph.gif: unknown kind of picture; end the name with .svg or .png"
        ]
        assert result.status == ExitStatus.USAGE

    def test_place_that_cannot_be_written(self, run, tmp_path):
        (tmp_path / "file").write_text("", encoding="utf-8")
        result = run("grammar", "draw", "--out", tmp_path / "file" / "graph.svg")
        assert result.status == ExitStatus.USAGE
        assert "cannot be written" in result.err[0]
