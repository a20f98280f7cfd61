"""Integer networks: both run-times agree to a step, files come back whole, what does not fit is refused."""

import hashlib
import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.features.find.selector_file import load_learned
from lightgesture.features.net.file import check_network, network_from
from lightgesture.features.net.flatbuffer import network_arrays, to_litert, with_litert
from lightgesture.features.net.network import (
    WEIGHTED,
    IntegerNetwork,
    LiteRtFile,
    NetworkError,
    Node,
    Quantisation,
    Weights,
    infer_shapes,
    weight_shape,
)
from lightgesture.features.net.runner import MOST_PLANNED, LiteRtRunner, Network
from tests.models.test_cnn import random_model

NODES = (
    Node("stem", "conv", ("x",), 8, 3, 2, "relu6"),
    Node("wide", "depthwise", ("stem",), 0, 5, 1, "relu6"),
    Node("point", "conv", ("wide",), 8),
    Node("sum", "add", ("stem", "point"), activation="relu6"),
    Node("coarse", "conv", ("sum",), 12, 3, 2),
    Node("up", "upsample", ("coarse",)),
    Node("side", "conv", ("sum",), 12),
    Node("maps", "add", ("side", "up")),
    Node("hidden", "dense", ("maps",), 16, activation="relu6"),
    Node("end", "dense", ("hidden",), 5),
)
SHAPE = (16, 20, 3)


def random_network(seed, nodes=NODES, outputs=("maps", "end"), shape=SHAPE):
    """A network of every operation with random integers whose outputs use most of their range."""
    rng = np.random.default_rng(seed)
    shapes = infer_shapes({"x": shape}, nodes)
    scales, weights = {"x": Quantisation(0.02, 3)}, {}
    for node in nodes:
        if node.op == "upsample":
            scales[node.name] = scales[node.inputs[0]]
        elif node.activation == "relu6":
            scales[node.name] = Quantisation(6 / 255, -128)
        else:
            scales[node.name] = Quantisation(float(rng.uniform(0.03, 0.1)), int(rng.integers(-30, 30)))
        if node.op in WEIGHTED:
            size, channels = weight_shape(node, shapes[node.inputs[0]]), shapes[node.name][2]
            levels = rng.integers(-127, 128, size).astype(np.int8)
            taps = levels.size / channels
            spread = 6 / (np.sqrt(taps) * 70 * 90 * scales[node.inputs[0]].scale)
            factors = (rng.uniform(0.5, 2, channels) * spread).astype(np.float32)
            weights[node.name] = Weights(
                levels, rng.integers(-3000, 3000, channels).astype(np.int32), factors
            )
    network = IntegerNetwork({"x": shape}, tuple(nodes), tuple(outputs), weights, scales)
    check_network(network)
    return with_litert(network)


def _input(seed, count, shape=SHAPE):
    return {"x": np.random.default_rng(seed).integers(-128, 128, (count, *shape)).astype(np.int8)}


LAYERS = {
    "conv": (Node("y", "conv", ("x",), 7, 3, 2, "relu6"),),
    "point": (Node("y", "conv", ("x",), 9),),
    "depthwise": (Node("y", "depthwise", ("x",), 0, 5, 1),),
    "dense": (Node("y", "dense", ("x",), 6, activation="relu6"),),
    "upsample": (Node("y", "upsample", ("x",)),),
    "add": (Node("y", "add", ("x", "x"), activation="relu6"),),
}


def _steps(network, inputs, name):
    """Differences of both run-times in steps of the output's scale."""
    fast, slow = (Network(network, backend).run(inputs)[name].ravel() for backend in ("litert", "numpy"))
    return np.abs(fast - slow) / network.quantisation[name].scale


@pytest.mark.parametrize("layer", LAYERS)
@given(seed=st.integers(0, 10_000), count=st.sampled_from([1, 3]))
@settings(max_examples=10, deadline=None)
def test_a_layer_differs_by_a_step_at_most_between_the_run_times(layer, seed, count):
    pytest.importorskip("ai_edge_litert")
    # XNNPACK multiplies by a rounded float where the reference has 31 bits, so a tie may fall to the other side; an
    # addition, which scales both of its operands so, has the most of them.
    steps = _steps(random_network(seed, LAYERS[layer], ("y",)), _input(seed, count), "y")
    assert steps.max() < 1.5
    assert (steps > 0.5).mean() < (0.1 if layer == "add" else 0.02)


