"""Records to send."""

import pytest

from lightgesture.fsm import Instruction
from lightgesture.records import HeartbeatRecord


@pytest.fixture
def instruction():
    """Makes an instruction; the keywords change its fields."""

    def make(**changes):
        fields = {
            "source": "cam",
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

    return make


@pytest.fixture
def heartbeat():
    """Makes a heartbeat with a number that tells it from others."""

    def make(frames=0):
        return HeartbeatRecord(
            source="cam", time_s=1.0, frames=frames, dropped=0, ms_per_frame=0.8, state="idle"
        )

    return make
