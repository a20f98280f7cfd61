"""[tags] and [motions] of a grammar file, and words that say themselves."""

import pytest

from lightgesture.fsm import Decoder, GrammarError, Sign, Signs, inspect_grammar, load_grammar
from lightgesture.fsm.signs import two_cards


def test_the_bundled_cards_are_those_of_the_language():
    tags, motions = load_grammar().tags, load_grammar().motions
    assert (tags.family, tags.hold_seconds) == ("36h11", 0.3)
    assert tags.words[0] == "STOP"
    assert [tags.words[20 + digit] for digit in range(6)] == list("012345")
    assert [tags.words[30 + number] for number in range(6)] == [f"PARAM {number}" for number in range(6)]
    assert tags.words[40] == "CANCEL"
    assert (motions.left, motions.right) == (50, 51)
    assert {*motions.words.values()} == {*tags.words.values()}
    assert len(motions.words) == len({*motions.words.values()})


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            'family = "36h11"',
            'family = "99h9"',
            "tags.family: '99h9' is no family of tags that is read; use one of",
        ),
        ('family = "36h11"', 'famliy = "X"', "tags.famliy: is no id of a tag; write a whole number from 0"),
        ('4 = "HOVER"', '587 = "HOVER"', "tags.587: 36h11 has the ids 0 to 586; use one of them"),
        ('4 = "HOVER"', '04 = "HOVER"', "tags.04: is no id of a tag"),
        ('4 = "HOVER"', '-4 = "HOVER"', "tags.-4: is no id of a tag"),
        ('4 = "HOVER"', '4 = "hover"', "tags.4: 'hover' is no word"),
        ('4 = "HOVER"', "4 = 4", "tags.4: is no text; write it in quotes"),
        ("[tags]", "[[tags]]", "tags: is no table"),
        ("right_id = 51", "right_id = 50", "motions.right_id: both hands have tag 50; give each its own"),
        ("right_id = 51", "right_id = 600", "motions.right_id: 36h11 has the ids 0 to 586"),
        ('"up,up" = "UP"', '"up" = "UP"', 'motions.up: is no pair of motions; write "left hand,right hand"'),
        ('"up,up" = "UP"', '"still,still" = "UP"', 'motions."still,still": two hands at rest are no motion'),
        ('"up,up" = "UP"', '"down, down" = "UP"', 'motions."down,down": pair used twice'),
    ],
)
def test_what_is_wrong_is_told_by_its_place(write_grammar, old, new, expected):
    path = write_grammar((old, new))
    with pytest.raises(GrammarError) as caught:
        load_grammar(path)
    assert str(caught.value).startswith(f"{path}: {expected}")


def test_a_card_of_no_use_is_told_and_the_rest_can_be_used(write_grammar):
    grammar, (defect,) = inspect_grammar(write_grammar(('40 = "CANCEL"', '41 = "DANCE"')))
    assert str(defect) == "tags.41: no form uses 'DANCE'; use it in one or remove it from [tags]"
    assert grammar.control.cancel == "CANCEL"  # by a motion


def test_cancel_is_the_word_that_control_names(write_grammar):
    path = write_grammar(
        ('"5,5" = "HOVER"', '"5,5" = "HOVER"\n"1,1" = "ABORT"'),
        ('# [control]\n# cancel = "CANCEL"', '[control]\ncancel = "ABORT"'),
    )
    assert load_grammar(path).control.cancel == "ABORT"
    assert load_grammar().control.cancel == "CANCEL"


def test_two_cards_are_told_once_and_the_sentence_is_kept():
    decoder = Decoder(load_grammar(), hold=2)
    shown = [
        *[Sign("STOP", is_word=True)] * 2,
        *[two_cards("UP", "DOWN")] * 4,
        *[Sign("UP", is_word=True)] * 2,
    ]
    events = [
        event for index, sign in enumerate(shown) for event in decoder.step(Signs(left=sign), index / 30)
    ]
    assert [(event.reason, event.detail) for event in events if event.type == "notice"] == [
        ("two_cards", "DOWN and UP are two cards at once; show one")
    ]
    assert decoder.sentence == "STOP UP"
