"""The soak: what it calls flat, what it calls the same, and a minute of it."""

from itertools import pairwise

import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.soak import __main__ as soak
from lightgesture.benchmarks.soak.decode_part import write_rounds
from lightgesture.benchmarks.soak.pieces import of_records, unlike
from lightgesture.benchmarks.soak.sampling import Sample, parts, save, wrong
from lightgesture.benchmarks.soak.stream import RoundStream
from lightgesture.sources import open_source


def samples(**last):
    """A hundred looks, a second and 200 frames apart; last: what the last ten have otherwise."""
    usual = {"memory_mib": 150.0, "handles": 12, "threads": 11}
    found = []
    for second in range(100):
        fields = {"wall_s": float(second), "processor_s": second * 0.5, "frames": second * 200, **usual}
        found.append(Sample(**{**fields, **(last if second >= 90 else {})}))
    return found


def test_what_is_flat():
    rows = parts(samples())
    assert wrong("live", rows) == []
    assert (rows[0]["memory_mib"], rows[-1]["handles"], rows[-1]["frames"]) == (150.0, 12, 19800)
    assert (rows[1]["a_second"], rows[1]["a_processor_second"]) == (200.0, 400.0)


@pytest.mark.parametrize(
    ("last", "told"),
    [
        ({"memory_mib": 157.0}, "live: memory_mib went from 150 to 157"),
        ({"handles": 13}, "live: handles went from 12 to 13"),
        ({"threads": 12}, "live: threads went from 11 to 12"),
    ],
)
def test_what_grows_is_told(last, told):
    assert wrong("live", parts(samples(**last))) == [told]


def test_what_gets_slower_is_told():
    found = samples()
    slow = [
        Sample(one.wall_s, 150.0, 12, 11, one.processor_s + max(0, place - 89) * 0.2, one.frames)
        for place, one in enumerate(found)
    ]
    (told,) = wrong("live", parts(slow))
    assert told.startswith("live: a_processor_second went from 400 to ")


def test_samples_are_kept_where_a_folder_is_named(tmp_path):
    save(samples(), "live", None)
    save(samples(), "live", tmp_path / "kept")
    lines = (tmp_path / "kept" / "live.csv").read_text().splitlines()
    assert lines[0] == "wall_s,memory_mib,handles,threads,processor_s,frames"
    assert len(lines) == 101


def test_verdicts_that_are_the_same_and_that_are_not():
    records = [
        {"type": "instruction", "text": "STOP UP GO", "start_frame": 10, "frame": 90},
        {"type": "state", "frame": 91},
        {"type": "rejected", "reason": "timeout", "text": "STOP", "frame": 200},
    ]
    expected = [("STOP UP GO", 10, 90), ("timeout: STOP", 200, 200)]
    assert of_records(records) == expected
    assert unlike("live", [("STOP UP GO", 11, 91), expected[1]], expected) == []
    assert unlike("live", [("STOP DOWN GO", 10, 90), expected[1]], expected)
    assert unlike("live", [("STOP UP GO", 10, 190), expected[1]], expected)
    assert unlike("live", expected[:1], expected) == ["live: 1 verdicts and not 2"]


def test_the_next_picture_comes_when_the_last_was_decoded():
    stream = RoundStream([b"one", b"two"], 5)
    found = []
    for picture in stream:
        found.append((picture, stream.clock()))
        stream.show(None, [])  # a record without a picture lets nothing come
        stream.show(object(), [])
    assert [picture for picture, _ in found] == [b"one", b"two", b"one", b"two", b"one"]
    assert [time_s for _, time_s in found] == [0.0, 0.033333, 0.066667, 0.1, 0.133333]


def test_a_video_of_rounds_goes_on_without_a_seam(tmp_path):
    write_rounds(SAMPLE, tmp_path / "rounds.mp4", 2)
    with open_source(str(SAMPLE)) as source:
        once = [frame.time_s for frame in source]
    with open_source(str(tmp_path / "rounds.mp4")) as source:
        twice = [(frame.time_s, frame.gap) for frame in source]
    assert len(twice) == 2 * len(once)
    steps = [later - earlier for (earlier, _), (later, _) in pairwise(twice)]
    assert steps == pytest.approx([1 / 30] * len(steps), abs=0.002)
    assert all(gap is None for _, gap in twice)


@pytest.mark.slow
def test_a_minute_of_it(capsys, tmp_path):
    """Too short to be flat, since buffers grow at the start; but what comes out is right."""
    soak.main(["--hours", "0.017", "--every", "0.5", "--samples", str(tmp_path)])
    lines = capsys.readouterr().out.splitlines()
    told = [line for line in lines if line.startswith(("live: ", "decode: ", "round_"))]
    assert [line for line in told if "memory_mib" not in line and "a_processor_second" not in line] == []
    assert {path.name for path in tmp_path.iterdir()} == {"live.csv", "decode.csv"}
