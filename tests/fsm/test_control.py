"""Cancel, kill, confirmation and menu, as the example grammar of the documentation has them."""

from pathlib import Path

import pytest

from lightgesture.fsm import Decoder, Sign, Signs, load_grammar

EXAMPLE = Path(__file__).parents[2] / "docs" / "grammars" / "sonar.toml"


@pytest.fixture(scope="module")
def language():
    return load_grammar(EXAMPLE)


@pytest.fixture
def sign(language):
    """A function that signs words in front of one decoder and returns the events."""
    decoder = Decoder(language, hold=1)
    pairs = {word: pair for pair, word in language.sentence_words.items()}
    pairs |= {"STOP": ("0", "0"), "MENU": ("ok", "ok"), "SELECT_2": ("2", "2"), "UNKNOWN": ("3", "left")}

    def show(text):
        events = []
        for word in text.split():
            events += decoder.step(Signs.of_tokens(*pairs[word.replace("PARAM_", "PARAM ")]), 0.0)
            events += decoder.step(Signs(), 0.0)
        return events

    show.decoder = decoder
    return show


def told(events):
    """What was issued, rejected or noticed: (type, text or reason)."""
    fields = {"instruction": "text", "rejected": "reason", "notice": "reason"}
    return [(event.type, getattr(event, fields[event.type])) for event in events if event.type in fields]


def test_new_task(sign, pick):
    (instruction,) = pick(sign("STOP SONAR 3 GO GO"), "instruction")
    assert (instruction.action, instruction.duration_s, instruction.kind) == ("SONAR", 3, "task")


class TestConfirmation:
    @pytest.mark.parametrize("sentence", ["STOP EXEC 1 GO", "STOP SONAR GO"])
    def test_form_or_word_needs_a_second_end_word(self, sign, pick, sentence):
        first = sign(sentence)
        assert told(first) == [("notice", "confirm")]
        assert sign.decoder.state == "confirming"
        assert pick(first, "state")[-1].to_dict()["state"] == "confirming"
        assert pick(first, "word")[-1].state == sentence
        assert pick(first, "notice")[0].detail == f"{sentence}: sign GO again to confirm"
        second = sign("GO")
        (instruction,) = pick(second, "instruction")
        assert (instruction.text, instruction.words) == (sentence, tuple(sentence.split()))
        assert pick(second, "word", field="state") == ["idle"]
        assert sign.decoder.state == "idle"

    def test_other_sentences_do_not(self, sign):
        assert told(sign("STOP HOVER GO")) == [("instruction", "STOP HOVER GO")]

    @pytest.mark.parametrize("word", ["STOP", "HOVER", "1", "CONTD"])
    def test_another_word_drops_the_sentence(self, sign, pick, word):
        sign("STOP EXEC 1 GO")
        pairs = sign("1" if word == "STOP" else word)  # 0,0 is no word inside a sentence
        (rejected,) = pick(pairs, "rejected")
        assert (rejected.reason, rejected.text) == ("unconfirmed", "STOP EXEC 1 GO")
        assert rejected.detail.endswith(" instead of GO for STOP EXEC 1 GO")
        assert not pick(sign("GO"), "instruction")

    def test_an_unknown_pair_keeps_it(self, sign):
        sign("STOP EXEC 1 GO")
        assert told(sign("UNKNOWN GO")) == [("notice", "unknown_pair"), ("instruction", "STOP EXEC 1 GO")]

    def test_what_makes_no_sense_is_not_worth_confirming(self, sign):
        assert told(sign("STOP EXEC 3 GO")) == [("rejected", "unknown_program")]

    def test_it_times_out(self, sign, pick):
        sign("STOP EXEC 1 GO")
        events = sign.decoder.step(Signs(), 20.0)
        assert pick(events, "rejected", field="reason") == ["timeout"]

    def test_one_held_end_word_is_not_two(self, language, pick):
        decoder = Decoder(language, hold=2)
        events = []
        for left, right in (("0", "0"), ("pic", "2"), ("ok", "1"), *[("ok", "ok")] * 50):
            events += decoder.step(Signs.of_tokens(left, right), 0.0) + decoder.step(
                Signs.of_tokens(left, right), 0.0
            )
        assert not pick(events, "instruction")
        decoder.step(Signs(), 0.0)
        decoder.step(Signs.of_tokens("ok", "ok"), 0.0)
        assert pick(decoder.step(Signs.of_tokens("ok", "ok"), 0.0), "instruction", field="text") == [
            "STOP EXEC 1 GO"
        ]

    def test_a_carrier_stands_for_all_its_numbers(self, write_grammar, pick):
        path = write_grammar(
            ('# [control]\n# cancel = "CANCEL"\n# kill = "KILL"\n# confirm', "[control]\nconfirm")
        )
        decoder = Decoder(load_grammar(path), hold=1)
        events = []
        for left, right in (("pic", "0"), ("3", "pic"), ("ok", "pic"), ("ok", "ok")):
            events += decoder.step(Signs.of_tokens(left, right), 0.0)
        assert pick(events, "notice", field="reason") == ["confirm"]


