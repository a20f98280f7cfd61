"""The command line itself: help, versions, wrong usage, streams that close."""

import io
import os
import subprocess
import sys

import pytest

from lightgesture import __version__, console
from lightgesture.cli import COMMANDS, main
from lightgesture.errors import ExitStatus, UsageError


def python(code, *arguments, **options):
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, **options)


def test_help_is_light_and_names_the_commands():
    code = (
        "import sys; from lightgesture.cli import main; status = main(['--help']);"
        "heavy = {'cv2', 'numpy', 'pydantic', 'sklearn', 'tqdm'} & set(sys.modules);"
        "sys.exit(f'imported {heavy}' if heavy else status)"
    )
    done = python(code)
    assert (done.returncode, done.stderr) == (0, "")
    assert all(name in done.stdout for name in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_each_command(run, command):
    result = run(command, "--help")
    assert result.status == ExitStatus.OK
    assert result.out[0].startswith(f"usage: lightgesture {command}")


def test_version(run):
    assert run("--version").out == [f"lightgesture {__version__}"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "lightgesture: the following arguments are required: COMMAND; see lightgesture --help"),
        (["frob"], "lightgesture: argument COMMAND: frob: unknown; use decode, live, "),
        (
            ["recgnize", "a.png"],
            "lightgesture: argument COMMAND: recgnize: unknown; did you mean 'recognize'? see lightgesture --help",
        ),
        (
            ["decode", "--hodl", "3"],
            "lightgesture: unrecognized arguments: --hodl; did you mean --hold? see lightgesture decode --help",
        ),
        (
            ["grammar", "draw", "--uot=a.svg"],
            "lightgesture: unrecognized arguments: --uot; did you mean --out? see lightgesture grammar draw --help",
        ),
        (
            ["doctor", "dive.mp4"],
            "lightgesture: unrecognized arguments: dive.mp4; see lightgesture doctor --help",
        ),
        (
            ["calibrate", "0", "--kind", "gloves"],
            "lightgesture: argument --kind: gloves: unknown; did you mean 'glove'? see lightgesture calibrate --help",
        ),
        (
            ["decode", "--hold"],
            "lightgesture: argument --hold: expected one argument; see lightgesture decode",
        ),
        (
            ["recognize"],
            "lightgesture: the following arguments are required: IMAGE; see lightgesture recognize",
        ),
    ],
)
def test_wrong_usage_is_one_line(run, arguments, message):
    result = run(*arguments)
    assert result.status == ExitStatus.USAGE
    assert result.out == []
    assert len(result.err) == 1
    assert result.err[0].startswith(message)


@pytest.mark.parametrize(
    ("arguments", "missing", "extra"),
    [
        (["train", "cnn", "--data", "."], "lightgesture.training", "train"),
        (["train", "--help"], "lightgesture.training", "train"),
        (["evaluate"], "lightgesture.benchmarks", "train"),
        (["synth", "--seed", "1"], "lightgesture.synth", "train"),
        (["doctor"], "torch", "train"),
        (["train", "--help"], "sklearn", "train"),
    ],
)
def test_a_command_that_lacks_a_package_names_the_extra_that_brings_it(
    run, monkeypatch, arguments, missing, extra
):
    def refuse(*_):
        raise ModuleNotFoundError(f"No module named '{missing}.x'", name=f"{missing}.x")

    monkeypatch.setattr("lightgesture.cli.importlib.import_module", refuse)
    result = run(*arguments)
    assert result.status == ExitStatus.USAGE
    assert result.out == []
    assert result.err == [
        f"lightgesture: {missing} is needed and not installed; pip install 'lightgesture[{extra}]'"
    ]


def test_a_package_that_no_extra_brings_is_a_defect(run, monkeypatch):
    monkeypatch.setattr("lightgesture.cli.COMMANDS", {"doctor": ("lightgesture.no_such_module", "missing")})
    with pytest.raises(ModuleNotFoundError, match="no_such_module"):
        run("doctor")


class ClosedPipe(io.StringIO):
    def write(self, text):
        raise BrokenPipeError(text)


@pytest.mark.usefixtures("fake")
def test_reader_that_has_gone(make_video, monkeypatch, capsys, tmp_path):
    path = make_video("dive.avi", 4)
    monkeypatch.setattr(sys, "stdout", ClosedPipe())
    status = main(["decode", str(path), "--json", "--out", str(tmp_path / "out")])
    monkeypatch.undo()
    assert status == ExitStatus.SOME_FAILED
    assert capsys.readouterr().err == ""
    assert [each.name for each in (tmp_path / "out").iterdir()] == [".lightgesture.lock"]


class FullDisk(io.StringIO):
    def write(self, text):
        raise OSError(28, "No space left on device", text)


def test_full_disk(monkeypatch):
    monkeypatch.setattr(sys, "stdout", FullDisk())
    with pytest.raises(UsageError, match=r"standard output: cannot be written \(No space left"):
        console.print_line("a")


def test_narrow_output_is_escaped(monkeypatch):
    stream = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stdout", stream)
    console.print_line("två")
    assert stream.buffer.getvalue() == b"tv\\xe5\n"


def test_one_line():
    assert console.one_line("två dykare") == "två dykare"
    assert console.one_line("a\nb\udcff\x1b[0m") == "a\\nb\\udcff\\x1b[0m"


def test_native_messages_are_muted():
    code = (
        "import os, sys; from lightgesture.console import messages_shown, native_messages_muted, say\n"
        "with messages_shown(), native_messages_muted():\n"
        "    os.write(2, b'libnoise complains\\n'); say('två')\n"
        "os.write(2, b'back again\\n'); print('end', file=sys.stderr)"
    )
    done = python(code, env={**os.environ, "PYTHONIOENCODING": "utf-8"}, encoding="utf-8")
    assert done.stderr.splitlines() == ["lightgesture: två", "back again", "end"]


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.parametrize("is_quiet", [False, True])
def test_progress_only_on_a_terminal_that_wants_it(monkeypatch, capsys, is_quiet):
    monkeypatch.setattr(sys, "stderr", Terminal())
    with console.Progress("dive.avi", 4, "frame", is_quiet) as progress:
        progress.advance()
        progress.print_line("a result")
        progress.fail("a message")
        shown = sys.stderr.getvalue()
    monkeypatch.undo()
    assert ("dive.avi" in shown) is not is_quiet
    assert "lightgesture: a message\n" in shown
    assert capsys.readouterr().out == "a result\n"
    with console.Progress("dive.avi", 4, "frame", quiet=False) as progress:
        progress.advance()
    assert capsys.readouterr().err == ""
