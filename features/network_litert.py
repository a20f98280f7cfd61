"""A network as a LiteRT model, written directly from its integers, and run by LiteRT (XNNPACK) in one thread."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.network import IntegerNetwork, Node, Quantisation, Shape, infer_shapes

Levels = NDArray[np.int8]

MODEL_VERSION = 3
"""Of the LiteRT schema."""
MOST_PLANNED = 16
"""Shapes of input that are kept ready: a folder of pictures of many sizes must not fill the memory."""
SAME = 0
"""The schema's number of this padding."""


class LiteRtRunner:
    """Runs a network; a model is built and planned once for each shape of input that comes."""

    def __init__(self, network: IntegerNetwork) -> None:
        """Raises ImportError without the package ai-edge-litert."""
        from ai_edge_litert import interpreter

        self._interpreter = interpreter.Interpreter
        self._network = network
        self._planned: dict[tuple[tuple[int, ...], ...], Any] = {}

    def run(self, inputs: Mapping[str, Levels]) -> dict[str, Levels]:
        """int8 (n, h, w, channels) for each input -> the same for each output."""
        network = self._network
        key = tuple(inputs[name].shape for name in network.inputs)
        planned = self._planned.pop(key, None) or self._plan(inputs)
        # The last is the one used last, so that the first can go.
        self._planned[key] = planned
        if len(self._planned) > MOST_PLANNED:
            del self._planned[next(iter(self._planned))]
        interpreter, places, results = planned
        for name, place in zip(network.inputs, places, strict=True):
            interpreter.set_tensor(place, inputs[name])
        interpreter.invoke()
        return {
            name: interpreter.get_tensor(place) for name, place in zip(network.outputs, results, strict=True)
        }

    def _plan(self, inputs: Mapping[str, Levels]) -> tuple[Any, list[int], list[int]]:
        shapes = {name: inputs[name].shape for name in self._network.inputs}
        batch = next(iter(shapes.values()))[0]
        sizes: dict[str, Shape] = {name: (shape[1], shape[2], shape[3]) for name, shape in shapes.items()}
        model = to_flatbuffer(self._network, sizes, batch)
        interpreter = self._interpreter(model_content=model, num_threads=1)
        interpreter.allocate_tensors()
        by_name = {item["name"]: item["index"] for item in interpreter.get_input_details()}
        results = {item["name"]: item["index"] for item in interpreter.get_output_details()}
        return (
            interpreter,
            [by_name[name] for name in self._network.inputs],
            [results[name] for name in self._network.outputs],
        )


def to_flatbuffer(network: IntegerNetwork, sizes: Mapping[str, Shape], batch: int = 1) -> bytes:
    """The network as a LiteRT model for inputs of these sizes. Needs ai-edge-litert; raises NetworkError."""
    import flatbuffers

    builder = flatbuffers.Builder(1024)
    builder.Finish(_Writer(network, sizes, batch).model().Pack(builder), b"TFL3")
    return bytes(builder.Output())


