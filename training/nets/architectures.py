"""The layers of the small nets, as nodes from which both torch and the board build them."""

from collections.abc import Mapping, Sequence

from lightgesture.features.find import locator, refiner, verifier
from lightgesture.features.net.network import WEIGHTED, Node, Shape, infer_shapes, taps
from lightgesture.models import cnn

LOCATOR_INPUT: Shape = (256, 320, 3)
"""A picture of 320 × 240, filled up to multiples of 32 as `features.find.locator` does."""
REFINER_INPUT: Shape = (refiner.WINDOW.size, refiner.WINDOW.size, 4)
"""A window: standardised blue, green, red and luma."""
LOCATOR_OUTPUTS = (locator.HEAT, locator.EDGES)
REFINER_OUTPUTS = (refiner.HAND, refiner.BOX)
VERIFIER_INPUT: Shape = (verifier.WINDOW.size, verifier.WINDOW.size, 3)
"""A patch: blue, green and red, standardised by themselves."""
VERIFIER_OUTPUTS = (verifier.HAND,)


def separable(name: str, source: str, channels: int, stride: int = 1, kernel: int = 3) -> list[Node]:
    """A depthwise and a pointwise convolution (Howard et al., "MobileNets", 2017)."""
    depth = Node(f"{name}_depth", "depthwise", (source,), 0, kernel, stride, "relu6")
    return [depth, Node(f"{name}_point", "conv", (depth.name,), channels, 1, 1, "relu6")]


def residual(name: str, source: str, channels: int, kernel: int = 3) -> list[Node]:
    """A separable convolution that is added to its own input (He et al., "Deep residual learning", 2016)."""
    depth = Node(f"{name}_depth", "depthwise", (source,), 0, kernel, 1, "relu6")
    point = Node(f"{name}_point", "conv", (depth.name,), channels, 1, 1, "none")
    return [depth, point, Node(name, "add", (source, point.name), activation="relu6")]


def merged(name: str, coarse: str, fine: str, channels: int) -> list[Node]:
    """A coarse map brought to a finer one and added (Lin et al., "Feature pyramid networks", 2017)."""
    reduced = Node(f"{name}_coarse", "conv", (coarse,), channels, 1)
    raised = Node(f"{name}_up", "upsample", (reduced.name,))
    own = Node(f"{name}_fine", "conv", (fine,), channels, 1)
    return [reduced, raised, own, Node(name, "add", (own.name, raised.name), activation="relu6")]


def locator_nodes(channels: tuple[int, int, int, int, int] = (8, 16, 32, 64, 96)) -> tuple[Node, ...]:
    """Grids of 8, 16 and 32 pixels and back to 8, where heat and edges are read.

    channels: of the two layers of the stem and of the three grids, fine to coarse; time grows with their squares.
    """
    first, second, fine, middle, coarse = channels
    head = 40
    return (
        Node("stem1", "conv", (locator.INPUT,), first, 3, 2, "relu6"),
        Node("stem2", "conv", ("stem1",), second, 3, 2, "relu6"),
        Node("stem3", "conv", ("stem2",), fine, 3, 2, "relu6"),
        *residual("fine1", "stem3", fine),
        *separable("middle1", "fine1", middle, stride=2),
        *residual("middle2", "middle1_point", middle),
        *residual("middle3", "middle2", middle),
        *separable("coarse1", "middle3", coarse, stride=2),
        *residual("coarse2", "coarse1_point", coarse, kernel=5),
        *residual("coarse3", "coarse2", coarse, kernel=5),
        *merged("middle_sum", "coarse3", "middle3", middle),
        *residual("middle4", "middle_sum", middle),
        *merged("fine_sum", "middle4", "fine1", fine),
        *residual("fine2", "fine_sum", fine),
        *separable("head", "fine2", head),
        Node(locator.HEAT, "conv", ("head_point",), 2, 1),
        Node(locator.EDGES, "conv", ("head_point",), 4, 1),
    )


def refiner_nodes() -> tuple[Node, ...]:
    """A window seen by five convolutions, then by one dense layer as a whole."""
    return (
        Node("edges1", "conv", (refiner.INPUT,), 16, 3, 2, "relu6"),
        Node("edges2", "conv", ("edges1",), 16, 3, 1, "relu6"),
        Node("fingers1", "conv", ("edges2",), 24, 3, 2, "relu6"),
        Node("fingers2", "conv", ("fingers1",), 48, 3, 1, "relu6"),
        Node("shape", "conv", ("fingers2",), 64, 3, 2, "relu6"),
        Node("whole", "dense", ("shape",), 64, activation="relu6"),
        Node(refiner.HAND, "dense", ("whole",), 1),
        Node(refiner.BOX, "dense", ("whole",), 4),
    )