@pytest.mark.parametrize("seed", [0, 1, 2, 477])
def test_both_run_times_agree_through_many_layers(seed):
    pytest.importorskip("ai_edge_litert")
    network = random_network(seed)
    steps = _steps(network, _input(seed, 3), "maps")
    assert steps.max() < 6.5
    assert (steps > 0.5).mean() < 0.02


def test_a_net_without_dense_layers_takes_pictures_of_any_size():
    pytest.importorskip("ai_edge_litert")
    network = random_network(5, NODES[:8], ("maps",))
    runners = [Network(network, backend) for backend in ("litert", "numpy")]
    for shape in ((16, 20, 3), (32, 24, 3), (8, 8, 3), (16, 20, 3)):
        fast, slow = (runner.run(_input(1, 1, shape))["maps"] for runner in runners)
        np.testing.assert_allclose(fast, slow, atol=6.5 * network.quantisation["maps"].scale)


def test_any_number_of_pictures_goes_through_one_plan_to_what_each_gives_alone():
    pytest.importorskip("ai_edge_litert")
    runner = LiteRtRunner(random_network(3))
    pictures = _input(4, 5)["x"]
    together = runner.run({"x": pictures})
    for place in range(len(pictures)):
        alone = runner.run({"x": pictures[place : place + 1]})
        for name in together:
            np.testing.assert_array_equal(together[name][place : place + 1], alone[name])
    assert runner.planned == 1


def test_pictures_of_many_sizes_keep_a_bounded_number_of_plans():
    pytest.importorskip("ai_edge_litert")
    runner = LiteRtRunner(random_network(5, NODES[:8], ("maps",)))
    for side in range(2, 2 + MOST_PLANNED + 3):
        runner.run(_input(0, 1, (4 * side, 8, 3)))
    assert runner.planned == MOST_PLANNED


def test_a_network_survives_its_arrays():
    network = random_network(1)
    copy = network_from(network_arrays("n", network), "n")
    assert (copy.nodes, copy.outputs, dict(copy.quantisation)) == (
        network.nodes,
        network.outputs,
        dict(network.quantisation),
    )
    inputs = _input(0, 2)
    first, second = (Network(one, "numpy").run(inputs) for one in (network, copy))
    np.testing.assert_array_equal(first["end"], second["end"])


@pytest.mark.parametrize(
    ("node", "reason"),
    [
        (Node("bad", "pickle", ("x",)), "unknown operation"),
        (Node("bad", "conv", ("later",), 4), "later"),
        (Node("stem", "conv", ("x",), 4), "stem"),
        (Node("bad", "conv", ("x",), 4, 99), "bad"),
        (Node("bad", "conv", ("x",), 10**6), "bad"),
        (Node("bad", "add", ("x", "stem")), "do not fit"),
        (Node("bad", "conv", ("x",), 4, activation="tanh"), "tanh"),
        (Node("../bad", "conv", ("x",), 4), "name"),
    ],
)
def test_a_node_that_does_not_fit_is_refused_in_one_line(node, reason):
    with pytest.raises(NetworkError, match=reason) as caught:
        infer_shapes({"x": SHAPE}, [NODES[0], node])
    assert "\n" not in str(caught.value)


def _layout(network, change):
    """The members of a network whose layout was changed."""
    arrays = network_arrays("n", network)
    layout = json.loads(arrays["n_layout"].tobytes())
    change(layout)
    return {**arrays, "n_layout": np.frombuffer(json.dumps(layout).encode(), np.uint8)}


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda layout: layout.clear(), "sha256"),
        (lambda layout: layout.update(sha256="0" * 64), "belongs to another"),
        (lambda layout: layout["places"].pop("stem/weights"), "stem/weights"),
        (lambda layout: layout["places"].update({"stem/weights": 10**9}), "no valid network"),
        (lambda layout: layout["places"].update({"stem/weights": -1}), "no valid network"),
        (lambda layout: layout["places"].update({"stem/weights": "x"}), "no valid network"),
        (lambda layout: layout["places"].update({"up/size": 0}), "does not stand where"),
        (lambda layout: layout["places"].update({"stem/scales": layout["places"]["stem/weights"]}), "stem"),
        (lambda layout: layout["nodes"][0].update(channels=9), "do not fit add"),
        (lambda layout: layout["nodes"][0].update(op="pickle"), "unknown operation"),
        (lambda layout: layout["quantisation"].pop("x"), "x"),
        (lambda layout: layout["quantisation"].update(x=[0.0, 3]), "x: scale 0.0"),
        (lambda layout: layout.update(nodes=3), "no valid network"),
    ],
)
def test_a_layout_that_is_none_is_refused_in_one_line(change, reason):
    with pytest.raises(NetworkError, match=reason) as caught:
        network_from(_layout(random_network(0), change), "n")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "array"),
    [
        ("n_layout", np.frombuffer(b'{"nodes": 3}', np.uint8)),
        ("n_layout", np.frombuffer(b"[" * 100_000, np.uint8)),
        ("n_layout", np.zeros(10**6, np.uint8)),
        ("n_tflite", np.zeros(3, np.float32)),
        ("n_tflite", np.zeros(30, np.uint8)),
    ],
)
def test_members_that_are_no_network_are_refused_in_one_line(name, array):
    arrays = {**network_arrays("n", random_network(0)), name: array}
    with pytest.raises(NetworkError) as caught:
        network_from(arrays, "n")
    assert "\n" not in str(caught.value)


