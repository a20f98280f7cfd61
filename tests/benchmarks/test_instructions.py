"""The count of instructions: what is compared with what, and what is said where nothing can be counted."""

import json

import numpy as np
import pytest

from lightgesture.benchmarks import instructions
from lightgesture.benchmarks.instructions import BASELINE, PARTS, compare, read_total, versions, write_frames

USED = {"python": "3.11", "numpy": "2"}


def known(thousands, used=USED):
    return {"versions": used, "thousands": {"followed": thousands}}


@pytest.mark.parametrize(
    ("before", "keeps"),
    [
        (known(1000), True),
        (known(960), True),
        (known(940), False),
        (known(2000), True),
        # With other libraries more is allowed, and without a baseline all is.
        (known(800, {"numpy": "1"}), True),
        (known(700, {"numpy": "1"}), False),
        (None, True),
    ],
)
def test_a_count_keeps_to_the_baseline_or_not(before, keeps):
    table, is_kept = compare({"followed": 1000}, before, USED, 0.05)
    assert is_kept is keeps
    assert table.rows[0]["thousands"] == 1000
    assert ("no baseline" in table.note) is (before is None)


def test_the_sum_of_a_file_is_read_and_a_file_without_one_refused(tmp_path):
    path = tmp_path / "counts.1"
    path.write_text("version: 1\nevents: Ir\nfn=(1)\n1 4\nsummary: 1234567\n")
    assert read_total(path) == 1234567
    path.write_text("version: 1\n")
    with pytest.raises(instructions.InputError, match="summary"):
        read_total(path)


def test_the_kept_baseline_counts_what_the_command_counts():
    for kind, content in json.loads(BASELINE.read_text()).items():
        assert kind.split("-")[0] in ("x86_64", "aarch64")
        assert set(content["versions"]) == set(versions())
        assert set(content["thousands"]) == set(PARTS)
        assert content["thousands"]["followed"] < content["thousands"]["searched"]


def test_without_valgrind_nothing_is_counted_and_nothing_fails(monkeypatch, capsys):
    monkeypatch.setattr(instructions.shutil, "which", lambda name: None)
    assert instructions.main([]) == 0
    out, err = capsys.readouterr()
    assert out == ""
    assert "valgrind is not installed" in err


def test_more_than_before_fails_and_can_be_accepted(monkeypatch, capsys, tmp_path):
    path = tmp_path / "instructions.json"
    monkeypatch.setattr(instructions, "BASELINE", path)
    monkeypatch.setattr(instructions.shutil, "which", lambda name: f"/usr/bin/{name}")
    counts = {"searched": 3000, "followed": 1000}
    monkeypatch.setattr(instructions, "count", lambda folder: counts)
    assert instructions.main(["--write"]) == 0
    assert instructions.main([]) == 0
    counts["followed"] = 1200
    assert instructions.main([]) == 1
    assert "more instructions than before" in capsys.readouterr().err
    assert instructions.main(["--tolerance", "0.25"]) == 0


def test_the_frames_of_the_run_are_of_one_size(tmp_path):
    write_frames(tmp_path / "frames.npy")
    frames = np.load(tmp_path / "frames.npy")
    assert frames.shape == (instructions.WARM_UP + instructions.FOLLOWED, 480, 640, 3)
