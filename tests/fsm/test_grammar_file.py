"""Reading a grammar: what a user may change, and one clear line for each thing that is wrong."""

import json
import pickle
import random
import subprocess
import sys
from pathlib import Path

import pytest

from lightgesture.fsm import Decoder, GrammarError, Signs, load_grammar


def refusal(path) -> str:
    """The message of the error, which is one line that begins with the file's name."""
    with pytest.raises(GrammarError) as caught:
        load_grammar(path)
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 700
    assert message.startswith(f"{path}: ")
    return message.removeprefix(f"{path}: ")


def test_bundled_file(grammar):
    assert Path(grammar.file).name == "grammar.toml"
    assert (grammar.dwell.hold, grammar.dwell.release, grammar.dwell.timeout_s) == (15, 0.2, 20)
    assert sorted(grammar.programs) == [0, 1, 2, 3, 4]
    assert sorted(grammar.parameters) == [0, 1, 2, 3, 4, 5]
    limits = grammar.limits
    assert (limits.min_seconds, limits.max_seconds, limits.max_digits) == (1, 600, 4)


def test_loading_twice_gives_equal_grammars_that_survive_pickling(grammar):
    assert load_grammar() == grammar
    assert pickle.loads(pickle.dumps(grammar)) == grammar


def test_limits_dwell_programs_and_parameters_may_be_left_out(tmp_path, grammar):
    text = Path(grammar.file).read_text(encoding="utf-8")
    path = tmp_path / "short.toml"
    path.write_text(text[: text.index("[programs]")], encoding="utf-8")
    short = load_grammar(path)
    assert (short.programs, short.parameters) == ({}, {})
    assert (short.limits, short.dwell) == (grammar.limits, grammar.dwell)


def test_new_task_touches_the_file_alone(write_grammar, pick):
    path = write_grammar(('"5,5" = "HOVER"', '"5,5" = "HOVER"\n"4,4" = "SONAR"'), ("HOVER|", "HOVER|SONAR|"))
    decoder = Decoder(load_grammar(path), hold=1)
    events = [
        event
        for pair in ("00", "44", ("ok", "3"), ("ok", "ok"))
        for event in decoder.step(Signs.of_tokens(*pair), 0.0)
    ]
    assert pick(events, "instruction", field="text") == ["STOP SONAR 3 GO"]


def test_optional_word_and_form_without_joiner(write_grammar, pick):
    path = write_grammar(
        ('join = "AND"\n', ""),
        ('"pic,ok" = "AND"', '"pic,ok" = "NOW"'),
        ('sentence = "STOP EXEC program GO"', 'sentence = "STOP EXEC program [NOW] GO"'),
    )
    decoder = Decoder(load_grammar(path), hold=1)
    signs = [("0", "0"), ("pic", "2"), ("ok", "3"), ("pic", "ok"), ("ok", "ok")]
    events = [event for pair in signs for event in decoder.step(Signs.of_tokens(*pair), 0.0)]
    (instruction,) = pick(events, "instruction")
    assert (instruction.text, instruction.program, instruction.change) == ("STOP EXEC 3 NOW GO", 3, "NOW")


def test_digits_are_counted_for_each_number(write_grammar, pick):
    path = write_grammar(
        ("CONTD SNAP [seconds] GO", "CONTD SNAP seconds UP program GO"), ("max_digits = 4", "max_digits = 2")
    )
    decoder = Decoder(load_grammar(path), hold=1)
    signs = ["pic,0", "pic,pic", "ok,1", "ok,2", "right,right", "ok,0", "pic,ok", "ok,3", "ok,ok"]
    events = [event for pair in signs for event in decoder.step(Signs.of_tokens(*pair.split(",")), 0.0)]
    (instruction,) = pick(events, "instruction")
    assert (instruction.text, instruction.duration_s, instruction.program) == ("CONTD SNAP 12 UP 3 GO", 12, 3)


