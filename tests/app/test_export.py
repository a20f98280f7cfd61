"""The exported files, read back with json and NumPy alone: nets and trees computed again from them give the vectors."""

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest

from lightgesture.cli import main
from lightgesture.export import files as flat
from lightgesture.features.net.network import IntegerNetwork, Node, Quantisation, Weights
from lightgesture.features.outline.contours import ContourSettings, contour_length
from lightgesture.features.patch import PatchSettings
from lightgesture.fsm.language.load import BUNDLED
from lightgesture.models.cnn import CnnModel
from lightgesture.training.model_files import write_cnn_model

NETS = ("cnn", "refiner", "locator", "verifier")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("export") / "flat"
    assert main(["export", str(path)]) == 0
    return path


@pytest.fixture(scope="module")
def manifest(folder):
    return json.loads((folder / "manifest.json").read_text())


@pytest.fixture(scope="module")
def read(folder, manifest):
    """Reads a JSON file, or an array by its name in the manifest."""

    def reader(name):
        if name.endswith(".json"):
            return json.loads((folder / name).read_text())
        entry = manifest["arrays"][name]
        raw = (folder / entry["file"]).read_bytes()[entry["offset"] : entry["offset"] + entry["bytes"]]
        assert hashlib.sha256(raw).hexdigest() == entry["sha256"]
        dtype = np.dtype(entry["dtype"]).newbyteorder("<")
        return np.frombuffer(raw, dtype).reshape(entry["shape"])

    return reader


def test_the_manifest_tells_every_file_and_where_each_array_lies(folder, manifest):
    found = {path.name for path in folder.iterdir()} - {"manifest.json"}
    assert found == set(manifest["files"])
    for name, entry in manifest["files"].items():
        content = (folder / name).read_bytes()
        assert (len(content), hashlib.sha256(content).hexdigest()) == (entry["bytes"], entry["sha256"])
    for entry in manifest["arrays"].values():
        assert entry["offset"] % 16 == 0
        assert entry["offset"] + entry["bytes"] <= manifest["files"][entry["file"]]["bytes"]


def test_the_readme_names_every_file(folder, manifest):
    text = (folder / "README.md").read_text()
    assert [name for name in manifest["files"] if name not in text and name != "README.md"] == []


def scaled(values, multipliers, shifts):
    return (values * multipliers + (np.int64(1) << (np.asarray(shifts, np.int64) - 1))) >> shifts


def clipped(values, layer):
    return np.clip(values + layer["zero"], layer["lowest"], layer["highest"])


def weighted(layer, source, zero, read):
    """A layer with weights, as the README tells it."""
    arrays = {kind: read(name).astype(np.int64) for kind, name in layer["arrays"].items() if kind != "scales"}
    weights, values = arrays["weights"], source - zero
    if layer["op"] == "dense":
        sums = (values.reshape(1, -1) @ weights.T)[:, None, None]
    else:
        above, left = layer["padding_above_below"], layer["padding_left_right"]
        padded = np.pad(values, ((0, 0), above, left, (0, 0)))
        rows, columns, stride = layer["shape"][0], layer["shape"][1], layer["stride"]
        sums = 0
        for y in range(layer["kernel"]):
            for x in range(layer["kernel"]):
                seen = padded[:, y : y + stride * rows : stride, x : x + stride * columns : stride]
                seen = seen[:, :rows, :columns]
                if layer["op"] == "depthwise":
                    sums = sums + seen * weights[0, y, x]
                else:
                    sums = sums + seen @ weights[:, y, x].T
    sums = sums + arrays["biases"]
    return clipped(scaled(sums, arrays["multipliers"], arrays["shifts"]), layer)


