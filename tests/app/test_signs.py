"""`signs`: what is to be signed for a sentence, in text and on pages, and what cannot be said."""

import re
from xml.etree import ElementTree

import cv2
import numpy as np
import pytest

from lightgesture import cli
from lightgesture.errors import UsageError
from lightgesture.fsm import Decoder, Signs, load_grammar
from lightgesture.signs.drawings import KINDS, load_drawing
from lightgesture.signs.layout import card_pages, sentence_pages, signs_pages
from lightgesture.signs.png import draw_page
from lightgesture.signs.sentences import following, pairs_by_word, read_sentence
from lightgesture.signs.sheet import Box, HandPicture, Text, text_width
from lightgesture.signs.svg import to_svg
from lightgesture.signs.text import tell_language, tell_sentence

GRAMMAR = load_grammar()
SONAR = load_grammar("docs/grammars/sonar.toml")
REPEAT = load_grammar("docs/grammars/repeat.toml")
TOKENS = GRAMMAR.tokens


def run(capsys, *words):
    """Exit status, lines of results and of messages."""
    status = cli.main(["signs", *words])
    out, err = capsys.readouterr()
    return status, out.splitlines(), err.splitlines()


@pytest.fixture
def forty(tmp_path):
    """A grammar of forty words."""
    pairs = [(left, right) for left in TOKENS[:9] for right in TOKENS if left != "ok"][:36]
    words = [f"TASK_{number}" for number in range(len(pairs))]
    lines = [
        f"tokens = {list(TOKENS)!r}".replace("'", '"'),
        '[sentinels]\nstart = ["STOP"]\nend = "GO"\njoin = "AND"\n[pairs]',
        '"ok,0" = "STOP"\n"ok,ok" = "GO"\n"ok,pic" = "AND"\n"ok,1" = "1"',
        *(f'"{left},{right}" = "{word}"' for (left, right), word in zip(pairs, words, strict=True)),
        f'[[forms]]\nkind = "task"\nsentence = "STOP {"|".join(words)} [seconds] GO"',
    ]
    path = tmp_path / "forty.toml"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("text", "pairs"),
    [
        ("STOP HOVER 50 GO", "ok,0 5,5 ok,5 pic,ok ok,0 ok,ok"),
        ("stop hover 5 and 0 go", "ok,0 5,5 ok,5 pic,ok ok,0 ok,ok"),
        ("STOP HOVER 5 0 GO", "ok,0 5,5 ok,5 pic,ok ok,0 ok,ok"),
        ("CONTD PARAM 3 DECREASE GO", "pic,0 3,pic left,pic ok,ok"),
        ("STOP EXEC 2 GO", "ok,0 pic,2 ok,2 ok,ok"),
    ],
)
def test_a_sentence_has_its_pairs(text, pairs):
    sentence = read_sentence(GRAMMAR, text)
    assert " ".join(",".join(sign.pair) for sign in sentence.signs) == pairs


def test_a_start_word_tells_its_other_pair():
    assert read_sentence(GRAMMAR, "STOP HOVER GO").signs[0].others == (("0", "0"),)


def test_pairs_are_what_the_decoder_reads():
    for grammar, text in (
        (GRAMMAR, "STOP DOWN 12 GO"),
        (SONAR, "STOP SONAR 3 GO"),
        (REPEAT, "STOP REPEAT 3 HOVER 5 SNAP END GO"),
    ):
        decoder, issued = Decoder(grammar, hold=1), []
        for sign in read_sentence(grammar, text).signs:
            for signs in (Signs.of_tokens(*sign.pair), Signs()):
                issued += [event.text for event in decoder.step(signs, 0.0) if event.type == "instruction"]
        assert issued == [text]


def test_a_sentence_to_be_confirmed_ends_twice():
    sentence = read_sentence(SONAR, "STOP SONAR 3 GO")
    assert sentence.is_confirmed
    assert [sign.word for sign in sentence.signs[-2:]] == ["GO", "GO"]
    assert "let go between two equal signs" in "\n".join(tell_sentence(sentence, 80))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("STOP HOVR GO", "did you mean HOVER"),
        ("STOP XYZ GO", "lists the words"),
        ("STOP GO", "GO cannot follow STOP"),
        ("HOVER GO", "HOVER opens no sentence"),
        ("STOP HOVER", "not complete; expected GO or a digit"),
        ("STOP EXEC 5 GO", "program 5 is not in"),
        ("STOP HOVER 7 GO", "7 is no word"),
        ("STOP HOVER 5555 GO", "outside 1 to 600"),
        ("STOP HOVER GO STOP", "one sentence at a time"),
        ("STOP HOVER GO " * 900, "one sentence at a time"),
        ("HOVER", "opens no sentence"),
        ("\x1b[31m\n", "no word"),
        ("  ", "no sentence"),
    ],
)
def test_what_cannot_be_said_is_told_in_one_line(text, told):
    with pytest.raises(UsageError) as error:
        read_sentence(GRAMMAR, text)
    assert told in str(error.value)
    assert len(str(error.value).strip().splitlines()) == 1 or "\n" in text


