"""A diver's hands: sign words by their pairs and see what comes out."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import pytest

from lightgesture.fsm import Decoder, Event, Grammar, Sign, Signs, load_grammar

RATE = 30.0
HOLD = 3

PAIRS = {
    "STOP": "ok,0",
    "CONTD": "pic,0",
    "GO": "ok,ok",
    "AND": "pic,ok",
    "HOVER": "5,5",
    "FOLLOW": "5,1",
    "DOWN": "left,left",
    "UP": "right,right",
    "LEFT": "0,left",
    "RIGHT": "0,right",
    "EXEC": "pic,2",
    "SNAP": "pic,pic",
    "DECREASE": "left,pic",
    "INCREASE": "right,pic",
    "DEFAULT": "ok,pic",
    **{str(n): f"ok,{n}" for n in range(6)},
    **{f"PARAM_{n}": f"{n},pic" for n in range(6)},
}
"""The published table, written out again: a slip in the bundled file must not slip through."""


class Diver:
    """Holds each pair for the decoder's hold and then shows nothing for `gap` frames, at 30 a second."""

    def __init__(self, decoder: Decoder, hold: int, gap: int) -> None:
        self.decoder = decoder
        self.hold = hold
        self.gap = gap
        self.frame = 0

    def show(self, pair: str | None, frames: int, *confidences: float) -> list[Event]:
        """confidences: of the left and of the right hand."""
        signs = Signs(*map(Sign, pair.split(","), confidences or (1.0, 1.0))) if pair else Signs()
        events: list[Event] = []
        for _ in range(frames):
            events += self.decoder.step(signs, self.frame / RATE, frame=self.frame)
            self.frame += 1
        return events

    def pairs(self, pairs: Iterable[str]) -> list[Event]:
        return [event for pair in pairs for event in self.show(pair, self.hold) + self.show(None, self.gap)]

    def words(self, sentence: str) -> list[Event]:
        """Sign words such as "STOP HOVER 5 AND 0 GO"; PARAM_3 is PARAM 3."""
        return self.pairs(PAIRS[word] for word in sentence.split())


@pytest.fixture(scope="session")
def grammar() -> Grammar:
    return load_grammar()


@pytest.fixture(scope="session")
def words_to_pairs() -> dict[str, str]:
    return PAIRS


@pytest.fixture(scope="session")
def new_diver(grammar: Grammar) -> Callable[..., Diver]:
    """A function that makes a diver in front of a fresh decoder."""

    def make(hold: int = HOLD, gap: int = 1, source: str | None = None, language: Grammar = grammar) -> Diver:
        return Diver(Decoder(language, hold=hold, source=source), hold, gap)

    return make


@pytest.fixture
def diver(new_diver: Callable[..., Diver]) -> Diver:
    return new_diver()


@pytest.fixture(scope="session")
def pick() -> Callable[..., list[Any]]:
    """A function that picks the events of the given types, or one field of them."""

    def choose(events: Iterable[Event], *types: str, field: str | None = None) -> list[Any]:
        found = [event for event in events if event.type in types]
        return [getattr(event, field) for event in found] if field else found

    return choose


@pytest.fixture
def write_grammar(tmp_path: Path) -> Callable[..., Path]:
    """A function that writes the bundled grammar with `old` replaced by `new` and returns its path."""
    bundled = (Path(load_grammar().file)).read_text(encoding="utf-8")

    def write(*replacements: tuple[str, str]) -> Path:
        text = bundled
        for old, new in replacements:
            assert old in text, f"{old!r} is not in the bundled grammar"
            text = text.replace(old, new, 1)
        path = tmp_path / "my.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write