def test_a_scale_that_is_no_number_is_refused():
    network = random_network(0)
    spoilt = replace(network.weights["stem"], scales=np.full(8, np.nan, np.float32))
    with pytest.raises(NetworkError, match="stem"):
        check_network(replace(network, weights={**network.weights, "stem": spoilt}))


def test_a_file_that_lite_rt_does_not_take_is_refused_in_one_line():
    pytest.importorskip("ai_edge_litert")
    network, other = random_network(0), random_network(0, NODES[:8], ("maps",))
    for file in (LiteRtFile(bytes(1000), {}), LiteRtFile(network.litert.content[:2000], {}), other.litert):
        with pytest.raises(NetworkError, match="does not take") as caught:
            Network(replace(network, litert=file), "litert")
        assert "\n" not in str(caught.value)


def test_a_network_without_a_file_runs_on_the_reference_alone():
    network = replace(random_network(2), litert=None)
    assert Network(network).run(_input(0, 1))["end"].size == 5
    with pytest.raises(NetworkError, match=r"no \.tflite"):
        Network(network, "litert")


def test_without_lite_rt_the_reference_runs_and_a_wish_for_it_is_told(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "ai_edge_litert", None)
    network = random_network(2)
    assert Network(network, "auto").run(_input(0, 1))["end"].size == 5
    with pytest.raises(NetworkError, match="pip install ai-edge-litert"):
        Network(network, "litert")
    with pytest.raises(NetworkError, match="must be auto, litert or numpy"):
        Network(network, "tflite")


def test_a_trained_network_and_its_integers_nearly_agree():
    torch = pytest.importorskip("torch")
    from lightgesture.training.nets.quantise import quantise
    from lightgesture.training.nets.torch_network import TorchNetwork

    torch.manual_seed(0)
    module = TorchNetwork({"x": SHAPE}, NODES, ("maps", "end"))
    batch = torch.rand(32, 3, 16, 20) * 2 - 1
    for _ in range(20):
        module({"x": batch})
    network = quantise(module, [{"x": batch}], {"x": (-1.0, 1.0)})
    runner = Network(network, "numpy")
    found = runner.run({"x": runner.table("x", batch.permute(0, 2, 3, 1).numpy())})
    with torch.no_grad():
        expected = module({"x": batch})["maps"].permute(0, 2, 3, 1).numpy()
    step = network.quantisation["maps"].scale
    assert np.abs(found["maps"] - expected).mean() < 3 * step


@pytest.mark.parametrize(
    ("place", "word"),
    [
        (16, 0),
        (140, 1),
        (232, 0x100),
        (440, 0xFFFFFFFF),
        (772, 0),
        (792, 0x100),
        (800, 0x100),
        (824, 1 << 31),
    ],
)
def test_tables_of_a_foreign_file_never_reach_litert(place, word):
    """Each of these words made LiteRT end the process."""
    pytest.importorskip("ai_edge_litert")
    arrays = network_arrays("net", random_model(3, has_outline=True).network)
    content = bytearray(arrays["net_tflite"].tobytes())
    content[place : place + 4] = word.to_bytes(4, "little")
    layout = json.loads(arrays["net_layout"].tobytes()) | {"sha256": hashlib.sha256(content).hexdigest()}
    foreign = {
        "net_layout": np.frombuffer(json.dumps(layout).encode(), np.uint8),
        "net_tflite": np.frombuffer(bytes(content), np.uint8),
    }
    with pytest.raises(NetworkError, match="does not take"):
        Network(network_from(foreign, "net"), "litert")


@pytest.mark.parametrize("net", ["locator", "refiner"])
def test_what_is_written_anew_of_a_bundled_net_is_its_file(net):
    network = getattr(load_learned(None), net)
    assert to_litert(network).content == network.litert.content
