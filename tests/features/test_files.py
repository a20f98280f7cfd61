"""Files of others are read once, whole, and within bounds."""

import os
import tracemalloc

import pytest

from lightgesture.features import files
from lightgesture.features.files import FileRefusedError, read_whole


def test_a_file_of_just_the_largest_size_comes_back(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"x" * 100)
    assert read_whole(path, 100) == b"x" * 100
    with pytest.raises(FileRefusedError, match="larger than 99 bytes"):
        read_whole(path, 99)
    with pytest.raises(FileRefusedError, match="larger than 1 MiB"):
        read_whole(_large(tmp_path), 1 << 20)


def _large(folder):
    path = folder / "large"
    with open(path, "wb") as stream:
        stream.truncate(1 << 34)  # 16 GiB that take no room
    return path


def test_pipes_devices_and_folders_are_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", "/dev/zero"):
        with pytest.raises(FileRefusedError, match="no regular file"):
            read_whole(path, 10)
    with pytest.raises(IsADirectoryError):
        read_whole(tmp_path, 10)


@pytest.mark.parametrize("change", ["longer", "shorter", "touched"])
def test_a_file_that_changes_while_it_is_read_is_refused(tmp_path, monkeypatch, change):
    path = tmp_path / "a"
    path.write_bytes(b"x" * 100)
    looked = []
    fstat = os.fstat

    def look(number):
        if looked:
            if change == "touched":
                os.utime(path, (1, 1))
            else:
                path.write_bytes(b"y" * (120 if change == "longer" else 80))
        looked.append(number)
        return fstat(number)

    monkeypatch.setattr(files.os, "fstat", look)
    with pytest.raises(FileRefusedError, match="changed while it was read"):
        read_whole(path, 1000)


def test_room_is_made_for_what_there_is_and_not_for_what_may_be(tmp_path):
    """Where memory is bounded, as by `ulimit -v`, sixty megabytes that are never touched are refused too."""
    path = tmp_path / "a"
    path.write_bytes(b"x" * 100)
    tracemalloc.start()
    try:
        read_whole(path, 64 << 20)
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert most < 1 << 20
