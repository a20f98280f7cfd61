"""What changes the weights: which of them by which rule, and that the matrices are those of the net itself."""

import numpy as np
import pytest

from lightgesture.features.net.network import Node

torch = pytest.importorskip("torch")

INNER = ("seen", "point", "whole")
"""The layers of `a_net` whose weights are matrices within the net."""


def a_net():
    from lightgesture.training.nets.torch_network import TorchNetwork

    torch.manual_seed(3)
    nodes = (
        Node("seen", "conv", ("picture",), 6, 3, 2, "relu6"),
        Node("depth", "depthwise", ("seen",), 0, 3, 1, "relu6"),
        Node("point", "conv", ("depth",), 5, 1, 1, "relu6"),
        Node("whole", "dense", ("point",), 7, activation="relu6"),
        Node("answer", "dense", ("whole",), 2),
    )
    net = TorchNetwork({"picture": (8, 8, 3)}, nodes, ("answer",))
    return net.to(memory_format=torch.channels_last)


def stepped(net, rate, matrix_rate):
    """What one step without decay changes, by name."""
    from lightgesture.training.nets.optimisers import NetOptimiser

    before = {name: value.detach().clone() for name, value in net.named_parameters()}
    optimiser = NetOptimiser(net, rate, matrix_rate, decay=0.0)
    net({"picture": torch.randn(256, 3, 8, 8)})["answer"].square().sum().backward()
    optimiser.step(0.5)
    assert all(value.grad is None for value in net.parameters())
    return {name: (value.detach() - before[name]).numpy() for name, value in net.named_parameters()}


def test_matrices_within_the_net_move_by_orthogonal_steps_and_the_others_by_the_other_rule():
    moved = stepped(a_net(), rate=1e-3, matrix_rate=0.04)
    for name in INNER:
        change = moved.pop(f"layers.{name}.weight")
        rows = change.transpose(0, 2, 3, 1) if change.ndim == 4 else change
        rows = rows.reshape(len(rows), -1)
        scale = 0.5 * 0.04 * max(1.0, rows.shape[0] / rows.shape[1]) ** 0.5
        spread = np.linalg.svd(rows / scale, compute_uv=False)
        # Five rounds of Muon's iteration bring every singular value near 1, not to it.
        assert (spread > 0.5).all()
        assert (spread < 1.3).all()
    assert {"layers.depth.weight", "layers.answer.weight", "norms.seen.weight"} < set(moved)
    # The first step of AdamW is its rate in the gradient's direction.
    assert all(np.abs(change).max() <= 0.5 * 1.001e-3 for change in moved.values())


def test_without_a_rate_of_their_own_matrices_move_like_the_others():
    moved = stepped(a_net(), rate=1e-3, matrix_rate=0.0)
    assert all(0.0 < np.abs(change).max() <= 0.5 * 1.001e-3 for change in moved.values())


def test_a_net_in_another_order_of_memory_is_refused():
    from lightgesture.training.nets.optimisers import NetOptimiser

    with pytest.raises(RuntimeError, match="view"):
        NetOptimiser(a_net().to(memory_format=torch.contiguous_format), 1e-3, 0.04, 0.0)