def test_byte_order_mark_and_windows_line_ends_are_endured(tmp_path, grammar):
    text = Path(grammar.file).read_text(encoding="utf-8").replace("\n", "\r\n")
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + text.encode("utf-8"))
    assert load_grammar(path).table == grammar.table


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"", "tokens: is missing; add it, as in the bundled grammar (and 3 more)"),
        (b"tokens = [\xff]", "byte 10: is not UTF-8; save the file as UTF-8"),
        (b"tokens = ", "TOML syntax: Invalid value (at end of document); write valid TOML, each key once"),
        (b"a = 1\na = 2", "TOML syntax: Cannot overwrite a value (at "),
        (b"a = " + b"[" * 5000, "too deeply nested; keep to the layout of the bundled grammar"),
        (b"a = " + b"9" * 5000, "Exceeds the limit (4300 digits) for integer string conversion"),
        (b"#" * (1 << 20) + b"#", "is larger than 1048576 bytes; name a grammar file (TOML)"),
        (b"\x89PNG\r\n\x1a\n\x00", "byte 0: is not UTF-8"),
        (b"a = '\x00'", r"TOML syntax: Found invalid character '\x00' (at line 1"),
    ],
    ids=["empty", "encoding", "syntax", "twice", "nested", "integer", "large", "picture", "null"],
)
def test_file_that_is_no_grammar(tmp_path, content, expected):
    path = tmp_path / "bad file ü.toml"
    path.write_bytes(content)
    assert refusal(path).startswith(expected)


def test_missing_file_and_folder(tmp_path):
    assert refusal(tmp_path / "none.toml") == "no such file; name an existing grammar file (TOML)"
    assert refusal(tmp_path) == "is a folder; name a grammar file (TOML)"
    assert refusal(tmp_path / "x.toml" / "y").startswith("no such file")
    assert refusal("a\0b").startswith("cannot be read (embedded null byte); name a readable file")
    assert refusal(tmp_path / ("x" * 300)).startswith("cannot be read (File name too long)")


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("hold = 15", "holt = 15", "dwell.holt: unknown key; did you mean 'hold'?"),
        (
            "hold = 15",
            "zzz = 15",
            "dwell.zzz: unknown key; use rule, hold, hold_seconds, release, unread, passage_s, count_hidden",
        ),
        ("[programs]", "[program]", "program: unknown key; did you mean 'programs'?"),
        ('kind = "task"', 'kind = "task"\nx = 1', "forms[0].x: unknown key; use kind, sentence"),
        ("hold = 15", 'hold = "15"', "dwell.hold: is no whole number; write one without quotes"),
        ("hold = 15", "hold = 15.0", "dwell.hold: is no whole number"),
        ("hold = 15", "hold = true", "dwell.hold: is no whole number"),
        ("hold = 15", "hold = 0", "dwell.hold: should be greater than or equal to 1, not 0; change it"),
        ("hold = 15", "hold = 1001", "dwell.hold: should be less than or equal to 1000, not 1001"),
        ("release = 0.2", "release = 0", "dwell.release: should be greater than 0, not 0"),
        ("release = 0.2", "release = 1.5", "dwell.release: should be less than or equal to 1, not 1.5"),
        ("timeout_s = 20", "timeout_s = inf", "dwell.timeout_s: is no finite number; write one such as 20"),
        ("timeout_s = 20", "timeout_s = nan", "dwell.timeout_s: is no finite number"),
        ("timeout_s = 20", 'timeout_s = "x"', "dwell.timeout_s: is no number; write one without quotes"),
        ("min_seconds = 1", "min_seconds = 700", "limits.min_seconds: 700 is above max_seconds = 600"),
        ("max_digits = 4", "max_digits = 99", "limits.max_digits: should be less than or equal to 9, not 99"),
        ('tokens = ["0",', 'tokens = [0, "0",', "tokens[0]: is no text; write it in quotes"),
        ('tokens = ["0",', 'tokens = ["a b", "0",', "tokens[0]: 'a b' is no token; use letters"),
        ('tokens = ["0",', 'tokens = ["0", "0",', "tokens[1]: '0' stands twice; keep one"),
        ('"ok"]', '"ok"]\nforms = 3', "TOML syntax: "),
        ('"5,5" = "HOVER"', '"5,5" = "hover"', "pairs.\"5,5\": 'hover' is no word; use capitals as in HOVER"),
        ('"5,5" = "HOVER"', '"5,5" = "HÖVER"', "pairs.\"5,5\": 'HÖVER' is no word; use capitals"),
        ('"5,5" = "HOVER"', '"5,5" = 5', 'pairs."5,5": is no text; write it in quotes'),
        ('"5,5" = "HOVER"', '"5,6" = "HOVER"', "pairs.\"5,6\": unknown token '6'; use one of 0, 1, 2"),
        ('"5,5" = "HOVER"', '"55" = "HOVER"', 'pairs.55: is no pair; write "left hand,right hand"'),
        ('"5,5" = "HOVER"', '"5,5,5" = "HOVER"', "pairs.\"5,5,5\": unknown token '5,5'"),
        ('"5,5" = "HOVER"', '"5,5" = "HOVER"\n"5, 5" = "UP"', 'pairs."5, 5": pair used twice; keep one'),
        ('"5,5" = "HOVER"', '"5,5" = "HOVER"\n"5,5" = "UP"', "TOML syntax: "),
        ('"5,5" = "HOVER"', '"5,5" = "HOVERR"', "forms[0].sentence: unknown word 'HOVER'; give it a sign"),
        ('"5,5" = "HOVER"', '"5,5" = "HOVER"\n"4,4" = "X"', "pairs.\"4,4\": no form uses 'X'; put it into"),
        ('"ok,0" = "STOP"', '"ok,0" = "GO"', "idle_pairs.\"ok,0\": 'GO' opens no sentence; use one of"),
        ('end = "GO"', 'end = "END"', "sentinels.end: unknown word 'END'; give it a sign in [pairs]"),
        ('end = "GO"', 'end = "STOP"', "sentinels.end: 'STOP' is a sentinel twice; give each of them"),
        ('end = "GO"', 'end = "5"', "sentinels.end: '5' is a digit; use a word in capitals"),
        ('start = ["STOP", "CONTD"]', "start = []", "sentinels.start: "),
        ('start = ["STOP", "CONTD"]', 'start = ["STOP", "X"]', "sentinels.start[1]: unknown word 'X'"),
        ('start = ["STOP", "CONTD"]', 'start = "STOP"', "sentinels.start: is no list; write values"),
        ("CONTD PARAM n", "CONTD PARAM", "forms[2].sentence: unknown word 'PARAM'; write 'PARAM n'"),
        ("CONTD PARAM n", "CONTD SNAP n", "forms[2].sentence: 'n' follows no word that carries a number"),
        ("CONTD PARAM n", "n PARAM n", "forms[2].sentence: 'n' follows no word that carries a number"),
        ('kind = "task"', 'kind = "Task 1"', "forms[0].kind: 'Task 1' is no kind; use small letters"),
        ('0 = "surface"', 'x = "surface"', "programs.x: 'x' is no number; use a whole number from 0"),
        ('0 = "surface"', '01 = "surface"', "programs.01: '01' is no number"),
        ('0 = "surface"', "0 = 7", "programs.0: is no text; write it in quotes"),
        ('0 = "surface"', '0 = ""', "programs.0: '' is no name; use 1 to 100 characters"),
        ('0 = "surface"', '0 = "a\\nb"', "programs.0: 'a\\nb' is no name"),
        ("[limits]", "[[limits]]", "limits: is no table; write a table of key = value lines"),
        ("[parameters]", "[[parameters]]", "parameters: is no table"),
    ],
)
def test_wrong_value_is_named_by_its_full_path(write_grammar, old, new, expected):
    assert refusal(write_grammar((old, new))).startswith(expected)


