"""The table over all dives of a folder of results."""

import csv

import pytest

from lightgesture.archive.dives import COLUMNS, write_dives
from lightgesture.errors import ExitStatus, UsageError
from lightgesture.fsm import Rejected
from lightgesture.results import open_writer, output_stems
from tests.makers import hover


def rows(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def instruction(source, start_s, end_s, utc=None):
    return hover(source=source, time_s=end_s, utc=utc, start_frame=0, start_time_s=start_s)


@pytest.mark.usefixtures("fake")
def test_every_run_adds_its_dives(run, make_video, tmp_path):
    out = tmp_path / "out"
    first, second = make_video("dive10.avi", 4), make_video("dive9.avi", 4)
    assert run("decode", first, "--out", out).status == ExitStatus.OK
    assert [row["source"] for row in rows(out / "dives.csv")] == [str(first)]
    run("decode", second, tmp_path / "gone.avi", "--out", out)
    found = rows(out / "dives.csv")
    assert [row["source"] for row in found] == [str(second), str(first)], (
        "in natural order, whichever run made them"
    )
    assert list(found[0]) == list(COLUMNS)
    assert [found[0][name] for name in ("start_s", "end_s", "sentence", "kind", "confidence")] == [
        "0.0",
        "0.1",
        "STOP HOVER GO",
        "task",
        "0.95",
    ]


def test_times_of_day_where_the_source_has_a_clock(tmp_path):
    with open_writer(tmp_path / "a.csv", "a") as writer:
        writer.write(instruction("=a", 0.5, 10.75, "2026-05-01T10:00:10.750Z"))
        writer.write(Rejected(source="=a", frame=1, time_s=1.0, reason="timeout", text="STOP", detail="late"))
        writer.write(instruction("=a", 20.0, 30.0))
    (tmp_path / "log.csv").write_text("time,depth\n1,2\n")
    write_dives(tmp_path)
    clocks = [(row["start_utc"], row["end_utc"], row["source"]) for row in rows(tmp_path / "dives.csv")]
    assert clocks == [
        ("2026-05-01T10:00:00.500Z", "2026-05-01T10:00:10.750Z", "'=a"),
        ("", "", "'=a"),
    ]


@pytest.mark.usefixtures("fake")
def test_a_foreign_table_is_kept(run, make_video, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "dives.csv").write_text("date,site\n")
    result = run("decode", make_video("a.avi", 4), "--out", out)
    assert result.status == ExitStatus.USAGE
    assert result.err[0].startswith(f"lightgesture: {out / 'dives.csv'}: was not written by this program")
    assert (out / "dives.csv").read_text() == "date,site\n"
    assert not (out / "a.csv").exists()


def test_no_input_has_the_name_of_the_table():
    assert output_stems(["/a/dives.mp4", "/a/b.mp4"]) == ["a_dives.mp4", "b"]
    assert output_stems(["Dives"])[0].casefold() != "dives"


@pytest.mark.parametrize(
    "row", ["instruction", "instruction,d,0,nan,,1.0", "instruction,d,0,1e300,,1.0", "instruction,d,0,1,x,0"]
)
def test_a_damaged_table_is_named(tmp_path, row):
    """As an editor, or a disk that was full, may leave it."""
    (tmp_path / "dive.csv").write_text(f"type,source,frame,time_s,utc,start_time_s\n{row}\n")
    with pytest.raises(UsageError, match=r"dive\.csv: is damaged .*decode its input again") as caught:
        write_dives(tmp_path)
    assert "\n" not in str(caught.value)
