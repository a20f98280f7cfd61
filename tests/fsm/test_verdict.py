"""When the rule "sentence" decides: how long it waits, what ends the waiting, and what it says of its own accord."""

import pytest

from lightgesture.fsm import Decoder, Sign, Signs, load_grammar
from lightgesture.fsm.rules.sentence import PATIENCE_S, PAUSE_S, SETTLE_S

UNREAD = Signs(Sign(None, 0.97, {"none": 0.97}), Sign(None, 0.97, {"none": 0.97}))
HOLD_S = 0.4


class Stream:
    """Frames before a decoder, `rate` a second. events: with their seconds."""

    def __init__(self, grammar, rate=20, **options):
        self.decoder, self.rate = Decoder(grammar, rule="sentence", **options), rate
        self.pairs = {word: pair for pair, word in grammar.sentence_words.items()}
        self.pairs |= {word: pair for pair, word in grammar.idle_words.items() if word not in self.pairs}
        self.pairs["STOP"] = ("0", "0")
        self.frame, self.events = 0, []

    def show(self, signs, seconds):
        for _ in range(round(seconds * self.rate)):
            self.events += self.decoder.step(signs, self.frame / self.rate, self.frame)
            self.frame += 1
        return self

    def sign(self, sentence, held_s=0.8, passage_s=0.2, **others):
        """others: of the right hand, probabilities of other tokens than the one that is signed."""
        for word in sentence.split():
            left, right = self.pairs[word]
            chances = {
                right: 0.97 - sum(others.values()),
                **{name.strip("_"): p for name, p in others.items()},
            }
            self.show(Signs(Sign(left, 0.97, {left: 0.97}), Sign(right, chances[right], chances)), held_s)
            self.show(UNREAD, passage_s)
        return self

    def rest(self, seconds=1.0):
        return self.show(Signs(), seconds)

    def told(self, kind, field):
        return [getattr(event, field) for event in self.events if event.type == kind]

    @property
    def seconds(self):
        return self.frame / self.rate


@pytest.fixture
def stream(grammar):
    return Stream(grammar)


def test_four_frames_a_second_are_enough_and_three_are_not(grammar):
    for rate, expected in ((4, ["STOP HOVER 5 GO"]), (3, [])):
        stream = Stream(grammar, rate).rest().sign("STOP HOVER 5 GO", held_s=2.0, passage_s=0.25)
        assert stream.told("instruction", "text") == expected


def test_an_end_word_is_looked_at_a_little_beyond_the_least_length(stream):
    stream.rest().sign("STOP HOVER 5")
    begun_s = stream.seconds
    stream.sign("GO")
    (issued_s,) = stream.told("instruction", "time_s")
    assert HOLD_S - 0.15 + SETTLE_S <= issued_s - begun_s <= HOLD_S + SETTLE_S + 0.05


@pytest.mark.parametrize(("held_s", "waits_s"), [(0.5, PATIENCE_S), (4.0, 2 * PATIENCE_S + HOLD_S)])
def test_a_sentence_in_doubt_waits_for_the_doubt_to_pass_longer_while_its_end_word_is_held(
    stream, held_s, waits_s
):
    stream.rest().sign("STOP HOVER").sign("3", _2=0.45)
    begun_s = stream.seconds
    stream.sign("GO", held_s).rest(3.0)
    ((reason, rejected_s),) = zip(
        stream.told("rejected", "reason"), stream.told("rejected", "time_s"), strict=True
    )
    assert reason == "ambiguous"
    entered_s = begun_s + HOLD_S - 0.15
    assert entered_s + waits_s <= rejected_s <= begun_s + HOLD_S + waits_s + 0.1


def rejected(stream):
    """A sentence that makes no sense is dropped on the way; the diver does not look."""
    stream.rest().sign("STOP HOVER 3").sign("UP UP")
    assert stream.told("instruction", "text") == []
    assert stream.told("rejected", "reason")
    return stream


def test_after_a_rejection_a_pause_or_an_end_word_begins_anew(grammar):
    for between, expected in (
        (lambda stream: stream.rest(PAUSE_S - 0.3), []),
        (lambda stream: stream.rest(PAUSE_S + 0.1), ["STOP HOVER 5 GO"]),
        (lambda stream: stream.rest(0.3).sign("GO").rest(0.3), ["STOP HOVER 5 GO"]),
        (lambda stream: stream.rest(0.3).sign("HOVER").rest(0.3), []),
        (lambda stream: stream.rest(0.8).sign("UP").rest(0.8), []),
    ):
        stream = rejected(Stream(grammar))
        stream.pairs["STOP"] = ("ok", "0")  # inside a sentence it is the digit 0
        between(stream)
        stream.sign("STOP HOVER 5 GO").rest()
        assert stream.told("instruction", "text") == expected


