"""The rule "sentence": what it issues, what it doubts, and that neither rate nor odd input matters."""

import math
import random
from pathlib import Path

import pytest

from lightgesture.fsm import UNSEEN, Decoder, Sign, Signs, load_grammar
from lightgesture.fsm.language.forms import spell
from lightgesture.fsm.reader import Reader
from lightgesture.fsm.reporter import Reporter, Timeline
from lightgesture.fsm.rules import beam
from lightgesture.fsm.rules.sentence import SentenceRule

RATES = (10, 30, 60)
UNREAD = Signs(Sign(None, 0.97, {"none": 0.97}), Sign(None, 0.97, {"none": 0.97}))
GRAMMARS = Path(__file__).parents[2] / "docs" / "grammars"


def likely(token, chance=0.97, others=None):
    """A hand whose reader names a token with this probability; others: probabilities of other tokens."""
    return Sign(token, chance, {token: chance, **(others or {})})


class Diver:
    """Signs words for `held_s` each, hands passing from one to the next for `passage_s`, at `rate` frames a second."""

    def __init__(self, grammar, rate=30, held_s=0.8, passage_s=0.25, **options):
        self.decoder = Decoder(grammar, rule="sentence", **options)
        self.rate, self.held_s, self.passage_s = rate, held_s, passage_s
        self.pairs = {word: pair for pair, word in grammar.sentence_words.items()}
        self.pairs |= {word: pair for pair, word in grammar.menu_words.items()}
        self.pairs |= {word: pair for pair, word in grammar.idle_words.items() if word not in self.pairs}
        self.pairs["STOP"] = ("0", "0")
        self.frame = 0
        self.events = []

    def show(self, signs, seconds):
        events = []
        for _ in range(max(1, round(seconds * self.rate))):
            events += self.decoder.step(signs, self.frame / self.rate, self.frame)
            self.frame += 1
        self.events += events
        return events

    def pair(self, left, right, chance=0.97, seconds=None):
        signs = Signs(likely(left, chance), likely(right, chance))
        return self.show(signs, self.held_s if seconds is None else seconds) + self.show(
            UNREAD, self.passage_s
        )

    def words(self, words, **how):
        events = []
        for word in words.split() if isinstance(words, str) else words:
            events += self.pair(*self.pairs[word.replace("_", " ")], **how)
        return events

    def pause(self, seconds=1.0):
        return self.show(Signs(), seconds)


def issued(events):
    return [event.text for event in events if event.type == "instruction"]


def rejected(events):
    return [event.reason for event in events if event.type == "rejected"]


@pytest.fixture
def diver(grammar):
    return Diver(grammar)


def sentences(grammar, most):
    """Every sentence of up to `most` words that the table accepts, sensible or not."""
    found, waiting = [], [((), 0)]
    while waiting:
        words, state = waiting.pop()
        if state in grammar.table.accepting and words:
            found.append(words)
        elif len(words) < most:
            waiting += [((*words, word), target) for word, target in grammar.table.transitions[state].items()]
    return found


def check_sentences(grammar, most, rate):
    for words in sentences(grammar, most):
        diver = Diver(grammar, rate)
        diver.pause(0.3)
        events = diver.words(words) + diver.decoder.finish()
        by_frames = Decoder(grammar, hold=1)
        expected = []
        for word in words:
            expected += by_frames.step(Signs.of_tokens(*diver.pairs[word]), 0.0) + by_frames.step(
                Signs(), 0.0
            )
        assert issued(events) == issued(expected), words
        assert rejected(events) == rejected(expected), words
        told = [event.word for event in events if event.type == "word"]
        assert told == list(words)


@pytest.mark.parametrize("rate", RATES)
def test_every_short_sentence_is_read_at_any_rate(grammar, rate):
    check_sentences(grammar, 4, rate)


@pytest.mark.slow
@pytest.mark.parametrize("rate", RATES)
def test_every_longer_sentence_is_read_at_any_rate(grammar, rate):
    check_sentences(grammar, 5, rate)


