"""Our end of the watchdog: starts it, and tells it again and again that we live."""

import json
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Final

from lightgesture.sinks.mavlink_link import Wire

_PROGRAM: Final = Path(__file__).with_name("watchdog_process.py")
END_S: Final = 3.0
"""Seconds that the end waits for it."""


class Watchdog:
    """A process that sends what it was given last when we fall silent.

    It inherits the descriptor of the link, so that a vehicle hears it from the same place. It is made when first
    needed, and anew where the link was opened anew or it was ended by somebody; `report` is told of that.
    """

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._descriptor: int | None = None
        self._is_ready = False

    def sign(self, wire: Wire | None, packets: list[bytes]) -> None:
        """We live. wire: the link; None: it is down, and nothing can be sent. packets: what to send if this was the
        last sign; none: nothing is to be done then."""
        if wire is None:
            self.close()
            return
        if self._process is None or wire.descriptor != self._descriptor or self._process.poll() is not None:
            self.close()
            self._start(wire.descriptor)
        content = {
            "packets": [packet.hex() for packet in packets],
            "descriptor": wire.descriptor,
            "addresses": wire.addresses,
        }
        self._write(content)

    def close(self) -> None:
        """End it in peace."""
        if self._process is None:
            return
        self._write({"bye": True})
        process, self._process = self._process, None
        for stream in (process.stdin, process.stdout):
            assert stream is not None
            with suppress(OSError):
                stream.close()
        try:
            process.wait(END_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    @property
    def is_ready(self) -> bool:
        """Whether it watches: a process that only begins, or that somebody ended, does not."""
        if self._process is None or self._process.poll() is not None:
            return False
        if not self._is_ready:
            assert self._process.stdout is not None
            with suppress(BlockingIOError):
                self._is_ready = bool(os.read(self._process.stdout.fileno(), 1))
        return self._is_ready

    @property
    def pid(self) -> int | None:
        """Number of the process, None where there is none."""
        return None if self._process is None else self._process.pid

    def _start(self, descriptor: int) -> None:
        # Isolated, without the site's packages: it needs none, and starts in 20 ms. A session of its own, so that
        # Ctrl-C in a terminal does not reach it.
        self._process = subprocess.Popen(
            [sys.executable, "-I", "-S", str(_PROGRAM)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            pass_fds=(descriptor,),
            start_new_session=True,
        )
        for stream in (self._process.stdin, self._process.stdout):
            assert stream is not None
            os.set_blocking(stream.fileno(), False)
        self._descriptor, self._is_ready = descriptor, False

    def _write(self, content: dict[str, object]) -> None:
        """Never waits: a watchdog that does not read has our last sign anyway, and is silent about us."""
        assert self._process is not None
        assert self._process.stdin is not None
        with suppress(OSError):
            os.write(self._process.stdin.fileno(), json.dumps(content).encode("ascii") + b"\n")
