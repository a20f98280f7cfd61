"""What is kept from a net: whole sources where that can be, and about as much as was asked for."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.training.pool.kept_hands import kept_out
from lightgesture.training.pool.samples import LabelledHand


def keeps_whole_sources(hands, kept):
    sources = np.array([hand.source for hand in hands])
    return not np.isin(sources[kept], sources[~kept]).any()


PICTURE = np.zeros((4, 4, 3), np.uint8)


def hands_of(sizes):
    return [
        LabelledHand(PICTURE, (0, 0, 4, 4), "left", "5", source, None)
        for source, size in sizes.items()
        for _ in range(size)
    ]


def test_whole_sources_are_kept_and_no_large_one_takes_their_place():
    hands = hands_of({f"person {number}": 5 for number in range(40)} | {"collection": 150})
    kept = kept_out(hands, 10)
    assert keeps_whole_sources(hands, kept)
    assert 0.05 <= kept.mean() <= 0.1
    assert "collection" not in {hand.source for hand, is_kept in zip(hands, kept, strict=True) if is_kept}


def test_a_further_source_changes_little():
    sizes = {f"person {number}": 5 for number in range(100)}
    before = hands_of(sizes)
    after = hands_of(sizes | {"newcomer": 5})

    def names(hands):
        kept = kept_out(hands, 10)
        return {hand.source for hand, is_kept in zip(hands, kept, strict=True) if is_kept}

    assert len(names(before) ^ names(after)) <= 2


@pytest.mark.parametrize("sizes", [{"one": 60}, {"one": 60, "two": 60}])
def test_of_few_sources_some_hands_each_are_kept(sizes):
    hands = hands_of(sizes)
    kept = kept_out(hands, 12)
    assert kept.sum() == len(hands) // 12
    assert not keeps_whole_sources(hands, kept)


def test_who_alone_shows_a_class_is_never_kept():
    """Wherever in the order of names the only one who shows a sign comes."""
    for number in range(40):
        sizes = {f"person {place}": 5 for place in range(40)}
        hands = [
            replace(hand, token="ok") if hand.source == f"person {number}" else hand
            for hand in hands_of(sizes)
        ]
        kept = kept_out(hands, 10)
        assert kept.any()
        assert "ok" in {hand.token for hand, is_kept in zip(hands, kept, strict=True) if not is_kept}


def test_the_only_hand_of_a_class_is_learnt():
    hands = [
        replace(hand, token=token)
        for hand, token in zip(hands_of({"one": 3}), ("up", "down", "down"), strict=True)
    ]
    assert not kept_out(hands, 12).any()
