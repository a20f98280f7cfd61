"""Landmarks as a second task of the nets' training: they follow the hand, and nothing of them reaches the board."""

import argparse
from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture.errors import UsageError
from lightgesture.features.patch import PatchSettings, cut_patch
from lightgesture.training.card import data_section
from lightgesture.training.commands import classifier, train_cnn, train_look
from lightgesture.training.nets import hand_samples
from lightgesture.training.nets.cnn import CnnTraining, draw
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.pictures import augment
from lightgesture.training.pictures.augment import AugmentSettings
from lightgesture.training.pictures.light import LightSettings
from lightgesture.training.pictures.sea import SeaLook
from lightgesture.training.pool import altered, diver_kinds, patch_kinds
from lightgesture.training.pool.divers import Divers
from lightgesture.training.pool.negatives import Scene
from lightgesture.training.pool.originals import Originals, PoolSettings
from lightgesture.training.pool.patch_kinds import KEPT, KINDS, MARGIN
from lightgesture.training.pool.patch_landmarks import COORDINATES, patch_landmarks
from lightgesture.training.pool.patch_pool import PatchPool, make_pool
from lightgesture.training.pool.samples import LabelledHand, landmark_box
from lightgesture.training.samples import TrainingSample

PLAIN = AugmentSettings(mirror=0, rotation=0, stretch=0, shear=0, background=0, shift=0, scale=0)
"""Copies that only move the hand to the canvas."""
LARGE = PatchSettings(size=144, context=KEPT.context)
"""A patch in which a dot's middle is measured finely."""
FINGERS = [(-18, -10), (-12, -30), (0, -34), (10, -30), (20, -22)]
"""Where the fingers end beside the wrist."""


def spread_landmarks():
    """A hand of 21 landmarks with its wrist at (50, 62), float32 (21, 2)."""
    fingers = [np.linspace((0, 0), end, 5)[1:] for end in FINGERS]
    return np.add(np.vstack([np.zeros((1, 2)), *fingers]), (50, 62)).astype(np.float32)


def dotted(number, token="5", source="somebody"):
    """A hand of which nothing is seen but a white dot at one of its landmarks."""
    landmarks = spread_landmarks()
    rows, columns = np.mgrid[:100, :100]
    x, y = landmarks[number]
    near = np.clip(3.5 - np.hypot(columns - x, rows - y), 0.0, 1.0)
    image = np.repeat(np.rint(255 * near).astype(np.uint8)[..., None], 3, axis=2)
    return LabelledHand(image, landmark_box(landmarks), "left", token, source, landmarks)


def middle_of_light(image):
    """Of a picture, (x, y) in sides of it, the corner of its first pixel being (0, 0)."""
    light = image.max(axis=-1).astype(float)
    light[light < 0.2 * light.max()] = 0.0
    rows, columns = np.indices(light.shape) + 0.5
    return np.array([(columns * light).sum(), (rows * light).sum()]) / light.sum() / len(light)


def assert_dots_are_told(samples, numbers):
    samples = list(samples)
    assert len(samples) == len(numbers)
    for sample, number in zip(samples, numbers, strict=True):
        told = patch_landmarks(sample, LARGE).reshape(-1, 2)[number]
        seen = middle_of_light(cut_patch(sample.image, sample.box, sample.side, LARGE))
        assert seen == pytest.approx(told, abs=0.012)


@pytest.fixture
def no_light(monkeypatch):
    """Copies in no other light, so that the dot stays the brightest of all."""
    monkeypatch.setattr(augment, "relight", lambda image, *_: image)
    monkeypatch.setattr(diver_kinds, "relight", lambda image, *_: image)
    monkeypatch.setattr(diver_kinds, "submerge", lambda image, *_: image)


