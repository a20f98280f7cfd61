"""The file of LiteRT that a network is written to, read by LiteRT's own schema."""

import numpy as np
import pytest

from lightgesture.features.find.selector_file import load_learned
from lightgesture.features.net.flatbuffer import network_arrays, to_flatbuffer
from lightgesture.features.net.network import Quantisation


@pytest.fixture(scope="module")
def schema():
    return pytest.importorskip("ai_edge_litert.schema_py_generated")


@pytest.fixture(scope="module")
def network():
    """The bundled locator, which has every operation but `dense`."""
    return load_learned(None).locator


@pytest.fixture(scope="module")
def model(schema, network):
    content, _ = to_flatbuffer(network)
    assert content[4:8] == b"TFL3"
    return schema.ModelT.InitFromObj(schema.Model.GetRootAs(content, 0))


@pytest.fixture(scope="module")
def graph(model):
    (graph,) = model.subgraphs
    return graph


def names(graph, numbers):
    return [graph.tensors[number].name.decode() for number in numbers]


def test_what_goes_in_and_out(graph, network):
    assert names(graph, graph.inputs) == list(network.inputs)
    assert names(graph, graph.outputs) == list(network.outputs)
    assert list(graph.tensors[graph.inputs[0]].shape) == [1, *network.inputs["picture"]]


def test_each_node_is_an_operator_with_its_options(schema, model, graph, network):
    codes, kinds = schema.BuiltinOperator, schema.ActivationFunctionType
    expected = {
        "conv": (codes.CONV_2D, schema.Conv2DOptionsT),
        "depthwise": (codes.DEPTHWISE_CONV_2D, schema.DepthwiseConv2DOptionsT),
        "dense": (codes.FULLY_CONNECTED, schema.FullyConnectedOptionsT),
        "add": (codes.ADD, schema.AddOptionsT),
        "upsample": (codes.RESIZE_NEAREST_NEIGHBOR, schema.ResizeNearestNeighborOptionsT),
    }
    assert len(graph.operators) == len(network.nodes)
    for node, operator in zip(network.nodes, graph.operators, strict=True):
        code = model.operatorCodes[operator.opcodeIndex]
        options = operator.builtinOptions
        assert (code.builtinCode, code.version) == (expected[node.op][0], 3)
        assert type(options) is expected[node.op][1]
        assert names(graph, operator.inputs)[: len(node.inputs)] == list(node.inputs)
        assert names(graph, operator.outputs) == [node.name]
        if node.op != "upsample":
            wanted = kinds.RELU6 if node.activation == "relu6" else kinds.NONE
            assert options.fusedActivationFunction == wanted
        if node.op in ("conv", "depthwise"):
            assert (options.padding, options.strideH, options.strideW) == (0, node.stride, node.stride)
            assert (options.dilationHFactor, options.dilationWFactor) == (1, 1)


def test_weights_and_scales_are_those_of_the_network(schema, model, graph, network):
    tensors = {tensor.name.decode(): tensor for tensor in graph.tensors}
    for name, own in network.weights.items():
        tensor = tensors[f"{name}/weights"]
        assert tensor.type == schema.TensorType.INT8
        assert tuple(tensor.shape) == own.weights.shape
        np.testing.assert_array_equal(
            np.asarray(model.buffers[tensor.buffer].data, np.uint8).view(np.int8), own.weights.ravel()
        )
        np.testing.assert_array_equal(tensor.quantization.scale, own.scales)
    for name, quantisation in network.quantisation.items():
        (scale,), (zero,) = tensors[name].quantization.scale, tensors[name].quantization.zeroPoint
        assert Quantisation(np.float32(quantisation.scale), quantisation.zero) == Quantisation(scale, zero)


def test_the_shipped_file_is_what_the_writer_makes_of_its_numbers(network):
    (layout, content) = network_arrays("n", network).values()
    assert content.tobytes() == network.litert.content
    assert b'"sha256"' in layout.tobytes()


def test_the_places_are_where_the_arrays_stand(network):
    content, places = to_flatbuffer(network)
    for name, own in network.weights.items():
        for kind in ("weights", "biases", "scales"):
            expected = getattr(own, kind).tobytes()
            place = places[f"{name}/{kind}"]
            assert content[place : place + len(expected)] == expected
    doubled = [node.name for node in network.nodes if node.op == "upsample"]
    assert sorted(places) == sorted(
        [f"{name}/{kind}" for name in network.weights for kind in ("weights", "biases", "scales")]
        + [f"{name}/size" for name in doubled]
    )
