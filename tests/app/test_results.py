"""Writers, names of output files, words for people."""

import json

import pytest

from lightgesture.errors import UsageError
from lightgesture.fsm import Notice, State, Word
from lightgesture.records import SummaryRecord
from lightgesture.results import WRITERS, describe, open_writer, output_stems, to_json_line
from lightgesture.results.atomic import replacing


def notice(source, detail="3,left is no word"):
    return Notice(source=source, frame=150, time_s=5.0, reason="unknown_pair", detail=detail)


READERS = {".jsonl": lambda path: [json.loads(line) for line in path.read_text("utf-8").splitlines()]}


@pytest.mark.parametrize("suffix", WRITERS)
def test_round_trip(tmp_path, suffix):
    path = tmp_path / "new" / f"ö{suffix}"
    written = [notice("a.mp4"), notice('två "dykare"\n.mp4', detail="ダ"), notice("\udcff")]
    with open_writer(path) as writer:
        for record in written:
            writer.write(record)
        assert not path.exists()
    assert READERS[suffix](path) == [record.to_dict() for record in written]


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_nothing_half_written(tmp_path, suffix, error):
    path = tmp_path / f"a{suffix}"
    path.write_text("as it was")

    def fail():
        with open_writer(path) as writer:
            writer.write(notice("a.mp4"))
            raise error

    with pytest.raises(error):
        fail()
    assert [each.name for each in tmp_path.iterdir()] == [path.name]
    assert path.read_text() == "as it was"


def test_suffix_without_a_writer(tmp_path):
    with pytest.raises(ValueError, match=r"no writer for '\.doc'; known are \.jsonl"):
        open_writer(tmp_path / "a.doc")


def test_place_that_cannot_be_written(tmp_path):
    (tmp_path / "file").touch()
    with (
        pytest.raises(UsageError, match="cannot be written"),
        replacing(tmp_path / "file" / "a") as temporary,
    ):
        temporary.write_bytes(b"")


def test_long_names_can_be_written(tmp_path):
    path = tmp_path / ("ö" * 124 + ".jsonl")
    with open_writer(path) as writer:
        writer.write(notice("a"))
    assert path.exists()


def test_json_line_in_a_narrow_encoding():
    assert '"type":"notice","source":"ö"' in to_json_line(notice("ö"))
    assert to_json_line(notice("ö"), "ascii").isascii()
    assert json.loads(to_json_line(notice("ö"), "ascii"))["source"] == "ö"


@pytest.mark.parametrize(
    ("inputs", "stems"),
    [
        (["a/dive.mp4", "reef.avi"], ["dive", "reef"]),
        (["a/dive.mp4", "b/dive.mp4"], ["a_dive.mp4", "b_dive.mp4"]),
        (["dives/a.mp4", "dives/a.avi", "c.avi"], ["dives_a.mp4", "dives_a.avi", "c"]),
        (["x/a/d.mp4", "y/a/d.mp4"], ["x_a_d.mp4", "y_a_d.mp4"]),
        (["a/Dive.mp4", "b/dive.mp4"], ["a_Dive.mp4", "b_dive.mp4"]),
        (["a/d.mp4", "b/d.mp4", "a_d.mp4.mov"], ["x_a_d.mp4", "b_d.mp4", "x_a_d.mp4.mov"]),
        (["a/b_d.mp4", "a_b/d.mp4", "b_d.avi"], ["a_b_d.mp4", "d", "x_b_d.avi"]),
        ([], []),
    ],
)
def test_stems(tmp_path, monkeypatch, inputs, stems):
    (tmp_path / "x").mkdir()
    monkeypatch.chdir(tmp_path / "x")
    assert output_stems(inputs) == stems


def test_stems_that_nothing_tells_apart_get_a_number():
    assert output_stems(["/A/d.mp4", "/a/d.mp4"]) == ["A_d.mp4", "a_d.mp4-2"]
    assert output_stems(["/a/b_c.x", "/a_b/c.x", "/c.x"]) == ["b_c", "a_b_c.x", "c.x"]


def test_stem_of_a_folder_is_its_whole_name(tmp_path, monkeypatch):
    folder = tmp_path / "dive v1.2"
    folder.mkdir()
    assert output_stems([str(folder)]) == ["dive v1.2"]
    monkeypatch.chdir(folder)
    assert output_stems(["."]) == ["dive v1.2"]
    assert output_stems(["/"]) == ["input"]


def test_words_and_states_are_not_for_people():
    word = Word(source="a", frame=1, time_s=0.1, pair=("5", "5"), word="HOVER", state="idle", confidence=1.0)
    state = State(source="a", frame=1, time_s=0.1, state="idle", sentence="", dwell=None)
    assert describe(word) is None
    assert describe(state) is None


def test_summary_without_times():
    summary = SummaryRecord(
        source="a",
        frames=1,
        seconds=0.0,
        instructions=2,
        rejected=0,
        status="failed",
        ms_per_frame={},
        stages_ms={},
    )
    assert describe(summary) == "  2 instructions, 0 rejected; 1 frame in 0.00 s; failed"
