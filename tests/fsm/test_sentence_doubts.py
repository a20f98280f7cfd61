"""The rule "sentence" in doubt: what is asked for again, rejected, never corrected."""

import pytest

from lightgesture.fsm import Decoder, Signs, load_grammar
from tests.fsm.signing import UNREAD, Diver, issued, likely, rejected, rule_and_timeline


@pytest.fixture(name="diver")
def _diver(grammar):
    return Diver(grammar)


def test_a_sign_that_every_frame_doubts_is_read_by_what_the_table_leaves(diver):
    """No rule that goes sign by sign reads a pair at 0.4; what may follow is enough here."""
    diver.words("STOP")
    diver.pair("5", "5", chance=0.4)
    assert issued(diver.words("3 GO")) == ["STOP HOVER 3 GO"]


def test_a_doubtful_digit_is_ambiguous(diver):
    diver.words("STOP HOVER")
    doubt = likely("3", 0.4, {"2": 0.38})
    diver.show(Signs(likely("ok"), doubt), 0.8)
    diver.show(UNREAD, 0.25)
    events = diver.words("GO") + diver.pause()
    assert (issued(events), rejected(events)) == ([], ["ambiguous"])
    (detail,) = [event.detail for event in events if event.type == "rejected"]
    assert "STOP HOVER 2 GO" in detail


def test_a_weak_sign_rejects_the_sentence_and_is_named(diver):
    diver.words("STOP HOVER")
    diver.show(Signs(likely("ok"), likely("3", 0.2)), 0.8)
    events = diver.show(UNREAD, 0.25) + diver.words("GO") + diver.pause()
    assert (issued(events), rejected(events)) == ([], ["weak_sign"])


def test_a_number_must_be_seen_better_than_a_word_that_little_else_could_be(diver):
    diver.words("STOP HOVER")
    diver.show(Signs(likely("ok"), likely("3", 0.6)), 0.8)
    events = diver.show(UNREAD, 0.25) + diver.words("GO") + diver.pause()
    assert (issued(events), rejected(events)) == ([], ["weak_sign"])


def test_a_weak_sign_is_asked_for_again_and_its_repetition_takes_its_place(diver):
    diver.words("STOP HOVER")
    events = diver.show(Signs(likely("ok"), likely("3", 0.2)), 0.8) + diver.show(UNREAD, 0.25)
    assert [event.detail for event in events if event.type == "notice"] == [
        "3 was not seen well; show it again"
    ]
    diver.show(UNREAD, 0.6)
    assert issued(diver.words("3 GO")) == ["STOP HOVER 3 GO"]


def test_what_comes_too_soon_to_be_a_repetition_is_the_next_word(diver):
    diver.words("STOP HOVER")
    diver.show(Signs(likely("ok"), likely("3", 0.4)), 0.8)
    diver.show(UNREAD, 0.25)
    events = diver.words("3 GO") + diver.pause()
    assert (issued(events), rejected(events)) == ([], ["weak_sign"])
    assert [event.text for event in events if event.type == "rejected"] == ["STOP HOVER 33 GO"]


def test_a_sign_that_nobody_could_read_is_not_passed_over(diver):
    diver.words("STOP HOVER")
    diver.show(UNREAD, 0.8)
    events = diver.words("GO") + diver.pause()
    assert (issued(events), rejected(events)) == ([], ["passed_over"])


@pytest.mark.parametrize(
    ("caution", "passage_s", "reasons"),
    [
        (0.5, 0.8, []),
        (0.5, 1.2, ["passed_over"]),
        (1.0, 0.3, []),
        (1.0, 0.6, ["passed_over"]),
        (2.0, 0.15, []),
        (2.0, 0.4, ["passed_over"]),
    ],
)
def test_how_long_a_passage_may_last_is_divided_by_caution(grammar, caution, passage_s, reasons):
    diver = Diver(grammar, caution=caution, passage_s=0.15)
    diver.words("STOP HOVER", chance=0.99)
    diver.show(UNREAD, passage_s - 0.15)
    diver.words("GO", chance=0.99)
    diver.pause(2.0)
    assert rejected(diver.events) == reasons


def test_a_word_that_opens_nothing_is_not_told_while_a_sentence_may_be_beginning(grammar):
    """Twice the control's least, but weak for a first word: the word after it might be the second one."""
    diver = Diver(grammar)
    diver.pair("0", "0", chance=0.5)
    events = diver.words("HOVER")
    assert [event.reason for event in events if event.type == "notice"] == []
    assert [event.text for event in events if event.type == "rejected"] == []


def test_what_hides_both_hands_is_a_pause_unless_it_counts(grammar, write_grammar):
    diver = Diver(grammar)
    diver.words("STOP HOVER")
    diver.pause(1.0)
    assert issued(diver.words("GO")) == ["STOP HOVER GO"]
    diver = Diver(load_grammar(write_grammar(("count_hidden = false", "count_hidden = true"))))
    diver.words("STOP HOVER")
    diver.pause(1.0)
    assert rejected(diver.words("GO") + diver.pause()) == ["passed_over"]


