"""The book of cards: what is printed is what is read."""

import cv2
import numpy as np
import pytest

from lightgesture.cards.book import Card, cards_of, write_book
from lightgesture.cards.drawings import DRAWINGS, strokes_of
from lightgesture.cards.proof import read_pages
from lightgesture.cli import main
from lightgesture.fsm import load_grammar
from lightgesture.fsm.language.forms import split_carrier


@pytest.fixture
def run(capsys):
    """Runs the command line; gives status, lines of output and lines of messages."""

    def call(*words):
        status = main(["tags", *map(str, words)])
        out, err = capsys.readouterr()
        return status, out.splitlines(), err.splitlines()

    return call


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    """The book of the bundled grammar."""
    path = tmp_path_factory.mktemp("book") / "cards.pdf"
    assert main(["tags", "print", "--out", str(path)]) == 0
    return path


@pytest.mark.parametrize("detector", ["aruco", pytest.param("apriltag", marks=pytest.mark.slow)])
def test_every_card_is_read_back_in_its_size(run, book, detector):
    status, lines, messages = run("check", book, "--tag-detector", detector)
    assert (status, messages) == (0, [])
    assert lines[-1] == f"{book}: all 30 cards are read from 31 pages"
    assert lines[0].startswith("page 2: tag 0  STOP, 80.")
    assert "page 30: tag 50  left hand" in "\n".join(lines)


def test_every_word_has_a_drawing_of_its_own():
    words = {split_carrier(word)[0] for word in load_grammar().tags.words.values()}
    assert {word for word in words if not word.isdigit()} <= {*DRAWINGS}
    assert [len(strokes_of(digit)) for digit in "12345"] == [1, 2, 3, 4, 5]
    points = np.concatenate([np.array(stroke) for strokes in DRAWINGS.values() for stroke in strokes])
    assert points.min() >= 0.0
    assert points.max() <= 1.0
    assert strokes_of("PARAM 3") == DRAWINGS["PARAM"]
    assert strokes_of("SONAR")


def test_what_is_missing_doubled_or_unknown_is_told(run, tmp_path):
    path = tmp_path / "odd.pdf"
    _, cards = cards_of(load_grammar())
    write_book(path, "36h11", [*cards[1:], cards[1], Card(300, "DANCE")], 60.0)
    status, lines, messages = run("check", path)
    assert status == 1
    assert "page 32: tag 300  no word, 60.0 mm" in lines
    assert [message.partition("odd.pdf: ")[2] for message in messages] == [
        "tag 0 (STOP) is missing",
        "tag 1 is there 2 times; keep one",
        "tag 300 is none of the grammar",
    ]


def test_a_page_of_two_tags_is_told(run, tmp_path):
    tag = cv2.aruco.generateImageMarker(
        cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11), 4, 80
    )
    card = cv2.copyMakeBorder(tag, *[20] * 4, cv2.BORDER_CONSTANT, value=255)
    path = tmp_path / "photo.png"
    cv2.imwrite(str(path), np.hstack([card, card]))
    status, lines, messages = run("check", path)
    assert status == 1
    assert lines[:2] == ["page 1: tag 4  HOVER"] * 2
    assert f"lightgesture: {path}: page 1 has 2 tags; a camera that sees both reads neither" in messages


@pytest.mark.parametrize(
    ("words", "status", "message"),
    [
        (("print", "--side", "200"), 2, "--side 200: a tag on an A6 card is 20 to 84 mm wide"),
        (("print", "--side", "nan"), 2, "--side nan: a tag on an A6 card is 20 to 84 mm wide"),
        (("print", "--out", "cards.svg"), 2, "--out cards.svg: the book is a PDF"),
        (("print", "--out", f"{__file__}/cards.pdf"), 2, f"{__file__}/cards.pdf: cannot be written"),
        (("check", "none.pdf"), 1, "none.pdf: cannot be read (No such file or directory)"),
        (("check", __file__), 1, f"{__file__}: is neither a PDF nor a picture"),
        (("print", "--grammar", "none.toml"), 2, "none.toml: no such file"),
    ],
)
def test_bad_input(run, monkeypatch, tmp_path, words, status, message):
    monkeypatch.chdir(tmp_path)
    found, _, messages = run(*words)
    assert found == status
    assert messages[0].startswith(f"lightgesture: {message}")


def test_a_pdf_that_is_none(run, tmp_path):
    path = tmp_path / "odd.pdf"
    path.write_bytes(b"%PDF-1.4 and no more")
    status, _, messages = run("check", path)
    assert status == 1
    assert messages[0].startswith(f"lightgesture: {path}: is no PDF that can be read")


def test_a_grammar_without_cards(run, tmp_path):
    text = open(load_grammar().file, encoding="utf-8").read()  # noqa: SIM115 - a test's own file
    start, end = text.index("[tags]"), text.index("# Words that are no part")
    path = tmp_path / "bare.toml"
    path.write_text(text[:start] + text[end:], encoding="utf-8")
    status, _, messages = run("print", "--grammar", path)
    assert status == 2
    assert messages == [
        f"lightgesture: {path}: has neither [tags] nor [motions]; add one, as in the bundled grammar"
    ]


def test_another_family(tmp_path):
    path = tmp_path / "small.pdf"
    write_book(path, "25h9", [Card(3, "HOVER")], 40.0)
    pages = [page for page in read_pages(path, "25h9") if page.tags]
    assert [(page.tags[0].id, round(page.side_mm[0])) for page in pages] == [(3, 40)]
