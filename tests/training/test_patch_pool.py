"""The pool of altered patches: what is in it, and that neither processes nor reruns change it."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.features.patch import cut_patch
from lightgesture.features.standardise import channel_tables
from lightgesture.training.nets import hand_samples
from lightgesture.training.nets.hand_samples import HandSamples, standardised
from lightgesture.training.pool import patch_kinds
from lightgesture.training.pool.negatives import Scene
from lightgesture.training.pool.originals import Originals, PoolSettings
from lightgesture.training.pool.patch_kinds import HIDDEN, KEPT, KINDS, MARGIN
from lightgesture.training.pool.patch_pool import PatchPool, make_pool, rows_without
from lightgesture.training.pool.samples import LabelledHand

SETTINGS = PoolSettings(copies=2, rounds=1, rendered=0)


@pytest.fixture(autouse=True)
def _few_backdrops(monkeypatch):
    monkeypatch.setattr(patch_kinds, "CROPS", replace(patch_kinds.CROPS, backdrops=1))


def picture(seed, size=80):
    return np.random.default_rng(seed).integers(0, 256, (size, size, 3)).astype(np.uint8)


@pytest.fixture(scope="module")
def originals():
    hands = [
        LabelledHand(picture(number), (20, 20, 40, 40), "left", token, f"person {number % 3}", None)
        for number, token in enumerate(["left", "right", "5", "none"] * 3)
    ]
    return Originals(hands, [Scene(picture(90, 160), (), (), "water")])


def test_the_pool_holds_copies_regions_and_rendered_hands(originals, tmp_path):
    pool = make_pool(originals, replace(SETTINGS, rendered=6), 0, 1, tmp_path, lambda *_: None)
    assert pool.patches.shape[1:] == (36, 36, 3)
    assert len(pool.patches) == len(pool.contours) == len(pool.tokens) == len(pool.sources) == len(pool.hands)
    assert (np.bincount(pool.hands[pool.hands >= 0]) == SETTINGS.copies + SETTINGS.mild_copies).all()
    for row, number in enumerate(pool.hands):
        if number >= 0:
            hand = originals.hands[number]
            assert pool.sources[row] == hand.source
            turned = {"left": {"left", "right"}, "right": {"left", "right"}}.get(hand.token, {hand.token})
            assert pool.tokens[row] in turned
    # Each picture of water is a source of its own.
    assert set(pool.tokens[pool.sources == "water 0"]) == {"none"}
    assert "water" not in pool.sources
    assert any(source.startswith("synthetic") for source in pool.sources)


def assert_same(one, other):
    np.testing.assert_array_equal(one.patches, other.patches)
    np.testing.assert_array_equal(one.contours, other.contours)
    assert (one.tokens == other.tokens).all()


def test_reruns_change_nothing_and_another_seed_does(originals, tmp_path):
    first = make_pool(originals, SETTINGS, 3, 1, tmp_path / "a", lambda *_: None)
    assert_same(first, make_pool(originals, SETTINGS, 3, 1, tmp_path / "a", pytest.fail))
    other = make_pool(originals, SETTINGS, 4, 1, tmp_path / "c", lambda *_: None)
    assert len(other.patches) != len(first.patches) or (other.patches != first.patches).any()


@pytest.mark.slow
def test_processes_change_nothing(originals, tmp_path, monkeypatch):
    # Other processes draw all surroundings.
    monkeypatch.undo()
    pools = [
        make_pool(originals, replace(SETTINGS, rendered=6), 3, jobs, tmp_path / f"{jobs}", lambda *_: None)
        for jobs in (1, 2)
    ]
    assert_same(*pools)


def test_many_patches_are_standardised_as_the_board_does_one():
    patches = np.stack([picture(seed, 16) // (seed + 1) for seed in range(5)])
    for patch, values in zip(patches, standardised(patches), strict=True):
        tables = channel_tables(patch)[0]
        expected = np.stack([tables[patch[..., c], c] for c in range(3)], axis=-1)
        np.testing.assert_allclose(values, expected, atol=2e-4)


def test_only_the_chosen_rows_are_drawn_and_no_source_rules(originals, tmp_path):
    pool = make_pool(originals, SETTINGS, 0, 1, tmp_path, lambda *_: None)
    chosen = pool.tokens == "5"
    samples = HandSamples(pool, chosen, ("5",), MARGIN)
    batch = samples.draw(np.random.default_rng(1), 300)
    assert batch.patches.shape == (300, 32, 32, 3)
    assert np.abs(batch.patches).max() <= 4.5
    assert set(batch.truth.tolist()) == {0}
    same = samples.draw(np.random.default_rng(1), 300)
    np.testing.assert_array_equal(batch.patches, same.patches)


def pool_of(sources, hands):
    """Rows of the given sources that are copies of the given hands, -1: regions."""
    count = len(sources)
    tokens = np.array(["5" if hand >= 0 else "none" for hand in hands])
    return PatchPool(
        np.zeros((count, 4, 4, 3), np.uint8),
        np.zeros((count, 2), np.float16),
        tokens,
        np.array(sources),
        np.array(hands),
    )


@pytest.mark.parametrize(
    ("sources", "held", "expected"),
    [
        (["a", "a", "b"], [True, True, False], [False, False, True, False, True]),
        # A person held out: neither the hands nor the regions of the source.
        (["a", "a", "b"], [True, False, False], [False, True, True, False, True]),
        # A folder of one source, of which some hands are held out, keeps its regions.
        (["a", "a", "a"], [True, False, False], [False, True, True, True, True]),
    ],
    ids=["source", "person", "one source"],
)
def test_nothing_of_what_is_held_out_is_trained_on(sources, held, expected):
    pool = pool_of([*sources, "a", "water"], [0, 1, 2, -1, -1])
    assert rows_without(pool, np.array(sources), np.array(held)).tolist() == expected


def test_some_hands_are_hidden_and_called_none(originals):
    many = Originals(list(originals.hands) * 10)
    hidden = list(KINDS["hidden"](many, SETTINGS, 0, len(many.hands), np.random.default_rng(0)))
    assert {sample.token for sample in hidden} == {"none"}
    assert not any(sample.original for sample in hidden)
    assert 0.8 * HIDDEN < len(hidden) / len(many.hands) < 1.2 * HIDDEN


def test_own_signs_have_no_rendered_hands_and_no_rendered_none(originals):
    hands = originals.hands
    assert originals.rendered_classes == {"left", "right", "5", "none"}
    assert Originals([*hands, replace(hands[0], token="shaka")]).rendered_classes == {"left", "right", "5"}
    assert not Originals([replace(hands[0], token="shaka")]).rendered_classes
    assert len(Originals([]).rendered_classes) == 11


def test_copies_of_own_signs_keep_their_name(originals):
    """Mirrored, `left` and `right` are each other where both are there; every other sign keeps its name."""

    def tokens(*names):
        hands = [replace(originals.hands[0], token=name) for name in names]
        drawn = KINDS["hands"](Originals(hands * 8), SETTINGS, 0, 8 * len(names), np.random.default_rng(0))
        return [sample.token for sample in drawn]

    assert tokens("shaka", "Left") == ["shaka", "Left"] * 8
    assert tokens("left", "shaka") == ["left", "shaka"] * 8
    both = tokens("left", "right")
    assert both != ["left", "right"] * 8
    assert set(both) == {"left", "right"}


def test_mild_copies_stay_near_their_hand(originals, tmp_path):
    # A ramp has no small parts that a turn by a degree would move away.
    image = np.repeat(np.arange(20, 180, 2, dtype=np.uint8), 240).reshape(80, 80, 3)
    hands = [replace(hand, image=image, token="5") for hand in originals.hands]

    def mean_distance(settings):
        folder = tmp_path / str(settings.mild_share)
        pool = make_pool(Originals(hands), settings, 0, 1, folder, lambda *_: None)
        last = pool.patches[pool.hands >= 0][-len(hands) :]
        plain = cut_patch(image, hands[0].box, "left", KEPT)
        return np.abs(last.astype(int) - plain).mean()

    none = replace(SETTINGS, mild_share=0.0)
    assert mean_distance(replace(none, mild_share=0.5)) < 0.5 * mean_distance(none)


def test_answers_of_other_nets_stay_with_their_patches(originals, tmp_path, monkeypatch):
    pool = make_pool(originals, SETTINGS, 0, 1, tmp_path, lambda *_: None)
    chosen = pool.tokens == "5"
    monkeypatch.setattr(hand_samples, "ERASED_SHARE", 0.0)
    samples = HandSamples(pool, chosen, ("5",), MARGIN)
    assert samples.draw(np.random.default_rng(1), 3).answers is None
    middles = samples.middles(0, len(samples))
    told = samples.with_answers(np.arange(len(samples), dtype=np.float16)[:, None])
    batch = told.draw(np.random.default_rng(1), 40)
    for patch, (answer,) in zip(batch.patches, batch.answers, strict=True):
        # Shifted by two pixels at most and standardised anew, a patch is its own middle.
        assert likeness(patch, middles[int(answer)], 2) > 0.99


def likeness(patch, middle, most):
    """Largest correlation of the patch without its rim with a part of the other one as large, in any channel."""
    inner = patch[most:-most, most:-most]
    rows, columns = inner.shape[:2]
    places = [(top, left) for top in range(2 * most + 1) for left in range(2 * most + 1)]
    return max(
        np.corrcoef(inner[..., c].ravel(), middle[top : top + rows, left : left + columns, c].ravel())[0, 1]
        for top, left in places
        for c in range(3)
    )