@pytest.mark.parametrize("name", NETS)
def test_a_net_computed_from_the_files_gives_every_tensor(name, read):
    net = read(f"{name}.json")
    zeros = {item["name"]: item["zero"] for item in (*net["inputs"], *net["layers"])}
    known = net["vectors"]["every_tensor_of_the_first"]
    tensors = {item["name"]: read(known[item["name"]]).astype(np.int64) for item in net["inputs"]}
    for layer in net["layers"]:
        sources = [tensors[one] for one in layer["inputs"]]
        if layer["op"] == "upsample":
            found = sources[0].repeat(2, axis=1).repeat(2, axis=2)
        elif layer["op"] == "add":
            wide = [
                scaled((source - zeros[one]) << layer["widening_shift"], how["multiplier"], how["shift"])
                for source, one, how in zip(sources, layer["inputs"], layer["operands"], strict=True)
            ]
            found = clipped(scaled(sum(wide), layer["sum"]["multiplier"], layer["sum"]["shift"]), layer)
        else:
            found = weighted(layer, sources[0], zeros[layer["inputs"][0]], read)
        np.testing.assert_array_equal(found, read(known[layer["name"]]), err_msg=layer["name"])
        tensors[layer["name"]] = found
    for output in net["outputs"]:
        answers = read(net["vectors"]["outputs"][output])
        assert len(answers) == 3
        np.testing.assert_array_equal(answers[:1], tensors[output])


@pytest.mark.parametrize("name", NETS)
def test_the_exported_file_of_lite_rt_gives_nearly_the_same(name, folder, read):
    interpreter = pytest.importorskip("ai_edge_litert.interpreter")
    net = read(f"{name}.json")
    own = interpreter.Interpreter(str(folder / f"{name}.tflite"), num_threads=1)
    own.allocate_tensors()
    (place,) = own.get_input_details()
    outputs = {item["name"]: item["index"] for item in own.get_output_details()}
    (inputs,) = (read(one) for one in net["vectors"]["inputs"].values())
    for number in range(len(inputs)):
        own.set_tensor(place["index"], inputs[number : number + 1])
        own.invoke()
        for output, index in outputs.items():
            expected = read(net["vectors"]["outputs"][output])[number].astype(int).ravel()
            assert np.abs(own.get_tensor(index).ravel() - expected).max() <= 6


def test_trees_walked_from_the_files_end_in_the_same_leaves(read):
    for trees in read("trees.json").values():
        arrays = {kind: read(name) for kind, name in trees["arrays"].items()}
        rows, leaves, values = (read(trees["vectors"][kind]) for kind in ("rows", "leaves", "values"))
        assert rows.shape[1] == trees["columns"]
        for row, expected, value in zip(rows, leaves, values, strict=True):
            node = np.zeros(len(expected), int)
            tree = np.arange(len(expected))
            for _ in range(trees["depth"]):
                right = row[arrays["feature"][tree, node]] > arrays["threshold"][tree, node]
                node = np.where(right, arrays["right"][tree, node], arrays["left"][tree, node])
            np.testing.assert_array_equal(node, expected)
            assert np.float32(trees["base"]) + arrays["value"][tree, node].sum() == value
        assert len(np.unique(leaves)) > 3


def softmax(scores, temperature):
    powers = np.exp((scores - scores.max(axis=1, keepdims=True)) / temperature)
    return powers / powers.sum(axis=1, keepdims=True)


def test_the_machine_computed_from_the_files_gives_its_scores(read):
    svm = read("svm.json")
    arrays = {kind: read(name).astype(float) for kind, name in svm["arrays"].items()}
    steps = {step: read(name) for step, name in svm["vectors"].items()}
    projected = (steps["features"] - arrays["mean"]) @ arrays["projection"]
    np.testing.assert_allclose(projected, steps["projected"], atol=1e-4)
    squares = ((projected[:, None] - arrays["centres"]) ** 2).sum(axis=2)
    scores = np.exp(-svm["gamma"] * squares) @ arrays["weights"] + arrays["bias"]
    np.testing.assert_allclose(scores, steps["scores"], atol=1e-4)
    np.testing.assert_allclose(softmax(scores, svm["temperature"]), steps["probabilities"], atol=1e-4)


