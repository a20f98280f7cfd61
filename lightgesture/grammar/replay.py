"""Why a recorded sentence was issued or not: its frames through the rule "sentence" once more, with its readings."""

import json
from collections.abc import Iterator
from typing import Any

from lightgesture.errors import UsageError
from lightgesture.fsm import UNSEEN, Decoder, Grammar, Sign, Signs
from lightgesture.grammar.report import tell

MOST_READINGS = 3
"""Readings that are told of each sentence."""


def explain_records(grammar: Grammar, path: str) -> list[str]:
    """What the rule "sentence" makes of recorded frames: every event, and at each verdict the readings that led.

    path: JSON Lines with frame records that have `probabilities`. UsageError: it cannot be read or has none.
    """
    decoder = Decoder(grammar, rule="sentence")
    lines: list[str] = []
    count = 0
    for record in _frames(path):
        count += 1
        events = decoder.step(_signs(record), record["time_s"], record["frame"])
        lines += [f"{record['time_s']:.2f} s  {text}" for text in tell(events)]
        if any(event.type in ("instruction", "rejected") for event in events):
            lines += _readings(decoder)
    if not count:
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


def _frames(path: str) -> Iterator[dict[str, Any]]:
    """The frame records of a file whose hands all have probabilities."""
    try:
        with open(path, encoding="utf-8") as stream:
            for number, line in enumerate(stream, 1):
                try:
                    record = json.loads(line)
                    if record["type"] == "frame" and _is_whole(record):
                        yield record
                except (ValueError, KeyError, TypeError) as error:
                    raise UsageError(
                        f"{path}: line {number} is no record ({error}); record it again"
                    ) from None
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise UsageError(f"{path}: cannot be read ({reason}); name a file of records") from None


def _is_whole(record: dict[str, Any]) -> bool:
    is_whole = all("probabilities" in hand for hand in record.get("hands", ()))
    return record["time_s"] is not None and is_whole


def _signs(record: dict[str, Any]) -> Signs:
    """The signs of the hands, or of the cards, of a record."""
    if "signs" in record:
        words = [card["word"] for card in record["signs"] if card["word"] is not None]
        return Signs(*(Sign(word, is_word=True) for word in dict.fromkeys(words[:2])))
    signs = {
        hand["side"]: Sign(hand["token"], hand["confidence"], hand["probabilities"], True, hand["reason"])
        for hand in record["hands"]
    }
    return Signs(signs.get("left", UNSEEN), signs.get("right", UNSEEN))
