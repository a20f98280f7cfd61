"""What may be wrong with how the camera looks, told by what is read: mirrored, on its head, on its side."""

from collections.abc import Iterable
from typing import Final

from lightgesture.features.image import as_bgr8, turned
from lightgesture.features.types import Image
from lightgesture.front_end import FrontEnd
from lightgesture.fsm import Grammar, Instruction, State, Word
from lightgesture.pipeline import Pipeline
from lightgesture.records import Record

HELD: Final = 0.3
"""Progress from which a hold counts as a sign that was meant, 0 to 1."""

LEAST_PAIRS: Final = 3
"""Held pairs that are words as their mirror image alone, from which it is said so."""

PAIRS_FACTOR: Final = 2
"""How many times as many they must be as those that are words as they stand alone."""

PROBE_S: Final = 1.0
"""Seconds between two pictures that are read turned as well."""

MOST_PROBES: Final = 24
"""Pictures that are read so; then it is known, or nobody signs."""

TURNS: Final = (180, 90, 270)
"""Degrees, clockwise, that are tried in turn."""

SURE: Final = 0.9
"""Confidence from which a token counts here, 0 to 1: hands upside down are read as signs too, but seldom surely."""

LEAST_TOKENS: Final = 4
"""Tokens in turned pictures from which it is said so."""

TOKENS_FACTOR: Final = 3
"""How many times as many they must be as in the same pictures as they stand."""


class MirrorHint:
    """Counts held pairs that are words only as their mirror image, in which the hands change places."""

    def __init__(self, grammar: Grammar) -> None:
        self._words = {*grammar.idle_words, *grammar.sentence_words, *grammar.menu_words}
        self._held: object = None
        self._mirrored = self._plain = 0
        self._is_issued = False

    def hear(self, records: Iterable[Record]) -> None:
        """Take in the records of a frame."""
        for record in records:
            if isinstance(record, Instruction):
                self._is_issued = True
            elif isinstance(record, State):
                self._note(record)

    def text(self) -> str | None:
        """What is to be told; None: nothing."""
        enough = self._mirrored >= max(LEAST_PAIRS, PAIRS_FACTOR * self._plain)
        if self._is_issued or not enough:
            return None
        return f"{self._mirrored} held pairs are words only with left and right exchanged"

    def _note(self, state: State) -> None:
        pair = None if state.dwell is None or state.dwell.progress < HELD else state.dwell.pair
        if pair == self._held:
            return
        self._held = pair
        if pair is None or len(pair) != 2 or pair[0] == pair[1]:
            return
        is_word, is_mirrored = pair in self._words, (pair[1], pair[0]) in self._words
        self._mirrored += is_mirrored and not is_word
        self._plain += is_word and not is_mirrored


class TurnHint:
    """Reads a picture now and then turned as well, until a word was signed: where hands are read so and not as they
    stand, the camera is not upright.

    front: the stream's own, of which another is made for single pictures.
    """

    def __init__(self, front: FrontEnd) -> None:
        self._front = front.for_stream()
        self._due_s: float | None = None
        self._probes = 0
        self._counts = {degrees: [0, 0] for degrees in TURNS}
        self._is_over = False

    def look(self, image: Image, time_s: float, records: Iterable[Record]) -> None:
        """Take in the next picture, uint8 (height, width, 3) BGR, and its records."""
        self._is_over = self._is_over or any(isinstance(record, Word) for record in records)
        is_due = self._due_s is None or not self._due_s - PROBE_S <= time_s < self._due_s
        if self._is_over or not is_due or self._probes == MOST_PROBES:
            return
        degrees = TURNS[self._probes % len(TURNS)]
        self._probes += 1
        self._due_s = time_s + PROBE_S
        upright = as_bgr8(image)
        for place, degrees_tried in enumerate((0, degrees)):
            self._counts[degrees][place] += self._tokens(turned(upright, degrees_tried))

    def turn(self) -> int | None:
        """Degrees, clockwise, by which it should be turned more; None: none that is known of."""
        best = max(TURNS, key=lambda degrees: self._counts[degrees][1])
        plain, better = self._counts[best]
        return best if not self._is_over and better >= max(LEAST_TOKENS, TOKENS_FACTOR * plain) else None

    def _tokens(self, image: Image) -> int:
        self._front.recognize(image)
        hands = self._front.shown().get("hands", ())
        return sum(hand.token is not None and hand.confidence >= SURE for hand in hands)


class Hints:
    """Both, for one stream. mirrored, rotate: the options that are in force."""

    def __init__(self, pipeline: Pipeline, mirrored: bool, rotate: int) -> None:
        self._mirror, self._turn = MirrorHint(pipeline.decoder.grammar), TurnHint(pipeline.front)
        self._mirrored, self._rotate = mirrored, rotate
        self._told: set[str] = set()

    def look(self, image: Image | None, time_s: float, records: Iterable[Record]) -> None:
        """Take in the next picture and its records."""
        records = list(records)
        self._mirror.hear(records)
        if image is not None:
            self._turn.look(image, time_s, records)

    def texts(self) -> list[str]:
        """What is to be told and was not told yet, without the input's name."""
        found = []
        if (text := self._mirror.text()) is not None:
            remedy = "leave out --mirrored" if self._mirrored else "try --mirrored"
            found.append(("mirror", f"read as a mirror image? {text}: {remedy}"))
        if (degrees := self._turn.turn()) is not None:
            whole = (self._rotate + degrees) % 360
            remedy = f"try --rotate {whole}" if whole else "leave out --rotate"
            doubt = "upside down?" if degrees == 180 else "on its side?"
            found.append(
                ("turn", f"{doubt} Hands are read with the picture turned and not as it stands: {remedy}")
            )
        new = [text for kind, text in found if kind not in self._told]
        self._told |= {kind for kind, _ in found}
        return new
