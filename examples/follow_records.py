"""A program of one's own behind `live`: `lightgesture live 0 --json | python examples/follow_records.py`.

Reads one JSON object a line and calls a function for each kind of instruction. What is not known here is told and not
done: a wrong instruction moves a vehicle near a person.
"""

import json
import sys
from collections.abc import Callable, Iterable
from typing import Any

LEAST_CONFIDENCE = 0.9
"""Of an instruction that is carried out, 0 to 1."""


def hover(record: dict[str, Any]) -> str:
    """Stay where the vehicle is."""
    duration_s = record["duration_s"]
    return "hover" if duration_s is None else f"hover for {duration_s} s"


def take_picture(record: dict[str, Any]) -> str:  # noqa: ARG001 - one shape for all actions
    """Store the camera's picture."""
    return "take a picture"


ACTIONS: dict[str, Callable[[dict[str, Any]], str]] = {"HOVER": hover, "SNAP": take_picture}
"""Action of an instruction to what does it."""


def follow(lines: Iterable[str]) -> list[str]:
    """What is done for the records, in words."""
    done = []
    for line in lines:
        record = json.loads(line)
        if record["type"] != "instruction":
            continue
        action = ACTIONS.get(record["action"])
        if action is None:
            done.append(f"not done: {record['text']} has no action here")
        elif record["confidence"] < LEAST_CONFIDENCE:
            done.append(f"not done: {record['text']} is not sure enough, {record['confidence']:.2f}")
        else:
            done.append(action(record))
        print(done[-1], flush=True)
    return done


if __name__ == "__main__":
    follow(sys.stdin)
