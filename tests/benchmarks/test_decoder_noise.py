"""The simulated misreadings behind the table of the dwell rules."""

import random
from itertools import pairwise

import pytest

from lightgesture.benchmarks.decoder.latency import (
    ACCEPTING,
    arguments,
    as_read,
    measure,
    our_step,
    recorded,
)
from lightgesture.benchmarks.decoder.noise import wrong_bound
from lightgesture.benchmarks.decoder.peers import edges, transitions_step
from lightgesture.benchmarks.decoder.signing import (
    HIDDEN_RULES,
    RULES,
    SENTENCES,
    Absence,
    Hand,
    Outcome,
    sign,
)
from lightgesture.fsm import Decoder, load_grammar

GRAMMAR = load_grammar()


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_without_misreadings_every_sentence_is_read(rule):
    outcome = Outcome()
    for sentence in SENTENCES[::3]:
        sign(sentence, rule, GRAMMAR, 0.0, 1.0, random.Random(sentence), outcome)
    assert (outcome.signed, outcome.right, outcome.wrong) == (17, 17, 0)
    assert set(map(round, outcome.delays, [1] * 999)) <= {0.3, 0.4, 0.5}


@pytest.mark.parametrize(("share", "burst"), [(0.05, 1.0), (0.2, 4.0), (0.1, 10.0)])
def test_hands_go_wrong_as_often_and_as_long_as_asked(share, burst):
    hand = Hand(GRAMMAR.tokens, share, burst, random.Random(1))
    wrong = [hand.read("ok")[1] for _ in range(60_000)]
    runs = sum(later and not now for now, later in pairwise(wrong))
    assert sum(wrong) / len(wrong) == pytest.approx(share, rel=0.15)
    assert sum(wrong) / runs == pytest.approx(burst, rel=0.25)


def test_half_of_the_wrong_frames_are_unread():
    hand = Hand(GRAMMAR.tokens, 0.5, 1.0, random.Random(2))
    shown = [token for token, is_wrong in (hand.read("ok") for _ in range(8000)) if is_wrong]
    assert shown.count(None) / len(shown) == pytest.approx(0.5, abs=0.04)


def test_lost_signs_are_what_the_rule_is_for():
    """With the rule off, bursts of misreadings lose digits; with it, none of the same sentences comes out wrong."""
    found = {}
    rules = {rule.name: rule for rule in RULES}
    for rule in (rules["frames, 15"], rules["frames, 15, signs may get lost"]):
        outcome = Outcome()
        for turn in range(60):
            rng = random.Random(turn)
            sign("STOP HOVER 35 GO", rule, GRAMMAR, 0.06, 3.0, rng, outcome)
        found[rule.name] = outcome
    assert found["frames, 15, signs may get lost"].wrong > 0
    assert found["frames, 15"].wrong == 0


def test_hidden_signs_are_dropped_where_they_count_and_pauses_too():
    found = {}
    for rule in HIDDEN_RULES[:2]:
        for what in (Absence(hidden=0.3), Absence(pauses=0.5)):
            outcome = Outcome()
            for turn in range(24):
                sign("STOP HOVER 5 GO", rule, GRAMMAR, 0.0, 1.0, random.Random(turn), outcome, what)
            found[rule.count_hidden, what.hidden] = outcome
    assert found[False, 0.3].wrong > 0
    assert found[True, 0.3].wrong == 0
    assert found[False, 0.0].right == 24
    assert found[True, 0.0].right < 24


def test_the_bound_grows_with_share_and_burst():
    bounds = [
        wrong_bound(share, burst, 6.0) for share, burst in ((0.01, 1.0), (0.01, 4.0), (0.1, 4.0), (0.1, 10.0))
    ]
    assert bounds == sorted(bounds)
    assert bounds[0] == 0.0
    # 6 words of 35.5 frames, a hundredth in bursts of four that last fifteen frames with probability 0.75 ** 14
    assert bounds[1] == pytest.approx(6 * 35.5 * 0.01 / 4 * 0.75**14)
    assert wrong_bound(0.9, 50.0, 60.0) == 1.0


def test_recorded_frames_make_the_words_where_they_say():
    step = our_step(GRAMMAR, "frames")
    frames = recorded(GRAMMAR)
    types = [{event.type for event in step(*arguments(shown, index))} for index, shown in enumerate(frames)]
    assert [index for index, found in enumerate(types) if "word" in found] == [
        index for index, shown in enumerate(frames) if shown.kind == ACCEPTING
    ]
    assert sum("instruction" in found for found in types) == 4


def test_latency_tables_have_every_kind_of_frame():
    count = len(recorded(GRAMMAR))
    latency, throughput = measure(count, 400)
    assert {row["frames"] for row in latency.rows} == {"idle", "collecting", "accepting", "all"}
    assert {(row["rule"], row["frames"]) for row in throughput.rows} == {("frames", count), ("sentence", 400)}
    whats = [row["what"] for row in latency.rows]
    assert [what for what in whats if f"{what}, second core busy" in whats] == whats[: len(whats) // 2]


def test_the_rule_sentence_reads_the_recorded_frames_too():
    frames = as_read(recorded(GRAMMAR), Decoder(GRAMMAR, rule="sentence"))
    step = our_step(GRAMMAR, "sentence")
    events = [event for index, shown in enumerate(frames) for event in step(*arguments(shown, index))]
    assert sum(event.type == "instruction" for event in events) == 4
    assert sum(shown.kind == ACCEPTING for shown in frames) == 17
    assert {shown.kind for shown in frames} == {"idle", "collecting", ACCEPTING}


@pytest.mark.parametrize("always", [True, False])
def test_a_library_moves_where_the_decoder_reads_words(always):
    pytest.importorskip("transitions")
    step, ours = transitions_step(GRAMMAR, always), our_step(GRAMMAR, "frames")
    given = [arguments(shown, index) for index, shown in enumerate(recorded(GRAMMAR))]
    words = [index for index, frame in enumerate(given) if any(e.type == "word" for e in ours(*frame))]
    assert words == [index for index, shown in enumerate(recorded(GRAMMAR)) if shown.kind == ACCEPTING]
    assert [index for index, frame in enumerate(given) if step(*frame)] == words
    assert len(list(edges(GRAMMAR))) == sum(map(len, GRAMMAR.table.transitions))
