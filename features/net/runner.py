"""A network made ready to run: by LiteRT (XNNPACK) in one thread where it is installed, else by the NumPy reference."""

import math
import struct
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Final, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.network import (
    IntegerNetwork,
    LiteRtFile,
    NetworkError,
    Quantisation,
    Shape,
    infer_shapes,
)
from lightgesture.features.net.reference import NumpyRunner
from lightgesture.features.types import Float

Levels = NDArray[np.int8]
Backend = Literal["auto", "litert", "numpy"]

MOST_PLANNED: Final = 16
"""Sizes of input that are kept ready: a folder of pictures of many sizes must not fill the memory."""


def quantise(values: NDArray[np.floating], quantisation: Quantisation) -> NDArray[np.int8]:
    """Nearest integers, clipped to int8."""
    levels = np.rint(np.asarray(values) * np.float32(1.0 / quantisation.scale)) + quantisation.zero
    return np.asarray(np.clip(levels, -128, 127), np.int8)


def dequantise(levels: NDArray[np.int8], quantisation: Quantisation) -> Float:
    """What the integers stand for."""
    return (levels.astype(np.float32) - np.float32(quantisation.zero)) * np.float32(quantisation.scale)


def logistic(logits: Float) -> Float:
    """Probabilities of the logits that a net gives: 1 / (1 + exp(-x))."""
    return np.asarray(1.0 / (1.0 + np.exp(-logits)), np.float32)


class Runner(Protocol):
    """What computes the integers."""

    def run(self, inputs: Mapping[str, Levels]) -> dict[str, Levels]: ...


class Network:
    """A network with its run-time; values in, values out."""

    def __init__(self, network: IntegerNetwork, backend: Backend = "auto") -> None:
        """backend: "litert", "numpy", or "auto" for LiteRT where it is installed and the network has its file, else
        NumPy. Raises NetworkError."""
        self._network = network
        self._runner = _runner(network, backend)

    @property
    def backend(self) -> Backend:
        """What runs it: "litert" or "numpy"."""
        return "numpy" if isinstance(self._runner, NumpyRunner) else "litert"

    def table(self, name: str, values: NDArray[np.floating]) -> Levels:
        """Values of an input as its integers."""
        return quantise(values, self._network.quantisation[name])

    def quantisation(self, name: str) -> Quantisation:
        """Which integers stand for the values of an input."""
        return self._network.quantisation[name]

    def zero(self, name: str) -> int:
        """The integer that stands for the value 0 of an input."""
        return self._network.quantisation[name].zero

    def run(self, inputs: Mapping[str, Levels]) -> dict[str, Float]:
        """Integers (n, h, w, channels) for each input -> values, float32, of each output."""
        outputs = self._runner.run(inputs)
        return {
            name: dequantise(levels, self._network.quantisation[name]) for name, levels in outputs.items()
        }


