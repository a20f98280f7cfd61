"""What the decoder says: frozen records, one class per `type`, keys in the documented order.

Common fields: `source` names the input (None: not named), `frame` is the 0-based index of the frame, `time_s` its time
stamp in seconds, and `utc` the same as time of day (ISO 8601), put in by whoever knows it. A pair is (left hand, right
hand), the diver's own, or the word of one card.
"""

from dataclasses import dataclass, field, fields
from typing import Any, Literal

from lightgesture.fsm.signs import Shown


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return list(value)
    return value.to_dict() if isinstance(value, Growth | Certainty) else value


def _record(event: Any) -> dict[str, Any]:
    return {item.name: _plain(getattr(event, item.name)) for item in fields(event)}


@dataclass(frozen=True, slots=True, kw_only=True)
class Growth:
    """A hold that is growing: `word` is what it would be read as (None: no word), `progress` 0 to 1."""

    pair: Shown
    word: str | None
    progress: float

    def to_dict(self) -> dict[str, Any]:
        return _record(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class Certainty:
    """How sure the best reading of the open sentence is, under the rule "sentence".

    words: each with how well its sign was seen, 0 to 1. expected: what may follow, for the diver.
    """

    words: tuple[tuple[str, float], ...]
    expected: str

    def to_dict(self) -> dict[str, Any]:
        return {"words": [list(word) for word in self.words], "expected": self.expected}


@dataclass(frozen=True, slots=True, kw_only=True)
class Word:
    """A sign was held long enough and has its place in the sentence.

    state: the sentence so far, this word included; "idle" after the word that closes a sentence.
    confidence: 0 to 1, mean over the hold of the lower of both hands' confidences.
    """

    type: Literal["word"] = field(default="word", init=False)
    source: str | None
    frame: int
    time_s: float
    utc: str | None = None
    pair: Shown
    word: str
    state: str
    confidence: float

    def to_dict(self) -> dict[str, Any]:
        return _record(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class Instruction:
    """A complete sentence, from its start word to its end word, that makes sense.

    Only the kinds "kill" and "menu", where a grammar file asks for them, have no such frame.

    start_frame, start_time_s: first frame of the hold that accepted the start word.
    text: the sentence with digits joined; words: the words as signed.
    kind: the form's kind. action: first word after the start word. change: second one, if any.
    duration_s: seconds. program, parameter: numbers that the grammar lists; of the menu the program is the entry.
    What a sentence may say several times, as between REPEAT and END, is only in the words.
    confidence: 0 to 1, the lowest of the words' confidences, for a sentence is as sure as its weakest
    sign, however long it is.
    """

    type: Literal["instruction"] = field(default="instruction", init=False)
    source: str | None
    frame: int
    time_s: float
    utc: str | None = None
    start_frame: int
    start_time_s: float
    text: str
    kind: str
    action: str
    duration_s: int | None
    program: int | None
    parameter: int | None
    change: str | None
    confidence: float
    words: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        return _record(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class Rejected:
    """A sentence was dropped.

    reason: "out_of_order", "unknown_program", "unknown_parameter", "limit", "timeout", "cancelled", "unread_sign" or
    "unconfirmed"; by the rule "sentence" also "ambiguous", "weak_sign", "passed_over" or "does_not_fit".
    text: the sentence as far as it went, with the word that broke it. detail: why, for the diver.
    """

    type: Literal["rejected"] = field(default="rejected", init=False)
    source: str | None
    frame: int
    time_s: float
    utc: str | None = None
    reason: str
    text: str
    detail: str

    def to_dict(self) -> dict[str, Any]:
        return _record(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """For displays: `sentence` has the words so far, `dwell` the hold that is growing.

    state: "idle", "collecting", or "confirming" while a complete sentence waits for its second end word. certainty:
    how sure the words are; None, and no part of the record, where the rule does not tell.
    """

    type: Literal["state"] = field(default="state", init=False)
    source: str | None
    frame: int
    time_s: float
    utc: str | None = None
    state: str
    sentence: str
    dwell: Growth | None
    certainty: Certainty | None = None

    def to_dict(self) -> dict[str, Any]:
        record = _record(self)
        if self.certainty is None:
            del record["certainty"]
        return record


@dataclass(frozen=True, slots=True, kw_only=True)
class Notice:
    """A sign that changed nothing.

    reason: "unknown_pair" (held, but no word: repeat it), "two_cards" (two words at once: show one), "out_of_order" (a
    word that opens no sentence while none is open), "confirm" (the end word is wanted again), "repeat" (the last sign
    was seen too badly: show it again) or "gap" (frames are missing or show nothing; an open sentence was dropped).
    """

    type: Literal["notice"] = field(default="notice", init=False)
    source: str | None
    frame: int
    time_s: float
    utc: str | None = None
    reason: str
    detail: str

    def to_dict(self) -> dict[str, Any]:
        return _record(self)


Event = Word | Instruction | Rejected | State | Notice
