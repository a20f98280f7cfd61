"""Real divers in the trainings: what a table says, what copies look like, and nets that go on from integers."""

import json
from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture.errors import InputError
from lightgesture.training.nets.hand_samples import RESTING_SHARE, SHOWN_SHARE, HandSamples
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.cutouts import Cutout
from lightgesture.training.pictures.real_divers import RealDiver, RealDivers
from lightgesture.training.pictures.sea import measure_look, submerge
from lightgesture.training.pool.divers import read_divers
from lightgesture.training.pool.patch_pool import PatchPool

HEADER = "file,sequence,kind,x,y,w,h,shape,glove,view\n"


@pytest.fixture
def table(tmp_path):
    image = np.random.default_rng(0).integers(20, 120, (120, 160, 3)).astype(np.uint8)
    cv2.imwrite(str(tmp_path / "a.png"), image)
    cv2.imwrite(str(tmp_path / "b.png"), image)
    (tmp_path / "boxes.csv").write_text(
        HEADER
        + "a.png,dive_1,hand,20,20,40,50,5,glove,palm\n"
        + "a.png,dive_1,hand,80,20,30,30,rest,bare,?\n"
        + "a.png,dive_1,hand,10,90,20,20,bad,?,?\n"
        + "a.png,dive_1,head,100,60,30,30,,,\n"
        + "b.png,dive_2,,,,,,,,\n",
        encoding="utf-8",
    )
    return tmp_path / "boxes.csv"


def test_hands_by_what_they_show(table):
    divers = read_divers(table, {"5", "0"})
    assert [(hand.token, hand.source) for hand in divers.shown] == [("5", "divers dive_1")]
    assert [hand.token for hand in divers.resting] == [
        "none"
    ]  # and nothing of the one that nobody could name
    assert [len(scene.hands) for scene in divers.scenes] == [3, 0]
    assert divers.sign_looks[0].gloved
    assert not divers.looks[0].gloved


def test_a_dive_is_left_out_whole(table):
    divers = read_divers(table, {"5"}, {"dive_1"})
    assert not divers.shown
    assert not divers.looks
    assert [scene.source for scene in divers.scenes] == ["divers dive_2"]


