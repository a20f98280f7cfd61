"""Trees at run time against the library that fitted them; damaged files are refused in one line."""

import json
from dataclasses import replace

import numpy as np
import pytest

from lightgesture.features.archive import read_archive
from lightgesture.features.find.selector_file import (
    BUNDLED,
    FORMAT,
    OLDER,
    UNVERIFIED,
    SelectorError,
    load_classical,
    load_learned,
    load_nets,
)
from lightgesture.features.find.trees import FlatTrees, Trees, evaluate
from lightgesture.training.model_files import write_classical, write_selector
from lightgesture.training.regions.trees import export_trees


def test_exported_trees_predict_what_the_library_predicts():
    from sklearn.ensemble import HistGradientBoostingRegressor

    rng = np.random.default_rng(0)
    rows = rng.normal(size=(600, 7)).astype(np.float32)
    target = rows[:, 0] * rows[:, 1] + np.abs(rows[:, 2])
    model = HistGradientBoostingRegressor(max_iter=30, max_leaf_nodes=15, random_state=0).fit(rows, target)
    fresh = rng.normal(size=(400, 7)).astype(np.float32)
    np.testing.assert_allclose(evaluate(export_trees(model), fresh), model.predict(fresh), atol=1e-5)
    np.testing.assert_allclose(evaluate(export_trees(model), rows), model.predict(rows), atol=1e-5)


def test_flat_trees_say_what_the_trees_say():
    trees = load_classical().regions
    rows = np.random.default_rng(2).normal(0.5, 0.5, (50, 263)).astype(np.float32)
    np.testing.assert_allclose(FlatTrees.of(trees).scores(rows), evaluate(trees, rows), atol=2e-4)
    assert FlatTrees.of(trees).scores(rows[:0]).shape == (0,)


def _assert_equal_trees(first, second):
    for name in ("feature", "threshold", "left", "right", "value"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))


def test_a_selector_survives_its_file(tmp_path):
    file = tmp_path / "copy.npz"
    bundled = load_classical(), load_learned()
    write_selector(*bundled, file)
    classical, learned = load_classical(file), load_learned(file)
    _assert_equal_trees(classical.glance, bundled[0].glance)
    _assert_equal_trees(classical.regions, bundled[0].regions)
    _assert_equal_trees(classical.pairs, bundled[0].pairs)
    np.testing.assert_array_equal(classical.bank.centres, bundled[0].bank.centres)
    _assert_equal_trees(learned.places, bundled[1].places)
    _assert_equal_trees(learned.pairs, bundled[1].pairs)
    for name in ("locator", "refiner"):
        mine, theirs = getattr(learned, name), getattr(bundled[1], name)
        assert (mine.nodes, mine.inputs, mine.outputs) == (theirs.nodes, theirs.inputs, theirs.outputs)
        for node in mine.weights:
            np.testing.assert_array_equal(mine.weights[node].weights, theirs.weights[node].weights)
    assert [path.name for path in tmp_path.iterdir()] == ["copy.npz"]


def test_other_classical_trees_leave_the_learned_choice_as_it_was(tmp_path):
    classical = load_classical()
    write_classical(
        replace(classical, pairs=replace(classical.pairs, base=0.25)), BUNDLED, tmp_path / "new.npz"
    )
    assert load_classical(tmp_path / "new.npz").pairs.base == 0.25
    (header, before), (same, after) = read_archive(BUNDLED), read_archive(tmp_path / "new.npz")
    assert header == same
    assert before.keys() == after.keys()
    for name in before:
        assert name == "extent_pairs_base" or before[name].tobytes() == after[name].tobytes(), name


def _header(**changes):
    header = {"format": FORMAT, "kind": "selector", **changes}
    return np.frombuffer(json.dumps(header).encode(), np.uint8)


def _write(path, **changes):
    arrays = {"header": _header(), **read_archive(BUNDLED)[1], **changes}
    np.savez(path, **arrays)
    return path


@pytest.mark.parametrize(
    "changes",
    [
        {"header": _header(format=99)},
        {"header": _header(kind="cnn")},
        {"extents_value": np.full((3, 3), np.nan, np.float32)},
        {"extents_left": np.full((2, 2), 7, np.int16)},
        {"extent_pairs_depth": np.int64(10_000)},
        {"glance_base": np.array(["x"])},
    ],
    ids=["version", "kind", "nan", "child", "depth", "text"],
)
def test_a_file_with_wrong_content_is_refused_in_one_line(tmp_path, changes):
    path = _write(tmp_path / "bad.npz", **changes)
    with pytest.raises(SelectorError, match=r"bad\.npz: .*lightgesture train regions") as caught:
        load_classical(path)
    assert "\n" not in str(caught.value)


