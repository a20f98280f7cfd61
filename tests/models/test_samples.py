from pathlib import Path

import cv2
import numpy as np
import pytest

from lightgesture.errors import InputError, UsageError
from lightgesture.training.pool.samples import landmark_box, load_hand, read_rows

HEADER = "path,token,set,hx0,hy0,hx1,hy1,lm,side,licence\n"


def manifest(
    folder: Path, *rows: str, header: str = HEADER, pictures: tuple[str, ...] = ("a.png", "b.png")
) -> Path:
    for name in pictures:
        assert cv2.imwrite(str(folder / name), np.full((50, 60, 3), 90, np.uint8))
    (folder / "hands.csv").write_text(header + "\n".join(rows) + "\n", encoding="utf-8")
    return folder / "hands.csv"


def test_a_manifest_gives_boxes_grown_to_the_outline(tmp_path: Path) -> None:
    landmarks = ";".join(f"{10 + index};{20 + index / 2}" for index in range(21))
    path = manifest(
        tmp_path,
        f"a.png,1,anna,10,20,30,40,{landmarks},,MIT",
        "b.png,none,,,,,,,right,",
        pictures=("a.png", "b.png"),
    )
    first, second = read_rows(path)
    assert first.box == (8, 18, 24, 24)
    assert (first.source, first.side, first.licence) == ("anna", "left", "MIT")
    assert first.landmarks is not None
    assert first.landmarks.shape == (21, 2)
    assert (second.box, second.landmarks, second.side) == (None, None, "right")
    assert (second.source, second.licence) == (tmp_path.name, "none stated")
    assert load_hand(second).box == (0, 0, 60, 50)


def test_an_outline_is_taken_as_it_is(tmp_path: Path) -> None:
    path = manifest(tmp_path, "a.png,1,5,6,20,30", "b.png,2,1,1,9,9", header="path,token,x,y,w,h\n")
    assert [row.box for row in read_rows(path)] == [(5, 6, 20, 30), (1, 1, 9, 9)]


def test_folders_name_the_classes(folder: Path) -> None:
    rows = read_rows(folder)
    assert [row.token for row in rows] == ["1"] * 12 + ["5"] * 12 + ["none"] * 12
    assert len({row.source for row in rows}) == 1


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (("a.png,1,,,,,,,,", "c.png,2,,,,,,,,"), "1 of 2 pictures are missing, first .*c.png"),
        (("a.png,1,,10,20,30,x,,,", "b.png,2,,,,,,,,"), "line 2: column hx0"),
        (("a.png,1,,30,20,10,40,,,", "b.png,2,,,,,,,,"), "line 2: the box has no area"),
        (("a.png,1,,10,20,30,nan,,,", "b.png,2,,,,,,,,"), "finite"),
        (("a.png,1,,,,,,1;2;3,,", "b.png,2,,,,,,,,"), "column lm needs 42"),
        (("a.png,1,,,,,,,upper,", "b.png,2,,,,,,,,"), "side 'upper'"),
    ],
)
def test_wrong_rows_are_refused(tmp_path: Path, rows: tuple[str, ...], words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_rows(manifest(tmp_path, *rows))


def test_other_tables_and_folders_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no column token"):
        read_rows(manifest(tmp_path, "a.png,1", header="path,label\n"))
    with pytest.raises(InputError, match=r"cannot be read"):
        read_rows(tmp_path / "missing.csv")
    with pytest.raises(InputError, match=r"cannot be read"):
        read_rows(tmp_path / "a.png")


@pytest.mark.parametrize("name", ["thumb up", "Größe", "up-down", "a" * 33])
def test_a_class_that_no_grammar_could_name_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(UsageError, match=r"line 3: .* cannot be a token of a grammar; name the token"):
        read_rows(manifest(tmp_path, "a.png,1,,,,,,,,", f"b.png,{name},,,,,,,,"))
    (tmp_path / "signs" / name).mkdir(parents=True)
    with pytest.raises(UsageError, match=r"signs: .* cannot be a token of a grammar; name the folder"):
        read_rows(tmp_path / "signs")


def test_a_row_without_a_class_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"line 3: column token is empty"):
        read_rows(manifest(tmp_path, "a.png,1,,,,,,,,", "b.png,,,,,,,,,"))


