"""Why a recorded sentence was issued or not: its frames through the rule "sentence" once more, with its readings."""

import json
from collections.abc import Iterator
from itertools import count
from typing import Annotated, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from lightgesture.errors import UsageError
from lightgesture.fsm import UNSEEN, Decoder, Grammar, Sign, Signs
from lightgesture.grammar.report import tell

MOST_READINGS = 3
"""Readings that are told of each sentence."""

LONGEST_LINE: Final = 1 << 20
"""Characters of a record; a longer line is cut there and refused."""

Share = Annotated[float, Field(ge=0.0, le=1.0)]


class _Record(BaseModel):
    """What is looked at of a record; it may have more."""

    model_config = ConfigDict(strict=True, frozen=True)


class _Hand(_Record):
    side: Literal["left", "right"]
    token: str | None
    confidence: Share
    probabilities: dict[str, Share]
    reason: str | None


class _Card(_Record):
    word: str | None


class _Frame(_Record):
    frame: int
    time_s: float
    hands: list[_Hand] = Field(default_factory=list)
    signs: list[_Card] | None = None


def explain_records(grammar: Grammar, path: str) -> list[str]:
    """What the rule "sentence" makes of recorded frames: every event, and at each verdict the readings that led.

    path: JSON Lines with frame records that have `probabilities`. UsageError: it cannot be read or has none.
    """
    decoder = Decoder(grammar, rule="sentence")
    lines: list[str] = []
    frames = 0
    for record in _frames(path):
        frames += 1
        events = decoder.step(_signs(record), record.time_s, record.frame)
        lines += [f"{record.time_s:.2f} s  {text}" for text in tell(events)]
        if any(event.type in ("instruction", "rejected") for event in events):
            lines += _readings(decoder)
    if not frames:
        raise UsageError(
            f"{path}: no frame record with probabilities; record some: decode VIDEO --frames --json"
        )
    lines += [f"end     {text}" for text in tell(decoder.finish())]
    return lines


def _readings(decoder: Decoder) -> Iterator[str]:
    for reading in decoder.readings[:MOST_READINGS]:
        words = ", ".join(f"{word} {sure:.2f}" for word, sure in reading.words)
        yield (
            f"          {reading.behind:5.1f} behind: {words}; passed over {reading.longest_s:.2f} s; "
            f"misfit {reading.misfit:.1f} at {reading.misfit_at}"
        )


def _frames(path: str) -> Iterator[_Frame]:
    """The frame records of a file whose hands all have probabilities."""
    try:
        with open(path, encoding="utf-8") as stream:
            for number in count(1):
                line = stream.readline(LONGEST_LINE)
                if not line:
                    return
                frame = _frame(line, f"{path}: line {number}")
                if frame is not None:
                    yield frame
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise UsageError(f"{path}: cannot be read ({reason}); name a file of records") from None


def _frame(line: str, place: str) -> _Frame | None:
    """A line as a frame; None: it is another record, or one that nothing can be told of."""
    try:
        record = json.loads(line)
        if record["type"] != "frame" or record["time_s"] is None:
            return None
        if not all("probabilities" in hand for hand in record.get("hands", ())):
            return None
        return _Frame.model_validate(record)
    except ValidationError as error:
        detail = error.errors(include_url=False)[0]
        reason = f"{'.'.join(map(str, detail['loc']))}: {detail['msg']}"
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        reason = str(error)
    raise UsageError(f"{place} is no record ({' '.join(reason.split())[:200]}); record it again")


def _signs(record: _Frame) -> Signs:
    """The signs of the hands, or of the cards, of a record."""
    if record.signs is not None:
        words = [card.word for card in record.signs if card.word is not None]
        return Signs(*(Sign(word, is_word=True) for word in dict.fromkeys(words[:2])))
    signs = {
        hand.side: Sign(hand.token, hand.confidence, hand.probabilities, True, hand.reason)
        for hand in record.hands
    }
    return Signs(signs.get("left", UNSEEN), signs.get("right", UNSEEN))
