"""Records that tests of several rooms need."""

from lightgesture.fsm import Instruction


def hover(**changes):
    """The record of `STOP HOVER 50 GO` with other values of some fields."""
    fields = {
        "source": "a.mp4",
        "frame": 131,
        "time_s": 4.37,
        "start_frame": 4,
        "start_time_s": 0.13,
        "text": "STOP HOVER 50 GO",
        "kind": "task",
        "action": "HOVER",
        "duration_s": 50,
        "program": None,
        "parameter": None,
        "change": None,
        "confidence": 0.95,
        "words": ("STOP", "HOVER", "5", "AND", "0", "GO"),
    }
    return Instruction(**{**fields, **changes})
