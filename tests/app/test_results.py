"""Writers, names of output files, words for people."""

import csv
import json
import os
import stat

import pytest
import webvtt

from lightgesture.errors import UsageError
from lightgesture.fsm import Notice, Rejected, State, Word
from lightgesture.records import SummaryRecord
from lightgesture.results import WRITERS, describe, open_writer, output_stems, to_json_line
from lightgesture.results.atomic import replacing, replacing_folder
from lightgesture.results.spreadsheet import COLUMNS
from tests.makers import hover


def notice(source, detail="3,left is no word"):
    return Notice(source=source, frame=150, time_s=5.0, reason="unknown_pair", detail=detail)


def rejected(time_s, text="STOP EXEC 5 GO", detail="no program 5", source="a.mp4"):
    return Rejected(source=source, frame=1, time_s=time_s, reason="limit", text=text, detail=detail)


def instruction(time_s, text="STOP HOVER 50 GO", source="a.mp4"):
    return hover(source=source, time_s=time_s, text=text)


def write(path, records, name="a.mp4"):
    with open_writer(path, name) as writer:
        for record in records:
            writer.write(record)
        assert not path.exists()
    return path


def read_csv(path):
    with open(path, encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_json_round_trip(tmp_path):
    written = [notice("a.mp4"), notice('två "dykare"\n.mp4', detail="ダ"), notice("\udcff")]
    path = write(tmp_path / "new" / "ö.jsonl", written)
    lines = path.read_text("utf-8").splitlines()
    assert [json.loads(line) for line in lines] == [record.to_dict() for record in written]


def test_spreadsheet(tmp_path):
    rows = read_csv(write(tmp_path / "a.csv", [notice("a"), instruction(4.37), rejected(5.0)]))
    assert [row["type"] for row in rows] == ["instruction", "rejected"]
    assert list(rows[0]) == list(COLUMNS)
    assert (rows[0]["text"], rows[0]["words"]) == ("STOP HOVER 50 GO", "STOP HOVER 5 AND 0 GO")
    assert (rows[0]["duration_s"], rows[0]["program"], rows[1]["kind"]) == ("50", "", "")
    assert set(instruction(1.0).to_dict()) | set(rejected(1.0).to_dict()) == set(COLUMNS)


def test_spreadsheet_without_a_record_has_its_names(tmp_path):
    assert write(tmp_path / "a.csv", []).read_text() == ",".join(COLUMNS) + "\n"


@pytest.mark.parametrize(
    "source", ['=HYPERLINK("http://x","y").mp4', "+1.mp4", "-1", "@SUM(1)", "\t=1", "\uff1d1"]
)
def test_spreadsheet_runs_no_formula(tmp_path, source):
    records = [instruction(-1.5, source=source), rejected(1.0, source="a\n,b\udcff", detail="=1")]
    first, second = read_csv(write(tmp_path / "a.csv", records))
    assert first["source"] == "'" + source
    assert first["time_s"] == "-1.5", "a number stays a number"
    assert (second["source"], second["detail"]) == ("a\n,b\\udcff", "'=1")


def test_subtitles(tmp_path):
    records = [notice("a"), instruction(4.37), rejected(5.0), rejected(5.2), instruction(3599.9996)]
    captions = webvtt.read(str(write(tmp_path / "a.vtt", records))).captions
    assert [(each.start, each.end) for each in captions] == [
        ("00:00:04.370", "00:00:05.370"),  # at least a second
        ("00:00:05.000", "00:00:06.000"),
        ("00:00:05.200", "00:00:09.200"),  # at most four
        ("01:00:00.000", "01:00:04.000"),
    ]
    assert captions[0].raw_text == "STOP HOVER 50 GO"
    assert captions[1].raw_text == "<i>rejected:</i> STOP EXEC 5 GO (no program 5)"


def test_subtitles_of_a_clock_that_runs_back(tmp_path):
    captions = webvtt.read(str(write(tmp_path / "a.vtt", [instruction(9.0), instruction(-2.0)]))).captions
    assert [(each.start, each.end) for each in captions] == [
        ("00:00:09.000", "00:00:10.000"),
        ("00:00:09.000", "00:00:13.000"),
    ]


def test_subtitles_escape_hostile_names_and_texts(tmp_path):
    hostile = "a --> b\n\n00:00:00.000 --> 99:00:00.000\n<script>&\udcff"
    path = write(tmp_path / "a.vtt", [instruction(1.0, hostile), rejected(9.0, detail=hostile)], hostile)
    captions = webvtt.read(str(path)).captions
    assert [each.start for each in captions] == ["00:00:01.000", "00:00:09.000"]
    text = path.read_text("utf-8")
    assert text.count("-->") == 2
    assert "<script>" not in text
    assert r"a --&gt; b\n\n00:00:00.000 --&gt; 99:00:00.000\n&lt;script&gt;&amp;\udcff" in text


def test_subtitles_without_a_cue_are_a_file_still(tmp_path):
    assert webvtt.read(str(write(tmp_path / "a.vtt", []))).captions == []


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_nothing_half_written(tmp_path, suffix, error):
    path = tmp_path / f"a{suffix}"
    path.write_text("as it was")

    def fail():
        with open_writer(path, "a.mp4") as writer:
            writer.write(notice("a.mp4"))
            raise error

    with pytest.raises(error):
        fail()
    assert [each.name for each in tmp_path.iterdir()] == [path.name]
    assert path.read_text() == "as it was"


def test_suffix_without_a_writer(tmp_path):
    with pytest.raises(ValueError, match=r"no writer for '\.doc'; known are \.jsonl, \.csv, \.vtt"):
        open_writer(tmp_path / "a.doc", "a")


def test_place_that_cannot_be_written(tmp_path):
    (tmp_path / "file").touch()
    with (
        pytest.raises(UsageError, match="cannot be written"),
        replacing(tmp_path / "file" / "a") as temporary,
    ):
        temporary.write_bytes(b"")


def test_a_folder_is_there_whole_or_not_at_all(tmp_path):
    place = tmp_path / "deep" / "clip"
    with pytest.raises(ZeroDivisionError), replacing_folder(place) as temporary:
        (temporary / "a").write_text(str(1 / 0))
    assert not list(place.parent.iterdir())
    for text in ("first", "second"):
        with replacing_folder(place) as temporary:
            (temporary / "deeper").mkdir()
            (temporary / "deeper" / text).write_text(text)
            assert not (place / "deeper" / text).exists()
        assert [file.name for file in place.rglob("*")] == ["deeper", text]
    assert list(place.parent.iterdir()) == [place]
    with (
        pytest.raises(UsageError, match="cannot be written"),
        replacing_folder(place / "deeper" / text / "x"),
    ):
        pass


def test_a_folder_that_another_process_put_there_meanwhile_stays(tmp_path, monkeypatch):
    place = tmp_path / "clip"
    place.mkdir()
    (place / "theirs").touch()
    monkeypatch.setattr("lightgesture.results.atomic.shutil.rmtree", lambda *_, **__: None)
    with replacing_folder(place) as temporary:
        (temporary / "ours").touch()
    assert [file.name for file in place.iterdir()] == ["theirs"]


def test_content_is_on_the_disk_before_it_has_its_name(tmp_path, monkeypatch):
    order = []

    def synced(descriptor):
        status = os.fstat(descriptor)
        order.append("folder" if stat.S_ISDIR(status.st_mode) else status.st_size)

    monkeypatch.setattr(os, "fsync", synced)
    monkeypatch.setattr(os, "replace", lambda source, target: order.append(target.name))
    with replacing(tmp_path / "a.bin", ".bin") as temporary:
        assert temporary.suffix == ".bin"
        temporary.write_bytes(b"12345")
    assert order == [5, "a.bin", "folder"]


def test_long_names_can_be_written(tmp_path):
    path = tmp_path / ("ö" * 124 + ".jsonl")
    with open_writer(path, "a.mp4") as writer:
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
