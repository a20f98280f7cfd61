"""REPEAT n ... END, as the example grammar of the documentation has it."""

from pathlib import Path

import pytest

from lightgesture.fsm import Decoder, GrammarError, Signs, load_grammar
from lightgesture.fsm.language.forms import FormError, Vocabulary, parse_form
from lightgesture.fsm.language.table import compile_table

EXAMPLE = Path(__file__).parents[2] / "docs" / "grammars" / "repeat.toml"
WORDS = Vocabulary.of(["STOP", "GO", "A", "B", "END", "0", "1", "P 1", "P 2"], "AND")


@pytest.fixture(scope="module")
def language():
    return load_grammar(EXAMPLE)


@pytest.fixture
def decode(language):
    """A function from words to what was issued or rejected."""
    pairs = {word: pair for pair, word in language.sentence_words.items()} | {"STOP": ("0", "0")}

    def sign(text):
        decoder = Decoder(language, hold=1)
        events = []
        for word in text.split():
            events += decoder.step(Signs.of_tokens(*pairs[word]), 0.0) + decoder.step(Signs(), 0.0)
        return [event for event in events if event.type in ("instruction", "rejected")]

    return sign


def test_a_loop_says_all_its_words(decode):
    (loop,) = decode("STOP REPEAT 3 HOVER 5 SNAP DOWN 1 AND 0 END GO")
    assert (loop.type, loop.kind, loop.action) == ("instruction", "loop", "REPEAT")
    assert loop.text == "STOP REPEAT 3 HOVER 5 SNAP DOWN 10 END GO"
    assert loop.words[3:-2] == ("HOVER", "5", "SNAP", "DOWN", "1", "AND", "0")
    # there may be several of each
    assert (loop.duration_s, loop.program, loop.parameter, loop.change) == (None, None, None, None)


def test_other_sentences_stay_as_they_are(decode):
    (task,) = decode("STOP HOVER 5 GO")
    assert (task.kind, task.action, task.duration_s) == ("task", "HOVER", 5)


@pytest.mark.parametrize(
    ("signed", "reason", "detail"),
    [
        ("STOP REPEAT 1 AND 1 HOVER END GO", "limit", "11 times is outside 1 to 10 times"),
        ("STOP REPEAT 0 HOVER END GO", "limit", "0 times is outside 1 to 10 times"),
        ("STOP REPEAT 2 HOVER 0 END GO", "limit", "0 s is outside 1 to 600 s"),
        ("STOP REPEAT 2 HOVER 5 HOVER 5 AND 5 AND 5 AND 5 END GO", "limit", "5555 s is outside 1 to 600 s"),
        ("STOP REPEAT 2 END", "out_of_order", None),
        ("STOP REPEAT HOVER", "out_of_order", None),
        ("STOP REPEAT 2 HOVER GO", "out_of_order", None),
        ("STOP REPEAT 2 HOVER END END", "out_of_order", None),
        ("STOP REPEAT 2 HOVER END HOVER", "out_of_order", None),
        ("STOP REPEAT 2 " + "HOVER " * 27, "limit", "a sentence has at most 30 words"),
    ],
)
def test_a_senseless_loop_is_rejected(decode, signed, reason, detail):
    (rejected,) = decode(signed)
    assert (rejected.type, rejected.reason) == ("rejected", reason)
    assert detail is None or rejected.detail == detail


def test_the_longest_sentence_itself_is_allowed(decode):
    (loop,) = decode("STOP REPEAT 2 " + "HOVER " * 25 + "END GO")
    assert len(loop.words) == 30


def accepts(sentence, words):
    """Whether the table of one form accepts the words."""
    table = compile_table([parse_form("x", sentence, WORDS)], WORDS)
    state = 0
    for word in words.split():
        if word not in table.transitions[state]:
            return False
        state = table.transitions[state][word]
    return state in table.accepting


@pytest.mark.parametrize(
    ("sentence", "words", "expected"),
    [
        ("STOP A {B} GO", "STOP A B GO", True),
        ("STOP A {B} GO", "STOP A B B B GO", True),
        ("STOP A {B} GO", "STOP A GO", False),
        ("STOP A {B} [B] GO", "STOP A B B GO", None),
        ("STOP A { A [seconds] } GO", "STOP A A 1 1 A A 0 GO", True),
        ("STOP A {[B] A} GO", "STOP A A B A GO", True),
        ("STOP A {[B] A} GO", "STOP A B GO", False),
        ("STOP A {A B} [seconds] GO", "STOP A A B A B 1 GO", True),
        ("STOP A {A B} [seconds] GO", "STOP A A B 1 A GO", False),
        ("STOP A {P n B} GO", "STOP A P B GO", False),
    ],
)
def test_what_may_come_again(sentence, words, expected):
    if expected is None:
        with pytest.raises(FormError, match="'B' could be read in two ways"):
            accepts(sentence, words)
    else:
        assert accepts(sentence, words) is expected


@pytest.mark.parametrize(
    ("sentence", "expected"),
    [
        ("STOP A {B GO", "'{' has no '}'"),
        ("STOP A B} GO", "'}' is odd or nested; write {...} once for what may come again"),
        ("STOP A {B {A} } GO", "'{' is odd or nested"),
        ("STOP A {B} {A} GO", "'{' is odd or nested"),
        ("STOP A }B{ GO", "'}' is odd or nested"),
        ("STOP A {[B]} GO", "'{...}' may be empty; put a word into it that is not optional"),
        ("STOP A {} GO", "'{...}' may be empty"),
        ("STOP A " + "[B] " * 62 + "GO", "the form has over 64 places; write several shorter forms"),
    ],
)
def test_odd_repetitions_are_named(sentence, expected):
    with pytest.raises(FormError) as caught:
        parse_form("x", sentence, WORDS)
    assert str(caught.value).startswith(expected)


@pytest.mark.parametrize(
    "sentence", ["{STOP HOVER} GO", "STOP {HOVER} GO", "STOP HOVER {GO}", "STOP HOVER {DOWN GO}"]
)
def test_the_frame_of_a_sentence_is_not_repeated(tmp_path, sentence):
    text = EXAMPLE.read_text(encoding="utf-8")
    path = tmp_path / "my.toml"
    path.write_text(text.replace("STOP HOVER|DOWN [seconds] GO", sentence), encoding="utf-8")
    with pytest.raises(GrammarError, match=r"repeats its frame; put \{...\} after the action"):
        load_grammar(path)
