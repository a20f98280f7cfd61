"""Every sentence form, the published study's instructions, and what the published decoder gets wrong."""

import pytest

TASKS = ["HOVER", "FOLLOW", "LEFT", "RIGHT", "UP", "DOWN"]


def only(events, pick):
    """The one instruction of these events, which hold no rejection and no notice."""
    assert not pick(events, "rejected", "notice")
    (instruction,) = pick(events, "instruction")
    return instruction


@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize(
    ("signed", "text", "seconds"), [("", "", None), ("5 AND 0 ", "50 ", 50), ("3 ", "3 ", 3)]
)
def test_task(diver, pick, task, signed, text, seconds):
    instruction = only(diver.words(f"STOP {task} {signed}GO"), pick)
    assert instruction.text == f"STOP {task} {text}GO"
    assert (instruction.kind, instruction.action, instruction.duration_s) == ("task", task, seconds)
    assert (instruction.program, instruction.parameter, instruction.change) == (None, None, None)


@pytest.mark.parametrize("number", range(5))
def test_program(diver, pick, number):
    instruction = only(diver.words(f"STOP EXEC {number} GO"), pick)
    assert (instruction.text, instruction.kind) == (f"STOP EXEC {number} GO", "program")
    assert (instruction.action, instruction.program, instruction.duration_s) == ("EXEC", number, None)


@pytest.mark.parametrize("number", range(6))
@pytest.mark.parametrize("change", ["INCREASE", "DECREASE", "DEFAULT"])
def test_parameter(diver, pick, number, change):
    instruction = only(diver.words(f"CONTD PARAM_{number} {change} GO"), pick)
    assert instruction.text == f"CONTD PARAM {number} {change} GO"
    assert instruction.words == ("CONTD", f"PARAM {number}", change, "GO")
    assert (instruction.kind, instruction.action) == ("parameter", "PARAM")
    assert (instruction.parameter, instruction.change, instruction.program) == (number, change, None)


@pytest.mark.parametrize(("signed", "seconds"), [("", None), ("2 AND 0 ", 20)])
def test_snapshot(diver, pick, signed, seconds):
    instruction = only(diver.words(f"CONTD SNAP {signed}GO"), pick)
    assert (instruction.kind, instruction.action) == ("snapshot", "SNAP")
    assert (instruction.duration_s, instruction.change) == (seconds, None)


@pytest.mark.parametrize(
    ("sentences", "total"),
    [
        (["STOP HOVER 5 AND 0 GO", "STOP EXEC 1 GO"], 10),
        (["CONTD SNAP 2 AND 0 GO", "CONTD PARAM_3 DECREASE GO"], 10),
        (["STOP EXEC 2 GO", "CONTD SNAP GO", "CONTD SNAP 5 AND 0 GO", "STOP FOLLOW GO"], 16),
    ],
    ids=["task switching", "parameters", "complex"],
)
def test_study_instructions_take_the_published_number_of_gestures(new_diver, pick, sentences, total):
    diver = new_diver(hold=15, gap=3)
    events = diver.words(" ".join(sentences)) + diver.decoder.finish()
    assert not pick(events, "rejected", "notice")
    assert len(pick(events, "word")) == total
    expected = [text.replace("_", " ").replace(" AND ", "") for text in sentences]
    assert pick(events, "instruction", field="text") == expected


@pytest.mark.parametrize(
    ("signed", "reason", "text", "detail"),
    [
        ("STOP EXEC 5 GO", "unknown_program", "STOP EXEC 5 GO", "program 5 is not in [programs]"),
        ("STOP EXEC 1 AND 2 GO", "unknown_program", "STOP EXEC 12 GO", "program 12 is not in [programs]"),
        ("STOP HOVER 0 GO", "limit", "STOP HOVER 0 GO", "0 s is outside 1 to 600 s"),
        ("CONTD SNAP 1 0 0 0 GO", "limit", "CONTD SNAP 1000 GO", "1000 s is outside 1 to 600 s"),
        ("STOP UP 1 AND 2 AND 3 AND 4 AND 5", "limit", "STOP UP 12345", "a number has at most 4 digits"),
        ("STOP EXEC GO", "out_of_order", "STOP EXEC GO", "GO cannot follow STOP EXEC; expected a digit"),
        ("STOP 5", "out_of_order", "STOP 5", None),
        ("STOP HOVER 5 AND GO", "out_of_order", "STOP HOVER 5 AND GO", None),
        ("STOP HOVER AND", "out_of_order", "STOP HOVER AND", None),
        ("STOP HOVER 5 AND AND", "out_of_order", "STOP HOVER 5 AND AND", None),
        ("STOP HOVER FOLLOW", "out_of_order", "STOP HOVER FOLLOW", None),
        ("CONTD CONTD", "out_of_order", "CONTD CONTD", None),
        ("CONTD HOVER", "out_of_order", "CONTD HOVER", None),
        ("CONTD PARAM_1 5", "out_of_order", "CONTD PARAM 1 5", None),
        ("CONTD PARAM_1 PARAM_2", "out_of_order", "CONTD PARAM 1 PARAM 2", None),
        ("STOP SNAP", "out_of_order", "STOP SNAP", None),
    ],
)
def test_senseless_sentence_is_rejected_with_its_reason(diver, pick, signed, reason, text, detail):
    events = diver.words(signed)
    (rejected,) = pick(events, "rejected")
    assert (rejected.reason, rejected.text) == (reason, text)
    assert detail is None or rejected.detail == detail
    assert not pick(events, "instruction")
    assert diver.decoder.state == "idle"
    assert only(diver.words("STOP HOVER GO"), pick).text == "STOP HOVER GO"


