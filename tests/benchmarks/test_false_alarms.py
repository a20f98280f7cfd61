"""What is counted where nobody signs."""

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks import false_alarms
from lightgesture.benchmarks.false_alarms import FPS, STILL_FRAMES, Seen, Stream, count, going_on, still
from lightgesture.fsm import Sign, Signs
from lightgesture.pipeline import Pipeline
from lightgesture.records import Hand


def hand(token, track, reason=None):
    return Hand(side="left", token=token, confidence=0.9, box=(0, 0, 9, 9), track=track, reason=reason)


def shown(left, right, frames):
    signs = Signs(*(Sign(token, 0.97, {token: 0.97}) for token in (left, right)))
    return (Seen(signs, (hand(left, 1), hand(None, 2, "partial"))),) * frames


NOTHING = (Seen(Signs(), ()),) * 8


@pytest.mark.parametrize("rule", false_alarms.RULES)
def test_words_hands_and_reasons_are_counted(rule):
    """STOP, HOVER and GO, each of them for a second, as nothing that is no signing should."""
    piece = shown("ok", "0", 30) + NOTHING + shown("5", "5", 30) + NOTHING + shown("ok", "ok", 30)
    row, reasons = count(Pipeline(rule=rule), Stream((piece, NOTHING * 4)))
    minutes = (len(piece) + len(NOTHING) * 4) / FPS / 60
    assert (row["words"], row["instructions"]) == (3, 1)
    assert row["minutes"] == round(minutes, 1)
    assert row["hands_a_minute"] == round(2 / minutes, 2)
    assert row["hands_read_a_minute"] == round(1 / minutes, 2)
    assert reasons["hand: partial"] == 90


def test_a_still_is_shown_for_a_second(tmp_path):
    path = tmp_path / "still.png"
    cv2.imwrite(str(path), np.random.default_rng(1).integers(0, 255, (120, 160, 3), np.uint8))
    assert len(still(Pipeline(), path)) == STILL_FRAMES


def test_clips_follow_each_other_until_the_time_is_over():
    stream = going_on([NOTHING, NOTHING * 2], hours=0.01)
    assert 0.01 * 3600 * FPS <= sum(map(len, stream.pieces)) < 0.01 * 3600 * FPS + 16
    assert stream.pieces == going_on([NOTHING, NOTHING * 2], hours=0.01).pieces


def test_an_instruction_is_a_failure(monkeypatch, capsys):
    rows = ({"what": "x", "rule": "frames", "instructions": 1},)
    tables = [false_alarms.Table("false_alarms", "x", ("what", "rule", "instructions"), rows)]
    monkeypatch.setattr(false_alarms, "measure", lambda data, hours: tables)
    assert false_alarms.main(["--rendered-only"]) == 1
    assert "frames" in capsys.readouterr().out


def test_a_data_folder_that_is_not_there(capsys):
    assert false_alarms.main(["--data", "/no/such/folder"]) == 1
    assert "no such folder" in capsys.readouterr().err
