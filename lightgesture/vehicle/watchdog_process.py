"""The watchdog itself, a process of its own that has nothing but the standard library and a few bytes to send.

It reads lines of JSON from standard input, each a sign of life with what is to be sent if it is the last one:
`{"packets": ["hex", …], "descriptor": 3, "addresses": [["127.0.0.1", 14550]]}`. Where none comes for TIMEOUT_S, or the
input ends without `{"bye": true}`, the packets are sent, again and again for REPEAT_S or until a sign of life comes.
Signals that end the decoder's group do not end it: it ends when its input has ended and all is sent.
"""

import json
import os
import select
import signal
import socket
import sys
import time
from contextlib import suppress
from typing import Any

TIMEOUT_S = 0.2
"""Seconds without a sign of life after which the decoder counts as hung; it gives one each 0.05 s. Less: a busy
machine is taken for a hung one. More: a vehicle goes on for longer."""

REPEAT_S = 1.5
"""Seconds for which the packets are sent, so that a lossy link lets some through."""

EVERY_S = 0.1
"""Seconds from one to the next."""

READY = b"!"
"""Written to standard output once, when it watches."""

_READ = 65536


class Last:
    """The last sign of life, and the rest of a line that has not come whole."""

    def __init__(self) -> None:
        self.content: dict[str, Any] = {}
        self._rest = b""

    def take(self, content: bytes) -> None:
        """Take what was read."""
        *lines, self._rest = (self._rest + content).split(b"\n")
        for line in lines[-1:]:
            self.content = json.loads(line)

    @property
    def is_goodbye(self) -> bool:
        """Whether the decoder has ended as it should."""
        return bool(self.content.get("bye"))


def watch(stream: int) -> None:
    """Watch until the input ends. stream: descriptor of the input."""
    last, silent_since_s, sent_s = Last(), time.monotonic(), float("-inf")
    is_ended = False
    while True:
        now_s = time.monotonic()
        silent_s = now_s - silent_since_s
        is_dead = is_ended or silent_s >= TIMEOUT_S
        if (
            is_dead
            and last.content.get("packets")
            and silent_s < TIMEOUT_S + REPEAT_S
            and now_s - sent_s >= EVERY_S
        ):
            sent_s = now_s
            send(last.content)
        if is_ended:
            if last.is_goodbye or not last.content.get("packets") or silent_s >= TIMEOUT_S + REPEAT_S:
                return
            time.sleep(EVERY_S / 2)
            continue
        if not select.select([stream], [], [], 0.02 if not is_dead else EVERY_S / 2)[0]:
            continue
        content = os.read(stream, _READ)
        if content:
            last.take(content)
            silent_since_s = time.monotonic()
        else:
            is_ended = True


def send(content: dict[str, Any]) -> None:
    """Send the packets on the descriptor that was handed down; a link that is gone is no matter here."""
    packets = [bytes.fromhex(packet) for packet in content["packets"]]
    addresses = [tuple(address) for address in content.get("addresses", ())]
    descriptor = int(content["descriptor"])
    for packet in packets:
        with suppress(OSError):
            if not addresses:
                os.write(descriptor, packet)
                continue
            with socket.socket(fileno=os.dup(descriptor)) as wire:
                for address in addresses:
                    wire.sendto(packet, address)


def main() -> None:
    """Watch standard input, and say so in one byte as soon as nothing stands against it."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    os.write(sys.stdout.fileno(), READY)
    watch(sys.stdin.fileno())


if __name__ == "__main__":
    main()
