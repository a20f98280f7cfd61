"""Compiled loops give the bytes of the plain ones, and nothing breaks where they cannot be had."""

import json
import logging
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.bad_frames import SCENES
from lightgesture.features.colour import ColourStage
from lightgesture.features.compiled import loops as compiled
from lightgesture.features.find import bank, cells, proposals
from lightgesture.features.find.candidates import pair_numbers
from lightgesture.features.find.classical import ClassicalSelector, Loops, Scene
from lightgesture.features.find.proposals import plain_distinct, whole_regions, without_forearms
from lightgesture.features.find.selector_file import load_classical
from lightgesture.features.skin_map import skin_map
from lightgesture.sources import open_source


@pytest.fixture(name="fast", scope="module")
def _fast(tmp_path_factory):
    numba = pytest.importorskip("numba", reason="needs the extra fast")
    return compiled.compiled_loops(numba, compiled.cache_folder())


def _textured(seed, height, width, light):
    rng = np.random.default_rng(seed)
    coarse = rng.integers(0, 256, (5, 6, 3)).astype(np.float32)
    picture = cv2.resize(coarse, (width, height)).reshape(height, width, 3) * light
    return np.clip(picture + rng.normal(0, 4, picture.shape), 0, 255).astype(np.uint8)


def _assert_same_regions(one, other):
    assert one.boxes.tobytes() == other.boxes.tobytes()
    assert one.levels.tobytes() == other.levels.tobytes()
    assert one.cut.tobytes() == other.cut.tobytes()
    for mine, theirs in zip(one.contours, other.contours, strict=True):
        assert mine.tobytes() == theirs.tobytes()


def _assert_same_candidates(one, other):
    assert len(one.regions) == len(other.regions)
    for mine, theirs in zip(one.regions, other.regions, strict=True):
        assert (mine.box, mine.confidence, mine.alternatives) == (
            theirs.box,
            theirs.confidence,
            theirs.alternatives,
        )
        assert mine.contour.tobytes() == theirs.contour.tobytes()
    assert one.pairs.tobytes() == other.pairs.tobytes()


@given(
    seed=st.integers(0, 2**31),
    height=st.integers(1, 130),
    width=st.integers(1, 170),
    light=st.floats(0.02, 1.5),
)
@settings(max_examples=40, deadline=None)
def test_any_picture_gives_the_same_bytes(fast, seed, height, width, light):
    picture = _textured(seed, height, width, light)
    skin = skin_map(picture)
    assert skin_map(picture, fast.skin).tobytes() == skin.tobytes()
    sums = cells.channel_sums(picture, skin)
    assert cells.channel_sums(picture, skin, fast.cells).tobytes() == sums.tobytes()
    regions, same = whole_regions(skin), whole_regions(skin, loops=fast.regions)
    _assert_same_regions(regions, same)
    size = width, height
    rows = cells.describe(sums, regions, size)
    assert cells.describe(sums, regions, size, fast.cells).tobytes() == rows.tobytes()