class TestUnknownPairs:
    """A word that is misread as a pair that is none is reported; a diver who does not look confirms nothing."""

    @pytest.fixture
    def told_of(self, write_grammar, pick):
        """A function from pairs, and the setting, to what the diver is told."""

        def decode(setting, *pairs):
            path = write_grammar(("# [control]\n", f"[control]\nconfirm_unknown = {setting}\n"))
            decoder = Decoder(load_grammar(path), hold=1)
            events = []
            for pair in pairs:
                events += decoder.step(Signs.of_tokens(*pair.split(",")), 0.0) + decoder.step(Signs(), 0.0)
            return told(events)

        return decode

    def test_sentence_with_one_waits_for_a_second_end_word(self, told_of):
        assert told_of("true", "0,0", "5,5", "3,3", "ok,ok") == [
            ("notice", "unknown_pair"),
            ("notice", "confirm"),
        ]
        assert told_of("true", "0,0", "5,5", "3,3", "ok,ok", "ok,ok")[-1] == ("instruction", "STOP HOVER GO")

    def test_other_sentences_do_not(self, told_of):
        assert told_of("true", "3,3", "0,0", "5,5", "ok,ok")[1:] == [("instruction", "STOP HOVER GO")]
        assert told_of("true", "0,0", "5,5", "3,3", "5,5", "0,0", "5,5", "ok,ok")[-1][0] == "instruction"
        assert told_of("false", "0,0", "5,5", "3,3", "ok,ok")[-1] == ("instruction", "STOP HOVER GO")


class TestCancel:
    @pytest.mark.parametrize("begun", ["STOP", "STOP HOVER 3", "CONTD PARAM_1", "STOP EXEC 1 GO"])
    def test_drops_the_open_sentence(self, sign, pick, begun):
        sign(begun)
        (rejected,) = pick(sign("CANCEL"), "rejected")
        assert (rejected.reason, rejected.detail) == ("cancelled", "CANCEL was signed")
        assert sign.decoder.state == "idle"

    def test_while_idle_there_is_nothing_to_cancel(self, sign):
        assert told(sign("CANCEL")) == [("notice", "out_of_order")]


class TestKill:
    @pytest.mark.parametrize("begun", ["", "STOP", "STOP HOVER 3", "CONTD", "STOP EXEC 1 GO", "MENU"])
    def test_is_heard_in_every_state(self, sign, pick, begun):
        sign(begun)
        is_open = sign.decoder.state != "idle"
        events = sign("ABORT")
        assert pick(events, "rejected", field="reason") == (["cancelled"] if is_open else [])
        (instruction,) = pick(events, "instruction")
        assert (instruction.kind, instruction.action, instruction.text) == ("kill", "ABORT", "ABORT")
        assert (instruction.words, instruction.duration_s, instruction.change) == (("ABORT",), None, None)
        assert pick(events, "word", field="state") == ["idle"]
        assert sign.decoder.state == "idle"
        assert told(sign("STOP HOVER GO")) == [("instruction", "STOP HOVER GO")]

    def test_starts_with_its_own_hold(self, language, pick):
        decoder = Decoder(language, hold=3)
        for frame in range(4):
            decoder.step(Signs.of_tokens("0", "0"), 0.0, frame=frame)
        events = [
            event
            for frame in range(4, 7)
            for event in decoder.step(Signs(Sign("5", 0.9), Sign("0", 0.8)), frame / 10, frame=frame)
        ]
        (instruction,) = pick(events, "instruction")
        assert (instruction.start_frame, instruction.start_time_s, instruction.frame) == (4, 0.4, 6)
        assert instruction.confidence == 0.8


class TestMenu:
    def test_two_pairs_select_an_entry(self, sign, pick):
        events = sign("MENU SELECT_2")
        (instruction,) = pick(events, "instruction")
        assert (instruction.kind, instruction.action, instruction.program) == ("menu", "MENU", 2)
        assert (instruction.text, instruction.words) == ("MENU SELECT 2", ("MENU", "SELECT 2"))
        assert (instruction.parameter, instruction.change, instruction.duration_s) == (None, None, None)

    def test_other_pairs_are_no_words_there(self, sign):
        assert told(sign("MENU HOVER")) == [("notice", "unknown_pair")]
        assert sign.decoder.sentence == "MENU"

    def test_the_end_word_still_ends_a_sentence(self, sign):
        assert told(sign("STOP HOVER GO")) == [("instruction", "STOP HOVER GO")]

    def test_cancel_closes_it(self, sign):
        assert told(sign("MENU CANCEL")) == [("rejected", "cancelled")]

    def test_there_is_none_unless_the_file_names_one(self, new_diver, pick):
        events = new_diver().pairs(["ok,ok", "2,2"])
        assert pick(events, "notice", field="reason") == ["out_of_order", "unknown_pair"]


def test_parameters_tell_the_robot_their_steps(language, grammar):
    depth, light = language.parameters[1], language.parameters[2]
    assert (depth.name, depth.unit, depth.step) == ("depth", "m", 0.5)
    assert (depth.minimum, depth.maximum, depth.default) == (0, 40, 2)
    assert (light.name, light.step, light.maximum) == ("light", None, None)
    assert grammar.parameters[1].name == "depth"
