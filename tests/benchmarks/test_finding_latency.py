"""What finding costs: searching and following apart, each run-time, and a fresh start."""

import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.finding import latency as finding_latency
from lightgesture.benchmarks.finding.latency import (
    FOLLOWED,
    LITERT,
    PARTS,
    SEARCHED,
    Engine,
    engines,
    finding_times,
    fresh_start,
    fresh_starts,
    open_stage,
    time_finding,
    without_litert,
)
from lightgesture.features.colour import ColourStage
from lightgesture.features.find.selector_file import load_learned
from lightgesture.features.net.runner import Network
from lightgesture.sources import open_source

ROUNDS = 2


@pytest.fixture(name="frames", scope="module")
def _frames():
    """Frames of the bundled clip in which both hands are up."""
    with open_source(SAMPLE) as source:
        return [frame.image for frame, _ in zip(source, range(40), strict=False)][20:]


def test_searching_and_following_are_told_apart(frames):
    rows = {row["stage"]: row for row in time_finding(frames, Engine("learned"), ROUNDS)}
    stages = [f"{part}, {word}" for word in ("searched", "followed") for part in PARTS]
    assert set(rows) == {SEARCHED, FOLLOWED, *stages}
    assert rows[SEARCHED]["share"] + rows[FOLLOWED]["share"] == pytest.approx(1.0)
    assert rows[FOLLOWED]["share"] > 0.5
    assert rows["regions, followed"]["median_ms"] < rows["regions, searched"]["median_ms"]
    assert all(0.0 < row["median_ms"] <= row["p95_ms"] for row in rows.values())


def test_the_classical_choice_searches_every_frame(frames):
    rows = time_finding(frames[:4], Engine("classical", is_plain=True), ROUNDS)
    assert [row["stage"] for row in rows] == [SEARCHED, *(f"{part}, searched" for part in PARTS)]
    assert {(row["selector"], row["nets"], row["share"]) for row in rows} == {("classical", "NumPy", 1.0)}


def test_without_the_run_time_the_nets_run_by_numpy():
    before = {name for name in sys.modules if name.startswith(LITERT)}
    network = load_learned().locator
    with without_litert():
        assert Network(network).backend == "numpy"
    assert {name for name in sys.modules if name.startswith(LITERT)} == before
    pytest.importorskip(LITERT)
    assert Network(network).backend == "litert"


def test_both_run_times_find_the_same(frames):
    pytest.importorskip(LITERT)
    colour = ColourStage().process(frames[0])
    found = [open_stage(Engine("learned", plain)).process(colour) for plain in (False, True)]
    first, second = ([region.box for region in one.regions] for one in found)
    assert len(first) >= 2
    assert np.array(first[:2]) == pytest.approx(np.array(second[:2]), abs=3)


def test_what_is_not_installed_is_not_timed(monkeypatch):
    monkeypatch.setattr(finding_latency, "find_spec", lambda _: None)
    plain = [("learned", "NumPy"), ("classical", "NumPy")]
    assert [(engine.selector, engine.name) for engine in engines()] == plain
    monkeypatch.setattr(finding_latency, "find_spec", lambda _: object())
    assert [(engine.selector, engine.name) for engine in engines()] == [
        ("learned", "LiteRT"),
        plain[0],
        ("classical", "numba"),
        plain[1],
    ]


def test_compiled_and_plain_loops_find_the_same(frames):
    colour = ColourStage().process(frames[0])
    first, second = (
        open_stage(Engine("classical", plain)).process(colour).regions for plain in (False, True)
    )
    assert len(first) >= 2
    assert [region.box for region in first] == [region.box for region in second]


def test_a_row_for_each_clip_and_engine(monkeypatch, frames):
    monkeypatch.setattr(
        finding_latency, "engines", lambda: [Engine("learned"), Engine("classical", is_plain=True)]
    )
    table = finding_times({"a": frames[:2], "b": frames[:2]}, 1)
    names = [(row["clip"], row["selector"]) for row in table.to_dicts()]
    changes = [first for first, second in pairwise([*names, None]) if first != second]
    assert changes == [("a", "learned"), ("a", "classical"), ("b", "learned"), ("b", "classical")]


def test_a_fresh_start_takes_time_and_memory():
    seconds, peak = fresh_start(Engine("learned", is_plain=True))
    assert 0.05 < seconds < 60.0
    assert peak is None or 20.0 < peak < 1000.0


def test_starts_are_summed_up(monkeypatch):
    answers = iter([(3.0, 10.0), (1.0, None), (2.0, 30.0), (9.0, 20.0), (0.5, 20.0)] * 4)
    monkeypatch.setattr(finding_latency, "fresh_start", lambda *_: next(answers))
    rows = fresh_starts().to_dicts()
    assert {(row["starts"], row["seconds"], row["peak_mb"]) for row in rows} == {(5, 2.0, 20.0)}


def test_a_start_that_fails_is_no_time():
    with pytest.raises(subprocess.CalledProcessError):
        fresh_start(Engine("nothing"))