def test_a_sentence_without_a_new_word_is_dropped_after_its_time(stream, grammar):
    stream.rest().sign("STOP HOVER")
    stream.rest(grammar.dwell.timeout_s + 1.0)
    assert stream.told("rejected", "reason") == ["timeout"]
    told_s = stream.told("word", "time_s")[-1]
    assert stream.told("rejected", "time_s")[0] - told_s == pytest.approx(grammar.dwell.timeout_s, abs=0.051)
    stream.sign("5 GO").rest()
    assert stream.told("instruction", "text") == []


def test_what_cannot_follow_is_named_with_what_could(stream):
    stream.rest().sign("STOP", 0.8).sign("CONTD").rest()
    (detail,) = stream.told("rejected", "detail")
    assert detail.startswith("CONTD cannot follow STOP; expected DOWN or EXEC")


def test_a_word_that_opens_no_sentence_is_told_once_a_hold(stream):
    stream.rest().sign("HOVER", 2.0).rest(0.5).sign("HOVER").rest(0.5)
    assert stream.told("notice", "reason") == ["out_of_order"] * 2
    assert stream.told("notice", "detail") == ["HOVER opens no sentence; expected CONTD or STOP"] * 2
    assert stream.told("rejected", "reason") == []


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        ("5 AND 0", "STOP HOVER 50 GO"),
        ("5 0", "STOP HOVER 50 GO"),
        ("5 AND 0 AND 2", "limit"),
        ("0 AND 0 AND 5", "limit"),
        ("5 AND 5 AND 5", "limit"),
        ("5 5 5", "limit"),
    ],
)
def test_a_number_has_its_most_digits_joined_or_not(write_grammar, number, expected):
    """Digits with the joining word between them were once counted each as a number of its own."""
    short = load_grammar(write_grammar(("max_digits = 4", "max_digits = 2")))
    stream = Stream(short).rest().sign(f"STOP HOVER {number} GO").rest()
    assert stream.told("rejected", "reason") + stream.told("instruction", "text") == [expected]


def test_where_frames_are_missing_nothing_of_before_is_left(stream):
    stream.rest().sign("STOP HOVER")
    stream.frame += 20 * 8
    stream.sign("5 GO").rest()
    assert stream.told("instruction", "text") == []
    stream.rest(2.0).sign("STOP HOVER 5 GO").rest()
    assert stream.told("instruction", "text") == ["STOP HOVER 5 GO"]


def test_the_end_of_a_stream_drops_what_is_open_and_another_stream_begins_as_the_first(stream):
    stream.rest().sign("STOP HOVER 5")
    stream.events += stream.decoder.finish()
    assert len(stream.told("rejected", "reason")) == 1
    stream.sign("GO").rest()
    assert stream.told("instruction", "text") == []
    stream.rest(2.0).sign("STOP HOVER 5 GO").rest()
    assert stream.told("instruction", "text") == ["STOP HOVER 5 GO"]


def test_all_words_are_told_once_and_in_order_before_the_instruction(stream):
    stream.rest().sign("STOP HOVER 5 AND 0 GO").rest()
    assert stream.told("word", "word") == ["STOP", "HOVER", "5", "AND", "0", "GO"]
    kinds = [event.type for event in stream.events if event.type in ("word", "instruction")]
    assert kinds == ["word"] * 6 + ["instruction"]
    assert all(0.2 <= confidence <= 0.98 for confidence in stream.told("word", "confidence"))
    assert stream.told("word", "pair") == [stream.pairs[word] for word in stream.told("word", "word")]


def test_why_a_sentence_was_judged_as_it_was_can_be_asked(stream):
    stream.rest().sign("STOP HOVER 5 GO").rest()
    best, *others = stream.decoder.readings
    assert [word for word, _ in best.words] == ["STOP", "HOVER", "5", "GO"]
    assert best.behind < 1.0
    assert len(others) <= 4
    assert all(other.behind >= best.behind for other in others)