HAND_CHANNELS = {"small": (12, 20, 32), "medium": (16, 28, 44), "large": (24, 40, 64)}
"""Channels of a hand net's grids of 2, 4 and 8 pixels by its size; time grows with their squares."""
WHOLE = "whole"
"""Name of the layer of the hand nets that sees a patch as a whole; what it reads still tells places apart."""
HAND_WHOLE = 56
"""Numbers in which a hand net sees a patch as a whole."""


def convolved(name: str, source: str, channels: int, count: int) -> list[Node]:
    """`count` convolutions of 3 × 3, the last added to their input (He et al., "Deep residual learning", 2016)."""
    nodes = []
    last = source
    for number in range(1, count + 1):
        activation = "relu6" if number < count else "none"
        nodes.append(Node(f"{name}_{number}", "conv", (last,), channels, 3, 1, activation))
        last = nodes[-1].name
    return [*nodes, Node(name, "add", (source, last), activation="relu6")]


def hand_nodes(classes: int, contours: int, size: str = "medium") -> tuple[Node, ...]:
    """A patch seen by eight convolutions and one dense layer, and the numbers of its outline, if any, added to that.

    classes: of the answer. contours: numbers of the outline, 0 for a net without.

    Full convolutions and not separable ones: of nets of as many products, those with depthwise layers learnt no more
    in as many steps, and took longer to train and to run.
    """
    fine, middle, coarse = HAND_CHANNELS[size]
    seen = "none" if contours else "relu6"
    nodes = [
        Node("edges", "conv", (cnn.PATCH,), fine, 3, 2, "relu6"),
        *convolved("edges1", "edges", fine, 2),
        Node("fingers", "conv", ("edges1",), middle, 3, 2, "relu6"),
        *convolved("fingers1", "fingers", middle, 2),
        Node("shape", "conv", ("fingers1",), coarse, 3, 2, "relu6"),
        *convolved("shape1", "shape", coarse, 1),
        Node(WHOLE, "dense", ("shape1",), HAND_WHOLE, activation=seen),
    ]
    last = WHOLE
    if contours:
        # The sum of two dense layers is one dense layer over both inputs side by side.
        nodes.append(Node("outline", "dense", (cnn.CONTOUR,), HAND_WHOLE))
        nodes.append(Node("both", "add", (WHOLE, "outline"), activation="relu6"))
        last = "both"
    return (*nodes, Node(cnn.SCORES, "dense", (last,), classes))


def teacher_nodes(classes: int, channels: tuple[int, int, int] = (24, 48, 80)) -> tuple[Node, ...]:
    """A larger net for the same patches, which a hand net learns from, and which is asked for a second look."""
    return (*_larger_body(channels), Node(cnn.SCORES, "dense", (WHOLE,), classes))


def verifier_nodes(channels: tuple[int, int, int] = (24, 48, 80)) -> tuple[Node, ...]:
    """The layers of a larger net that reads hands, which it learns on from, and a last one that says hand or not."""
    return (*_larger_body(channels), Node(verifier.HAND, "dense", (WHOLE,), 1))


def _larger_body(channels: tuple[int, int, int]) -> tuple[Node, ...]:
    fine, middle, coarse = channels
    return (
        Node("stem", "conv", (cnn.PATCH,), fine, 3, 1, "relu6"),
        Node("fine", "conv", ("stem",), fine, 3, 2, "relu6"),
        *convolved("fine1", "fine", fine, 2),
        Node("middle", "conv", ("fine1",), middle, 3, 2, "relu6"),
        *convolved("middle1", "middle", middle, 2),
        *convolved("middle2", "middle1", middle, 2),
        Node("coarse", "conv", ("middle2",), coarse, 3, 2, "relu6"),
        *convolved("coarse1", "coarse", coarse, 2),
        Node(WHOLE, "dense", ("coarse1",), 96, activation="relu6"),
    )


def multiply_adds(inputs: Mapping[str, Shape], nodes: Sequence[Node]) -> int:
    """Products that the weighted layers sum for one picture."""
    shapes = infer_shapes(inputs, nodes)
    total = 0
    for node in nodes:
        if node.op in WEIGHTED:
            height, width, channels = shapes[node.name]
            total += height * width * channels * taps(node, shapes[node.inputs[0]])
    return total