def test_the_command_tells_it_on_standard_error(capsys):
    status, out, err = run(capsys, "STOP", "GO")
    assert (status, out, len(err)) == (2, [], 1)


def test_what_may_follow():
    assert following(GRAMMAR, "", "idle") == ["CONTD", "STOP"]
    assert following(GRAMMAR, "STOP HOVER 50", "collecting") == ["0", "1", "2", "3", "4", "5", "AND", "GO"]
    assert following(GRAMMAR, "STOP HOVER 5 AND", "collecting") == ["0", "1", "2", "3", "4", "5"]
    assert following(GRAMMAR, "CONTD PARAM 3", "collecting") == ["DECREASE", "DEFAULT", "INCREASE"]
    assert following(SONAR, "STOP SONAR 3 GO", "confirming") == ["GO"]
    assert following(GRAMMAR, "no such", "collecting") == []


def test_words_stand_in_a_natural_order():
    words = list(pairs_by_word(GRAMMAR))
    assert words[:4] == ["STOP", "CONTD", "GO", "AND"]
    assert [word for word in words if word.isdigit()] == list("012345")
    assert "SELECT 1" not in words


@pytest.mark.parametrize("columns", [20, 40, 80, 100])
def test_text_is_no_wider_than_the_terminal(columns):
    lines = [
        *tell_language(GRAMMAR, columns),
        *tell_language(REPEAT, columns),
        *tell_sentence(read_sentence(GRAMMAR, "STOP HOVER 50 GO"), columns),
    ]
    longest_word = max(len(word) for line in lines for word in re.split(r"[ |]", line))
    assert max(map(len, lines)) <= max(columns, longest_word + 6)
    assert not any("\x1b" in line for line in lines)
    joined = " ".join(lines)
    assert all(word in joined for word in pairs_by_word(GRAMMAR))


