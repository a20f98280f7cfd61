"""Every defect of a grammar by name and place, all at once, in bounded time."""

import json
import time
from pathlib import Path

import pytest

from lightgesture.fsm import GrammarError, inspect_grammar, load_grammar

EXAMPLE = Path(__file__).parents[2] / "docs" / "grammars" / "sonar.toml"


@pytest.fixture
def defects(tmp_path):
    """A function that changes the example grammar and returns what is wrong with it, as lines."""

    def change(*replacements):
        text = EXAMPLE.read_text(encoding="utf-8")
        for old, new in replacements:
            assert old in text, f"{old!r} is not in the example"
            text = text.replace(old, new, 1)
        path = tmp_path / "my.toml"
        path.write_text(text, encoding="utf-8")
        grammar, found = inspect_grammar(path)
        assert (grammar is None) == any(defect.is_fatal for defect in found)
        return [str(defect) for defect in found]

    return change


@pytest.mark.parametrize("path", [None, EXAMPLE, EXAMPLE.with_name("repeat.toml")])
def test_sound_grammars_have_none(path):
    grammar, found = inspect_grammar(path)
    assert found == []
    assert grammar == load_grammar(path)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            'cancel = "CANCEL"',
            'cancel = "STOPP"',
            "control.cancel: unknown word 'STOPP'; give it a sign in [pairs]",
        ),
        ('cancel = "CANCEL"', 'cancel = "GO"', "control.cancel: 'GO' has another use; give it its own word"),
        ('kill = "ABORT"', 'kill = "AND"', "control.kill: 'AND' has another use; give it its own word"),
        ('kill = "ABORT"', 'kill = "3"', "control.kill: '3' has another use; give it its own word"),
        ('kill = "ABORT"', 'kill = "CANCEL"', "control.kill: 'CANCEL' cancels too; give each its own word"),
        ('kill = "ABORT"', 'kill = "HOVER"', "control: a form uses 'HOVER'; give one of them another word"),
        (
            '"5,0" = "ABORT"',
            '"1,1" = "ABORT"',
            "control.kill: the pair 1,1 has another meaning in [idle_pairs] or [menu]; use a pair that is free",
        ),
        (
            '"left,right" = "CANCEL"',
            '"0,0" = "CANCEL"',
            "control.cancel: the pair 0,0 has another meaning in [idle_pairs] or [menu]",
        ),
        (
            'confirm = ["SONAR"]',
            'confirm = ["SONAR", "SONR"]',
            "control.confirm[1]: unknown word 'SONR'; use a word that has a sign",
        ),
        (
            'open = "ok,ok"',
            'open = "ok"',
            'menu.open: is no pair; write "left hand,right hand", such as "ok,5"',
        ),
        (
            'open = "ok,ok"',
            'open = "0,0"',
            "menu.open: the pair is STOP while idle; use another, or remove it",
        ),
        ('"1,1" = 1', '"1,6" = 1', "menu.entries.\"1,6\": unknown token '6'; use one of 0, 1, 2"),
        ('"1,1" = 1', '"1,1" = "1"', 'menu.entries."1,1": is no whole number; write one without quotes'),
        ('"1,1" = 1', '"1,1" = 1\n"1, 1" = 2', 'menu.entries."1, 1": pair used twice; keep one, here or for'),
        ("confirm = true", "confirm = 1", "forms[1].confirm: "),
        ("step = 0.5", "step = 0", "parameters.1.step: should be greater than 0, not 0; change it"),
        (
            "step = 0.5",
            "step = 50",
            "parameters.1.step: 50 is more than from minimum to maximum; use a smaller one",
        ),
        (
            "minimum = 0",
            "minimum = 50",
            "parameters.1.minimum: 50 is above maximum = 40; swap or correct them",
        ),
        (
            "default = 2",
            "default = 41",
            "parameters.1.default: 41 is outside minimum and maximum; use one between",
        ),
        ("default = 2", "default = -1", "parameters.1.default: -1 is outside minimum and maximum"),
        ("step = 0.5", "stepp = 0.5", "parameters.1.stepp: unknown key; did you mean 'step'?"),
        (
            '"pic,0" = "CONTD"',
            '"0,0" = "CONTD"',
            "sentinels.start[1]: 'CONTD' cannot be signed: all its pairs mean something else while idle; give it",
        ),
        (
            '1 = "surface"',
            '4 = "surface"',
            "programs.4: no sign for the digit 4; use other digits or add a pair",
        ),
        (
            '1 = "surface"',
            '11111 = "surface"',
            "programs.11111: has more than max_digits = 4 digits; use a shorter number",
        ),
        ('2 = "light"', '3 = "light"', "parameters.2: is signed and not listed; add it, or remove the pair"),
        (
            '2 = "light"',
            '2 = "light"\n7 = "x"',
            "parameters.7: has no sign; add a pair for a word that carries it",
        ),
        (
            '1 = "surface"\n2 = "follow the transect"\n',
            "",
            'programs: lists no program; add a line such as 1 = "surface"',
        ),
        ("[sentinels]", 'include = "my.toml"\n[sentinels]', "include: unknown key; use tokens, sentinels"),
        (
            "[menu]\n",
            "[limits]\nmax_words = 2\n[menu]\n",
            "limits.max_words: should be greater than or equal to 3",
        ),
        (
            "[menu]\n",
            '[dwell]\nrule = "time"\n[menu]\n',
            "dwell.rule: should be 'frames', 'seconds', 'evidence' or 'sentence'",
        ),
        ("[menu]\n", "[dwell]\nunread = 0\n[menu]\n", "dwell.unread: should be greater than 0, not 0"),
        (
            "[menu]\n",
            "[dwell]\nhold_seconds = 0\n[menu]\n",
            "dwell.hold_seconds: should be greater than or equal to",
        ),
    ],
)
def test_each_defect_is_named(defects, old, new, expected):
    found = defects((old, new))
    assert found
    assert found[0].startswith(expected)