@pytest.mark.parametrize(
    ("sentence", "expected"),
    [
        ("CONTD SNAP [second] GO", "unknown word 'second'"),
        ("CONTD SNAP [seconds GO", "'[seconds' has an odd bracket"),
        ("CONTD SNAP [] GO", "'[]' has an odd bracket"),
        ("CONTD SNAP| GO", "unknown word ''"),
        ("SNAP [seconds] GO", "'SNAP [seconds] GO' has no start"),
        ("CONTD SNAP [seconds]", "'CONTD SNAP [seconds]' has no end"),
        ("CONTD SNAP [GO]", "'CONTD SNAP [GO]' has no end word"),
        ("[CONTD] SNAP GO", "'[CONTD] SNAP GO' has no start word"),
        ("CONTD GO", "'CONTD GO' is too short; write start word"),
        ("", "'' is too short"),
        ("CONTD [SNAP] GO", "'CONTD [SNAP] GO' has no action"),
        ("CONTD program GO", "'CONTD program GO' has no action"),
        ("CONTD SNAP GO GO", "'GO' stands inside 'CONTD SNAP GO GO'"),
        ("CONTD SNAP AND GO", "'AND' stands inside"),
        ("CONTD SNAP STOP GO", "'STOP' stands inside"),
        ("CONTD SNAP seconds [seconds] GO", "'seconds' stands twice"),
    ],
)
def test_wrong_sentence_is_named(write_grammar, sentence, expected):
    message = refusal(write_grammar(("CONTD SNAP [seconds] GO", sentence)))
    assert message.startswith(f"forms[3].sentence: {expected}")


