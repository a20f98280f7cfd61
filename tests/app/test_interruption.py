"""SIGTERM ends a run as Ctrl-C does."""

import os
import signal
import threading
import time

import pytest

from lightgesture import cli
from lightgesture.errors import ExitStatus
from lightgesture.interruption import terminated_as_interrupted
from lightgesture.results.atomic import replacing


def terminate():
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(0.2)  # the signal is taken at the next step of the main thread


def test_what_was_half_written_is_gone(tmp_path):
    def write():
        with terminated_as_interrupted(), replacing(tmp_path / "a") as temporary:
            temporary.write_text("half")
            terminate()

    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(KeyboardInterrupt):
        write()
    assert list(tmp_path.iterdir()) == []
    assert signal.getsignal(signal.SIGTERM) is before


def test_a_second_signal_does_not_break_off_the_clean_up():
    cleaned = []

    def clean_up_slowly():
        try:
            terminate()
        finally:
            terminate()
            cleaned.append(True)

    with pytest.raises(KeyboardInterrupt), terminated_as_interrupted():
        clean_up_slowly()
    assert cleaned == [True]


def test_every_command_takes_it(capsys):
    assert cli.exit_status(terminate, "all is kept") == ExitStatus.INTERRUPTED
    assert "interrupted" in capsys.readouterr().err


def test_other_threads_are_left_alone():
    seen = []

    def work():
        with terminated_as_interrupted():
            seen.append(signal.getsignal(signal.SIGTERM))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [signal.getsignal(signal.SIGTERM)]
