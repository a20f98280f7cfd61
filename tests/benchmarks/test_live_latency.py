"""The age of frames: what is counted, and one short run of the whole."""

import os

import pytest

from lightgesture.benchmarks import live_latency
from lightgesture.benchmarks.live_latency import Run, memory_mib, table, take
from lightgesture.benchmarks.mjpeg_server import main as serve
from lightgesture.errors import ExitStatus


def feed(run, *records, now_s=10.0, is_counted=True):
    for record in records:
        take(record, now_s, {0: 9.9, 1: 9.95, 2: 9.96}, run, is_counted)


def frame(index):
    return {"type": "frame", "frame": index}


def beat(spent_ms, dropped=0):
    return {"type": "heartbeat", "ms_per_frame": spent_ms, "dropped": dropped}


def test_an_age_goes_with_the_processing_of_its_own_frame():
    run = Run()
    feed(run, frame(0), beat(30.0), beat(0.0), frame(1), frame(2), beat(5.0, dropped=4), {"type": "word"})
    assert run.ages_ms == pytest.approx([100.0, 50.0, 40.0])
    assert len(run.pairs_ms) == 1
    assert run.pairs_ms[0] == pytest.approx((100.0, 30.0))
    assert run.dropped == 4


def test_the_warm_up_does_not_count():
    run = Run()
    feed(run, frame(0), beat(30.0), is_counted=False)
    assert (run.ages_ms, run.pairs_ms) == ([], [])


def test_the_bound_is_that_of_each_frame():
    run = Run(ages_ms=[50.0, 60.0, 90.0, 40.0], memory_mib=[100.0, 101.0], dropped=7)
    run.pairs_ms = [(50.0, 20.0), (60.0, 20.0), (90.0, 60.0), (40.0, 5.0)]
    values = {row["what"]: row["value"] for row in table(run, 60.0).rows}
    assert values["age within two frame times and processing, % of frames"] == 50.0
    assert (values["frames decoded"], values["frames passed over"]) == (4, 7)
    assert values["age, most ms"] == 90.0
    assert values["age beyond processing, median ms"] == pytest.approx(32.5)


def test_memory_of_this_process():
    assert 20 < memory_mib(os.getpid()) < 20_000


def test_a_clip_that_is_none(capsys, tmp_path):
    missing = str(tmp_path / "none.mp4")
    assert live_latency.main([missing]) == serve([missing]) == ExitStatus.SOME_FAILED
    assert capsys.readouterr().err.count("no such file or folder; check the name") == 2


@pytest.mark.slow
def test_a_short_run(capsys):
    assert live_latency.main(["--fps", "20", "--seconds", "2"]) == ExitStatus.OK
    assert "age, median ms" in capsys.readouterr().out