@pytest.mark.parametrize(
    ("sentence", "expected"),
    [
        (
            "CONTD SNAP [seconds] [program] GO",
            "forms[3].sentence: '0' could be read in two ways in 'CONTD SNAP [seconds] [program]",
        ),
        (
            "CONTD SNAP [UP] UP GO",
            "forms[3].sentence: 'UP' could be read in two ways in 'CONTD SNAP [UP] UP GO'; put a word that",
        ),
        (
            "STOP UP GO",
            "forms: 'STOP HOVER|FOLLOW|LEFT|RIGHT|UP|DOWN [seconds] GO' and 'STOP UP GO' read the same",
        ),
        (
            "STOP EXEC seconds GO",
            "forms: 'STOP EXEC program GO' and 'STOP EXEC seconds GO' read the same sentence",
        ),
    ],
)
def test_ambiguous_sentences_are_named(write_grammar, sentence, expected):
    assert refusal(write_grammar(("CONTD SNAP [seconds] GO", sentence))).startswith(expected)


def test_number_slot_without_digits(write_grammar):
    digits = [(f'"ok,{n}" = "{n}"\n', "") for n in range(6)]
    message = refusal(write_grammar(*digits))
    assert message.startswith("forms[0].sentence: 'seconds' needs digits; give [pairs] the words 0 to 9")


def test_other_defects_are_counted(write_grammar):
    message = refusal(write_grammar(("hold = 15", "hold = 0"), ("max_digits = 4", "max_digits = 0")))
    assert message.endswith("(and 1 more)")


def many_words(count: int) -> str:
    """A grammar of `count` words, most of them tasks, with no more tokens than their pairs need."""
    side = int(count**0.5) + 1
    tokens = [f"t{n}" for n in range(side)]
    pairs = [f'"t{n // side},t{n % side}" = "W{n}"' for n in range(count)]
    return (
        f"tokens = {json.dumps(tokens)}\n"
        '[sentinels]\nstart = ["W0"]\nend = "W1"\n[pairs]\n'
        + "\n".join(pairs)
        + '\n[[forms]]\nkind = "task"\nsentence = "W0 '
        + "|".join(f"W{n}" for n in range(2, count))
        + ' W1"\n'
    )


def test_grammar_of_ten_thousand_words_is_refused_in_one_line(tmp_path):
    path = tmp_path / "huge.toml"
    path.write_text(many_words(10_000), encoding="utf-8")
    assert refusal(path).startswith("tokens: ")


def test_grammar_of_a_few_hundred_words_is_read(tmp_path, pick):
    path = tmp_path / "large.toml"
    path.write_text(many_words(200), encoding="utf-8")
    decoder = Decoder(load_grammar(path), hold=1)
    signs = [("t0", "t0"), ("t13", "t4"), ("t0", "t1")]  # 15 tokens: word 199 is 13 * 15 + 4
    events = [event for pair in signs for event in decoder.step(Signs.of_tokens(*pair), 0.0)]
    assert pick(events, "instruction", field="text") == ["W0 W199 W1"]


def test_table_that_explodes_is_refused(write_grammar):
    """Optional words in another order in each form: the merged table needs a state for each mixture."""
    shuffle = random.Random(0).shuffle
    words = [f"W{n}" for n in range(40)]
    forms = ""
    for n in range(20):
        shuffle(words)
        inside = " ".join(f"[{word}]" for word in words)
        forms += f'[[forms]]\nkind = "x"\nsentence = "STOP HOVER {inside} T{n} GO"\n'
    names = [*words, *(f"T{n}" for n in range(20))]
    tokens = "".join(f'"t{n}", ' for n in range(8))
    pairs = "".join(f'"t{n // 8},t{n % 8}" = "{name}"\n' for n, name in enumerate(names))
    path = write_grammar(
        ('tokens = ["0",', f'tokens = [{tokens}"0",'),
        ("[pairs]\n", f"[pairs]\n{pairs}"),
        ("[[forms]]", f"{forms}[[forms]]"),
    )
    assert refusal(path) == "forms: the forms need over 65536 transitions; use fewer or shorter forms"


def test_import_is_light():
    """The command line and robot code import this at start; pydantic waits until a file is read."""
    code = (
        "import sys, lightgesture.fsm\n"
        "print([name for name in ('pydantic', 'numpy', 'cv2', 'sklearn', 'tomllib') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