class LiteRtRunner:
    """Runs the network's `.tflite` file, once it is seen to be what would be written of the network, planned once for
    each size of picture that comes.

    Plans are for one picture, and several go through one after the other: at the sizes here, a plan for each number of
    pictures would take half a megabyte, and 3 ms of the frame in which that number comes first, to save 4 µs a picture.
    """

    def __init__(self, network: IntegerNetwork) -> None:
        """Raises ImportError without the package ai-edge-litert, NetworkError for a file that it does not take."""
        from ai_edge_litert import interpreter

        from lightgesture.features.net.flatbuffer import to_litert

        if network.litert is None:
            raise NetworkError("the network has no .tflite file, which LiteRT needs; run it with NumPy")
        self._interpreter = interpreter.Interpreter
        # Written anew of integers that were checked, two milliseconds a net: LiteRT reads and writes beyond its memory
        # where a table of the file is not as it should be, and a model may come from anybody.
        written = to_litert(network)
        if written.content != network.litert.content:
            raise NetworkError(
                "LiteRT does not take the .tflite file (it is another than its layout describes); train it again"
            )
        # Equal bytes are held once.
        self._network, self._file = network, replace(written, content=network.litert.content)
        # Every net but the locator before a camera of another shape sees no other size than its training's.
        self._planned = {tuple(network.inputs.values()): self._plan(dict(network.inputs))}

    @property
    def planned(self) -> int:
        """Number of sizes that are ready."""
        return len(self._planned)

    def run(self, inputs: Mapping[str, Levels]) -> dict[str, Levels]:
        """int8 (n, h, w, channels) for each input -> the same for each output, n being 1 or more."""
        network = self._network
        interpreter, places, results = self._plan_for(inputs)
        pictures = [inputs[name] for name in network.inputs]
        found: dict[str, list[Levels]] = {name: [] for name in network.outputs}
        for number in range(len(pictures[0])):
            for place, levels in zip(places, pictures, strict=True):
                interpreter.set_tensor(place, levels[number : number + 1])
            interpreter.invoke()
            for name, place in zip(network.outputs, results, strict=True):
                found[name].append(interpreter.get_tensor(place))
        return {name: np.concatenate(levels) for name, levels in found.items()}

    def _plan_for(self, inputs: Mapping[str, Levels]) -> tuple[Any, list[int], list[int]]:
        sizes: dict[str, Shape] = {name: inputs[name].shape[1:] for name in self._network.inputs}
        key = tuple(sizes.values())
        planned = self._planned.pop(key, None) or self._plan(sizes)
        # The last is the one used last, so that the first can go.
        self._planned[key] = planned
        if len(self._planned) > MOST_PLANNED:
            del self._planned[next(iter(self._planned))]
        return planned

    def _plan(self, sizes: dict[str, Shape]) -> tuple[Any, list[int], list[int]]:
        """The interpreter, ready for inputs of these sizes, and the numbers of its inputs and outputs."""
        network = self._network
        shapes = infer_shapes(sizes, network.nodes)
        is_trained_size = sizes == network.inputs
        content = self._file.content if is_trained_size else _resized(self._file, shapes)
        try:
            interpreter = self._interpreter(model_content=content, num_threads=1)
            if not is_trained_size:
                for item in interpreter.get_input_details():
                    interpreter.resize_tensor_input(item["index"], (1, *sizes[item["name"]]))
            interpreter.allocate_tensors()
            inputs = self._numbers(interpreter.get_input_details(), tuple(sizes), shapes)
            outputs = self._numbers(interpreter.get_output_details(), network.outputs, shapes)
        except (KeyError, RuntimeError, ValueError) as error:
            reason = " ".join(str(error).split())
            raise NetworkError(f"LiteRT does not take the .tflite file ({reason}); train it again") from error
        return interpreter, inputs, outputs

    def _numbers(
        self, details: list[dict[str, Any]], names: tuple[str, ...], shapes: Mapping[str, Shape]
    ) -> list[int]:
        """LiteRT's numbers of these tensors. Raises ValueError where the file has others than the layout."""
        found = {item["name"]: item for item in details}
        for name in names:
            item, expected = found[name], self._network.quantisation[name]
            # A dense layer's output has no height and width of its own.
            own = int(np.prod(item["shape"])), item["dtype"], item["quantization"]
            if own != (math.prod(shapes[name]), np.int8, (np.float32(expected.scale), expected.zero)):
                raise ValueError(f"its {name} is another than the layout's")
        return [int(found[name]["index"]) for name in names]


def _resized(file: LiteRtFile, shapes: Mapping[str, Shape]) -> bytes:
    """The `.tflite` with the heights and widths that doubled maps have at these shapes."""
    content = bytearray(file.content)
    for name, place in file.sizes.items():
        struct.pack_into("<2i", content, place, *shapes[name][:2])
    return bytes(content)


def _runner(network: IntegerNetwork, backend: Backend) -> Runner:
    if backend not in ("auto", "litert", "numpy"):
        raise NetworkError(f"back-end {backend!r}: must be auto, litert or numpy")
    if backend == "numpy" or (backend == "auto" and network.litert is None):
        return NumpyRunner(network)
    try:
        return LiteRtRunner(network)
    except ImportError:
        if backend == "litert":
            raise NetworkError("LiteRT is not installed; pip install ai-edge-litert") from None
        return NumpyRunner(network)
