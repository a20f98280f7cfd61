"""What the rule "sentence" endures: languages as large as they may be, two divers at once, and signs that change."""

import random
from itertools import product
from time import perf_counter

import pytest

from lightgesture.fsm import Decoder, GrammarError, Sign, Signs, load_grammar

RATE = 30
UNREAD = Signs(Sign(None, 0.9), Sign(None, 0.9))


def grammar_text(tokens, words):
    """A language in which every word is a task of its own; each has a pair of tokens."""
    names = [f"t{number}" for number in range(tokens)]
    pairs = list(product(names, names))[: words + 2]
    lines = [f"tokens = {names}", "[sentinels]", 'start = ["STOP"]', 'end = "GO"', "[pairs]"]
    signed = ["STOP", "GO", *(f"W{number}" for number in range(words))]
    lines += [f'"{left},{right}" = "{word}"' for (left, right), word in zip(pairs, signed, strict=True)]
    for first in range(2, len(signed), 100):
        choice = "|".join(signed[first : first + 100])
        lines += ["[[forms]]", 'kind = "task"', f'sentence = "STOP {choice} GO"']
    return "\n".join(lines), dict(zip(signed, pairs, strict=True))


def shown(decoder, signs, seconds, frame):
    events = []
    for number in range(frame, frame + round(seconds * RATE)):
        events += decoder.step(signs, number / RATE, number)
    return events


def issued(events):
    return [event.text for event in events if event.type == "instruction"]


def test_a_language_of_ten_thousand_words_is_refused_at_once(tmp_path):
    """64 tokens have 4,096 pairs; more words than that nobody could sign."""
    path = tmp_path / "huge.toml"
    path.write_text(grammar_text(101, 10_000)[0], encoding="utf-8")
    start = perf_counter()
    with pytest.raises(GrammarError, match="tokens"):
        load_grammar(path)
    assert perf_counter() - start < 20.0