class _Writer:
    """Collects tensors, buffers and operators of one model."""

    def __init__(self, network: IntegerNetwork, sizes: Mapping[str, Shape], batch: int) -> None:
        from ai_edge_litert import schema_py_generated as schema

        self._schema: Any = schema
        self._network, self._batch = network, batch
        self._shapes = infer_shapes(sizes, network.nodes)
        self._sizes = sizes
        self._buffers: list[Any] = [schema.BufferT()]
        self._tensors: list[Any] = []
        self._operators: list[Any] = []
        self._codes: dict[int, int] = {}
        self._places: dict[str, int] = {}

    def model(self) -> Any:
        """The whole model as the schema's own object."""
        schema = self._schema
        for name in self._sizes:
            self._activation_tensor(name)
        for node in self._network.nodes:
            self._add_node(node)
        graph = schema.SubGraphT()
        graph.tensors, graph.operators = self._tensors, self._operators
        graph.inputs = [self._places[name] for name in self._sizes]
        graph.outputs = [self._places[name] for name in self._network.outputs]
        model = schema.ModelT()
        model.version, model.subgraphs, model.buffers = MODEL_VERSION, [graph], self._buffers
        model.operatorCodes = [self._operator_code(code) for code in self._codes]
        return model

    def _operator_code(self, code: int) -> Any:
        item = self._schema.OperatorCodeT()
        item.builtinCode, item.deprecatedBuiltinCode, item.version = code, min(code, 127), 3
        return item

    def _activation_tensor(self, name: str) -> int:
        height, width, channels = self._shapes[name]
        own = self._network.quantisation[name]
        self._places[name] = self._tensor(
            name, (self._batch, height, width, channels), self._schema.TensorType.INT8, None, own
        )
        return self._places[name]

    def _tensor(
        self,
        name: str,
        shape: tuple[int, ...],
        kind: int,
        data: NDArray[Any] | None,
        scale: Quantisation | tuple[NDArray[np.float32], int] | None,
    ) -> int:
        """Number of a new tensor. scale: of all of it, or (scales, axis) of each channel along an axis."""
        tensor = self._schema.TensorT()
        tensor.name, tensor.shape, tensor.type, tensor.buffer = name, list(shape), kind, 0
        if data is not None:
            buffer = self._schema.BufferT()
            buffer.data = np.frombuffer(np.ascontiguousarray(data).tobytes(), np.uint8)
            tensor.buffer = len(self._buffers)
            self._buffers.append(buffer)
        if scale is not None:
            tensor.quantization = self._quantisation(scale)
        self._tensors.append(tensor)
        return len(self._tensors) - 1

    def _quantisation(self, scale: Quantisation | tuple[NDArray[np.float32], int]) -> Any:
        item = self._schema.QuantizationParametersT()
        if isinstance(scale, Quantisation):
            item.scale = np.array([scale.scale], np.float32)
            item.zeroPoint = np.array([scale.zero], np.int64)
        else:
            item.scale, item.quantizedDimension = scale
            item.zeroPoint = np.zeros(len(item.scale), np.int64)
        return item

    def _add_node(self, node: Node) -> None:
        sources = [self._places[name] for name in node.inputs]
        if node.op == "upsample":
            height, width, _ = self._shapes[node.name]
            size = np.array([height, width], np.int32)
            sources.append(self._tensor(f"{node.name}/size", (2,), self._schema.TensorType.INT32, size, None))
        elif node.op != "add":
            sources += self._weight_tensors(node)
        code, kind, options = self._options(node)
        operator = self._schema.OperatorT()
        operator.opcodeIndex = self._codes.setdefault(code, len(self._codes))
        operator.inputs, operator.outputs = sources, [self._activation_tensor(node.name)]
        operator.builtinOptionsType, operator.builtinOptions = kind, options
        self._operators.append(operator)

    def _weight_tensors(self, node: Node) -> list[int]:
        own, kinds = self._network.weights[node.name], self._schema.TensorType
        axis = 3 if node.op == "depthwise" else 0
        shape = own.weights.shape
        weights = self._tensor(f"{node.name}/weights", shape, kinds.INT8, own.weights, (own.scales, axis))
        scales = (own.scales * np.float32(self._network.quantisation[node.inputs[0]].scale)).astype(
            np.float32
        )
        biases = self._tensor(f"{node.name}/biases", own.biases.shape, kinds.INT32, own.biases, (scales, 0))
        return [weights, biases]

    def _options(self, node: Node) -> tuple[int, int, Any]:
        """The operator's number, the kind of its options and the options."""
        schema = self._schema
        codes, kinds = schema.BuiltinOperator, schema.BuiltinOptions
        functions = schema.ActivationFunctionType
        activation = functions.RELU6 if node.activation == "relu6" else functions.NONE
        if node.op == "upsample":
            options = schema.ResizeNearestNeighborOptionsT()
            return codes.RESIZE_NEAREST_NEIGHBOR, kinds.ResizeNearestNeighborOptions, options
        if node.op == "add":
            options, code, kind = schema.AddOptionsT(), codes.ADD, kinds.AddOptions
        elif node.op == "dense":
            options, code, kind = (
                schema.FullyConnectedOptionsT(),
                codes.FULLY_CONNECTED,
                kinds.FullyConnectedOptions,
            )
        else:
            code, kind, options = self._convolution(node)
        options.fusedActivationFunction = activation
        return code, kind, options

    def _convolution(self, node: Node) -> tuple[int, int, Any]:
        codes, kinds = self._schema.BuiltinOperator, self._schema.BuiltinOptions
        if node.op == "depthwise":
            options, code, kind = (
                self._schema.DepthwiseConv2DOptionsT(),
                codes.DEPTHWISE_CONV_2D,
                kinds.DepthwiseConv2DOptions,
            )
            options.depthMultiplier = 1
        else:
            options, code, kind = self._schema.Conv2DOptionsT(), codes.CONV_2D, kinds.Conv2DOptions
        options.strideH = options.strideW = node.stride
        options.dilationHFactor = options.dilationWFactor = 1
        options.padding = SAME
        return code, kind, options