@given(
    seed=st.integers(0, 2**31),
    height=st.integers(1, 90),
    width=st.integers(1, 90),
    grain=st.integers(1, 12),
    levels=st.sampled_from([2, 7, 24, 128, 200, 256]),
)
@settings(max_examples=60, deadline=None)
def test_any_map_has_the_same_regions_within_regions(fast, seed, height, width, grain, levels):
    """Rings, specks in holes and regions that touch by a corner, from noise to blobs."""
    coarse = np.random.default_rng(seed).integers(0, 256, (height // grain + 1, width // grain + 1))
    skin = cv2.resize(coarse.astype(np.uint8), (width, height)).reshape(height, width)
    regions = whole_regions(skin, levels)
    _assert_same_regions(regions, whole_regions(skin, levels, fast.regions))
    hands = without_forearms(regions)
    _assert_same_regions(hands, without_forearms(regions, fast.regions))
    every = regions.joined(hands)
    size = width, height
    assert fast.cells.shapes(every, size).tobytes() == cells.PLAIN.shapes(every, size).tobytes()
    assert fast.regions.overlaps(every.boxes).tobytes() == proposals.PLAIN.overlaps(every.boxes).tobytes()
    if len(every):
        parts = (
            every.points,
            every.starts,
            every.lengths,
            bank.DescriptorSettings(points=levels // 4 + 8, harmonics=3),
        )
        assert bank.describe_points(*parts, fast.bank).tobytes() == bank.describe_points(*parts).tobytes()
    picture = _textured(seed, height, width, 1.0)
    colours = proposals.PLAIN.colours(picture, every)
    assert fast.regions.colours(picture, every).tobytes() == colours.tobytes()


def test_a_region_larger_than_any_of_a_working_picture_is_cut_alike(fast):
    skin = np.zeros((400, 400), np.uint8)
    cv2.circle(skin, (150, 120), 80, 255, cv2.FILLED)
    cv2.rectangle(skin, (110, 120), (190, 350), 255, cv2.FILLED)
    regions = whole_regions(skin)
    assert len(without_forearms(regions)) == 1
    _assert_same_regions(without_forearms(regions), without_forearms(whole_regions(skin), fast.regions))


@given(
    boxes=st.lists(
        st.tuples(st.integers(-50, 300), st.integers(-50, 300), st.integers(1, 90), st.integers(1, 90)),
        max_size=60,
    ),
    most=st.integers(1, 20),
)
@settings(max_examples=60, deadline=None)
def test_any_boxes_are_parted_and_described_alike(fast, boxes, most):
    table = np.array(boxes, np.int32).reshape(-1, 4)
    np.testing.assert_array_equal(fast.regions.distinct(table, most), plain_distinct(table, most))
    picture = _textured(1, 120, 160, 1.0)
    sums = cells.channel_sums(picture, skin_map(picture))
    assert fast.cells.cells(sums, table).tobytes() == cells.PLAIN.cells(sums, table).tobytes()


def test_frames_of_a_clip_give_the_same_candidates(fast):
    parts = load_classical()
    plain, quick = ClassicalSelector(parts), ClassicalSelector(parts, fast)
    found = 0
    with open_source(SAMPLE) as source:
        for frame in source:
            if frame.index % 12:
                continue
            colour = ColourStage().process(frame.image)
            one = plain.process(colour)
            _assert_same_candidates(one, quick.process(colour))
            found += len(one.regions)
    assert found > 10


def test_the_worst_frames_give_the_same_candidates(fast):
    parts = load_classical()
    plain, quick = ClassicalSelector(parts), ClassicalSelector(parts, fast)
    clip = [_textured(seed, 480, 640, 0.8) for seed in (5, 6)]
    for scene in SCENES.values():
        for image in scene(clip):
            colour = ColourStage().process(image)
            _assert_same_candidates(plain.process(colour), quick.process(colour))


@given(
    rows=st.lists(
        st.tuples(
            *[st.integers(0, 150)] * 2,
            *[st.integers(1, 110)] * 2,
            *[st.floats(0.0, 1.0, width=32)] * 5,
        ),
        min_size=2,
        max_size=8,
    ),
    face=st.sampled_from([None, (70.0, 40.0)]),
)
@settings(max_examples=100, deadline=None)
def test_any_pairs_have_the_same_numbers(fast, rows, face):
    table = np.array(rows, np.float64)
    pairs, numbers = pair_numbers(table, (160, 120), face)
    same, others = pair_numbers(table, (160, 120), face, numbers=fast.pairs)
    assert same.tobytes() == pairs.tobytes()
    assert others.tobytes() == numbers.tobytes()


@pytest.mark.parametrize("is_fast", [False, True])
def test_threads_and_sizes_do_not_share_what_is_kept_of_a_frame(fast, is_fast):
    selector = ClassicalSelector(load_classical(), fast if is_fast else None)
    sizes = (120, 160), (90, 200), (160, 120), (120, 160)
    colours = [ColourStage().process(_textured(seed, *sizes[seed % 4], 1.0)) for seed in range(12)]
    alone = [ClassicalSelector(load_classical(), fast if is_fast else None).process(one) for one in colours]
    with ThreadPoolExecutor(4) as pool:
        for one, other in zip(alone, pool.map(selector.process, colours), strict=True):
            _assert_same_candidates(one, other)


def test_read_only_frames_and_views_are_taken(fast):
    picture = _textured(3, 100, 140, 1.0)
    whole = ClassicalSelector(load_classical(), fast)
    expected = whole.process(ColourStage().process(picture))
    view = np.repeat(picture, 2, axis=1)[:, ::2]
    frozen = picture.copy()
    frozen.flags.writeable = False
    for same in (view, frozen):
        _assert_same_candidates(expected, whole.process(ColourStage().process(same)))


def test_a_profile_of_colours_takes_the_place_of_the_map(fast):
    colour = ColourStage().process(_textured(4, 120, 160, 1.0))
    object.__setattr__(colour, "skin_of", lambda picture: np.ascontiguousarray(picture[..., 0]))
    assert Scene.of(colour, fast).skin.tobytes() == colour.picture[..., 0].tobytes()


@pytest.fixture(name="told")
def _told(caplog):
    compiled.best_loops.cache_clear()
    with caplog.at_level(logging.WARNING, "lightgesture"):
        yield caplog
    compiled.best_loops.cache_clear()


def _refuses(*_, **__):
    raise TypeError("this version\nknows no such thing")


def _numba_of_another_version():
    return SimpleNamespace(
        __version__="0.1", njit=_refuses, config=SimpleNamespace(DISABLE_JIT=0, CACHE_DIR="")
    )


def test_numba_of_another_version_gives_one_line_and_the_plain_loops(monkeypatch, told, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setitem(sys.modules, "numba", _numba_of_another_version())
    assert compiled.best_loops() == Loops()
    assert compiled.best_loops() == Loops()
    (line,) = told.messages
    assert "numba 0.1 does not serve" in line
    assert "\n" not in line


def test_a_cache_folder_that_cannot_be_written_gives_one_line_and_the_plain_loops(
    monkeypatch, told, tmp_path
):
    (tmp_path / "lightgesture").write_text("a file where the folder should be")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setitem(sys.modules, "numba", _numba_of_another_version())
    assert compiled.best_loops() == Loops()
    (line,) = told.messages
    assert "cannot be written" in line


def test_without_numba_nothing_is_told(monkeypatch, told):
    monkeypatch.setitem(sys.modules, "numba", None)
    assert compiled.best_loops() == Loops()
    assert not told.messages


def test_a_variable_keeps_numba_out(monkeypatch, told):
    monkeypatch.setenv(compiled.SWITCHED_OFF, "1")
    monkeypatch.setitem(sys.modules, "numba", _numba_of_another_version())
    assert compiled.best_loops() == Loops()
    assert not told.messages


def test_the_cache_lies_in_the_users_folder(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert compiled.cache_folder() == tmp_path / "lightgesture" / "numba"
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    assert compiled.cache_folder().is_absolute()


def test_loops_with_other_numbers_are_compiled_anew(monkeypatch, tmp_path):
    """Numba itself sees only whether the file of a loop has changed."""
    for name in ("compiled/cells.py", "compiled/runs.py", "skin_map.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("MOST = 96")
    monkeypatch.setattr(compiled, "__file__", str(tmp_path / "compiled" / "loops.py"))
    monkeypatch.setattr(compiled, "SIGNATURES", {"cells": {}, "runs": {}})
    monkeypatch.setattr(compiled, "NUMBERS_FROM", ("skin_map.py",))
    versions = [compiled.version_of_loops()]
    for name in ("compiled/runs.py", "skin_map.py"):
        (tmp_path / name).write_text("MOST = 95")
        versions.append(compiled.version_of_loops())
    assert len(set(versions)) == 3


def test_the_learned_choice_loads_no_numba():
    code = (
        "import json, sys\n"
        "from lightgesture.features.find.selector import load_selector\n"
        "load_selector('learned')\n"
        "print(json.dumps('numba' in sys.modules))\n"
    )
    answer = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, env={**os.environ}
    )
    assert json.loads(answer.stdout) is False
