"""Cached clips: rendered once, again when damaged, bounded, in the user's cache folder."""

import os
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from lightgesture.benchmarks.suite.cache import (
    TRUTH,
    VIDEO,
    cache_folder,
    fetch_clip,
    source_digest,
)
from lightgesture.errors import InputError


@pytest.fixture(name="folder")
def _folder(tmp_path):
    return tmp_path / "cache with space" / "suite"


def only_clip(folder):
    (place,) = [place for place in folder.iterdir() if not place.name.startswith(".")]
    return place


def test_a_clip_is_rendered_once_and_tells_the_truth(folder, signed_take):
    first = fetch_clip(signed_take, folder)
    again = fetch_clip(signed_take, folder)
    assert signed_take.rendered == [1]
    assert first.video == again.video
    assert first.instructions == again.instructions == ("STOP UP GO",)
    assert [word.word for word in first.words] == ["STOP", "UP", "GO"]
    assert len(first.labels) == signed_take.count
    assert {label.token for label in first.labels[5]} == {"ok", "0"}
    assert first.labels[18] == ()
    assert list(folder.iterdir()) == [only_clip(folder)]


@pytest.mark.parametrize("name", [VIDEO, TRUTH])
@pytest.mark.parametrize("damage", ["missing", "short", "changed", "empty"])
def test_a_damaged_clip_is_made_again(folder, signed_take, name, damage):
    fetch_clip(signed_take, folder)
    file = only_clip(folder) / name
    content = file.read_bytes()
    if damage == "missing":
        file.unlink()
    else:
        middle = len(content) // 2
        changed = content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]
        file.write_bytes({"short": content[:-30], "changed": changed, "empty": b""}[damage])
    clip = fetch_clip(signed_take, folder)
    assert signed_take.rendered == [2]
    assert clip.instructions == ("STOP UP GO",)


def test_another_recipe_is_another_clip(folder, signed_take):
    first = fetch_clip(signed_take, folder)
    second = fetch_clip(replace(signed_take, recipe="newer"), folder)
    assert first.video != second.video
    assert first.video.is_file()


def test_an_interrupted_rendering_leaves_nothing(folder, signed_take):
    @dataclass(frozen=True)
    class Interrupted(type(signed_take)):
        def frames(self):
            yield next(super().frames())
            raise KeyboardInterrupt

    take = Interrupted(signed_take.scenario, signed_take.recipe, signed_take.rendered)
    with pytest.raises(KeyboardInterrupt):
        fetch_clip(take, folder)
    assert list(folder.iterdir()) == []


def test_the_longest_unused_clips_go_first(folder, signed_take):
    takes = [replace(signed_take, recipe=str(number)) for number in range(3)]
    places = [fetch_clip(take, folder).video.parent for take in takes]
    size = sum(file.stat().st_size for file in places[0].iterdir())
    for age, place in zip((100, 300, 200), places, strict=True):
        os.utime(place, (1e9 - age, 1e9 - age))
    kept = fetch_clip(replace(signed_take, recipe="new"), folder, int(3.5 * size)).video.parent
    assert set(folder.iterdir()) == {kept, places[0], places[2]}


def test_leftovers_of_killed_runs_are_swept_when_old(folder, signed_take):
    for name, age in ((".old.part", 1e9), (".young.part", None)):
        (folder / name).mkdir(parents=True)
        if age:
            os.utime(folder / name, (age, age))
    fetch_clip(signed_take, folder)
    assert {place.name for place in folder.iterdir() if place.name.startswith(".")} == {".young.part"}


def test_a_place_that_cannot_be_written_is_named(tmp_path, signed_take):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(InputError, match=r"cannot be written .*XDG_CACHE_HOME"):
        fetch_clip(signed_take, tmp_path / "file" / "suite")


def test_cache_folder_follows_the_xdg_specification(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache_folder() == tmp_path / "lightgesture" / "suite"
    for value in ("", "relative/place"):
        monkeypatch.setenv("XDG_CACHE_HOME", value)
        assert cache_folder() == Path.home() / ".cache" / "lightgesture" / "suite"


def test_digest_changes_with_the_sources(tmp_path):
    file = tmp_path / "a.py"
    file.write_text("x = 1")
    before = source_digest([file])
    file.write_text("x = 2")
    assert source_digest([file]) != before