def test_patches_become_levels_scores_and_probabilities(read):
    cnn, constants = read("cnn.json"), read("constants.json")["features.standardise"]
    steps = {step: read(name) for step, name in cnn["hands"].items()}
    assert len(steps["patches"]) == 8
    named = {**constants, **constants.get("StandardSettings", {}).get("fields", {})}
    evenness = named["evenness" if "evenness" in named else "EVENNESS"]["value"]
    largest = named["largest" if "largest" in named else "LARGEST"]["value"]
    roots = np.sqrt(steps["patches"] / 255.0)
    mean, deviation = (getattr(roots, what)(axis=(1, 2), keepdims=True) for what in ("mean", "std"))
    values = np.clip((roots - mean) / (deviation + evenness), -largest, largest)
    (entry,) = cnn["inputs"]
    levels = np.clip(np.rint(values / entry["scale"]) + entry["zero"], -128, 127)
    assert np.abs(levels - steps["levels"]).max() <= 1
    (last,) = [layer for layer in cnn["layers"] if layer["name"] == "scores"]
    steps_of_scale = steps["scores"] / last["scale"]
    np.testing.assert_allclose(steps_of_scale, np.rint(steps_of_scale), atol=1e-3)
    np.testing.assert_allclose(
        softmax(steps["scores"], cnn["temperature"]), steps["probabilities"], atol=1e-5
    )


def test_the_words_of_the_sequences_lead_through_the_table(read):
    grammar, vectors = read("grammar.json"), read("decoder_vectors.json")
    following = {(state, word): target for state, word, target in grammar["transitions"]}
    pairs = {
        (left, right): word
        for left, right, word in (*grammar["pairs"]["idle"], *grammar["pairs"]["sentence"])
    }
    issued = 0
    for sequence in vectors["sequences"]:
        state = 0
        for event in sequence["events"]:
            if event["type"] == "word":
                assert tuple(event["pair"]) in pairs
                state = following[state, event["word"]]
            elif event["type"] == "instruction":
                issued += 1
                form = next(
                    one for one in grammar["forms"] if one["sentence"] == grammar["accepting"][str(state)]
                )
                assert event["kind"] == form["kind"]
                state = 0
    assert issued >= 4
    reasons = {event.get("reason") for one in vectors["sequences"] for event in one["events"]}
    assert {"out_of_order", "cancelled", "unknown_pair"} <= reasons
    (brief,) = [one for one in vectors["sequences"] if one["name"] == "held too briefly"]
    assert brief["frames"]
    assert brief["events"] == []


def test_constants_come_with_what_they_do(read):
    peaks = read("constants.json")["features.find.locator"]
    assert peaks["STRIDE"] == {"value": 4, "about": "Working pixels for one cell of the maps."}


def test_the_same_files_are_written_again(folder, tmp_path):
    """A second export takes the place of the first, and gives the same bytes."""
    (tmp_path / "again").mkdir()
    assert main(["export", str(tmp_path / "again")]) == 0
    own, again = (
        {path.name: path.read_bytes() for path in one.iterdir()} for one in (folder, tmp_path / "again")
    )
    assert own == again
    flat.write_folder(tmp_path / "again", {**flat.FlatFiles().all_files(), "README.md": b"new"})
    assert {path.name for path in (tmp_path / "again").iterdir()} == {"manifest.json", "README.md"}
    assert [path.name for path in tmp_path.iterdir()] == ["again"]


