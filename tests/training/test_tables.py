"""Tables as scripts, Excel and Windows write them."""

import cv2
import numpy as np
import pytest

from lightgesture.errors import InputError
from lightgesture.training.pool.negatives import read_scenes
from lightgesture.training.pool.samples import read_rows
from lightgesture.training.tables import table_rows

NEEDED = ("path", "token")
EXPECTED = [{"path": "a.jpg", "token": "5", "note": "é; x"}, {"path": "b.jpg", "token": "0", "note": ""}]


def rows(path):
    return [row for _, row in table_rows(path, NEEDED, "give another")]


@pytest.mark.parametrize(
    "content",
    [
        'path,token,note\na.jpg,5,"é; x"\nb.jpg,0,\n'.encode(),
        '\ufeffpath,token,note\r\na.jpg,5,"é; x"\r\nb.jpg,0,\r\n'.encode(),
        '\ufeffpath;token;note\r\na.jpg;5;"é; x"\r\nb.jpg;0;\r\n'.encode(),
        'sep=;\r\npath;token;note\r\na.jpg;5;"é; x"\r\nb.jpg;0;\r\n'.encode(),
        '\ufeffsep=,\r\nPath, Token ,NOTE\r\n"a.jpg","5","é; x"\r\n"b.jpg","0",""\r\n'.encode(),
        "path\ttoken\tnote\r\na.jpg\t5\té; x\r\nb.jpg\t0\t\r\n".encode("utf-16"),
        'path,token,note\ra.jpg,5,"é; x"\rb.jpg,0,\r'.encode(),
        'path,token,note\n\na.jpg,5,"é; x"\n,,\nb.jpg,0\n,,,,\n'.encode(),
        'path,token,note,\na.jpg,5,"é; x",\nb.jpg,0,,,,\n'.encode(),
    ],
    ids=["plain", "mark", "semicolons", "sep", "capitals", "utf-16", "mac", "short and empty", "trailing"],
)
def test_what_is_meant_is_read(tmp_path, content):
    (tmp_path / "a.csv").write_bytes(content)
    found = rows(tmp_path / "a.csv")
    assert [{name: row[name] for name in ("path", "token", "note")} for row in found] == EXPECTED


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", ": holds nothing, has no column path, token; give another"),
        (b"path,label\na.jpg,5\n", ": has no column token; add it to the header, which has path, label"),
        (b"path,token\na.jpg,5\nb.jpg\n", ", line 3: column token is empty; fill it or delete the row"),
        (b"path,token\na.jpg,5,4\n", ", line 2: has 3 cells, the header 2; quote cells that hold"),
        (b"sep=;\npath;token\na.jpg;\n", ", line 3: column token is empty"),
        ("path,token\na.jpg,5\nö.jpg,5\n".encode("cp1252"), ", line 3: .*not UTF-8.; save it as 'CSV UTF-8'"),
        (b"path,token\na.jpg,5\n" + b"x" * 200_000, ", line 3: is no row of a CSV table .*; give another"),
        (b"PK\x03\x04\x00\xff", ": cannot be read as a CSV table .is no text.; give another"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(tmp_path, content, reason):
    path = tmp_path / "a.csv"
    path.write_bytes(content)
    with pytest.raises(InputError, match=f"^{path}{reason}"):
        rows(path)


def test_backslashes_part_folders(tmp_path):
    for name in ("one/a.jpg", "b\\c.jpg"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(cv2.imencode(".jpg", np.zeros((8, 8, 3), np.uint8))[1].tobytes())
    table = tmp_path / "a.csv"
    table.write_bytes(b"path;token\r\none\\a.jpg;5\r\nb\\c.jpg;0\r\n")
    assert [row.path for row in read_rows(table)] == [tmp_path / "one" / "a.jpg", tmp_path / "b\\c.jpg"]
    table.write_bytes(b"\xef\xbb\xbffile;x;y;w;h\r\none\\a.jpg;1;2;3;4\r\none\\a.jpg;2;2;3;4\r\n")
    (scene,) = read_scenes(table)
    assert scene.hands == ((1, 2, 3, 4), (2, 2, 3, 4))
    table.write_bytes(b"file;x;y;w;h\r\none\\a.jpg;1;2;3;inf\r\n")
    with pytest.raises(InputError, match=r"a\.csv, line 2: holds no box .*; correct it"):
        read_scenes(table)