STUDY = (
    "STOP HOVER 5 AND 0 GO",
    "STOP EXEC 1 GO",
    "CONTD SNAP 2 AND 0 GO",
    "CONTD PARAM_3 DECREASE GO",
    "STOP EXEC 2 GO CONTD SNAP GO",
    "CONTD SNAP 5 AND 0 GO STOP FOLLOW GO",
)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("sentence", STUDY)
def test_the_instructions_of_the_study(grammar, rate, sentence):
    diver = Diver(grammar, rate)
    expected = [
        spell([*part.replace("_", " ").strip().split(), "GO"], "AND") for part in sentence.split("GO")[:-1]
    ]
    assert issued(diver.words(sentence)) == [text.replace("PARAM 3", "PARAM 3") for text in expected]


@pytest.mark.parametrize("rate", [120, 500])
def test_a_fast_camera_reads_the_same(grammar, rate):
    """Frames that come faster than they are remembered share a place."""
    assert issued(Diver(grammar, rate).words("STOP HOVER 5 GO")) == ["STOP HOVER 5 GO"]


def test_dropped_frames_do_not_matter(grammar):
    rng = random.Random(5)
    for _ in range(5):
        diver = Diver(grammar, 30)
        step = diver.decoder.step
        diver.decoder.step = lambda *given, step=step: [] if rng.random() < 0.3 else step(*given)
        assert issued(diver.words("STOP HOVER 5 AND 0 GO")) == ["STOP HOVER 50 GO"]


def test_a_word_is_told_and_an_instruction_issued_within_the_limits(diver):
    for number, word in enumerate(["STOP", "HOVER", "5", "GO"]):
        diver.show(UNREAD, 0.25)
        first = diver.frame
        diver.show(Signs(*map(likely, diver.pairs[word])), 0.8)
        told = [event for event in diver.events if event.type in ("word", "instruction")][number:]
        assert (told[0].frame - first) / 30 <= (0.5 if word != "GO" else 0.6)
    assert told[-1].type == "instruction"


def test_the_record_of_an_instruction(diver):
    diver.pause(1.0)
    (event,) = [event for event in diver.words("STOP HOVER 5 GO") if event.type == "instruction"]
    assert (event.text, event.kind, event.action, event.duration_s) == ("STOP HOVER 5 GO", "task", "HOVER", 5)
    assert event.words == ("STOP", "HOVER", "5", "GO")
    assert abs(event.start_time_s - 1.0) <= 0.1
    assert event.confidence == pytest.approx(0.97, abs=0.02)


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


def rule_and_timeline(grammar):
    """The rule by itself, without the decoder round it."""
    timeline = Timeline()
    reporter = Reporter(None, timeline)
    reader = Reader(grammar, reporter, timeline)
    return SentenceRule(grammar, grammar.sentence, reader, reporter, timeline), timeline


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


class TestControl:
    @pytest.fixture
    def diver(self):
        return Diver(load_grammar(GRAMMARS / "sonar.toml"))

    def test_kill_acts_at_once_in_every_state(self, diver):
        assert issued(diver.show(Signs(*map(likely, diver.pairs["ABORT"])), 0.5)) == ["ABORT"]
        diver.pause()
        diver.words("STOP HOVER")
        events = diver.show(Signs(*map(likely, diver.pairs["ABORT"])), 0.5)
        assert (issued(events), rejected(events)) == (["ABORT"], ["cancelled"])

    def test_a_kill_that_is_held_is_issued_once(self, diver):
        assert issued(diver.show(Signs(*map(likely, diver.pairs["ABORT"])), 60.0)) == ["ABORT"]

    def test_cancel_drops_the_open_sentence(self, diver):
        diver.words("STOP HOVER")
        assert rejected(diver.words("CANCEL")) == ["cancelled"]
        assert diver.decoder.state == "idle"

    def test_confirmation_wants_the_end_word_twice(self, diver):
        events = diver.words("STOP SONAR 3 GO")
        assert issued(events) == []
        assert diver.decoder.state == "confirming"
        assert issued(diver.words("GO")) == ["STOP SONAR 3 GO"]

    def test_another_word_does_not_confirm(self, diver):
        diver.words("STOP SONAR 3 GO")
        assert rejected(diver.words("HOVER")) == ["unconfirmed"]

    def test_an_end_word_that_is_held_on_does_not_confirm(self, diver):
        diver.words("STOP SONAR 3 GO", seconds=0.8)
        assert diver.decoder.state == "confirming"
        diver = Diver(diver.decoder.grammar)
        diver.words("STOP SONAR 3")
        assert issued(diver.show(Signs(likely("ok"), likely("ok")), 10.0)) == []

    def test_the_menu(self, diver):
        diver.pause()
        events = diver.words(["MENU", "SELECT 2"])
        assert [(event.kind, event.program) for event in events if event.type == "instruction"] == [
            ("menu", 2)
        ]