@pytest.mark.usefixtures("no_light")
@pytest.mark.parametrize(
    "how",
    [
        *({}, {"mirror": 1.0}, {"rotation": 30.0}, {"lying": 1.0}, {"stretch": 0.3}, {"narrowed": 1.0}),
        *({"shear": 0.3}, {"shift": 0.1, "scale": 0.1}),
        {"mirror": 0.5, "rotation": 20.0, "lying": 0.3, "stretch": 0.2, "shear": 0.1, "shift": 0.05},
    ],
    ids=lambda how: "-".join(how) or "plain",
)
@pytest.mark.parametrize("side", ["left", "right"])
def test_landmarks_follow_every_alteration(how, side):
    numbers = [0, 4, 8, 14, 20]
    hands = [replace(dotted(number), side=side) for number in numbers]
    copies = altered.altered(Originals(hands), hands, replace(PLAIN, **how), np.random.default_rng(1))
    assert_dots_are_told(copies, numbers)


@pytest.mark.usefixtures("no_light")
@pytest.mark.parametrize("kind", ["hands", "mild", "sea"])
def test_landmarks_follow_every_kind_of_copies(kind):
    # Within the hand: another background takes a part of a dot at its outline.
    numbers = [2, 6, 9, 10, 14, 18] * 4
    look = SeaLook((90.0, 80.0, 40.0), (20.0, 20.0, 15.0), 60.0)
    black = Scene(np.zeros((50, 50, 3), np.uint8), (), (), "night")
    originals = Originals([dotted(number) for number in numbers], [black], divers=Divers(looks=[look]))
    drawn = KINDS[kind](originals, PoolSettings(), 0, len(numbers), np.random.default_rng(2))
    assert_dots_are_told(drawn, numbers)


def test_a_region_in_other_light_keeps_its_landmarks():
    still = LightSettings(
        gamma=0, contrast=0, gain=0, gradient=0, dark=0, backlit=0, water=0, blur=0, noise=0
    )
    hand = dotted(8)
    image = np.kron(hand.image, np.ones((4, 4, 1), np.uint8))
    box = tuple(4 * value for value in hand.box)
    sample = TrainingSample(
        image=image, box=box, side="left", token="5", source="", landmarks=(hand.landmarks + 0.5) * 4 - 0.5
    )
    assert_dots_are_told([altered.relit(sample, still, np.random.default_rng(0))], [8])


def test_rendered_hands_bring_theirs_and_hidden_ones_none(monkeypatch):
    monkeypatch.setattr(patch_kinds, "CROPS", replace(patch_kinds.CROPS, backdrops=1))
    originals = Originals([dotted(4, token) for token in ("5", "none")] * 8)
    random = np.random.default_rng(0)
    (rendered, *_) = KINDS["rendered"](originals, PoolSettings(), 0, 11, random)
    told = patch_landmarks(rendered, KEPT).astype(float)
    assert ((told > 0.0) & (told < 1.0)).mean() > 0.9
    hidden = list(KINDS["hidden"](originals, PoolSettings(), 0, 16, random))
    assert hidden
    assert all(sample.landmarks is None for sample in hidden)


@pytest.fixture
def pool(tmp_path):
    hands = [dotted(4), dotted(8, "none"), replace(dotted(12), landmarks=None)]
    originals = Originals(hands, [Scene(np.full((60, 60, 3), 90, np.uint8), (), (), "water")])
    settings = PoolSettings(copies=2, rounds=1, rendered=0)
    return make_pool(originals, settings, 0, 1, tmp_path / "pool", lambda *_: None)


def test_a_pool_keeps_landmarks_where_they_are_known(pool, tmp_path):
    assert pool.landmarks.shape == (len(pool.tokens), COORDINATES)
    assert pool.landmarks.dtype == np.float16
    known = np.isfinite(pool.landmarks).all(axis=1)
    for one, count in ((pool, int(known.sum())), (replace(pool, landmarks=None), 0)):
        assert data_section([], Originals([]), one, [])["patches_with_landmarks"] == count
    assert (known == np.isin(pool.hands, (0, 1))).all()
    assert np.isnan(pool.landmarks[~known]).all()
    path = tmp_path / "pool" / "landmarks.npy"
    np.save(path, pool.landmarks[1:])
    with pytest.raises(UsageError, match="holds landmarks of other patches"):
        make_pool(Originals([]), PoolSettings(), 0, 1, tmp_path / "pool", pytest.fail)
    path.unlink()
    assert make_pool(Originals([]), PoolSettings(), 0, 1, tmp_path / "pool", pytest.fail).landmarks is None