def test_nan_in_a_tree_of_the_right_shape_is_refused(tmp_path):
    value = read_archive(BUNDLED)[1]["extents_value"].copy()
    value[0, 0] = np.nan
    with pytest.raises(SelectorError, match="not finite"):
        load_classical(_write(tmp_path / "nan.npz", extents_value=value))


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 not a zip", b"text"])
def test_a_file_that_is_no_selector_is_refused_in_one_line(tmp_path, content):
    path = tmp_path / "cut.npz"
    path.write_bytes(content)
    with pytest.raises(SelectorError, match=r"cut\.npz"):
        load_classical(path)


def test_a_cut_off_file_is_refused(tmp_path):
    path = tmp_path / "half.npz"
    path.write_bytes(BUNDLED.read_bytes()[:20_000])
    with pytest.raises(SelectorError, match=r"half\.npz"):
        load_classical(path)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(SelectorError, match=r"none\.npz: cannot be read"):
        load_classical(tmp_path / "none.npz")


def test_a_pickle_is_never_opened(tmp_path):
    path = tmp_path / "evil.npz"
    np.savez(path, header=_header(), extents_value=np.array([object()], dtype=object))
    with pytest.raises(SelectorError, match=r"evil\.npz"):
        load_classical(path)


def test_of_a_file_of_before_nets_can_learn_on_and_the_classical_choice_serves(tmp_path):
    _write(tmp_path / "old.npz", header=_header(format=OLDER))
    with pytest.raises(SelectorError, match=r"old\.npz: has format 3, this version reads 5; make it again"):
        load_learned(tmp_path / "old.npz")
    assert load_classical(tmp_path / "old.npz").pairs.base == load_classical().pairs.base
    locator, refiner = load_nets(tmp_path / "old.npz")
    bundled = load_learned()
    assert (locator.nodes, refiner.nodes) == (bundled.locator.nodes, bundled.refiner.nodes)


@pytest.mark.parametrize("left", [[1, 0, 2], [0, 1, 2], [2, 1, 2]], ids=["circle", "root", "both"])
def test_a_tree_that_leads_to_a_node_twice_is_refused(left):
    """It would be laid out for ever, or many times over."""
    column, number = np.zeros((1, 3), np.int16), np.zeros((1, 3), np.float32)
    right = np.array([[2, 1, 2]], np.int16)
    trees = Trees(column, number, np.array([left], np.int16), right, number, 0.0, 2)
    with pytest.raises(ValueError, match="twice"):
        trees.check(1)
    replace(trees, left=np.array([[1, 1, 2]], np.int16)).check(1)


def test_trees_that_point_outside_are_refused():
    ones = np.ones((1, 1), np.int16)
    trees = Trees(ones * 0, np.zeros((1, 1), np.float32), ones, ones, np.zeros((1, 1), np.float32), 0.0, 1)
    with pytest.raises(ValueError, match="outside its nodes"):
        trees.check(columns=3)


@pytest.mark.parametrize(
    "changes",
    [
        {"locator_layout": np.frombuffer(b"{}", np.uint8)},
        {"locator_layout": np.frombuffer(b"[" * 100_000, np.uint8)},
        {"refiner_tflite": np.zeros(3000, np.uint8)},
        {"refiner_tflite": np.zeros(3000, np.float32)},
        {"places_feature": np.full((2, 2), 99, np.int16)},
    ],
    ids=["empty layout", "deep layout", "file", "type", "column"],
)
def test_a_net_with_wrong_content_is_refused_in_one_line(tmp_path, changes):
    path = _write(tmp_path / "bad.npz", **changes)
    with pytest.raises(SelectorError, match=r"bad\.npz: .*lightgesture train regions") as caught:
        load_learned(path)
    assert "\n" not in str(caught.value)


def test_a_file_of_an_older_version_is_told_so(tmp_path):
    np.savez(tmp_path / "old.npz", version=np.int32(2), extents_value=np.zeros((1, 1), np.float32))
    with pytest.raises(
        SelectorError, match=r"old\.npz: has no header, so it is of an older version.*; make it again"
    ):
        load_classical(tmp_path / "old.npz")


def test_a_file_without_a_verifier_is_read_as_it_is(tmp_path):
    arrays = {name: array for name, array in read_archive(BUNDLED)[1].items() if "verifier" not in name}
    np.savez(tmp_path / "before.npz", header=_header(format=UNVERIFIED), **arrays)
    parts = load_learned(tmp_path / "before.npz")
    assert parts.verifier is None
    assert parts.pairs.base == load_learned().pairs.base