def test_loops(grammar):
    diver = Diver(load_grammar(GRAMMARS / "repeat.toml"))
    events = diver.words("STOP REPEAT 3 HOVER 5 SNAP END GO")
    assert issued(events) == ["STOP REPEAT 3 HOVER 5 SNAP END GO"]


def test_cards_are_words_by_themselves(grammar):
    diver = Diver(grammar)
    events = []
    for word in ("STOP", "HOVER", "0", "GO"):
        events += diver.show(Signs(UNSEEN, Sign(word, 0.99, is_word=True)), 0.6)
        events += diver.show(Signs(), 0.3)
    assert rejected(events) == ["limit"]  # the card 0 is the digit, though its pair would be STOP
    two = Signs(Sign("STOP", is_word=True), Sign("GO", is_word=True))
    assert not diver.decoder.step(two, 100.0)


# Bad input


@pytest.mark.parametrize(
    "probabilities",
    [
        {},
        {"ok": math.nan, "0": math.nan},
        {"ok": math.inf},
        {"ok": -1.0, "0": 2.0},
        dict.fromkeys(["0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok"], 0.1),
        dict.fromkeys(["0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok"], 1.0),
        dict.fromkeys(["0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok"], math.nan),
        {"unknown": 1.0},
    ],
)
def test_probabilities_that_say_nothing_issue_nothing_and_break_nothing(diver, probabilities):
    odd = Sign("ok", math.nan, probabilities)
    diver.words("STOP")
    diver.show(Signs(odd, odd), 5.0)
    diver.show(Signs(Sign("no such token", 0.9), Sign(None)), 1.0)
    assert issued(diver.events) == []
    diver.pause(25.0)
    assert issued(diver.words("STOP HOVER GO")) == ["STOP HOVER GO"]


def test_a_reader_that_knows_more_and_fewer_classes(grammar):
    diver = Diver(grammar)
    events = []
    for word in ("STOP", "HOVER", "GO"):
        left, right = diver.pairs[word]
        signs = Signs(Sign(left, 0.9, {left: 0.9, "none": 0.1}), Sign(right, 0.9, {right: 0.9, "fish": 0.1}))
        events += diver.show(signs, 0.8) + diver.show(UNREAD, 0.25)
    assert issued(events) == ["STOP HOVER GO"]


@pytest.mark.parametrize("stamp", [0.0, math.nan, math.inf, -5.0])
def test_time_that_stands_still_makes_no_words(grammar, stamp):
    decoder = Decoder(grammar, rule="sentence")
    events = []
    for word in ("STOP", "HOVER", "GO"):
        for _ in range(50):
            events += decoder.step(Signs.of_tokens(*Diver(grammar).pairs[word]), stamp)
    assert [event.type for event in events if event.type != "state"] == []


def test_time_that_jumps_is_no_hold(grammar):
    decoder = Decoder(grammar, rule="sentence")
    signs = Signs.of_tokens("0", "0")
    events = decoder.step(signs, 0.0) + decoder.step(signs, 1000.0)
    assert [event.type for event in events if event.type == "word"] == []


def test_frames_that_were_dropped_may_have_hidden_a_sign(diver):
    diver.words("STOP HOVER 5")
    diver.frame += 30
    events = diver.words("GO") + diver.pause()
    assert (issued(events), rejected(events)) == ([], ["passed_over"])


@pytest.mark.parametrize("rate", [30, 1000])
def test_memory_is_bounded_whatever_comes(grammar, rate):
    """An hour of one sign, held, and of random signs: no more readings, texts or rows than at the start."""
    rng = random.Random(1)
    rule, timeline = rule_and_timeline(grammar)
    pair = ("0", "0")
    for frame in range(3000):
        if frame % 20 == 0:
            pair = rng.choice(list(grammar.idle_words))
        rule.process(
            Signs(likely(pair[0], 0.5), likely(pair[1], 0.5)), timeline.advance(frame / rate), 1 / rate
        )
        assert sum(reading is not None for reading in rule.search.beam.readings) <= beam.MOST
    assert rule.search.beam.known_texts <= beam.MOST_TEXTS


