"""The loop that trains a net: interrupted or not, the result is the same; the overlap it learns by."""

import numpy as np
import pytest

from lightgesture.features.net.network import Node

torch = pytest.importorskip("torch")

SETTINGS = {"steps": 6, "rate": 0.05, "warm_up": 2}


def a_net():
    from lightgesture.training.nets.torch_network import TorchNetwork

    torch.manual_seed(0)
    nodes = (
        Node("seen", "conv", ("picture",), 4, 3, 2, "relu6"),
        Node("answer", "dense", ("seen",), 1),
    )
    return TorchNetwork({"picture": (8, 8, 3)}, nodes, ("answer",))


def brightness(rng):
    """Pictures and how bright each is."""
    pictures = torch.from_numpy(rng.random((4, 3, 8, 8), np.float32))
    return {"picture": pictures}, (pictures.mean(dim=(1, 2, 3)),)


def squared(outputs, truth):
    return (outputs["answer"][:, 0] - truth[0]).square().mean()


def train(path, batch=brightness, said=None, seed=5, matrix_rate=0.0):
    from lightgesture.training.nets.net_training import LoopSettings, train_net

    tell = (said if said is not None else []).append
    settings = LoopSettings(**SETTINGS, matrix_rate=matrix_rate)
    return train_net(a_net(), batch, squared, settings, seed, path, tell)


def same(one, other):
    return all(
        torch.equal(own, new)
        for own, new in zip(one.state_dict().values(), other.state_dict().values(), strict=True)
    )


@pytest.mark.parametrize("matrix_rate", [0.0, 0.05])
def test_an_interrupted_training_gives_what_a_whole_one_gives(tmp_path, matrix_rate, monkeypatch):
    monkeypatch.setattr("lightgesture.training.nets.net_training.SAVE_EVERY", 2)
    drawn = []

    def interrupted(rng):
        drawn.append(rng)
        if len(drawn) == 4:
            raise KeyboardInterrupt
        return brightness(rng)

    whole = train(tmp_path / "whole.pt", matrix_rate=matrix_rate)
    with pytest.raises(KeyboardInterrupt):
        train(tmp_path / "parts.pt", interrupted, matrix_rate=matrix_rate)
    said = []
    assert same(train(tmp_path / "parts.pt", said=said, matrix_rate=matrix_rate), whole)
    assert [line.split(",")[0] for line in said] == [f"parts: step {step} of 6" for step in (3, 4, 5, 6)]
    assert not same(train(tmp_path / "other.pt", seed=6, matrix_rate=matrix_rate), whole)
    assert not same(train(tmp_path / "slow.pt", matrix_rate=0.01), whole)


@pytest.mark.parametrize(
    ("precision", "matrix_rate"), [("float32", 0.0), ("bfloat16", 0.0), ("float32", 0.02)]
)
def test_training_lowers_the_loss(tmp_path, precision, matrix_rate):
    from lightgesture.training.nets.net_training import LoopSettings, train_net

    inputs, truth = brightness(np.random.default_rng(9))
    settings = LoopSettings(60, 0.02, matrix_rate, warm_up=5, precision=precision)
    trained = train_net(a_net(), brightness, squared, settings, 0, tmp_path / "net.pt", [].append)
    assert all(value.dtype == torch.float32 for value in trained.parameters())
    with torch.no_grad():
        assert squared(trained(inputs), truth) < 0.3 * squared(a_net().eval()(inputs), truth)


def test_generalised_overlap_of_known_boxes():
    from lightgesture.training.nets.net_training import giou

    box = torch.tensor([[0.0, 0.0, 2.0, 2.0]])
    others = torch.tensor([[0.0, 0.0, 2.0, 2.0], [1.0, 0.0, 3.0, 2.0], [4.0, 0.0, 6.0, 2.0]])
    # Same; half overlapping (union fills the hull); two boxes with a gap of their own size between them.
    expected = (1.0, 1 / 3, -1 / 3)
    assert giou(box.expand(3, 4), others).tolist() == pytest.approx(expected)
