"""The seconds of a training are those of all its runs, or unknown."""

import json

import pytest

from lightgesture.training.nets.checkpoints import checkpoint_folder
from lightgesture.training.nets.spent_time import FILE, SpentTime


def spent(folder, *moments):
    return SpentTime(folder, iter(moments).__next__)


@pytest.fixture
def folder(tmp_path):
    return checkpoint_folder(tmp_path / "selector.npz", {"seed": 0})


def test_a_run_that_goes_on_adds_its_seconds(folder):
    with pytest.raises(KeyboardInterrupt), spent(folder, 100.0, 130.0):
        raise KeyboardInterrupt
    (folder / "locator.pt").write_bytes(b"")
    assert spent(folder, 1000.0, 1007.0).seconds == 37.0


def test_a_run_that_is_killed_has_kept_them_at_its_last_message(folder):
    told = []
    spent(folder, 0.0, 12.0).kept_by(told.append)("composing pictures")
    assert told == ["composing pictures"]
    assert spent(folder, 50.0, 50.0).seconds == 12.0


def test_those_of_a_folder_of_before_are_unknown_for_good(folder):
    (folder / "composed.npy").write_bytes(b"")
    with spent(folder, 0.0) as unknown:
        assert unknown.seconds is None
    assert json.loads((folder / FILE).read_text(encoding="utf-8")) is None
    assert spent(folder, 0.0).seconds is None
