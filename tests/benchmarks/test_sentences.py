"""Damaged sentences, and the tables of what rules issue of them: with signs read without doubt nothing is wrong."""

import pytest

from lightgesture.benchmarks.decoder.damage import KINDS, Recorded, damage, pieces, read_ideally
from lightgesture.benchmarks.decoder.sentences import damage_row, idle_row, measure, suite_row, time_row
from lightgesture.fsm import Sign, Signs, load_grammar

GRAMMAR = load_grammar()
SIGNED = {
    "STOP HOVER 50 GO": "0,0 5,5 ok,5 pic,ok ok,0 ok,ok",
    "CONTD PARAM 3 DECREASE GO": "pic,0 3,pic left,pic ok,ok",
    "STOP LEFT GO": "0,0 0,left ok,ok",
}


def recorded(sentence, suite="water"):
    """A clip in which hands are lowered, sign, and are lowered again, passing for 8 frames between two signs."""
    pairs = [tuple(pair.split(",")) for pair in SIGNED.get(sentence, "").split()]
    unread = Signs(Sign(None, 0.9, {"none": 0.9}), Sign(None, 0.9, {"none": 0.9}))
    signs, held = [Signs()] * 20, [None] * 20
    for left, right in pairs:
        shown = Signs(Sign(left, 0.95, {left: 0.95}), Sign(right, 0.95, {right: 0.95}))
        signs += [unread] * 8 + [shown] * 24
        held += [None] * 8 + [(left, right)] * 24
    signs += [Signs()] * 40
    held += [None] * 40
    times = tuple(frame / 30 for frame in range(len(signs)))
    sentences = (sentence,) if pairs else ()
    return Recorded(sentence, suite, sentences, times, tuple(signs), tuple(held))


@pytest.fixture(scope="module")
def clips():
    return [*map(recorded, SIGNED), recorded("swimming", "negative")]


def test_a_clip_is_cut_into_its_signs(clips):
    found = pieces(clips[0])
    assert [",".join(piece.pair) for piece in found] == SIGNED["STOP HOVER 50 GO"].split()
    assert all(len(piece.held) == 24 for piece in found)
    assert sum(len(piece.frames) for piece in found) == 6 * 24 + 5 * 8 + 2 * 4
    assert pieces(clips[-1]) == []


def test_what_the_grammar_makes_of_signs():
    pairs = [tuple(pair.split(",")) for pair in SIGNED["STOP HOVER 50 GO"].split()]
    assert read_ideally(pairs, GRAMMAR) == ("STOP HOVER 50 GO",)
    assert read_ideally(pairs[1:], GRAMMAR) == ()


def test_damage_is_the_same_each_time_and_never_shows_a_sign_twice_in_a_row(clips):
    made = damage(clips, 50, GRAMMAR, 1)
    assert made == damage(clips, 50, GRAMMAR, 1)
    assert {item.kind for item in made} == set(KINDS)
    assert all(one != other for item in made for one, other in zip(item.shown, item.shown[1:], strict=False))


@pytest.mark.parametrize("rule", ["frames", "sentence"])
def test_signs_that_are_read_without_doubt_are_never_corrected(clips, rule):
    row, blamed = damage_row(damage(clips, 50, GRAMMAR, 2), GRAMMAR, rule)
    assert (row["wrong"], blamed) == (0, [])
    assert suite_row(clips, GRAMMAR, rule) == {"water": 3, "land": 0, "real": 0, "wrong": 0}
    assert time_row(clips, GRAMMAR, rule, rounds=2)["frames"] == sum(len(clip.signs) for clip in clips)


def test_all_tables(clips, monkeypatch):
    monkeypatch.setattr("lightgesture.benchmarks.decoder.sentences.IDLE_S", 5.0)
    monkeypatch.setattr("lightgesture.benchmarks.decoder.sentences.CAUTIONS", (1.0,))
    tables = measure({("cnn", "sentence", 1): clips, ("cnn", "sentence", 3): clips}, 10)
    rows = {table.name: table.rows for table in tables}
    assert [row["fps"] for row in rows["sentences_suite"]] == [30.0, 10.0]
    assert rows["sentences_caution"][0]["wrong"] == 0
    assert rows["sentences_idle"][0]["instructions"] == 0
    assert idle_row(clips[:1], GRAMMAR, "frames") == {"hours": 0.0, "instructions": 0}
