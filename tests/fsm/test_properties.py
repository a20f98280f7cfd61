"""What must hold for any sequence of pairs."""

from collections.abc import Iterator
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.fsm import Decoder, Sign, Signs, load_grammar
from lightgesture.fsm.language.forms import spell

GRAMMAR = load_grammar()
TOKENS = st.sampled_from([*GRAMMAR.tokens, None])
WORDS = st.sampled_from(sorted(GRAMMAR.idle_words)) | st.tuples(TOKENS, TOKENS)
STAMPS = st.floats(min_value=-30, max_value=60, allow_nan=False) | st.just(float("nan"))
NOISE = st.tuples(WORDS, st.integers(1, 4), STAMPS).map(lambda sign: [sign])
SENTENCES = st.sampled_from(
    [
        "0,0 5,5 ok,ok",
        "ok,0 5,1 ok,2 ok,0 ok,ok",
        "0,0 pic,2 ok,3 ok,ok",
        "pic,0 3,pic ok,pic ok,ok",
        "0,0 pic,2 ok,5 ok,ok",
    ]
).map(lambda text: [(tuple(pair.split(",")), 4, 0.0) for pair in text.split()])
FRAMES = st.lists(NOISE | SENTENCES, max_size=30).map(lambda parts: [sign for part in parts for sign in part])
"""Signs as (pair, frames held, pause in seconds): true sentences among arbitrary pairs."""

HOLDS = st.integers(1, 4)


def decode(frames, hold):
    """The events of every step; every pair is repeated and time goes on by the given amount each frame."""
    decoder = Decoder(GRAMMAR, hold=hold)
    steps = []
    time_s = 0.0
    for (left, right), count, pause_s in frames:
        for _ in range(count):
            steps.append(
                decoder.step(
                    Signs(Sign(left, 0.9, seen=left is not None), Sign(right, 0.8, seen=right is not None)),
                    time_s,
                )
            )
            time_s += 1 / 30
        time_s += pause_s if abs(pause_s) < 25 else 0.0
    steps.append(decoder.finish())
    return steps


@given(FRAMES, HOLDS)
@settings(max_examples=300, deadline=None)
def test_no_instruction_without_start_and_end_word_and_every_sentence_ends_once(frames, hold):
    events = [event for step in decode(frames, hold) for event in step]
    signed: list[str] = []
    for event in events:
        if event.type == "word":
            signed.append(event.word)
        elif event.type == "instruction":
            assert list(event.words) == signed
            assert signed[0] in ("STOP", "CONTD")
            assert signed[-1] == "GO"
            assert not {"STOP", "CONTD", "GO"} & set(signed[1:-1])
            assert event.start_frame <= event.frame
            assert event.program is None or event.program in GRAMMAR.programs
            assert event.duration_s is None or 1 <= event.duration_s <= 600
            signed = []
        elif event.type == "rejected":
            assert signed, "only an open sentence can be rejected"
            signed = []
    assert not signed


@given(FRAMES, HOLDS)
@settings(max_examples=100, deadline=None)
def test_two_decoders_fed_the_same_agree(frames, hold):
    assert decode(frames, hold) == decode(frames, hold)


@given(FRAMES, HOLDS)
@settings(max_examples=150, deadline=None)
def test_state_records_follow_the_sentence(frames, hold):
    """The last state record of a step is the state; what it shows is what the words add up to."""
    signed: list[str] = []
    for step in decode(frames, hold):
        for event in step:
            if event.type == "word":
                signed.append(event.word)
            elif event.type in ("instruction", "rejected"):
                signed = []
            elif event.type == "state":
                assert event.sentence == spell(signed, "AND")
                assert event.state == ("collecting" if signed else "idle")


@given(st.lists(st.sampled_from(sorted(GRAMMAR.idle_words)), max_size=40))
@settings(max_examples=100, deadline=None)
def test_a_sign_shorter_than_the_hold_says_nothing(pairs):
    shortened = [pair for index, pair in enumerate(pairs) if index == 0 or pair != pairs[index - 1]]
    decoder = Decoder(GRAMMAR, hold=4)
    events = [
        event for pair in shortened for _ in range(3) for event in decoder.step(Signs.of_tokens(*pair), 0.0)
    ]
    assert not [event for event in events if event.type != "state"]


RULES = {
    "frames": {},
    "seconds": {"hold_seconds": 0.5},
    "evidence": {"hold_seconds": 0.4},
}
"""Dwell rules with the options of their decoders."""


