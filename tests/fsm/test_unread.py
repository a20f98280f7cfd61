"""A sign that was shown and not read must not leave a valid sentence that lacks it."""

from itertools import product

import pytest

from lightgesture.fsm import Decoder, Sign, Signs, load_grammar
from lightgesture.fsm.rules.unread import UnreadSigning

HOLD = 15
SIGNED = "STOP HOVER 3 AND 5 GO"
pair = Signs.of_tokens


def sign(decoder, pairs, words, lost=(), how="unread", held=22, passage=9, rate=30.0):
    """Sign `words`; those whose index is in `lost` are shown and not read, in one of several ways."""
    events, frame = [], 0

    def show(left, right, is_seen=True):
        nonlocal frame
        events.extend(
            decoder.step(
                Signs(Sign(left, seen=is_seen), Sign(right, seen=is_seen)), frame / rate, frame=frame
            )
        )
        frame += 1

    for index, word in enumerate(words.split()):
        left, right = pairs[word].split(",")
        for _ in range(passage):
            show(None, None)
        for moment in range(held):
            if index not in lost or how == "read":
                show(left, right)
            elif how == "unread":
                show(None, None)
            elif how == "one hand":
                show(left, None)
            elif how == "flicker":
                show(*((left, right), (left, "4"), (None, right))[moment % 3])
            elif how == "broken":
                show(*((left, right) if moment % HOLD != HOLD // 2 else (None, right)))
            elif how == "out of view":
                show(None, None, is_seen=False)
    return events


@pytest.mark.parametrize("how", ["unread", "one hand", "flicker"])
@pytest.mark.parametrize("lost", [(2,), (3,), (4,), (2, 3), (3, 4), (2, 3, 4)])
def test_a_lost_sign_drops_the_sentence(grammar, words_to_pairs, pick, how, lost):
    events = sign(Decoder(grammar, rule="frames"), words_to_pairs, SIGNED, lost, how)
    assert not pick(events, "instruction")
    assert pick(events, "rejected", field="reason") == ["unread_sign"]


def test_the_rejection_tells_where_the_sign_was(grammar, words_to_pairs, pick):
    (rejected,) = pick(sign(Decoder(grammar, rule="frames"), words_to_pairs, SIGNED, (2,)), "rejected")
    assert rejected.text == "STOP HOVER"
    assert rejected.detail == "a sign after STOP HOVER was not read; sign the sentence again"
    assert rejected.frame == 2 * (9 + 22) + 18  # the nineteenth frame without a word, 1.2 holds allowing 18


@pytest.mark.parametrize(("held", "passage"), list(product((15, 18, 22, 34), (2, 5, 9, 12, 15, 18))))
def test_clean_signing_is_read_and_no_lost_sign_gives_another_instruction(
    grammar, words_to_pairs, pick, held, passage
):
    """The limit, 18 frames, is not less than a passage and less than a hold and two passages."""
    signed = sign(
        Decoder(grammar, rule="frames"), words_to_pairs, SIGNED, how="read", held=held, passage=passage
    )
    assert pick(signed, "instruction", field="text") == ["STOP HOVER 35 GO"]
    for how, lost in product(("unread", "one hand", "flicker", "broken"), ((2,), (3, 4), (2, 3, 4))):
        events = sign(Decoder(grammar, rule="frames"), words_to_pairs, SIGNED, lost, how, held, passage)
        assert {*pick(events, "instruction", field="text")} <= {"STOP HOVER 35 GO"}, how


@pytest.mark.parametrize("rate", [10, 30, 60])
def test_the_rule_holds_in_seconds_too(grammar, words_to_pairs, pick, rate):
    def decode(lost, how):
        decoder = Decoder(grammar, rule="seconds")
        held, passage = round(0.8 * rate), round(0.3 * rate)
        return sign(decoder, words_to_pairs, SIGNED, lost, how, held, passage, rate)

    assert pick(decode((), "read"), "instruction", field="text") == ["STOP HOVER 35 GO"]
    for lost in ((2,), (3, 4), (2, 3, 4)):
        assert pick(decode(lost, "unread"), "rejected", field="reason") == ["unread_sign"]


@pytest.mark.parametrize(("hold", "rate"), [(3, 30), (5, 30), (8, 30), (15, 60), (4, 10), (15, 25)])
def test_short_holds_leave_the_time_to_go_from_sign_to_sign(grammar, words_to_pairs, pick, hold, rate):
    held, passage = max(round(0.7 * rate), hold), round(0.4 * rate)
    signed = sign(Decoder(grammar, hold=hold), words_to_pairs, SIGNED, (), "read", held, passage, rate)
    assert pick(signed, "instruction", field="text") == ["STOP HOVER 35 GO"]
    for how, lost in product(("unread", "one hand"), ((2,), (3, 4), (2, 3, 4))):
        events = sign(Decoder(grammar, hold=hold), words_to_pairs, SIGNED, lost, how, held, passage, rate)
        assert pick(events, "rejected", field="reason") == ["unread_sign"]


def test_hands_out_of_view_are_no_sign(grammar, words_to_pairs, pick):
    events = sign(
        Decoder(grammar, rule="frames"),
        words_to_pairs,
        "STOP HOVER 3 GO",
        (2,),
        "out of view",
        held=60,
        passage=5,
    )
    assert pick(events, "instruction", field="text") == ["STOP HOVER GO"]


@pytest.mark.parametrize("rule", ["frames", "seconds", "evidence"])
@pytest.mark.parametrize("lost", [(), (2,), (4,), (3, 4), (2, 3, 4)])
def test_a_grammar_may_count_hidden_signs_too(write_grammar, words_to_pairs, pick, rule, lost):
    language = load_grammar(
        write_grammar(
            ('rule = "sentence"', f'rule = "{rule}"'), ("count_hidden = false", "count_hidden = true")
        )
    )
    events = sign(Decoder(language), words_to_pairs, SIGNED, lost, "out of view" if lost else "read")
    assert pick(events, "instruction", field="text") == ([] if lost else ["STOP HOVER 35 GO"])
    assert pick(events, "rejected", field="reason") == (["unread_sign"] if lost else [])


def test_hidden_time_adds_to_unread_time(write_grammar):
    """A sign of which something hides one half and nobody can read the other."""
    language = load_grammar(write_grammar(("count_hidden = false", "count_hidden = true")))
    halves = [Signs(left=UNREAD), Signs()]
    assert frames_until_dropped(open_sentence(language), *halves) == 4
    assert frames_until_dropped(open_sentence(load_grammar()), *halves) == 8


def test_the_last_word_held_on_is_no_new_sign(grammar, words_to_pairs, pick):
    events = sign(Decoder(grammar, rule="frames"), words_to_pairs, "STOP HOVER GO", how="read", held=200)
    assert pick(events, "instruction", field="text") == ["STOP HOVER GO"]


def test_unread_signing_outside_a_sentence_says_nothing(grammar, pick):
    decoder = Decoder(grammar, rule="frames")
    events = [event for _ in range(200) for event in decoder.step(Signs(Sign(None), Sign("5")), 0.0)]
    assert not pick(events, "rejected", "notice")


def open_sentence(grammar, **options):
    """A decoder inside "STOP HOVER" with a hold of four frames."""
    decoder = Decoder(grammar, hold=4, **options)
    for left, right in (("0", "0"), ("5", "5")):
        for _ in range(4):
            decoder.step(pair(left, right), 0.0)
    return decoder


def frames_until_dropped(decoder, *frames):
    """How many of the frames, repeated, the sentence survives."""
    for count in range(1000):
        decoder.step(frames[count % len(frames)], 0.0)
        if decoder.state == "idle":
            return count
    return None


UNREAD = Sign(None)
FIVE, OTHER_FIVE = Signs(left=Sign("5")), Signs(right=Sign("5"))


@pytest.mark.parametrize(
    ("frames", "expected"),
    [
        ([Signs(UNREAD, UNREAD)], 4),
        ([Signs(left=UNREAD)], 4),
        ([Signs(right=UNREAD)], 4),
        ([Signs()], None),
        ([FIVE], 4),
        ([OTHER_FIVE], 4),
        ([pair("5", "5")], None),  # the last word
        ([pair("ok", "3"), pair("ok", "4")], 5),  # each may still become a word while it is shown
        ([*[pair("ok", "3")] * 3, Signs(right=Sign("3"))], 7),
        ([pair("5", "5"), OTHER_FIVE], 5),  # released at once, it is a sign that breaks off
    ],
)
def test_what_counts_as_unread(grammar, frames, expected):
    assert frames_until_dropped(open_sentence(grammar), *frames) == expected


def test_a_word_begins_the_count_anew(grammar, pick):
    decoder = open_sentence(grammar)
    for left, right in (("ok", "1"), ("ok", "2"), ("ok", "ok")):
        for _ in range(4):
            decoder.step(Signs(left=Sign(None)), 0.0)
        events = [event for _ in range(4) for event in decoder.step(pair(left, right), 0.0)]
    assert pick(events, "instruction", field="text") == ["STOP HOVER 12 GO"]


def test_a_pair_that_is_no_word_was_told_and_does_not_count(grammar, pick):
    decoder = open_sentence(grammar)
    events = [event for _ in range(4) for event in decoder.step(Signs.of_tokens("3", "left"), 0.0)]
    events += [event for _ in range(4) for event in decoder.step(Signs(left=Sign(None)), 0.0)]
    assert pick(events, "notice", field="reason") == ["unknown_pair"]
    assert decoder.sentence == "STOP HOVER"
    assert pick(decoder.step(Signs(left=Sign(None)), 0.0), "rejected", field="reason") == ["unread_sign"]


def test_a_sign_half_held_when_the_sentence_drops_does_not_open_the_next(grammar, pick):
    """ok,0 is a digit inside a sentence and STOP outside."""
    decoder = Decoder(grammar, hold=4)
    for left, right in (("0", "0"), ("5", "5")):
        for _ in range(4):
            decoder.step(pair(left, right), 0.0)
    for left in ("ok", "ok", "ok", "5", "5", "ok"):  # the last frame breaks the limit as the sign begins
        events = decoder.step(Signs.of_tokens(left, "0"), 0.0)
    assert pick(events, "rejected", field="reason") == ["unread_sign"]
    assert not pick(
        [event for _ in range(20) for event in decoder.step(Signs.of_tokens("ok", "0"), 0.0)], "word"
    )


def test_the_limit_is_a_setting_of_the_grammar(write_grammar):
    lenient = load_grammar(write_grammar(("unread = 1.2", "unread = 2.5")))
    assert frames_until_dropped(open_sentence(lenient), Signs(left=UNREAD)) == 10


class TestUnreadSigning:
    """The sum by itself. A letter is a pair, a dot hands without one, a comma a frame out of view."""

    @pytest.mark.parametrize(
        ("frames", "expected"),
        [
            ("......", 5),
            ("..,..,.,.", 8),
            ("aaaaaaaaaa", None),  # it may still become a word
            ("aaaaaaaa...", 9),  # gone for two frames it was a sign
            ("aaaa.aaaa.aaaa", None),  # flicker: only the frames between count
            ("aaaa.aaaa.aaaa..", 15),
            ("aaaabaaaabaaaa", None),
            ("aaaabb.", 6),  # another sign: one frame until it was sure
            ("aaaabbbbbbb", None),
            ("aaabbbccc", 7),
            (".....aaaaaaaaaaaa", None),
            (".....aa.", 7),
        ],
    )
    def test_when_a_sign_was_missed(self, frames, expected):
        for passage_s, step_s in ((0.0, 0.1), (9.0, 0.0), (0.5, 0.1)):
            assert self.first_missed(UnreadSigning(5, 2, passage_s), frames, step_s) == expected

    def first_missed(self, signing, frames, step_s):
        missed = [
            index
            for index, shown in enumerate(frames)
            if shown != "," and signing.process(None if shown == "." else (shown, shown), 1.0, step_s)
        ]
        return missed[0] if missed else None

    @pytest.mark.parametrize(
        ("frames", "expected"),
        [("." * 20, 8), ("aaaaaaaaaaaa..", 13), ("aaaa..........", 8), ("aaa.aaa.aaa....", 12)],
    )
    def test_a_passage_may_last_its_time(self, frames, expected):
        assert self.first_missed(UnreadSigning(5, 2, 0.8), frames, 0.0999) == expected

    def test_a_word_takes_all_away_and_what_was_told_only_itself(self):
        signing = UnreadSigning(5, 2, 0.0)
        for take_away, left in ((signing.reset, 6), (signing.pass_over, 3)):
            signing.reset()
            for pair in (None, None, None, ("a", "a"), ("a", "a"), ("a", "a")):
                assert not signing.process(pair, 1.0, 0.1)
            take_away()
            assert [signing.process(None, 1.0, 0.1) for _ in range(left)] == [False] * (left - 1) + [True]