def test_the_largest_language_is_read_in_bounded_time_and_memory(tmp_path):
    path = tmp_path / "large.toml"
    text, pairs = grammar_text(64, 4000)
    path.write_text(text, encoding="utf-8")
    grammar = load_grammar(path)
    decoder = Decoder(grammar, rule="sentence")
    events, frame, times = [], 0, []
    for word in ("STOP", "W3999", "GO"):
        for signs, count in ((Signs.of_tokens(*pairs[word]), 20), (UNREAD, 8)):
            for _ in range(count):
                start = perf_counter()
                events += decoder.step(signs, frame / RATE, frame)
                times.append(perf_counter() - start)
                frame += 1
    assert issued(events) == ["STOP W3999 GO"]
    assert sorted(times)[len(times) // 2] < 0.02


SENTENCES = ("0,0 5,5 ok,3 ok,ok", "pic,0 pic,pic ok,2 ok,ok")


@pytest.mark.parametrize("turn_s", [1 / RATE, 0.2, 0.8])
def test_two_divers_that_are_seen_in_turn_are_never_read_as_one(grammar, turn_s):
    """A front end that takes now one diver and now the other must not lead to what neither signed."""
    allowed = {"STOP HOVER 3 GO", "CONTD SNAP 2 GO"}
    for start in range(4):
        decoder, events = Decoder(grammar, rule="sentence"), []
        for frame in range(RATE * 8):
            turn = int(frame / RATE / turn_s + start) % 2
            signs = SENTENCES[turn].split()
            left, right = signs[min(len(signs) - 1, frame // (RATE * 2))].split(",")
            events += decoder.step(Signs(Sign(left, 0.95), Sign(right, 0.95)), frame / RATE, frame)
        assert set(issued(events)) <= allowed


def test_the_hands_of_two_divers_issue_only_what_both_halves_say(grammar):
    """The left hand of one diver and the right hand of another are a pair like any other, and no sentence by chance."""
    rng = random.Random(4)
    tokens = grammar.tokens
    decoder, events, frame = Decoder(grammar, rule="sentence"), [], 0
    hands = [rng.choice(tokens), rng.choice(tokens)]
    for _ in range(400):
        hands[rng.randrange(2)] = rng.choice(tokens)
        signs = Signs(Sign(hands[0], 0.9), Sign(hands[1], 0.9))
        events += shown(decoder, signs, rng.uniform(0.1, 0.6), frame)
        frame += RATE
    assert issued(events) == []


def outcome(grammar, signed, caution=None):
    """What becomes of pairs, each with the probability of its right hand, held for 0.7 s."""
    decoder, events, frame = Decoder(grammar, rule="sentence", caution=caution), [], 0
    for pair, chance in signed:
        left, right = pair.split(",")
        signs = Signs(Sign(left, 0.98, {left: 0.98}), Sign(right, chance, {right: chance}))
        events += shown(decoder, signs, 0.7, frame) + shown(decoder, UNREAD, 0.2, frame + 21)
        frame += 27
    events += shown(decoder, Signs(), 2.0, frame)
    told = {kind: [event for event in events if event.type == kind] for kind in ("rejected", "notice")}
    rejected = [event.reason for event in told["rejected"]]
    return issued(events), rejected, [event.detail for event in told["notice"]]


def test_the_first_word_must_be_seen_better_than_others(grammar):
    """Nothing before it speaks against it: what else was shown would be left out of the sentence."""
    rest = ("ok,ok", 0.98)
    assert outcome(grammar, [("0,0", 0.98), ("5,5", 0.4), rest]) == (["STOP HOVER GO"], [], [])
    told = outcome(grammar, [("0,0", 0.4), ("5,5", 0.98), rest])
    assert told == ([], ["weak_sign"], ["STOP was not seen well; show it again"])


def test_a_first_word_that_is_shown_again_is_seen_anew(grammar):
    signed = [("0,0", 0.4), ("0,0", 0.98), ("5,5", 0.98), ("ok,ok", 0.98)]
    assert outcome(grammar, signed)[:2] == (["STOP HOVER GO"], [])


@pytest.mark.parametrize(
    ("chance", "expected"), [(0.93, (["STOP HOVER 321 GO"], [])), (0.85, ([], ["weak_sign"]))]
)
def test_all_digits_of_a_number_must_be_seen_well_together(grammar, chance, expected):
    number = [("ok,3", chance), ("pic,ok", 0.98), ("ok,2", chance), ("pic,ok", 0.98), ("ok,1", chance)]
    signed = [("0,0", 0.98), ("5,5", 0.98), *number, ("ok,ok", 0.98)]
    assert outcome(grammar, signed)[:2] == expected
    assert outcome(grammar, [*signed[:2], number[0], signed[-1]])[:2] == (["STOP HOVER 3 GO"], [])


def test_the_end_word_must_be_seen_well(grammar):
    signed = [("0,0", 0.98), ("5,5", 0.98)]
    assert outcome(grammar, [*signed, ("ok,ok", 0.65)])[:2] == (["STOP HOVER GO"], [])
    assert outcome(grammar, [*signed, ("ok,ok", 0.5)])[:2] == ([], ["weak_sign"])


@pytest.mark.parametrize(
    ("caution", "expected"), [(0.7, ["STOP HOVER GO"]), (1.0, ["STOP HOVER GO"]), (1.2, []), (3.0, [])]
)
def test_with_more_caution_the_end_word_must_be_seen_better(grammar, caution, expected):
    signed = [("0,0", 0.98), ("5,5", 0.98), ("ok,ok", 0.65)]
    assert outcome(grammar, signed, caution)[0] == expected


def test_a_word_after_a_hardly_seen_first_one_is_not_said_to_open_nothing(grammar):
    """It may go on with what was too weak to be told; by itself it opens no sentence."""
    assert outcome(grammar, [("5,5", 0.98)])[2] == ["HOVER opens no sentence; expected CONTD or STOP"]
    assert outcome(grammar, [("0,0", 0.12), ("5,5", 0.98)])[2] == []