def language(rule):
    """The bundled grammar with another rule of dwell."""
    return replace(GRAMMAR, dwell=replace(GRAMMAR.dwell, rule=rule))


SEEN = st.booleans()
TOLD = st.tuples(WORDS, st.integers(1, 20), SEEN, SEEN, st.floats(0.3, 1.0))
"""A pair, how long it is shown, which hands are in view, and its probability."""


@given(st.lists(TOLD, max_size=25), st.sampled_from(sorted(RULES)), st.sampled_from([10, 30, 60]))
@settings(max_examples=60, deadline=None)
def test_no_rule_issues_what_was_not_signed(signs, rule, rate):
    """The words of an instruction were accepted in this order since the last sentence ended, whatever was shown."""
    decoder = Decoder(language(rule), **RULES[rule])
    signed: list[str] = []
    frame = 0
    for (left, right), count, left_seen, right_seen, confidence in signs:
        for _ in range(count):
            signs = Signs(Sign(left, confidence, seen=left_seen), Sign(right, seen=right_seen))
            events = decoder.step(signs, frame / rate, frame)
            frame += 1
            for event in events:
                if event.type == "word":
                    signed.append(event.word)
                elif event.type == "instruction":
                    assert list(event.words) == signed
                    assert (signed[0] in ("STOP", "CONTD"), signed[-1]) == (True, "GO")
                    signed = []
                elif event.type == "rejected":
                    signed = []


def sentences(state: int, words: list[str], length: int) -> Iterator[list[str]]:
    """All complete sentences of at most `length` words that the table allows."""
    if state in GRAMMAR.table.accepting:
        yield words
    if len(words) < length:
        for word, target in GRAMMAR.table.transitions[state].items():
            yield from sentences(target, [*words, word], length)


def test_every_sentence_up_to_five_words_decodes_to_itself():
    inside = {word: pair for pair, word in GRAMMAR.sentence_words.items()} | {"STOP": ("0", "0")}
    every = list(sentences(0, [], 5))
    assert len(every) == 6 * (1 + 6 + 36) + (6 + 36) + 6 * 3 + (1 + 6 + 36)
    decoder = Decoder(GRAMMAR, hold=1)
    for words in every:
        events = []
        for word in words:
            events += decoder.step(Signs.of_tokens(*inside[word]), 0.0) + decoder.step(Signs(), 0.0)
        outcome = [event for event in events if event.type in ("instruction", "rejected", "notice")]
        assert len(outcome) == 1
        assert outcome[0].text == spell(words, "AND")
        if outcome[0].type == "instruction":
            assert list(outcome[0].words) == words
        else:
            assert outcome[0].reason in ("unknown_program", "limit")


def decode_by_rule(words, rule, rate, hold_s=0.7, passage_s=0.3):
    """What is issued or rejected when words are signed at a rate of frames; hands are unread between two signs."""
    inside = {word: pair for pair, word in GRAMMAR.sentence_words.items()} | {"STOP": ("0", "0")}
    decoder = Decoder(language(rule), **(RULES[rule] or {"hold": rate // 2}))
    events = []
    frame = 0
    for word in words:
        for shown, seconds in ((None, passage_s), (inside[word], hold_s)):
            for _ in range(round(seconds * rate)):
                left, right = shown or (None, None)
                events += decoder.step(
                    Signs(Sign(left, 0.95), Sign(right, 0.9)), round(frame / rate, 3), frame
                )
                frame += 1
    return [event for event in events if event.type in ("instruction", "rejected", "notice")]


def check_every_sentence(length, rule, rate):
    for words in sentences(0, [], length):
        (outcome,) = decode_by_rule(words, rule, rate)
        assert outcome.text == spell(words, "AND")
        if outcome.type == "instruction":
            assert list(outcome.words) == words
        else:
            assert outcome.reason in ("unknown_program", "limit")


@pytest.mark.parametrize("rate", [10, 30, 60])
@pytest.mark.parametrize("rule", sorted(RULES))
def test_every_sentence_of_four_words_decodes_to_itself_at_any_rate(rule, rate):
    check_every_sentence(4, rule, rate)


@pytest.mark.slow
@pytest.mark.parametrize("rate", [10, 30, 60])
@pytest.mark.parametrize("rule", sorted(RULES))
def test_every_sentence_of_six_words_decodes_to_itself_at_any_rate(rule, rate):
    check_every_sentence(6, rule, rate)
