"""A network as a `.tflite` file of LiteRT, a FlatBuffer, written table by table from its integers.

LiteRT brings a module that could do it, but its 1,100 classes take four megabytes. The nets need five operators and
seven other tables. Numbers of fields and codes are those of LiteRT's `schema.fbs`, which may add to them and never
change them.
"""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.file import BIASES, LAYOUT, SCALES, SIZE, TFLITE, WEIGHTS
from lightgesture.features.net.network import IntegerNetwork, LiteRtFile, Node, Quantisation, infer_shapes

FILE_KIND = b"TFL3"
MODEL_VERSION = 3
OPERATOR_VERSION = 3
"""The first version that takes int8 for all of the operators below."""
INT32, INT8 = 2, 9
"""Types of tensors."""
ACTIVATIONS = {"relu6": 3}
"""Functions that an operator ends with; 0 is none."""

Field = tuple[int, str, int]
"""Number of a field in its table, its type, its value."""


@dataclass(frozen=True, slots=True)
class _Operator:
    """code: of the operator. options, fields: kind of its table of options, and how many fields that has.
    stride, multiplier, activation: numbers of its fields, None where it has no such one."""

    code: int
    options: int
    fields: int
    stride: tuple[int, int] | None = None
    multiplier: int | None = None
    activation: int | None = None


_OPERATORS = {
    "conv": _Operator(code=3, options=1, fields=7, stride=(1, 2), activation=3),
    "depthwise": _Operator(code=4, options=2, fields=7, stride=(1, 2), multiplier=3, activation=4),
    "dense": _Operator(code=9, options=8, fields=6, activation=0),
    "add": _Operator(code=0, options=11, fields=2, activation=0),
    "upsample": _Operator(code=97, options=74, fields=2),
}


def with_litert(network: IntegerNetwork) -> IntegerNetwork:
    """The network with its `.tflite` file, so that LiteRT can run it."""
    return replace(network, litert=to_litert(network))


def to_litert(network: IntegerNetwork) -> LiteRtFile:
    """The `.tflite` file of a network. Needs the package flatbuffers."""
    content, places = to_flatbuffer(network)
    sizes = {node.name: places[f"{node.name}/{SIZE}"] for node in network.nodes if node.op == "upsample"}
    return LiteRtFile(content, sizes)


def network_arrays(prefix: str, network: IntegerNetwork) -> dict[str, NDArray[Any]]:
    """All that a network holds, as the two members of an archive that `features.net.file.network_from` reads."""
    content, places = to_flatbuffer(network)
    layout = {
        "inputs": {name: list(shape) for name, shape in network.inputs.items()},
        "outputs": list(network.outputs),
        "nodes": [asdict(node) for node in network.nodes],
        "quantisation": {name: [item.scale, item.zero] for name, item in network.quantisation.items()},
        "places": places,
        "sha256": hashlib.sha256(content).hexdigest(),
    }
    members = {LAYOUT: json.dumps(layout).encode(), TFLITE: content}
    return {f"{prefix}_{end}": np.frombuffer(data, np.uint8) for end, data in members.items()}


def to_flatbuffer(network: IntegerNetwork) -> tuple[bytes, dict[str, int]]:
    """The network as a LiteRT model for one picture of each input, of the training's size, and where its arrays are.

    Places are bytes from the start, by "node/weights", "node/biases", "node/scales" (of the weights) and, of a node
    that doubles a map, "node/size". Needs the package flatbuffers.
    """
    return _Writer(network).model()