def dotted_pool(count, classes=("1", "5"), unknown=0):
    """Patches of grey with a white dot at landmark 7, whose height tells the class; the last `unknown` without."""
    random = np.random.default_rng(3)
    patches = random.integers(60, 90, (count, KEPT.size, KEPT.size, 3), np.uint8)
    landmarks = np.full((count, 21, 2), 0.5, np.float16)
    for number in range(count):
        x, y = random.integers(4, 32), random.integers(4, 16) + 16 * (number % 2)
        patches[number, y - 1 : y + 2, x - 1 : x + 2] = 255
        landmarks[number, 7] = (x + 0.5) / KEPT.size, (y + 0.5) / KEPT.size
    landmarks[count - unknown :] = np.nan
    tokens = np.array([classes[number % 2] for number in range(count)])
    contours = np.zeros((count, 4), np.float16)
    sources = np.array(["somebody"] * count)
    return PatchPool(patches, contours, tokens, sources, np.arange(count), landmarks.reshape(count, -1))


def samples_of(pool):
    return HandSamples(pool, np.ones(len(pool.tokens), bool), ("1", "5"), MARGIN)


def test_landmarks_move_with_the_drawn_part_of_a_patch(monkeypatch):
    monkeypatch.setattr(hand_samples, "ERASED_SHARE", 0.0)
    batch = samples_of(dotted_pool(20)).draw(np.random.default_rng(0), 60)
    assert batch.landmarks.shape == (60, COORDINATES)
    for patch, told in zip(batch.patches, batch.landmarks.reshape(60, 21, 2), strict=True):
        x, y = np.floor((told[7] + 0.5) * 32).astype(int)
        assert patch[y, x].min() == patch.max()


def test_what_is_covered_is_unknown(monkeypatch):
    samples = samples_of(dotted_pool(20))
    monkeypatch.setattr(hand_samples, "ERASED_SHARE", 0.0)
    plain = samples.draw(np.random.default_rng(0), 200)
    monkeypatch.setattr(hand_samples, "ERASED_SHARE", 1.0)
    batch = samples.draw(np.random.default_rng(0), 200)
    covered = []
    for number, told in enumerate(plain.landmarks.reshape(200, 21, 2)):
        x, y = np.floor((told[7] + 0.5) * 32).astype(int)
        covered.append((batch.patches[number, y, x] != plain.patches[number, y, x]).any())
    unknown = np.isnan(batch.landmarks.reshape(200, 21, 2)[:, 7]).all(axis=1)
    assert unknown.tolist() == covered
    assert 0 < sum(covered) < 200


def test_samples_without_landmarks_say_so():
    assert samples_of(dotted_pool(4)).has_landmarks
    assert not samples_of(dotted_pool(4, unknown=4)).has_landmarks
    bare = samples_of(replace(dotted_pool(4), landmarks=None))
    assert not bare.has_landmarks
    assert bare.draw(np.random.default_rng(0), 3).landmarks is None


def test_unknown_landmarks_give_no_gradient():
    torch = pytest.importorskip("torch")
    from lightgesture.training.nets.landmark_task import landmark_loss

    truth = torch.zeros(3, COORDINATES)
    truth[1] = torch.nan
    truth[2, 5] = torch.nan
    told = torch.full((3, COORDINATES), 0.2, requires_grad=True)
    loss = landmark_loss(told, truth)
    loss.backward()
    assert torch.isfinite(loss)
    assert (told.grad[1] == 0).all()
    assert (told.grad == 0).sum() == COORDINATES + 1
    assert landmark_loss(told, torch.full_like(truth, torch.nan)).item() == 0.0


def same_network(one, other):
    return (
        one.nodes == other.nodes
        and tuple(one.outputs) == tuple(other.outputs)
        and one.quantisation == other.quantisation
        and all((one.weights[n].weights == other.weights[n].weights).all() for n in one.weights)
    )


