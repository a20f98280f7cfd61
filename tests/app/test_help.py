"""What is made of the table of commands and options: help, man page, completion, a configuration file."""

import importlib.util
import logging
import re
import shutil
import subprocess
import sys

import pytest

from lightgesture.cli import COMMANDS, make_parser, present_commands
from lightgesture.config.declaring import DECODING
from lightgesture.config.options import read_config
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import messages_shown, warn
from lightgesture.errors import ExitStatus
from lightgesture.parser import arguments, children


def words_of_commands(parser, words=()):
    """The words that lead to each command and action."""
    yield words
    for name, child, _ in children(parser):
        yield from words_of_commands(child, (*words, name))


EVERY = list(words_of_commands(make_parser(present_commands())))


@pytest.mark.parametrize("words", EVERY, ids=" ".join)
def test_help_keeps_to_80_columns(run, monkeypatch, words):
    monkeypatch.setenv("COLUMNS", "80")
    result = run(*words, "--help")
    assert (result.status, result.err) == (ExitStatus.OK, [])
    assert [line for line in result.out if len(line) > 80] == []


@pytest.mark.parametrize("words", EVERY, ids=" ".join)
def test_help_keeps_to_40_columns_where_an_option_and_its_values_do(run, monkeypatch, words):
    monkeypatch.setenv("COLUMNS", "40")
    wide = [line for line in run(*words, "--help").out if len(line) > 40]
    assert [line for line in wide if not line.lstrip().startswith(("-", "[", "usage: "))] == []


def test_the_man_page_has_every_command_and_option(run):
    page = "\n".join(run("manual").out).replace(r"\-", "-").replace(r"\e", "\\")
    assert [words for words in EVERY[1:] if f".SS lightgesture {' '.join(words)}\n" not in page] == []
    options = {
        option
        for words in EVERY[1:]
        for action in arguments(parser_of(words))
        for option in action.option_strings
    }
    assert {option for option in options if rf"\fB{option}\fR" not in page} == set()


def parser_of(words):
    parser = make_parser(present_commands())
    for word in words:
        parser = {name: child for name, child, _ in children(parser)}[word]
    return parser


@pytest.mark.skipif(shutil.which("groff") is None, reason="no groff on this machine")
def test_groff_takes_the_man_page(run):
    page = "\n".join(run("manual").out)
    done = subprocess.run(
        ["groff", "-man", "-ww", "-Tascii", "-z"], input=page, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash on this machine")
@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("gram", "grammar"),
        ("decode --mirr", "--mirrored"),
        ("grammar dr", "draw"),
        ("train cnn --pre", "--precision"),
    ],
)
def test_bash_completes_commands_and_options(run, tmp_path, typed, expected):
    script = tmp_path / "completion"
    script.write_text("\n".join(run("completion", "bash").out))
    ask = (
        f"source {script}; COMP_WORDS=(lightgesture {typed}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); "
        "$(complete -p lightgesture | sed 's/.*-F \\([^ ]*\\).*/\\1/') lightgesture; echo ${COMPREPLY[@]}"
    )
    done = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, check=False)
    assert expected in done.stdout.split(), done.stderr


@pytest.mark.parametrize("shell", ["zsh", "tcsh"])
def test_the_other_shells_have_a_script(run, shell):
    assert any("mirrored" in line for line in run("completion", shell).out)


def test_a_configuration_file_has_every_option_and_what_was_given(run, tmp_path):
    path = tmp_path / "sub" / "my.toml"
    path.parent.mkdir()
    grammar = tmp_path / "my grammar.toml"
    given = ["--hold-seconds", 0.4, "--annotate", "--grammar", grammar, "--udp", "rov:9000", "--no-mirrored"]
    assert run("config", path, *given).status == ExitStatus.OK
    assert read_config(str(path)) == {
        "hold_seconds": 0.4,
        "annotate": "below",
        "grammar": str(path.parent / ".." / "my grammar.toml"),
        "udp": ["rov:9000"],
        "mirrored": False,
    }
    lines = path.read_text(encoding="utf-8")
    fields = DecodeSettings.model_fields.items()
    keys = {
        field.alias or name for name, field in fields if set(DECODING) & set(field.json_schema_extra["only"])
    }
    assert set(re.findall(r"^#?(\w+) = ", lines, re.MULTILINE)) == keys
    shown = "\n".join(re.findall(r"^#(\w+ = (?:[\[\"\d]|true|false).*)$", lines, re.MULTILINE))
    path.write_text(shown, encoding="utf-8")
    assert DecodeSettings.model_validate(read_config(str(path))) == DecodeSettings()


def test_a_configuration_file_replaces_none(run, tmp_path):
    path = tmp_path / "my.toml"
    path.write_text("mine")
    result = run("config", path)
    assert (result.status, result.err) == (
        ExitStatus.USAGE,
        [f"lightgesture: {path}: is there already; name a new file"],
    )
    assert path.read_text() == "mine"
    assert (
        run("config", tmp_path / "no" / "my.toml")
        .err[0]
        .endswith("(No such file or directory); name another place")
    )
    assert run("config", "-", "--hold", "0").status == ExitStatus.USAGE
    assert "hold = 9" in run("config", "-", "--hold", "9").out


def test_commands_of_rooms_that_are_not_installed_are_left_out(monkeypatch):
    find = importlib.util.find_spec
    missing = "lightgesture.training"

    def refuse(name):
        if name.startswith(missing):
            raise ModuleNotFoundError(name)
        return find(name)

    monkeypatch.setattr("lightgesture.cli.importlib.util.find_spec", refuse)
    assert set(COMMANDS) - set(present_commands()) == {"train"}


def test_messages_go_through_logging(caplog, capsys):
    with messages_shown(), caplog.at_level(logging.INFO, logger="lightgesture"):
        warn("two\nlines")
    assert [(one.name, one.levelname, one.getMessage()) for one in caplog.records] == [
        ("lightgesture", "WARNING", "two\\nlines")
    ]
    assert capsys.readouterr().err == "lightgesture: two\\nlines\n"


def test_other_programs_decide_where_messages_go():
    code = (
        "import logging, sys\n"
        "from lightgesture.console import warn\n"
        "logging.basicConfig(format='%(name)s %(levelname)s %(message)s', stream=sys.stdout)\n"
        "warn('dive.mp4: has no clock')\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("lightgesture WARNING dive.mp4: has no clock\n", "")
