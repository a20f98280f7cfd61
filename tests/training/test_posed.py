"""Posed hands: from an archive of joints beside the manifest to samples of a pool."""

import csv
from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture.errors import InputError
from lightgesture.synth.poses import TOKENS, token_pose
from lightgesture.synth.skeleton import pose_skeleton
from lightgesture.training.pictures.sea import SeaLook
from lightgesture.training.pool import posed as posed_module
from lightgesture.training.pool.divers import Divers
from lightgesture.training.pool.originals import PoolSettings, read_originals
from lightgesture.training.pool.patch_pool import make_pool
from lightgesture.training.pool.posed import POSED_SOURCE, posed
from lightgesture.training.pool.samples import read_rows, rows_digest

NAMES = (*TOKENS, "none")


@pytest.fixture(autouse=True)
def _few_surroundings(monkeypatch):
    monkeypatch.setattr(posed_module, "CROPS", replace(posed_module.CROPS, backdrops=1, atlases=1))


@pytest.fixture
def manifest(tmp_path):
    """A hand of each class, posed as the synthetic one, every second a left one."""
    rng = np.random.default_rng(0)
    with (tmp_path / "hands.csv").open("w", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(["path", "token", "set", "note"])
        for number, name in enumerate(NAMES):
            cv2.imwrite(str(tmp_path / f"{number}.png"), np.full((40, 40, 3), 90, np.uint8))
            table.writerow([f"{number}.png", name, f"person {number}", ""])
    shapes = ["claw" if name == "none" else name for name in NAMES]
    joints = np.array([pose_skeleton(token_pose(shape, rng, 0.3)).points for shape in shapes])
    # A left hand whose palm is seen has its thumb on image left, and shows a left; a right hand the other way.
    left = np.array([name == "left" or number % 2 == 0 for number, name in enumerate(NAMES)])
    left[NAMES.index("right")] = False
    joints[left, :, 0] *= -1.0
    world = (0.001 * joints * [1.0, -1.0, -1.0]).astype(np.float16)
    write(tmp_path, world=world, hand=np.where(left, 1, -1), err=np.zeros(len(NAMES)))
    return tmp_path / "hands.csv"


def write(folder, **arrays):
    np.savez(folder / "world_hands.npz", **arrays)


def read(manifest):
    return read_originals(read_rows(manifest), (), None)


def test_poses_are_those_of_the_hands_and_left_ones_are_mirrored(manifest):
    poses = read(manifest).poses
    assert poses.hands.tolist() == list(range(len(NAMES)))
    # As right hands, both signs of the thumb have it on image right.
    expected = ["right" if name == "left" else name for name in NAMES]
    assert poses.tokens.tolist() == expected
    np.testing.assert_allclose(poses.rotations, np.tile(np.eye(3), (len(NAMES), 1, 1)), atol=0.03)


def test_joints_that_are_not_trusted_are_left_out(manifest):
    archive = dict(np.load(manifest.with_name("world_hands.npz")))
    archive["err"][:3] = [np.nan, 0.07, 0.05]
    archive["hand"][3] = 0
    archive["world"][4] = np.inf
    write(manifest.parent, **archive)
    text = manifest.read_text().splitlines()
    text[6] += "padded doubtful"
    manifest.write_text("\n".join(text))
    assert read(manifest).poses.hands.tolist() == [2, *range(6, len(NAMES))]


def test_a_hand_whose_joints_make_another_sign_poses_for_none(manifest):
    archive = dict(np.load(manifest.with_name("world_hands.npz")))
    archive["world"][NAMES.index("1")] = archive["world"][NAMES.index("5")]
    archive["hand"][NAMES.index("1")] = archive["hand"][NAMES.index("5")]
    write(manifest.parent, **archive)
    assert NAMES.index("1") not in read(manifest).poses.hands


def test_own_data_without_joints_have_no_posed_hands(manifest, tmp_path):
    digest = rows_digest(read_rows(manifest))
    manifest.with_name("world_hands.npz").unlink()
    assert rows_digest(read_rows(manifest)) != digest
    originals = read(manifest)
    assert len(originals.poses) == 0
    settings = PoolSettings(copies=1, rounds=1, rendered=0, posed=30)
    pool = make_pool(originals, settings, 0, 1, tmp_path, lambda *_: None)
    assert not np.char.startswith(pool.sources, POSED_SOURCE).any()


@pytest.mark.parametrize(
    "arrays",
    [
        {"world": np.zeros((2, 21, 3))},
        {"world": np.zeros((2, 21, 3)), "hand": np.ones(2), "err": np.zeros(2)},
    ],
    ids=["no hand", "other rows"],
)
def test_a_wrong_archive_is_refused_by_name(manifest, arrays):
    write(manifest.parent, **arrays)
    with pytest.raises(InputError, match=r"world_hands\.npz"):
        read_rows(manifest)


def test_a_broken_archive_is_refused_by_name(manifest):
    manifest.with_name("world_hands.npz").write_bytes(b"PK\x03\x04 nothing")
    with pytest.raises(InputError, match=r"world_hands\.npz"):
        read_rows(manifest)


def test_posed_hands_show_all_classes_wet_and_dry_and_know_their_landmarks(manifest):
    look = SeaLook((90.0, 80.0, 20.0), (12.0, 12.0, 8.0), 40.0)
    originals = replace(read(manifest), divers=Divers(looks=[look], sign_looks=[look]))
    samples = list(posed(originals, PoolSettings(), 0, 44, np.random.default_rng(0)))
    # Of the classes of right hands, `left` is seen in a mirror and from the back.
    assert {sample.token for sample in samples} == set(NAMES)
    assert all(sample.source.startswith(POSED_SOURCE) for sample in samples)
    for sample in samples:
        assert not sample.original
        assert sample.landmarks.shape == (21, 2)
        size = sample.image.shape[0]
        assert ((sample.landmarks > 0) & (sample.landmarks < size)).all()
        thumb, knuckles = sample.landmarks[4, 0], sample.landmarks[[5, 9, 13, 17], 0].mean()
        if sample.token in ("left", "right"):
            assert (thumb < knuckles) == (sample.token == "left")
    red = [sample.image[..., 2].mean() - sample.image[..., 0].mean() for sample in samples]
    assert 10 < sum(one < -50 for one in red) < 34


def test_the_same_seed_poses_the_same_hands_in_a_pool(manifest, tmp_path):
    originals = read(manifest)
    settings = PoolSettings(copies=1, rounds=1, rendered=0, posed=4)
    first, again = (
        make_pool(originals, settings, 0, 1, tmp_path / name, lambda *_: None) for name in ("a", "b")
    )
    assert np.char.startswith(first.sources, POSED_SOURCE).sum() == 4
    np.testing.assert_array_equal(first.patches, again.patches)


def test_no_pose_of_a_hand_that_is_kept_from_the_net_is_used(manifest, monkeypatch):
    originals = read(manifest)
    kept = np.array([name != "5" for name in NAMES])
    monkeypatch.setattr(posed_module, "kept_out", lambda hands: kept)
    samples = list(posed(originals, PoolSettings(), 0, 4, np.random.default_rng(0)))
    assert {sample.token for sample in samples} == {"5"}


def test_no_hand_is_drawn_that_shows_its_sign_in_no_view(manifest):
    originals = read(manifest)
    fists = np.tile(originals.poses.angles[NAMES.index("0")], (len(NAMES), 1, 1))
    hidden = replace(originals, poses=replace(originals.poses, angles=fists))
    samples = list(posed(hidden, PoolSettings(), 0, 11, np.random.default_rng(0)))
    assert not {sample.token for sample in samples} & {"5", "left", "right"}