def test_a_box_that_is_none_is_told_with_its_line(table):
    table.write_text(HEADER + "a.png,dive_1,hand,20,x,40,50,5,,\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"boxes\.csv, line 2: holds no box"):
        read_divers(table, {"5"})


def test_a_copy_takes_the_colours_of_the_look():
    real = np.full((80, 80, 3), (90, 60, 10), np.uint8)
    real[20:60, 20:60] = (110, 90, 20)
    look = measure_look(real, (20, 20, 40, 40), is_gloved=False)
    dry = np.random.default_rng(1).integers(0, 256, (96, 96, 3)).astype(np.uint8)
    copies = [submerge(dry, None, 56.0, [look], np.random.default_rng(seed)) for seed in range(8)]
    means = np.mean([copy.reshape(-1, 3).mean(axis=0) for copy in copies], axis=0)
    assert all(copy.shape == dry.shape and copy.dtype == np.uint8 for copy in copies)
    assert np.abs(means - look.mean).max() < 8.0


def test_a_gloved_look_darkens_the_hand():
    mask = np.zeros((96, 96), np.float32)
    mask[28:68, 28:68] = 1.0
    grey = np.full((96, 96, 3), 128, np.uint8)
    real = np.random.default_rng(2).integers(60, 160, (80, 80, 3)).astype(np.uint8)
    look = measure_look(real, (20, 20, 40, 40), is_gloved=True)
    for seed in range(6):
        copy = submerge(grey, mask, 56.0, [look], np.random.default_rng(seed)).astype(float)
        # Left and right of it, as high as it, so that light from above does not count.
        beside = np.concatenate([copy[35:60, 4:20], copy[35:60, 76:92]], axis=1)
        assert copy[35:60, 35:60].mean() < beside.mean()


def test_covered_hands_keep_the_picture_and_change_its_box():
    image = np.full((120, 160, 3), 90, np.uint8)
    picture = BoxedPicture(image, ((40, 30, 40, 40),), sources=frozenset({"divers d"}))
    alpha = np.zeros((64, 64), np.float32)
    alpha[8:56, 20:44] = 1.0
    hand = Cutout(np.full((64, 64, 3), 200, np.uint8), alpha, (20, 8, 24, 48), (32.0, 56.0), "1", "p")
    divers = RealDivers([RealDiver(picture, True)], [hand])
    drawn = [divers.draw(np.random.default_rng(seed)) for seed in range(20)]
    assert (image == 90).all()
    assert {place for place, _ in drawn} == {0}
    changed = [one for _, one in drawn if one.boxes != picture.boxes]
    assert 0 < len(changed) < len(drawn)
    for one in changed:
        x, y, width, height = one.boxes[0]
        assert (one.image[y : y + height, x : x + width] != 90).any()


def test_real_divers_have_their_share_of_a_batch():
    tokens = np.array(["5", "none", "5", "none"])
    sources = np.array(["anna", "anna", "divers d", "divers d"])
    patches = np.zeros((4, 36, 36, 3), np.uint8)
    patches[:, :] = np.array([10, 20, 30, 40], np.uint8)[:, None, None, None]
    pool = PatchPool(patches, np.zeros((4, 2), np.float16), tokens, sources, np.array([0, 1, -1, -1]))
    samples = HandSamples(pool, np.ones(4, bool), ("5", "none"), 2)
    counts = np.bincount(samples.draw_rows(np.random.default_rng(0), 20000), minlength=4) / 20000
    assert counts[2] == pytest.approx(SHOWN_SHARE, abs=0.01)
    assert counts[3] == pytest.approx(RESTING_SHARE, abs=0.01)


def test_a_net_goes_on_where_the_integers_ended():
    torch = pytest.importorskip("torch")
    from lightgesture.features.find.selector_file import load_learned
    from lightgesture.features.net.runner import Network, quantise
    from lightgesture.training.nets.architectures import REFINER_INPUT, REFINER_OUTPUTS, refiner_nodes
    from lightgesture.training.nets.started import start_from
    from lightgesture.training.nets.torch_network import TorchNetwork

    network = load_learned().refiner
    (name,) = network.inputs
    module = TorchNetwork({name: REFINER_INPUT}, refiner_nodes(), REFINER_OUTPUTS)
    values = np.random.default_rng(0).normal(0, 1, (16, *REFINER_INPUT)).clip(-3, 3).astype(np.float32)
    batch = {name: torch.from_numpy(values).permute(0, 3, 1, 2)}
    start_from(module, network, batch)
    wanted = Network(network, "numpy").run({name: quantise(values, network.quantisation[name])})
    for mode in (module.train(), module.eval()):
        for output, tensor in mode(batch).items():
            own = tensor.detach().numpy()
            assert (
                np.abs(own - wanted[output].reshape(own.shape)).mean() < 0.02 * np.abs(wanted[output]).mean()
            )


def test_a_net_goes_on_at_another_stride_but_not_with_other_layers():
    torch = pytest.importorskip("torch")
    from lightgesture.errors import UsageError
    from lightgesture.features.find.selector_file import load_learned
    from lightgesture.training.nets.architectures import LOCATOR_OUTPUTS, locator_nodes
    from lightgesture.training.nets.started import start_from
    from lightgesture.training.nets.torch_network import TorchNetwork

    network = load_learned().locator
    (name,) = network.inputs
    finer = [replace(node, stride=1) if node.name == "stem3" else node for node in locator_nodes()]
    module = TorchNetwork({name: (128, 160, 3)}, finer, LOCATOR_OUTPUTS)
    start_from(module, network, {name: torch.zeros(2, 3, 128, 160)})
    own, scales = network.weights["stem3"].weights, network.weights["stem3"].scales
    wanted = (own * scales[:, None, None, None]).transpose(0, 3, 1, 2)
    np.testing.assert_allclose(module.layers["stem3"].weight.detach().numpy(), wanted, atol=1e-6)
    wider = TorchNetwork({name: (128, 160, 3)}, locator_nodes((8, 16, 32, 64, 100)), LOCATOR_OUTPUTS)
    with pytest.raises(UsageError, match="a net of other layers"):
        start_from(wider, network, {name: torch.zeros(2, 3, 128, 160)})


def test_a_net_that_answers_another_question_takes_all_layers_but_the_last():
    torch = pytest.importorskip("torch")
    from lightgesture.errors import UsageError
    from lightgesture.training.nets.architectures import VERIFIER_INPUT, VERIFIER_OUTPUTS, verifier_nodes
    from lightgesture.training.nets.started import start_from
    from lightgesture.training.nets.torch_network import TorchNetwork
    from lightgesture.training.regions.nets import larger_net

    network, batch = larger_net("cnn"), {"patch": torch.zeros(2, 3, 32, 32)}
    module = TorchNetwork({"patch": VERIFIER_INPUT}, verifier_nodes(), VERIFIER_OUTPUTS)
    last = module.layers["hand"].weight.detach().clone()
    start_from(module, network, batch, but_the_last=True)
    own, scales = network.weights["stem"].weights, network.weights["stem"].scales
    wanted = (own * scales[:, None, None, None]).transpose(0, 3, 1, 2)
    np.testing.assert_allclose(module.layers["stem"].weight.detach().numpy(), wanted, atol=1e-6)
    assert torch.equal(module.layers["hand"].weight, last)
    with pytest.raises(UsageError, match="a net of other layers"):
        start_from(module, network, batch)


def test_a_reader_without_a_larger_net_starts_no_verifier():
    from lightgesture.errors import UsageError
    from lightgesture.training.regions.nets import larger_net

    with pytest.raises(UsageError, match="svm: has no larger net to learn on from"):
        larger_net("svm")


def test_the_history_of_a_small_net_is_carried_on(tmp_path):
    from lightgesture.models.loading import SHIPPED
    from lightgesture.training.nets.look import carried_on

    card = json.loads(SHIPPED["cnn"].with_suffix(".json").read_text(encoding="utf-8"))
    assert carried_on(SHIPPED["cnn"], beside=False) == {"small_net": card["small_net"]}
    earlier = carried_on(SHIPPED["cnn"], beside=True)["trainings_of_the_other_larger_nets"]
    assert earlier == [*card["trainings_of_the_other_larger_nets"], card["training"]]
    assert card["small_net"]["trained_on"]["licences"]["GPL-3.0"] == 5
    (tmp_path / "m.npz").write_bytes(b"net")
    with pytest.raises(InputError, match=r"m\.json: No such file or directory; a model needs its card"):
        carried_on(tmp_path / "m.npz", beside=False)
