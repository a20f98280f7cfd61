"""The guarded reader: whole archives come back, all others are refused in one line before they cost anything."""

import io
import json
import os
import struct
import zipfile
from contextlib import suppress

import numpy as np
import pytest

from lightgesture.features import archive
from lightgesture.features.archive import ArchiveError, check_format, read_archive

HEADER = {"kind": "svm", "format": 2}
ARRAYS = {
    "numbers": np.arange(12, dtype=np.int16).reshape(3, 4),
    "columns": np.asfortranarray(np.arange(6.0).reshape(2, 3)),
    "words": np.array(["ok", "left"]),
    "nothing": np.zeros(0, np.float32),
    "single": np.array(2.5),
}


def text(header):
    return np.frombuffer(json.dumps(header).encode(), np.uint8)


@pytest.fixture
def file(tmp_path):
    np.savez_compressed(tmp_path / "own.npz", header=text(HEADER), **ARRAYS)
    return tmp_path / "own.npz"


def stored(array):
    """An array as a member of an archive."""
    content = io.BytesIO()
    np.save(content, array)
    return content.getvalue()


def claimed(shape, dtype="<f4"):
    """The header of an array of this shape without its data."""
    text = repr({"descr": dtype, "fortran_order": False, "shape": shape}).encode()
    text += b" " * (-(len(text) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text


def archive_of(path, members):
    """A zip with these members, and a header that is right."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as zipped:
        for name, content in {"header.npy": stored(text(HEADER)), **members}.items():
            zipped.writestr(name, content)
    return path


def refusal(path):
    with pytest.raises(ArchiveError) as caught:
        read_archive(path)
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith(f"{path}: ")
    return str(caught.value)


def test_header_and_arrays_come_back(file):
    header, arrays = read_archive(file)
    assert header == HEADER
    assert set(arrays) == set(ARRAYS)
    for name, array in ARRAYS.items():
        assert arrays[name].dtype == array.dtype
        np.testing.assert_array_equal(arrays[name], array)


def test_what_is_not_wanted_stays_packed(file, monkeypatch):
    header, arrays = read_archive(file, lambda name: name.startswith("w"))
    assert (header, list(arrays)) == (HEADER, ["words"])


def test_a_file_that_is_not_there_is_told_from_a_damaged_one(tmp_path):
    for path in (tmp_path / "none.npz", tmp_path):
        with pytest.raises(ArchiveError, match="cannot be read") as caught:
            read_archive(path)
        assert caught.value.is_missing


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.99])
def test_a_file_that_was_cut_is_refused(file, share):
    whole = file.read_bytes()
    file.write_bytes(whole[: int(share * len(whole))])
    assert "cut off" in refusal(file)


def test_every_flipped_byte_is_refused_or_changes_nothing(file):
    whole = file.read_bytes()
    for place in range(0, len(whole), 7):
        file.write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :])
        with suppress(ArchiveError):
            header, arrays = read_archive(file)
            assert header == HEADER
            assert all(np.array_equal(arrays[name], ARRAYS[name]) for name in arrays)


def test_an_archive_that_would_unpack_to_too_much_is_refused_unopened(tmp_path, monkeypatch):
    path = archive_of(tmp_path / "bomb.npz", {"big.npy": stored(np.zeros(2**20, np.uint8))})
    assert path.stat().st_size < 20_000
    monkeypatch.setattr(archive, "LARGEST_FILE", 2**19)
    monkeypatch.setattr(zipfile.ZipFile, "open", lambda *_: pytest.fail("a member was opened"))
    assert "unpacks to more" in refusal(path)


def test_a_member_that_tells_a_smaller_size_than_it_has_is_refused(tmp_path):
    path = archive_of(tmp_path / "liar.npz", {"big.npy": stored(np.zeros(10_000, np.uint8))})
    whole = path.read_bytes()
    size = struct.pack("<I", len(stored(np.zeros(10_000, np.uint8))))
    assert whole.count(size) == 2
    path.write_bytes(whole.replace(size, struct.pack("<I", 300)))
    assert "big.npy" in refusal(path)


def test_too_many_members_are_refused(tmp_path):
    path = tmp_path / "many.npz"
    archive_of(path, {f"a{i}.npy": stored(np.zeros(1)) for i in range(archive.MOST_MEMBERS)})
    assert f"{archive.MOST_MEMBERS + 1} arrays" in refusal(path)


@pytest.mark.parametrize(
    "content",
    [
        claimed((10**9,)),
        claimed((10**9, 10**9)),
        claimed((-1,)),
        claimed((2**63, 2)),
        claimed((1, 1, 1, 1, 1, 1)) + bytes(4),
        claimed((10**12,), "<U0"),
        claimed((1,), "|O") + bytes(8),
        claimed((1,), "|V4") + bytes(4),
        claimed((1,), [("x", "<f4")]) + bytes(4),
        claimed((1,))[:20],
        claimed((1,), "<f4'\0"),
        claimed((1,), "<i7") + bytes(7),
        b"\x93NUMPY\x01\x00\x05\x00{'des",
        b"",
        b"\x80\x04pickle",
        b"\x93NUMPY\x09\x00" + bytes(200),
        b"\x93NUMPY\x01\x00" + struct.pack("<H", 60_000) + b"(" * 60_000,
    ],
)
def test_a_member_of_another_shape_than_it_has_room_for_is_refused(tmp_path, content):
    refusal(archive_of(tmp_path / "bad.npz", {"bad.npy": content}))


def test_objects_are_never_unpickled(tmp_path):
    np.savez(tmp_path / "evil.npz", header=text(HEADER), evil=np.array([{}], object))
    assert "pickle" in refusal(tmp_path / "evil.npz")


@pytest.mark.parametrize(
    "name", ["../up.npy", "/etc/x.npy", "a/b.npy", "a.txt", ".npy", "sp ace.npy", "..\\up.npy"]
)
def test_a_name_that_is_a_path_is_refused(tmp_path, name):
    assert "no name of an array" in refusal(archive_of(tmp_path / "bad.npz", {name: stored(np.zeros(1))}))


def test_a_link_in_an_archive_is_refused(tmp_path):
    entry = zipfile.ZipInfo("linked.npy")
    entry.external_attr = 0o120777 << 16
    path = archive_of(tmp_path / "bad.npz", {})
    with zipfile.ZipFile(path, "a") as zipped:
        zipped.writestr(entry, "/etc/passwd")
    assert "is a link" in refusal(path)


def test_a_pipe_in_the_place_of_an_archive_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe.npz")
    assert "no regular file" in refusal(tmp_path / "pipe.npz")


def test_another_packing_than_deflate_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "bad.npz", "w", zipfile.ZIP_LZMA) as zipped:
        zipped.writestr("header.npy", stored(text(HEADER)))
    assert "another method" in refusal(tmp_path / "bad.npz")


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_a_name_that_stands_twice_is_refused(tmp_path):
    path = archive_of(tmp_path / "twice.npz", {"a.npy": stored(np.zeros(1))})
    with zipfile.ZipFile(path, "a") as zipped:
        zipped.writestr("a.npy", stored(np.ones(1)))
    assert "stands twice" in refusal(path)


@pytest.mark.parametrize(
    "content",
    [b"", b"[1]", b"{", b"\xff", b"[" * 100_000, b'{"a": "' + b"x" * archive.LARGEST_HEADER + b'"}'],
)
def test_a_header_that_is_no_json_object_is_refused(tmp_path, content):
    np.savez_compressed(tmp_path / "bad.npz", header=np.frombuffer(content, np.uint8))
    refusal(tmp_path / "bad.npz")


def test_an_archive_without_a_header_is_refused(tmp_path):
    np.savez(tmp_path / "bare.npz", a=np.zeros(1))
    assert "no header" in refusal(tmp_path / "bare.npz")


def test_another_kind_or_format_is_refused(file):
    check_format(file, HEADER, "svm", 2)
    with pytest.raises(ArchiveError, match=r"own\.npz: is no cnn model"):
        check_format(file, HEADER, "cnn", 2)
    with pytest.raises(ArchiveError, match=r"own\.npz: has format 2, this version reads 3"):
        check_format(file, HEADER, "svm", 3)


def test_where_there_is_no_memory_an_archive_is_not_told_to_be_damaged(file, monkeypatch):
    """The command says that the memory is too small, which `damaged; train it again` would hide."""

    def no_memory(*_):
        raise MemoryError

    monkeypatch.setattr(archive, "read_whole", no_memory)
    with pytest.raises(MemoryError):
        read_archive(file)