def test_forty_columns_of_a_terminal(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    status, out, _ = run(capsys)
    assert status == 0
    assert max(map(len, out)) <= 40


def test_every_sign_is_drawn_bare_and_gloved_for_both_hands():
    for token in TOKENS:
        for kind in KINDS:
            left, right = load_drawing(token, "left", kind), load_drawing(token, "right", kind)
            points = [point for layer in left.layers for polygon in layer.polygons for point in polygon]
            assert all(0 <= x <= 400 and 0 <= y <= 400 for x, y in points)
            assert right.mirrored() == left
    assert load_drawing("claw", "left") is None
    assert load_drawing("../hands/0", "left") is None
    assert load_drawing("none", "left") is None


def items_inside(page):
    """Texts and boxes that reach over the page's edges."""
    for item in page.items:
        if isinstance(item, Text):
            wide = text_width(item.text, item.size, item.bold)
            left = item.x - {"left": 0, "middle": wide / 2, "right": wide}[item.align]
            yield left >= 0 and left + wide <= page.width and item.y <= page.height, item
        elif isinstance(item, Box):
            yield (
                item.x >= 0 and item.x + item.width <= page.width and item.y + item.height <= page.height,
                item,
            )
        else:
            yield item.x >= 0 and item.x + item.size <= page.width, item


def test_pages_keep_within_their_edges(forty):
    grammar = load_grammar(forty)
    words = " ".join(["1"] * 4)
    long = read_sentence(REPEAT, "STOP REPEAT 3 " + "HOVER 11 SNAP 12 " * 2 + "END GO")
    for pages in (
        card_pages(GRAMMAR, "bare"),
        card_pages(REPEAT, "gloved"),
        card_pages(grammar, "bare"),
        signs_pages(TOKENS),
        sentence_pages(long, REPEAT, "bare"),
        sentence_pages(read_sentence(grammar, f"STOP TASK_0 {words[:5]} GO"), grammar, "bare"),
    ):
        for page in pages:
            assert [item for is_inside, item in items_inside(page) if not is_inside] == []


def test_the_card_has_every_word_once(forty):
    for grammar in (GRAMMAR, load_grammar(forty)):
        pages = card_pages(grammar, "bare")
        texts = [item.text for page in pages for item in page.items if isinstance(item, Text) and item.bold]
        words = list(pairs_by_word(grammar))
        assert [text for text in texts if text in words] == words
        assert sum(isinstance(item, HandPicture) for page in pages for item in page.items) == 2 * len(words)


def test_a_large_grammar_takes_several_pages():
    words = {(left, right): f"W{left}{right}".upper() for left in TOKENS for right in TOKENS}
    from dataclasses import replace

    pages = card_pages(replace(GRAMMAR, idle_words=words, sentence_words=words), "bare")
    assert len(pages) > 2
    numbers = [
        item.text for page in pages for item in page.items if isinstance(item, Text) and "/" in item.text
    ]
    assert numbers == [f"{page}/{len(pages)}" for page in range(1, len(pages) + 1)]
    assert all(is_inside for page in pages for is_inside, _ in items_inside(page))


def test_a_token_without_a_drawing_is_named(tmp_path, capsys):
    path = tmp_path / "own.toml"
    path.write_text(
        'tokens = ["claw", "ok"]\n[sentinels]\nstart = ["STOP"]\nend = "GO"\n[pairs]\n"claw,ok" = "STOP"\n'
        '"ok,ok" = "GO"\n"claw,claw" = "DIG"\n[[forms]]\nkind = "task"\nsentence = "STOP DIG GO"\n',
        encoding="utf-8",
    )
    out = tmp_path / "card.svg"
    assert run(capsys, "--card", "--grammar", str(path), "--out", str(out))[0] == 0
    texts = [element.text for element in ElementTree.parse(out).iter("{http://www.w3.org/2000/svg}text")]
    assert texts.count("claw") == 3


def test_files_of_every_kind(tmp_path, capsys):
    pytest.importorskip("fpdf")
    for kind, mark in ((".svg", b"<?xml"), (".png", b"\x89PNG"), (".PDF", b"%PDF")):
        out = tmp_path / f"sentence{kind}"
        status, lines, _ = run(capsys, "stop", "hover", "50", "go", "--out", str(out), "--gloved")
        assert (status, lines) == (0, [f"{out}: STOP HOVER 50 GO"])
        assert out.read_bytes().startswith(mark)
    assert run(capsys, "--out", str(tmp_path / "signs.svg"))[0] == 0


def test_pictures_are_the_same_whoever_draws_them():
    page = signs_pages(TOKENS)[0]
    drawn = draw_page(page, 2.0)
    hand = next(item for item in page.items if isinstance(item, HandPicture))
    part = drawn[
        round(hand.y * 2) : round((hand.y + hand.size) * 2),
        round(hand.x * 2) : round((hand.x + hand.size) * 2),
    ]
    assert 0.1 < np.mean(part.min(axis=2) < 200) < 0.9
    assert to_svg(page).count(b"evenodd") >= 20 * 4


def test_further_pages_are_further_pictures(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("lightgesture.signs.layout.CELL_HEIGHTS", (60.0, 60.0))
    out = tmp_path / "card.png"
    _, lines, _ = run(capsys, "--card", "--out", str(out))
    assert [line.partition(":")[0] for line in lines][:2] == [str(out), str(tmp_path / "card-2.png")]
    assert cv2.imread(str(tmp_path / "card-2.png")) is not None


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--out", "card.docx"), "end the name with .svg, .png, .pdf"),
        (("--card", "STOP", "HOVER", "GO"), "leave out"),
        (("--grammar", "no.toml"), "no such file"),
        (("--card", "--out", "/proc/no/card.svg"), "/proc/no/card.svg"),
    ],
)
def test_wrong_use_is_told_in_one_line(capsys, words, told):
    status, _, err = run(capsys, *words)
    assert status == 2
    assert len(err) == 1
    assert told in err[0]


def test_pdf_without_its_package_names_the_extra(monkeypatch, capsys, tmp_path):
    import sys

    monkeypatch.setitem(sys.modules, "fpdf", None)
    status, _, err = run(capsys, "--card", "--out", str(tmp_path / "card.pdf"))
    assert status == 2
    assert "lightgesture[print]" in err[0]