def test_a_sign_held_for_an_hour_is_one_word(grammar):
    diver = Diver(grammar, rate=5)
    events = diver.show(Signs(*map(likely, diver.pairs["CONTD"])), 3600.0)
    assert [event.type for event in events if event.type == "instruction"] == []
    diver.pause(25.0)
    diver.rate = 30
    diver.frame *= 6
    assert issued(diver.words("STOP HOVER GO")) == ["STOP HOVER GO"]


def test_random_signs_never_make_what_the_table_does_not_accept(grammar):
    rng = random.Random(2)
    for trial in range(20):
        diver = Diver(grammar)
        for _ in range(30):
            left, right = rng.choice(list(grammar.idle_words))
            diver.pair(left, right, chance=rng.uniform(0.3, 0.98), seconds=rng.uniform(0.1, 1.0))
        for event in diver.events:
            if event.type == "instruction":
                state = 0
                for word in event.words:
                    state = grammar.table.transitions[state][word]
                assert state in grammar.table.accepting, trial


def test_two_decoders_agree_and_a_finished_one_is_as_new(grammar):
    one, other = Diver(grammar), Diver(grammar)
    sentence = "STOP HOVER 5 AND 0 GO"
    assert one.words(sentence) == other.words(sentence)
    one.decoder.finish()
    again = Diver(grammar)
    again.decoder = one.decoder.for_stream(None)
    assert again.words(sentence) == other.events


def test_idle_hands_issue_nothing(grammar):
    rng = random.Random(3)
    diver = Diver(grammar)
    for _ in range(300):
        chances = {token: rng.random() for token in rng.sample(grammar.tokens, 3)}
        total = sum(chances.values()) + rng.random()
        hand = [
            Sign(None, 0.3, {token: chance / total for token, chance in chances.items()}) for _ in range(2)
        ]
        diver.show(Signs(*hand), rng.uniform(0.05, 0.6))
    assert issued(diver.events) == []


# Options


def test_caution_is_the_grammars_or_the_callers(grammar, write_grammar):
    careful = load_grammar(write_grammar(("caution = 1", "caution = 3")))
    assert careful.sentence.caution == 3
    doubt = likely("3", 0.75, {"2": 0.15})

    def outcome(language, **options):
        diver = Diver(language, **options)
        diver.words("STOP HOVER")
        diver.show(Signs(likely("ok"), doubt), 0.8)
        diver.show(UNREAD, 0.25)
        return issued(diver.words("GO") + diver.pause())

    assert outcome(grammar) == ["STOP HOVER 3 GO"]
    assert outcome(careful) == outcome(grammar, caution=3) == []
    assert outcome(careful, caution=1) == ["STOP HOVER 3 GO"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"hold": 5}, "hold: the rule sentence goes by seconds; use hold_seconds"),
        ({"hold_seconds": 0.0}, "hold_seconds is 0; use a number above 0"),
        ({"caution": math.nan}, "caution is nan; use a number above 0"),
    ],
)
def test_options_that_make_no_sense(grammar, options, message):
    with pytest.raises(ValueError, match=message):
        Decoder(grammar, rule="sentence", **options)


def test_a_rule_of_frames_has_no_seconds_and_a_rule_of_seconds_no_frames(grammar):
    with pytest.raises(ValueError, match="the rule frames goes by frames"):
        Decoder(grammar, rule="frames", hold_seconds=0.5)
    with pytest.raises(ValueError, match="the rule evidence goes by seconds"):
        Decoder(grammar, rule="evidence", hold=5)
    assert Decoder(grammar, rule="seconds").hold_seconds == 0.5


def test_it_is_the_default_and_the_grammar_may_name_another(grammar, write_grammar):
    by_frames = Decoder(load_grammar(write_grammar(('rule = "sentence"', 'rule = "frames"'))))
    assert (by_frames.rule, by_frames.hold_frames) == ("frames", 15)
    assert Decoder(load_grammar(write_grammar(('rule = "sentence"', "")))).rule == "sentence"
    assert Decoder(grammar, hold=9).hold_frames == 9
    diver = Diver(grammar)
    diver.decoder = Decoder(grammar)
    assert (diver.decoder.rule, diver.decoder.hold_seconds, diver.decoder.hold_frames) == (
        "sentence",
        0.4,
        None,
    )
    assert issued(diver.words("STOP HOVER GO")) == ["STOP HOVER GO"]
