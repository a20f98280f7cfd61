"""Bounds themselves, and corners of forms that no sentence of the bundled grammar reaches."""

import re

import pytest

from lightgesture.fsm.language import table
from lightgesture.fsm.language.forms import MAX_ITEMS, FormError, Vocabulary, parse_form
from lightgesture.fsm.language.table import bind, compile_table

WORDS = Vocabulary.of(["STOP", "GO", "A", "B", "END", "0", "1", "P 1", "P 2"], "AND")


def compiled(*sentences):
    forms = [parse_form("x", sentence, WORDS) for sentence in sentences]
    return forms, compile_table(forms, WORDS)


def test_a_form_may_have_as_many_places_as_are_allowed():
    assert len(parse_form("x", "STOP A " + "[B] " * (MAX_ITEMS - 3) + "GO", WORDS).items) == MAX_ITEMS


def test_a_table_may_have_as_many_transitions_as_are_allowed(monkeypatch):
    sentences = ("STOP A [seconds] GO", "STOP B P n GO")
    size = sum(map(len, compiled(*sentences)[1].transitions))
    monkeypatch.setattr(table, "MAX_TRANSITIONS", size)
    compiled(*sentences)
    monkeypatch.setattr(table, "MAX_TRANSITIONS", size - 1)
    with pytest.raises(FormError, match=f"the forms need over {size - 1} transitions"):
        compiled(*sentences)


@pytest.mark.parametrize("before", [1, 2, 3])
@pytest.mark.parametrize("words", [[], ["1"], ["1", "AND", "0"]])
def test_a_number_may_be_left_out_wherever_it_stands(before, words):
    _, compiled_table = compiled("STOP " + "A " * before + "[seconds] GO")
    state = 0
    for word in ["STOP", *["A"] * before, *words, "GO"]:
        state = compiled_table.transitions[state][word]
    assert state in compiled_table.accepting


def test_what_may_come_again_is_no_argument_though_it_stands_alone():
    (form,), compiled_table = compiled("STOP A {P n} END GO")
    arguments = bind(form, ["STOP", "A", "P 1", "P 2", "END", "GO"], compiled_table)
    assert (arguments.action, arguments.parameter, arguments.change) == ("A", None, None)


def test_what_stands_before_and_after_a_repetition_is_an_argument():
    (form,), compiled_table = compiled("STOP A P n {B} END GO")
    arguments = bind(form, ["STOP", "A", "P 2", "B", "B", "END", "GO"], compiled_table)
    assert (arguments.action, arguments.parameter, arguments.change) == ("A", 2, None)


def test_forms_that_read_the_same_are_all_named_or_refused():
    sentences = ["STOP A GO", "STOP A|B GO", "STOP A|END GO"]
    forms = [parse_form("x", sentence, WORDS) for sentence in sentences]
    with pytest.raises(FormError, match=re.escape("'STOP A GO' and 'STOP A|B GO' read the same")):
        compile_table(forms, WORDS)
    ambiguous = []
    found = compile_table(forms, WORDS, ambiguous)
    assert [(one.sentence, other.sentence) for one, other in ambiguous] == [
        ("STOP A GO", "STOP A|B GO"),
        ("STOP A GO", "STOP A|END GO"),
    ]
    assert {form.sentence for form in found.accepting.values()} == set(sentences)
