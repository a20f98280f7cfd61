"""A network run by LiteRT (XNNPACK) in one thread."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.flatbuffer import to_flatbuffer
from lightgesture.features.net.network import IntegerNetwork, Shape

Levels = NDArray[np.int8]

MOST_PLANNED = 16
"""Sizes of input that are kept ready: a folder of pictures of many sizes must not fill the memory."""


class LiteRtRunner:
    """Runs a network; a model is built and planned once for each size of picture that comes.

    Plans are for one picture, and several go through one after the other: at the sizes here, a plan for each number of
    pictures would take half a megabyte, and 3 ms of the frame in which that number comes first, to save 4 µs a picture.
    """

    def __init__(self, network: IntegerNetwork) -> None:
        """Raises ImportError without the package ai-edge-litert."""
        from ai_edge_litert import interpreter

        self._interpreter = interpreter.Interpreter
        self._network = network
        self._planned: dict[tuple[tuple[int, ...], ...], Any] = {}

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
        key = tuple(inputs[name].shape[1:] for name in self._network.inputs)
        planned = self._planned.pop(key, None) or self._plan(inputs)
        # The last is the one used last, so that the first can go.
        self._planned[key] = planned
        if len(self._planned) > MOST_PLANNED:
            del self._planned[next(iter(self._planned))]
        return planned

    def _plan(self, inputs: Mapping[str, Levels]) -> tuple[Any, list[int], list[int]]:
        shapes = {name: inputs[name].shape for name in self._network.inputs}
        sizes: dict[str, Shape] = {name: (shape[1], shape[2], shape[3]) for name, shape in shapes.items()}
        model = to_flatbuffer(self._network, sizes)
        interpreter = self._interpreter(model_content=model, num_threads=1)
        interpreter.allocate_tensors()
        by_name = {item["name"]: item["index"] for item in interpreter.get_input_details()}
        results = {item["name"]: item["index"] for item in interpreter.get_output_details()}
        return (
            interpreter,
            [by_name[name] for name in self._network.inputs],
            [results[name] for name in self._network.outputs],
        )
