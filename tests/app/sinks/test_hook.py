"""Commands run for instructions."""

import json
import subprocess
import sys
import time

import pytest

from lightgesture.errors import UsageError
from lightgesture.sinks import RecordError
from lightgesture.sinks.hook import HookSink


@pytest.fixture
def patience(monkeypatch):
    """Sets how long a command may take."""
    return lambda seconds: monkeypatch.setattr("lightgesture.sinks.hook.TIMEOUT_S", seconds)


def hook(tmp_path, code):
    script = tmp_path / "a hook.py"
    script.write_text(code)
    return HookSink(f"{sys.executable} '{script}' '$HOME; false'")


def test_the_record_comes_on_standard_input_and_no_shell_is_in_between(
    tmp_path, patience, instruction, heartbeat
):
    code = f"import sys; open({str(tmp_path / 'out')!r}, 'w').write(sys.argv[1] + sys.stdin.read())"
    # An emulated board takes more than the usual five seconds to start an interpreter.
    patience(60)
    sink = hook(tmp_path, code)
    assert sink.wants(instruction())
    assert not sink.wants(heartbeat())
    sink.open()
    sink.send(instruction())
    sink.close()
    written = (tmp_path / "out").read_text()
    assert written.startswith("$HOME; false{")
    assert json.loads(written.removeprefix("$HOME; false")) == instruction().to_dict()


def test_a_command_that_fails(tmp_path, instruction):
    with pytest.raises(RecordError, match=r"^hook .*: failed with status 3$"):
        hook(tmp_path, "raise SystemExit(3)").send(instruction())


def test_a_command_that_does_not_read(instruction):
    HookSink("true").send(instruction(words=("X" * 300_000,)))


def test_a_command_that_takes_too_long_ends_with_what_it_started(tmp_path, patience, instruction):
    patience(0.3)
    child = f"import time; time.sleep(0.6); open({str(tmp_path / 'late')!r}, 'w')"
    code = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {child!r}])"
    with pytest.raises(RecordError, match=r"killed after 0.3 s$"):
        hook(tmp_path, code).send(instruction())
    time.sleep(0.6)
    assert not (tmp_path / "late").exists()


def test_a_command_that_vanishes(tmp_path, instruction):
    program = tmp_path / "program"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    sink = HookSink(str(program))
    program.unlink()
    with pytest.raises(RecordError, match=r"cannot be run \(No such file"):
        sink.send(instruction())


@pytest.mark.parametrize("command", ["", "   ", "no-such-program --x", "'open", "/tmp"])
def test_no_command(command):
    with pytest.raises(UsageError, match=r"^--hook"):
        HookSink(command)


def test_its_standard_error_is_ours_while_native_messages_are_muted(tmp_path):
    code = (
        "import sys; from types import SimpleNamespace\n"
        "from lightgesture.console import native_messages_muted; from lightgesture.sinks.hook import HookSink\n"
        "hook = HookSink(sys.argv[1]); record = SimpleNamespace(to_dict=dict)\n"
        "with native_messages_muted(): hook.send(record)"
    )
    script = "sh -c 'echo out; echo complaint >&2'"
    done = subprocess.run(
        [sys.executable, "-c", code, script], capture_output=True, text=True, timeout=60, check=True
    )
    assert (done.stdout, done.stderr) == ("", "complaint\n")
