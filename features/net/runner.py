"""A network made ready to run: by LiteRT where it is installed, else by the NumPy reference."""

from collections.abc import Mapping
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.network import IntegerNetwork, NetworkError, dequantise, quantise
from lightgesture.features.net.reference import NumpyRunner

Levels = NDArray[np.int8]
Backend = Literal["auto", "litert", "numpy"]


class Runner(Protocol):
    """What computes the integers."""

    def run(self, inputs: Mapping[str, Levels]) -> dict[str, Levels]: ...


class Network:
    """A network with its run-time; values in, values out."""

    def __init__(self, network: IntegerNetwork, backend: Backend = "auto") -> None:
        """backend: "litert", "numpy", or "auto" for the first that is installed. Raises NetworkError."""
        self._network = network
        self._runner = _runner(network, backend)

    def table(self, name: str, values: NDArray[np.floating]) -> Levels:
        """Values of an input as its integers."""
        return quantise(values, self._network.quantisation[name])

    def zero(self, name: str) -> int:
        """The integer that stands for the value 0 of an input."""
        return self._network.quantisation[name].zero

    def run(self, inputs: Mapping[str, Levels]) -> dict[str, NDArray[np.float32]]:
        """Integers (n, h, w, channels) for each input -> values, float32, of each output."""
        outputs = self._runner.run(inputs)
        return {
            name: dequantise(levels, self._network.quantisation[name]) for name, levels in outputs.items()
        }


def _runner(network: IntegerNetwork, backend: Backend) -> Runner:
    if backend not in ("auto", "litert", "numpy"):
        raise NetworkError(f"back-end {backend!r}: must be auto, litert or numpy")
    if backend == "numpy":
        return NumpyRunner(network)
    try:
        from lightgesture.features.net.litert import LiteRtRunner

        return LiteRtRunner(network)
    except ImportError:
        if backend == "litert":
            raise NetworkError("LiteRT is not installed; pip install ai-edge-litert") from None
        return NumpyRunner(network)