def refused(capsys, *arguments):
    assert main(["export", *map(str, arguments)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    return error


@pytest.mark.parametrize("manifest", [None, "{", "[]", '{"made_by": "another", "files": {"notes.txt": 1}}'])
def test_a_folder_with_other_files_is_refused_and_left_alone(tmp_path, capsys, manifest):
    (tmp_path / "notes.txt").write_text("mine")
    if manifest is not None:
        (tmp_path / "manifest.json").write_text(manifest)
    before = {path.name: path.read_text() for path in tmp_path.iterdir()}
    assert "which no export wrote" in refused(capsys, tmp_path)
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == before


def test_a_file_in_place_of_the_folder_is_refused(tmp_path, capsys):
    (tmp_path / "taken").write_text("mine")
    assert "taken" in refused(capsys, tmp_path / "taken")
    assert "taken" in refused(capsys, tmp_path / "taken" / "below")
    assert (tmp_path / "taken").read_text() == "mine"


def test_a_wrong_model_or_grammar_writes_nothing(tmp_path, capsys):
    (tmp_path / "bad.npz").write_bytes(b"no model")
    out = tmp_path / "out"
    assert "bad.npz" in refused(capsys, out, "--model", tmp_path / "bad.npz")
    assert "none.toml" in refused(capsys, out, "--grammar", tmp_path / "none.toml")
    assert [path.name for path in tmp_path.iterdir()] == ["bad.npz"]


def own_net_with_an_outline():
    """A hand net of three classes that looks at the numbers of the outline too."""
    contour = ContourSettings(size=16, directions=8)
    length = contour_length(contour)
    nodes = (
        Node("seen", "dense", ("patch",), 4),
        Node("outline", "dense", ("contour",), 4),
        Node("both", "add", ("seen", "outline")),
        Node("scores", "dense", ("both",), 3),
    )
    rng = np.random.default_rng(0)
    inputs = {"patch": (16, 16, 3), "contour": (1, 1, length)}
    sizes = {"seen": (4, 768), "outline": (4, length), "scores": (3, 4)}
    weights = {
        name: Weights(
            rng.integers(-127, 128, size).astype(np.int8),
            rng.integers(-900, 900, size[0]).astype(np.int32),
            np.full(size[0], 0.002, np.float32),
        )
        for name, size in sizes.items()
    }
    scales = dict.fromkeys([*inputs, *(node.name for node in nodes)], Quantisation(0.05, 3))
    network = IntegerNetwork(inputs, nodes, ("scores",), weights, scales)
    mean, deviation = np.zeros(length, np.float32), np.ones(length, np.float32)
    return CnnModel(("wave", "5", "none"), PatchSettings(16), network, 0.8, 12, contour, mean, deviation)


def test_your_own_model_and_grammar_take_the_place_of_the_shipped_ones(tmp_path):
    write_cnn_model(own_net_with_an_outline(), tmp_path / "own.npz")
    text = BUNDLED.read_text().replace("max_seconds = 600", "max_seconds = 500")
    (tmp_path / "own.toml").write_text(text)
    arguments = ["--model", str(tmp_path / "own.npz"), "--grammar", str(tmp_path / "own.toml")]
    assert main(["export", str(tmp_path / "out"), *arguments]) == 0
    net = json.loads((tmp_path / "out" / "cnn.json").read_text())
    assert net["classes"] == ["wave", "5", "none"]
    assert net["contour"]["directions"] == 8
    assert {item["name"] for item in net["inputs"]} == {"patch", "contour"}
    grammar = json.loads((tmp_path / "out" / "grammar.json").read_text())
    assert grammar["limits"]["max_seconds"] == 500


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_what_breaks_off_leaves_the_older_export_as_it_was(tmp_path, monkeypatch, error):
    out = tmp_path / "out"
    flat.write_folder(out, {**flat.FlatFiles().all_files()})
    before = (out / "manifest.json").read_bytes()
    original, written = Path.write_bytes, []

    def failing(path, content):
        written.append(path)
        if len(written) > 1:
            raise error
        return original(path, content)

    monkeypatch.setattr(Path, "write_bytes", failing)
    with pytest.raises((flat.UsageError, KeyboardInterrupt)):
        flat.write_folder(out, {"a": b"a", "b": b"b"})
    assert (out / "manifest.json").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


@pytest.mark.parametrize("error", [OSError(18, "Invalid cross-device link"), KeyboardInterrupt()])
def test_a_rename_that_fails_brings_the_older_export_back(tmp_path, monkeypatch, error):
    out = tmp_path / "out"
    flat.write_folder(out, flat.FlatFiles().all_files())
    before = (out / "manifest.json").read_bytes()
    original, asked = flat.os.rename, []

    def failing(source, target):
        asked.append(target)
        if len(asked) == 2:
            raise error
        original(source, target)

    monkeypatch.setattr(flat.os, "rename", failing)
    with pytest.raises((flat.UsageError, KeyboardInterrupt)):
        flat.write_folder(out, {"a": b"a"})
    assert (out / "manifest.json").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