@pytest.mark.parametrize("teacher", [False, True])
def test_the_integers_hold_no_head(teacher):
    pytest.importorskip("torch")
    from lightgesture.training.nets.architectures import hand_nodes, teacher_nodes
    from lightgesture.training.nets.hand_net import NetSettings, make_net, to_integers

    nodes = teacher_nodes(2, (8, 8, 12)) if teacher else hand_nodes(2, 0, "small")
    samples = samples_of(dotted_pool(20))
    nets = [make_net(nodes, 32, 0, 0, landmarks=learnt).eval() for learnt in (False, True)]
    plain, headed = (to_integers(net, samples, None, NetSettings(1), 0) for net in nets)
    assert nets[1].outputs == ("scores", "landmarks")
    assert same_network(plain, headed)


@pytest.mark.parametrize("answers", [False, True])
def test_a_net_learns_classes_and_landmarks(tmp_path, monkeypatch, answers):
    torch = pytest.importorskip("torch")
    from lightgesture.training.nets import hand_net
    from lightgesture.training.nets.architectures import hand_nodes
    from lightgesture.training.nets.hand_net import NetSettings, make_net, tells_landmarks, train_hand_net

    monkeypatch.setattr(hand_net, "BATCH", 32)
    pool = dotted_pool(200, unknown=40)
    samples, settings = samples_of(pool), NetSettings(60, landmarks=1.0)
    if answers:
        samples = samples.with_answers(np.where(pool.tokens[:, None] == ("1", "5"), 4, -4).astype(np.float16))
    assert tells_landmarks(samples, settings)
    assert not tells_landmarks(samples, NetSettings(60))
    net = make_net(hand_nodes(2, 0, "small"), 32, 0, 0, landmarks=True)
    net = train_hand_net(net, samples, None, settings, 0, tmp_path / "hand.pt", lambda _: None)
    patches = torch.from_numpy(samples.middles(0, 160)).permute(0, 3, 1, 2)
    with torch.no_grad():
        outputs = net({"patch": patches})
    assert (outputs["scores"].argmax(dim=1) == torch.arange(160) % 2).float().mean() > 0.9
    told = outputs["landmarks"].numpy().reshape(160, 21, 2)[:, 7]
    truth = (pool.landmarks[:160].astype(np.float32).reshape(160, 21, 2)[:, 7] * 36 - 2) / 32 - 0.5
    assert np.abs(told - truth).mean() < 0.5 * np.abs(truth - truth.mean(axis=0)).mean()


def test_patches_of_before_are_used_and_it_is_told(tmp_path, monkeypatch, caplog, pool):
    hands = tmp_path / "hands"
    for token in ("5", "none"):
        (hands / token).mkdir(parents=True)
        cv2.imwrite(str(hands / token / "1.png"), dotted(4).image)
    training = CnnTraining(hands, pool=PoolSettings(copies=1, rounds=1, rendered=0), landmarks=0.3)
    out = tmp_path / "net.npz"
    draw(training, out, lambda _: None)
    assert not caplog.records
    (tmp_path / "net.parts" / "landmarks.npy").unlink()
    assert draw(training, out, lambda _: None).pool.landmarks is None
    (record,) = caplog.records
    assert "drawn without landmarks" in record.getMessage()


@pytest.mark.parametrize("command", [train_cnn, train_look])
def test_posed_hands_and_landmarks_are_learnt_when_asked_for_alone(command):
    parser = argparse.ArgumentParser()
    command.add_arguments(parser)
    words = ["--data", "hands.csv"]
    training = classifier.net_training(parser.parse_args(words))
    assert (training.pool.posed, training.landmarks) == (0, 0.0)
    training = classifier.net_training(parser.parse_args([*words, "--posed", "20", "--landmarks", "0.3"]))
    assert (training.pool.posed, training.landmarks) == (20, 0.3)


@pytest.mark.parametrize("text", ["-0.1", "11", "nan"])
def test_a_weight_out_of_range_is_refused(text, capsys):
    parser = argparse.ArgumentParser()
    classifier.add_landmarks_argument(parser)
    with pytest.raises(SystemExit):
        parser.parse_args(["--landmarks", text])
    assert "is not from 0 to 10" in capsys.readouterr().err
