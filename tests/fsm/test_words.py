"""Every pair of the published table, idle and inside a sentence."""

from itertools import product

import pytest

from lightgesture.fsm import Signs

TOKENS = ["0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok"]
ALL_PAIRS = [f"{left},{right}" for left, right in product(TOKENS, TOKENS)]


def test_bundled_tokens_are_the_ten(grammar):
    assert list(grammar.tokens) == TOKENS


def test_bundled_table_is_the_published_one(grammar, words_to_pairs):
    inside = {pair: word.replace("_", " ") for word, pair in words_to_pairs.items()}
    inside["ok,0"] = "0"
    idle = {**inside, "ok,0": "STOP", "0,0": "STOP"}
    assert {",".join(pair): word for pair, word in grammar.sentence_words.items()} == inside
    assert {",".join(pair): word for pair, word in grammar.idle_words.items()} == idle


@pytest.mark.parametrize("pair", ALL_PAIRS)
def test_idle_pair_opens_a_sentence_or_is_reported(new_diver, pick, grammar, pair):
    diver = new_diver()
    events = diver.pairs([pair])
    word = grammar.idle_words.get(tuple(pair.split(",")))
    if word in ("STOP", "CONTD"):
        assert pick(events, "word", field="word") == [word]
        assert diver.decoder.state == "collecting"
        return
    (notice,) = pick(events, "notice")
    assert not pick(events, "word", "instruction", "rejected")
    assert diver.decoder.state == "idle"
    if word is None:
        assert (notice.reason, notice.detail) == ("unknown_pair", f"{pair} is no word; repeat it")
    else:
        assert notice.reason == "out_of_order"
        assert notice.detail == f"{word} opens no sentence; expected CONTD or STOP"


@pytest.mark.parametrize("pair", ALL_PAIRS)
def test_pair_inside_a_sentence_is_taken_reported_or_rejects(new_diver, pick, grammar, pair):
    diver = new_diver()
    diver.words("STOP HOVER")
    events = diver.pairs([pair])
    word = grammar.sentence_words.get(tuple(pair.split(",")))
    if word is None:
        (notice,) = pick(events, "notice")
        assert notice.reason == "unknown_pair"
        assert diver.decoder.sentence == "STOP HOVER"
    elif word.isdigit():
        assert pick(events, "word", field="word") == [word]
        assert diver.decoder.sentence == f"STOP HOVER {word}"
    elif word == "GO":
        assert pick(events, "instruction", field="text") == ["STOP HOVER GO"]
    else:
        (rejected,) = pick(events, "rejected")
        assert (rejected.reason, rejected.text) == ("out_of_order", f"STOP HOVER {word}")
        assert diver.decoder.state == "idle"


def test_fist_and_fist_is_stop_only_while_idle(diver, pick):
    assert pick(diver.pairs(["0,0"]), "word", field="word") == ["STOP"]
    diver.pairs(["5,5"])
    (notice,) = pick(diver.pairs(["0,0"]), "notice")
    assert notice.detail == "0,0 is no word inside a sentence; repeat it"
    assert diver.decoder.sentence == "STOP HOVER"


def test_ok_and_fist_is_stop_while_idle_and_the_digit_0_inside(diver, pick):
    events = diver.pairs(["ok,0", "5,5", "ok,1", "ok,0", "ok,ok"])
    assert pick(events, "instruction", field="words") == [("STOP", "HOVER", "1", "0", "GO")]


def test_one_missing_hand_is_no_pair(diver):
    for _ in range(50):
        assert diver.decoder.step(Signs.of_tokens("ok", None), 0.0) == []
        assert diver.decoder.step(Signs.of_tokens(None, "0"), 0.0) == []