@pytest.mark.parametrize("pairs", ["3,left", "5,5 5,1", "pic,0"])
def test_nonsense_is_never_corrected(diver, pairs):
    diver.words("STOP HOVER")
    for pair in pairs.split():
        diver.pair(*pair.split(","))
    events = diver.words("5 GO") + diver.pause()
    assert issued(events) == []
    assert rejected(diver.events)


def test_after_a_rejection_its_rest_is_no_sentence_until_the_diver_pauses(diver):
    """The digit 0 is the sign of STOP."""
    diver.pairs["STOP"] = ("ok", "0")
    diver.words("STOP HOVER")
    diver.pair("3", "left")
    diver.pair("2", "left")
    assert issued(diver.words("0 HOVER GO")) == []
    diver.pause(2.0)
    assert issued(diver.words("STOP HOVER GO")) == ["STOP HOVER GO"]


def test_a_start_word_in_mid_sentence_rejects(diver):
    diver.words("STOP")
    events = diver.words("CONTD SNAP GO")
    assert (issued(events), rejected(diver.events)) == ([], ["out_of_order"])


def test_the_same_word_again_needs_a_passage(diver):
    diver.words("STOP HOVER")
    diver.show(Signs(likely("ok"), likely("5")), 3.0)
    diver.show(UNREAD, 0.25)
    assert issued(diver.words("GO")) == ["STOP HOVER 5 GO"]
    diver.pause()
    assert issued(diver.words("STOP HOVER 5 5 GO")) == ["STOP HOVER 55 GO"]


def test_numbers_out_of_range_and_unknown_programs_are_rejected(diver):
    assert rejected(diver.words("STOP EXEC 5 GO")) == ["unknown_program"]
    diver.pause()
    assert rejected(diver.words("STOP HOVER 0 GO")) == ["limit"]
    diver.pause()
    assert rejected(diver.words("STOP HOVER 5 4 3 2 1 GO")) == ["limit"]


def test_an_open_sentence_times_out_and_ends_with_the_input(diver):
    diver.words("STOP HOVER")
    assert rejected(diver.pause(21.0)) == ["timeout"]
    diver.words("STOP HOVER")
    assert rejected(diver.decoder.finish()) == ["cancelled"]
    assert (diver.decoder.state, diver.decoder.sentence) == ("idle", "")


def test_what_was_too_weak_to_be_told_is_forgotten_in_time(grammar):
    rule, timeline = rule_and_timeline(grammar)
    for frame in range(24):
        rule.process(
            Signs(likely("0", 0.3), likely("0", 0.2)), timeline.advance(frame / 30), 1 / 30 * (frame > 0)
        )
    assert any(rule.search.beam.readings)
    for frame in range(24, 924):
        rule.process(Signs(), timeline.advance(frame / 30), 1 / 30)
    assert not any(rule.search.beam.readings)


def test_a_word_that_opens_nothing_is_told(diver):
    events = diver.words("HOVER")
    assert [event.reason for event in events if event.type == "notice"] == ["out_of_order"]


def test_state_shows_the_best_reading_how_sure_it_is_and_what_may_follow(diver):
    diver.words("STOP HOVER 5")
    state = [event for event in diver.events if event.type == "state"][-1]
    assert (state.state, state.sentence) == ("collecting", "STOP HOVER 5")
    record = state.to_dict()["certainty"]
    assert [word for word, _ in record["words"]] == ["STOP", "HOVER", "5"]
    assert all(0.9 < sure <= 1.0 for _, sure in record["words"])
    assert record["expected"] == "AND or GO or a digit"
    assert (diver.decoder.state, diver.decoder.sentence) == ("collecting", "STOP HOVER 5")
    growing = [event.dwell for event in diver.events if event.type == "state" and event.dwell]
    assert {growth.word for growth in growing} >= {"STOP", "HOVER", "5"}


def test_the_readings_of_a_verdict_can_be_asked_for(diver):
    diver.words("STOP HOVER 5 GO")
    best = diver.decoder.readings[0]
    assert [word for word, _ in best.words] == ["STOP", "HOVER", "5", "GO"]
    assert best.longest_s < 0.3
    assert Decoder(diver.decoder.grammar).readings == ()


@pytest.mark.parametrize(("digits", "cost"), [("5 AND 4", 0.0), ("5 4", 3.0), ("5 5", 0.0), ("5 4 3", 3.0)])
def test_the_first_digit_without_the_joining_word_costs_something_unless_it_repeats_one(diver, digits, cost):
    diver.words("STOP HOVER 5 GO")
    alone = diver.decoder.readings[0].behind
    diver.pause()
    diver.words(f"STOP HOVER {digits} GO")
    assert diver.decoder.readings[0].behind - alone == pytest.approx(cost, abs=1.5)