class _Writer:
    """Writes tensors, buffers and operators of one model as they come, and then the tables that list them."""

    def __init__(self, network: IntegerNetwork) -> None:
        import flatbuffers

        self._builder: Any = flatbuffers.Builder(1 << 16)
        self._network = network
        self._shapes = infer_shapes(network.inputs, network.nodes)
        self._buffers = [self._table(3)]  # the first is that of tensors without data
        self._tensors: list[int] = []
        self._operators: list[int] = []
        self._codes: dict[int, int] = {}
        self._number_of: dict[str, int] = {}
        self._kept: dict[str, int] = {}

    def model(self) -> tuple[bytes, dict[str, int]]:
        """The whole model, and at which byte of it each array that is kept begins."""
        for name in self._network.inputs:
            self._activation_tensor(name)
        for node in self._network.nodes:
            self._add_node(node)
        codes = [self._operator_code(code) for code in self._codes]
        graph = self._table(
            6,
            (0, "Offset", self._tables(self._tensors)),
            (1, "Offset", self._numbers([self._number_of[name] for name in self._network.inputs])),
            (2, "Offset", self._numbers([self._number_of[name] for name in self._network.outputs])),
            (3, "Offset", self._tables(self._operators)),
        )
        model = self._table(
            10,
            (0, "Uint32", MODEL_VERSION),
            (1, "Offset", self._tables(codes)),
            (2, "Offset", self._tables([graph])),
            (4, "Offset", self._tables(self._buffers)),
        )
        self._builder.Finish(model, FILE_KIND)
        content = bytes(self._builder.Output())
        # The builder counts from the end; a list begins with its length, four bytes.
        return content, {name: len(content) - offset + 4 for name, offset in self._kept.items()}

    def _table(self, size: int, *fields: Field) -> int:
        """Place of a new table of `size` fields; those that are left out have the schema's own values."""
        builder = self._builder
        puts = {
            "Int8": builder.PrependInt8Slot,
            "Uint8": builder.PrependUint8Slot,
            "Int32": builder.PrependInt32Slot,
            "Uint32": builder.PrependUint32Slot,
            "Offset": builder.PrependUOffsetTRelativeSlot,
        }
        builder.StartObject(size)
        for number, kind, value in fields:
            puts[kind](number, value, 0)
        return int(builder.EndObject())

    def _tables(self, places: Sequence[int]) -> int:
        """Place of a new list of tables."""
        self._builder.StartVector(4, len(places), 4)
        for place in reversed(places):
            self._builder.PrependUOffsetTRelative(place)
        return int(self._builder.EndVector())

    def _numbers(self, numbers: Sequence[int] | NDArray[Any], kind: type[np.generic] = np.int32) -> int:
        """Place of a new list of numbers."""
        return int(self._builder.CreateNumpyVector(np.asarray(numbers, kind)))

    def _operator_code(self, code: int) -> int:
        return self._table(4, (0, "Int8", code), (2, "Int32", OPERATOR_VERSION), (3, "Int32", code))

    def _activation_tensor(self, name: str) -> int:
        self._number_of[name] = self._tensor(
            name, (1, *self._shapes[name]), INT8, None, self._network.quantisation[name]
        )
        return self._number_of[name]

    def _tensor(
        self,
        name: str,
        shape: tuple[int, ...],
        kind: int,
        data: NDArray[Any] | None,
        scale: Quantisation | tuple[NDArray[np.float32], int] | None,
    ) -> int:
        """Number of a new tensor. scale: of all of it, or (scales, axis) of each channel along an axis."""
        fields = [
            (0, "Offset", self._numbers(shape)),
            (1, "Int8", kind),
            (3, "Offset", int(self._builder.CreateString(name))),
        ]
        if data is not None:
            content = np.frombuffer(np.ascontiguousarray(data).tobytes(), np.uint8)
            fields.append((2, "Uint32", len(self._buffers)))
            self._kept[name] = self._numbers(content, np.uint8)
            self._buffers.append(self._table(3, (0, "Offset", self._kept[name])))
        if scale is not None:
            fields.append((4, "Offset", self._quantisation(name, scale)))
        self._tensors.append(self._table(11, *fields))
        return len(self._tensors) - 1

    def _quantisation(self, name: str, scale: Quantisation | tuple[NDArray[np.float32], int]) -> int:
        if isinstance(scale, Quantisation):
            scales, zeros, axis = np.array([scale.scale]), np.array([scale.zero]), 0
        else:
            scales, axis = scale
            zeros = np.zeros(len(scales))
        offset = self._numbers(scales, np.float32)
        if name.endswith(f"/{WEIGHTS}"):
            self._kept[f"{name.removesuffix(WEIGHTS)}{SCALES}"] = offset
        return self._table(
            7,
            (2, "Offset", offset),
            (3, "Offset", self._numbers(zeros, np.int64)),
            (6, "Int32", axis),
        )

    def _add_node(self, node: Node) -> None:
        sources = [self._number_of[name] for name in node.inputs]
        if node.op == "upsample":
            height, width, _ = self._shapes[node.name]
            size = np.array([height, width], np.int32)
            sources.append(self._tensor(f"{node.name}/{SIZE}", (2,), INT32, size, None))
        elif node.op != "add":
            sources += self._weight_tensors(node)
        operator = _OPERATORS[node.op]
        fields = [
            (0, "Uint32", self._codes.setdefault(operator.code, len(self._codes))),
            (1, "Offset", self._numbers(sources)),
            (2, "Offset", self._numbers([self._activation_tensor(node.name)])),
            (3, "Uint8", operator.options),
            (4, "Offset", self._options(node, operator)),
        ]
        self._operators.append(self._table(14, *fields))

    def _weight_tensors(self, node: Node) -> list[int]:
        own = self._network.weights[node.name]
        axis = 3 if node.op == "depthwise" else 0
        weights = self._tensor(
            f"{node.name}/{WEIGHTS}", own.weights.shape, INT8, own.weights, (own.scales, axis)
        )
        entering = np.float32(self._network.quantisation[node.inputs[0]].scale)
        scales = (own.scales * entering).astype(np.float32)
        biases = self._tensor(f"{node.name}/{BIASES}", own.biases.shape, INT32, own.biases, (scales, 0))
        return [weights, biases]

    def _options(self, node: Node, operator: _Operator) -> int:
        """Place of the operator's options. Padding is 0, SAME, and dilation 1, as in the schema."""
        fields: list[Field] = []
        if operator.stride is not None:
            fields += [(number, "Int32", node.stride) for number in operator.stride]
        if operator.multiplier is not None:
            fields.append((operator.multiplier, "Int32", 1))
        if operator.activation is not None:
            fields.append((operator.activation, "Int8", ACTIVATIONS.get(node.activation or "", 0)))
        return self._table(operator.fields, *fields)