def test_known_tokens_are_told_up_to_a_dozen(defects):
    (told,) = defects(('"1,1" = 1', '"1,6" = 1'))
    assert told.endswith("; use one of 0, 1, 2, 3, 4, 5, left, right, pic, ok")
    (told,) = defects(('"1,1" = 1', '"1,x" = 1'), ('tokens = ["0",', 'tokens = ["6", "7", "8", "0",'))
    assert told.endswith("; use one of 6, 7, 8, 0, 1, 2, 3, 4, 5, left, right, pic, ...")
    (told,) = defects(('"1,1" = 1', '"1,x" = 1'), ('tokens = ["0",', 'tokens = ["6", "7", "0",'))
    assert told.endswith(", pic, ok")


def test_the_limits_of_a_parameter_themselves_are_allowed(defects):
    assert defects(("step = 0.5", "step = 40"), ("default = 2", "default = 40")) == []
    assert (
        defects(("default = 2", "default = 0"), ("maximum = 40", "maximum = 0"), ("step = 0.5, ", "")) == []
    )
    assert defects(("minimum = 0, maximum = 40, ", "")) == []


def test_all_kinds_are_found_at_once(defects):
    found = defects(
        ('"4,4" = "SONAR"', '"4,9" = "SONAR"'),
        ("STOP EXEC program GO", "STOP EXEC program"),
        ("CONTD PARAM n", "CONTD PARM n"),
        ("step = 0.5", 'step = "0.5"'),
        ('kill = "ABORT"', 'kill = "KILL"'),
        ('end = "GO"', 'end = "GOO"'),
    )
    places = [line.partition(": ")[0] for line in found]
    assert places == [
        "parameters.1.step",
        'pairs."4,9"',
        "sentinels.end",
        "control.kill",
        "forms[0].sentence",
        "forms[1].sentence",
        "forms[2].sentence",
    ]


def test_every_ambiguous_pair_of_forms_is_named(defects):
    form = '[[forms]]\nkind = "x"\nsentence = "{}"\n\n[programs]'
    found = defects(
        ("[programs]", form.format("STOP HOVER GO")), ("[programs]", form.format("STOP SONAR 1|2 GO"))
    )
    assert [line.partition(";")[0] for line in found] == [
        "forms: 'STOP HOVER|SONAR [seconds] GO' and 'STOP HOVER GO' read the same sentence",
        "forms: 'STOP HOVER|SONAR [seconds] GO' and 'STOP SONAR 1|2 GO' read the same sentence",
    ]


def test_wrong_entries_of_a_list_are_left_out_together(defects):
    found = defects(
        ('start = ["STOP", "CONTD"]', 'start = [1, "STOP", 2, "CONTD", "X"]'),
        ('tokens = ["0",', 'tokens = [true, "0", "0",'),
    )
    assert [line.partition(": ")[0] for line in found] == [
        "tokens[0]",
        "sentinels.start[0]",
        "sentinels.start[2]",
        "tokens[1]",
        "sentinels.start[2]",
    ]


def test_fatal_defects_come_first(defects):
    found = defects(('1 = "surface"', '9 = "surface"'), ('"4,4" = "SONAR"', '"4,4" = "SONAR"\n"3,3" = "X"'))
    assert [line.partition(":")[0] for line in found] == ['pairs."3,3"', "programs.9"]


def test_what_is_not_fatal_can_be_loaded(tmp_path):
    path = tmp_path / "my.toml"
    path.write_text(EXAMPLE.read_text(encoding="utf-8").replace('2 = "light"', ""), encoding="utf-8")
    assert sorted(load_grammar(path).parameters) == [1]


@pytest.mark.parametrize(
    "content",
    [
        "tokens = "
        + json.dumps(["a", "b"])
        + "\n[pairs]\n"
        + "\n".join(f'"a,{n}" = "W{n}"' for n in range(10_000)),
        "tokens = [" + ", ".join(["1"] * 10_000) + "]",
        "\n".join(f"k{n} = 1" for n in range(10_000)),
        "forms = [" + ", ".join(['{kind = "x", sentence = "A"}'] * 10_000) + "]",
        "a = " + "[" * 200 + "]" * 200,
        "'ü' = 1\n'日本' = 2",
        "tokens = 1\nsentinels = 2\nidle_pairs = 3\npairs = 4\nforms = 5\nprograms = 6\nparameters = 7\nlimits = 8\n"
        "dwell = 9\ncontrol = 10\nmenu = 11",
    ],
    ids=["pairs", "tokens", "keys", "forms", "nested", "unicode", "types"],
)
def test_large_or_odd_files_are_told_in_bounded_time(tmp_path, content):
    path = tmp_path / "my.toml"
    path.write_text(content, encoding="utf-8")
    start = time.process_time()
    grammar, found = inspect_grammar(path)
    assert grammar is None
    assert found
    assert all("\n" not in str(defect) and len(str(defect)) < 700 for defect in found)
    assert time.process_time() - start < 5.0


def test_nesting_beyond_measure_is_told(tmp_path):
    path = tmp_path / "my.toml"
    path.write_text("a = " + "[" * 100_000, encoding="utf-8")
    with pytest.raises(GrammarError, match="too deeply nested"):
        inspect_grammar(path)