def test_unlisted_parameter_is_rejected(new_diver, pick, write_grammar):
    from lightgesture.fsm import load_grammar

    language = load_grammar(write_grammar(('3 = "turning rate"', "")))
    (rejected,) = pick(new_diver(language=language).words("CONTD PARAM_3 DEFAULT GO"), "rejected")
    assert (rejected.reason, rejected.text) == ("unknown_parameter", "CONTD PARAM 3 DEFAULT GO")
    assert rejected.detail == "parameter 3 is not in [parameters]"


def test_limits_themselves_are_allowed(diver, pick):
    events = diver.words("STOP HOVER 1 GO STOP HOVER 5 AND 5 AND 5 GO STOP HOVER 0 AND 0 AND 0 AND 5 GO")
    assert pick(events, "instruction", field="duration_s") == [1, 555, 5]
    assert pick(events, "instruction", field="text")[-1] == "STOP HOVER 5 GO"


def test_unknown_pair_keeps_the_sentence(diver, pick):
    events = diver.words("STOP HOVER") + diver.pairs(["3,left"]) + diver.words("GO")
    assert pick(events, "notice", field="detail") == ["3,left is no word; repeat it"]
    assert pick(events, "instruction", field="text") == ["STOP HOVER GO"]


class TestWhatThePublishedDecoderGetsWrong:
    """Each was measured on the decoder that the paper's authors published."""

    def test_stop_go_is_issued(self, diver, pick):
        events = diver.words("STOP GO")
        assert not pick(events, "instruction")
        assert pick(events, "rejected", field="text") == ["STOP GO"]

    def test_stop_hover_contd_go_is_issued(self, diver, pick):
        events = diver.words("STOP HOVER CONTD GO")
        assert not pick(events, "instruction")
        (rejected,) = pick(events, "rejected")
        assert rejected.text == "STOP HOVER CONTD"
        assert rejected.detail == "CONTD cannot follow STOP HOVER; expected GO or a digit"
        assert pick(events, "notice", field="reason") == ["out_of_order"]  # the GO on its own

    @pytest.mark.parametrize("hold", [1, 2, 15])
    def test_start_word_needs_more_sightings_than_others(self, new_diver, pick, hold):
        diver = new_diver(hold=hold)
        for pair in ("ok,0", "5,5", "ok,5", "ok,ok"):
            assert not pick(diver.show(pair, hold - 1), "word")
            assert len(pick(diver.show(pair, 1), "word")) == 1

    def test_five_zero_without_and_loses_the_zero(self, diver, pick):
        events = diver.words("STOP HOVER 5 0 GO STOP HOVER 5 AND 0 GO")
        assert pick(events, "instruction", field="duration_s") == [50, 50]
        assert len(set(pick(events, "instruction", field="text"))) == 1

    def test_words_of_the_last_sentence_leak_into_one_that_starts_with_contd(self, diver, pick):
        events = diver.words("STOP HOVER GO CONTD SNAP GO")
        assert pick(events, "instruction", field="text") == ["STOP HOVER GO", "CONTD SNAP GO"]
        assert pick(events, "instruction", field="duration_s") == [None, None]

    def test_there_is_no_time_out(self, diver, pick):
        diver.words("STOP HOVER")
        events = diver.show(None, 20 * 30 + 10)
        assert pick(events, "rejected", field="reason") == ["timeout"]

    def test_the_diver_is_told_nothing(self, diver):
        events = diver.words("STOP EXEC 5 GO") + diver.pairs(["3,left"])
        assert {event.type for event in events} == {"state", "word", "rejected", "notice"}
