"""Holds in seconds and by evidence: the same at any rate of frames."""

import pytest

from lightgesture.fsm import Decoder, Signs, load_grammar
from lightgesture.fsm.language.settings import DwellSettings
from lightgesture.fsm.rules.dwell import Dwell, make_dwell

A, B = ("a", "a"), ("b", "b")
RATES = (10, 30, 60)


def timed(weighed=False, need=0.5, release=0.1):
    return Dwell(need, release, timed=True, weighed=weighed)


def accepted(dwell, pattern, rate, drop=(), confidence=1.0):
    """Times at which a hold was long enough; a letter is a tenth of a second of a pair, a dot of none."""
    times = []
    for frame in range(len(pattern) * rate // 10):
        letter = pattern[frame * 10 // rate]
        if frame in drop:
            continue
        pair = None if letter == "." else (letter, letter)
        now_s = round(frame / rate, 3)  # as containers round it
        if dwell.process(pair, confidence, frame, now_s, now_s) is not None:
            times.append(now_s)
    return times


@pytest.mark.parametrize("weighed", [False, True])
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize(
    ("pattern", "expected"),
    [
        (".aaaa", []),
        (".aaaaaaaaa", [0.6]),
        ("..aaaaaaaaaaaaaaaaaaa", [0.7]),  # held on: still one word
        (".aaaaaaa...aaaaaaaa", [0.6, 1.6]),
        (".aaaaaaabbbbbbbbbb", [0.6, 1.3]),  # another pair needs no gap
        (".aaa.......aaaa", []),
    ],
)
def test_the_rate_does_not_matter(weighed, rate, pattern, expected):
    """As evidence a frame stands for the time before it, so that the first one counts too."""
    first = 1 / rate if weighed else 0.0
    times = [time_s + first for time_s in accepted(timed(weighed), pattern, rate)]
    assert times == pytest.approx(expected, abs=0.002)


@pytest.mark.parametrize("weighed", [False, True])
@pytest.mark.parametrize("rate", RATES)
def test_dropped_frames_do_not_matter(weighed, rate):
    last = round(0.5 * rate)
    for gap in range(1, last - 1):
        drop = set(range(gap, min(gap + int(0.15 * rate), last)))
        assert accepted(timed(weighed), "aaaaaaaa", rate, drop) == pytest.approx([0.5], abs=0.001)


@pytest.mark.parametrize("weighed", [False, True])
def test_what_was_not_watched_for_half_a_hold_was_not_held(weighed):
    dwell = timed(weighed)
    for now_s in (0.0, 0.2, 0.46):  # 0.26 s without a frame
        assert dwell.process(A, 1.0, 0, now_s, now_s) is None
    assert dwell.pair == A
    assert dwell.progress == 0.0
    held = [now_s for now_s in (0.6, 0.8, 0.9, 0.96, 1.0) if dwell.process(A, 1.0, 0, now_s, now_s)]
    assert held == [0.96]


def test_a_gap_of_just_half_a_hold_was_watched():
    dwell = timed()
    assert [dwell.process(A, 1.0, 0, now_s, now_s) is not None for now_s in (1.0, 1.25, 1.5)] == [
        False,
        False,
        True,
    ]


@pytest.mark.parametrize("weighed", [False, True])
def test_time_that_stands_still_holds_nothing(weighed):
    dwell = timed(weighed)
    assert not any(dwell.process(A, 1.0, frame, 3.0, 3.0) for frame in range(100))


@pytest.mark.parametrize("rate", RATES)
def test_release_takes_its_time_at_any_rate(rate):
    """One absent frame is a flicker, whatever the rate; absence for longer than a tenth of a second is a release."""
    for absent in range(1, rate):
        dwell = timed()
        frames = [A] * rate + [None] * absent + [A] * rate
        held = [
            frame for frame, pair in enumerate(frames) if dwell.process(pair, 1.0, frame, 0.0, frame / rate)
        ]
        assert len(held) == (2 if (absent - 1) / rate >= 0.0999 else 1), absent


@pytest.mark.parametrize(("absent", "holds"), [(3, 1), (4, 2)])
def test_release_begins_with_the_first_absent_frame_after_the_hold(absent, holds):
    dwell = timed()
    frames = [A] * 16 + [None] * absent + [A] * 16
    held = [frame for frame, pair in enumerate(frames) if dwell.process(pair, 1.0, frame, 0.0, frame / 30)]
    assert len(held) == holds


def test_an_unbroken_run_is_broken_by_one_frame():
    dwell = timed()
    frames = [A] * 14 + [B] + [A] * 14 + [None] + [A] * 16
    held = [frame for frame, pair in enumerate(frames) if dwell.process(pair, 1.0, frame, 0.0, frame / 30)]
    assert held == [45]


class TestEvidence:
    def test_a_wrong_frame_delays_and_does_not_break(self):
        dwell = timed(weighed=True)
        frames = [A] * 8 + [B] + [A] * 8 + [None] + [A] * 8
        held = [
            frame for frame, pair in enumerate(frames) if dwell.process(pair, 1.0, frame, 0.0, frame / 30)
        ]
        # fifteen thirtieths of a second, one lost to b and half of one to the unread frame; the first had no time
        assert held == [19]

    def test_frames_weigh_by_their_probability(self):
        assert accepted(timed(weighed=True), "a" * 20, 30, confidence=0.8) == [
            pytest.approx(0.633, abs=0.001)
        ]
        assert accepted(timed(weighed=False), "a" * 20, 30, confidence=0.8) == [pytest.approx(0.5, abs=0.001)]

    def test_the_pair_with_the_most_evidence_wins(self):
        dwell = timed(weighed=True)
        holds = [dwell.process((A, A, B)[frame % 3], 1.0, frame, 0.0, frame / 30) for frame in range(60)]
        (hold,) = [hold for hold in holds if hold]
        assert hold.pair == A

    def test_half_of_the_time_is_not_enough(self):
        dwell = timed(weighed=True)
        assert not any(dwell.process((A, B)[frame % 2], 0.9, frame, 0.0, frame / 30) for frame in range(600))

    def test_evidence_begins_anew_with_another_pair(self):
        dwell = timed(weighed=True)
        for frame in range(6):
            dwell.process(A if frame < 3 else B, 1.0, frame, 0.0, frame / 30)
        assert dwell.pair == B
        assert dwell.progress == pytest.approx(2 / 15)

    def test_flicker_does_not_release(self):
        """Absence is weighed as presence is: sixty frames of which every third is another pair's are one word."""
        dwell = timed(weighed=True)
        frames = [A] * 16 + [B, A, A] * 20
        assert sum(dwell.process(pair, 1.0, n, 0.0, n / 30) is not None for n, pair in enumerate(frames)) == 1

    def test_absence_adds_up(self):
        dwell = timed(weighed=True)
        frames = [A] * 16 + [None, None, A] * 5
        spent = []
        for frame, pair in enumerate(frames):
            dwell.process(pair, 1.0, frame, 0.0, frame / 30)
            spent.append(dwell.spent)
        assert spent.index(None, 16) == 16 + 4  # thirtieths of a second of absence: 1, 2, 1, 2, 3


class TestWhichRule:
    @pytest.mark.parametrize(
        ("rule", "hold", "hold_seconds", "need"),
        [
            ("frames", None, None, 15),
            ("frames", 9, None, 9),
            ("frames", None, 0.4, 0.4),
            ("seconds", None, None, 0.5),
            ("seconds", 9, None, 9),
            ("seconds", None, 0.4, 0.4),
            ("evidence", None, 0.4, 0.4),
            ("evidence", 9, None, 9),
        ],
    )
    def test_options_go_before_the_file(self, rule, hold, hold_seconds, need):
        assert make_dwell(DwellSettings(rule=rule), hold, hold_seconds).need == need

    def test_release_is_a_share_of_the_hold(self):
        settings = DwellSettings(release=0.3)
        assert make_dwell(settings, 20, None).release == 6
        assert make_dwell(settings, None, 0.5).release == pytest.approx(0.15, abs=0.0011)

    def test_seconds_keep_the_rule_of_evidence(self):
        frames = [A] * 5 + [B] + [A] * 5

        def count(rule):
            dwell = make_dwell(DwellSettings(rule=rule), None, 0.2)
            return sum(dwell.process(pair, 1.0, n, 0.0, n / 30) is not None for n, pair in enumerate(frames))

        assert (count("seconds"), count("evidence")) == (0, 1)

    @pytest.mark.parametrize("seconds", [0.0, -1.0, float("nan"), float("inf")])
    @pytest.mark.parametrize("rule", ["seconds", "sentence"])
    def test_seconds_out_of_range_are_refused(self, grammar, seconds, rule):
        with pytest.raises(ValueError, match="use a number above 0, such as"):
            Decoder(grammar, rule=rule, hold_seconds=seconds)

    def test_both_are_refused(self, grammar):
        with pytest.raises(ValueError, match="hold and hold_seconds exclude each other; give one of them"):
            Decoder(grammar, hold=3, hold_seconds=0.5)

    def test_the_file_chooses(self, write_grammar, pick):
        language = load_grammar(
            write_grammar(
                ('rule = "sentence"', 'rule = "evidence"'), ("hold_seconds = 0.5", "hold_seconds = 0.3")
            )
        )
        decoder = Decoder(language)
        events = []
        for frame in range(13):
            right = "1" if frame == 5 else "0"
            events += decoder.step(Signs.of_tokens("ok", right), frame / 30, frame=frame)
        assert pick(events, "word", field="frame") == [11]
