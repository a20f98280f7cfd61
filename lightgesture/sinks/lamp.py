"""A lamp of three colours on pins of the board, for the diver to see."""

import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Final

from lightgesture.errors import UsageError, reason_of
from lightgesture.fsm import Instruction, Notice, Rejected, State
from lightgesture.records import Record, VehicleRecord
from lightgesture.sinks.answers import Lights, Mood, advance, lights
from lightgesture.sinks.outbox import Sink, SinkError

POLL_S: Final = 0.05
"""Seconds from one look at the lights to the next: a fifth of a blink."""

MOST_PIN: Final = 53
"""Highest number of a pin, as Broadcom counts them."""


class LampSink(Sink):
    """Green, orange and red, each on a pin of its own, by gpiozero.

    pins: the numbers of green, orange and red. obeys: whether a vehicle says what becomes of instructions.
    UsageError when made: gpiozero is not installed.
    """

    poll_s = POLL_S

    def __init__(
        self, pins: tuple[int, int, int], obeys: bool, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.name = f"lamp {','.join(map(str, pins))}"
        self._pins, self._obeys, self._clock = pins, obeys, clock
        self._make = _import_led()
        self._leds: list[Any] = []
        self._mood = Mood()
        self._shown: Lights | None = None

    def wants(self, record: Record) -> bool:
        """What changes the lights."""
        return isinstance(record, State | VehicleRecord | Instruction | Rejected | Notice)

    def open(self) -> None:
        """Take the pins. SinkError: they cannot be had."""
        try:
            for pin in self._pins:
                self._leds.append(self._make(pin))
        except Exception as error:  # each of gpiozero's back-ends has its own
            raise SinkError(f"{self.name}: the pins cannot be had ({reason_of(error)})") from None
        self._shown = None
        self.poll()

    def send(self, record: Record) -> None:
        """Show what a record tells."""
        self._mood = advance(self._mood, record, self._clock(), self._obeys)
        self.poll()

    def poll(self) -> None:
        """Switch what must be switched. SinkError: a pin is gone."""
        wanted = lights(self._mood, self._clock())
        if wanted == self._shown:
            return
        try:
            for led, is_on in zip(self._leds, (wanted.green, wanted.orange, wanted.red), strict=True):
                led.value = is_on
        except Exception as error:
            raise SinkError(f"{self.name}: cannot be switched ({reason_of(error)})") from None
        self._shown = wanted

    def close(self) -> None:
        """All dark, and the pins given back."""
        for led in self._leds:
            with suppress(Exception):  # likewise
                led.close()
        self._leds.clear()


def parse_pins(text: str) -> tuple[int, int, int]:
    """The pins of `GREEN,ORANGE,RED`. UsageError: they are none."""
    parts = text.split(",")
    is_number = all(part.isascii() and part.isdecimal() and int(part) <= MOST_PIN for part in parts)
    if len(parts) != 3 or not is_number or len(set(map(int, parts))) != 3:
        raise UsageError(
            f"--answer lamp:{text}: should be three pins, 0 to {MOST_PIN}, of green, orange and red, as lamp:17,27,22"
        )
    green, orange, red = map(int, parts)
    return green, orange, red


def _import_led() -> Any:
    try:
        from gpiozero import LED
    except ImportError as error:
        raise UsageError(
            f"--answer lamp: gpiozero is not installed ({error}); install lightgesture[lamp]"
        ) from None
    return LED