@pytest.mark.parametrize(
    ("tokens", "words"), [(("up", "up"), "holds the class 'up' alone"), ((), "holds no class")]
)
def test_fewer_than_two_classes_are_refused(tmp_path: Path, tokens: tuple[str, ...], words: str) -> None:
    rows = [f"a.png,{token},anna,,,,,,," for token in tokens]
    with pytest.raises(UsageError, match=words):
        read_rows(manifest(tmp_path, *rows))
    with pytest.raises(UsageError, match="holds no class"):
        read_rows(manifest(tmp_path, *rows), without=["anna"])


def test_hidden_folders_are_no_classes_and_empty_ones_are_refused(folder: Path) -> None:
    (folder / ".thumbnails").mkdir()
    assert {row.token for row in read_rows(folder)} == {"1", "5", "none"}
    (folder / "wave").mkdir()
    with pytest.raises(UsageError, match="wave: holds no pictures"):
        read_rows(folder)


def test_folders_in_a_class_are_sources_and_can_be_left_out(tmp_path: Path) -> None:
    for number, place in enumerate(("up/anna", "up/ben", "down/anna", "down/ben")):
        (tmp_path / "signs" / place).mkdir(parents=True)
        assert cv2.imwrite(str(tmp_path / "signs" / place / "1.png"), np.full((9, 9, 3), number, np.uint8))
    rows = read_rows(tmp_path / "signs", without=["signs/ben"])
    assert [(row.token, row.source) for row in rows] == [("down", "signs/anna"), ("up", "signs/anna")]


def test_pictures_that_are_none_and_boxes_outside_are_refused(tmp_path: Path) -> None:
    (tmp_path / "c.png").write_bytes(b"no picture")
    path = manifest(tmp_path, "c.png,1,0,0,9,9", "b.png,2,70,5,9,9", header="path,token,x,y,w,h\n")
    broken, outside = read_rows(path)
    with pytest.raises(InputError, match=r"c\.png: is no picture"):
        load_hand(broken)
    with pytest.raises(InputError, match=r"b\.png: box .* outside"):
        load_hand(outside)


def test_what_is_kept_of_a_large_picture_holds_the_same_hand(tmp_path: Path) -> None:
    picture = np.zeros((600, 800, 3), np.uint8)
    picture[200:400, 300:450] = 255
    assert cv2.imwrite(str(tmp_path / "big.png"), picture)
    path = manifest(tmp_path, "big.png,1,300,200,150,200", "b.png,2,1,1,9,9", header="path,token,x,y,w,h\n")
    hand = load_hand(read_rows(path)[0])
    assert max(hand.image.shape) <= 161
    x, y, width, height = hand.box
    assert hand.image[y + 1 : y + height - 1, x + 1 : x + width - 1].min() == 255
    assert hand.image[: y - 1].max() == 0
    assert hand.image[:, : x - 1].max() == 0


def test_the_outline_is_nine_percent_larger_on_each_side() -> None:
    landmarks = np.zeros((21, 2), np.float32)
    landmarks[1] = 100, 200
    assert landmark_box(landmarks) == (-9, -18, 118, 236)


def test_pictures_under_the_gpl_are_left_out_and_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    licences = ("MIT", "GPL-3.0", "AGPL-3.0 (README)", "gpl", "LGPL", "none stated")
    rows = [f"a.png,{token},,,,,,,,{licence}" for token in ("1", "none") for licence in licences]
    kept = read_rows(manifest(tmp_path, *rows))
    assert [row.licence for row in kept] == ["MIT", "LGPL", "none stated"] * 2
    assert "6 of 12 pictures are under the GPL and left out" in capsys.readouterr().err
