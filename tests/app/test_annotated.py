"""Annotated videos and timelines: their own time, sizes, disks that are full, and what is drawn."""

import subprocess
import sys

import av
import numpy as np
import pytest
from matplotlib.figure import Figure

from lightgesture.errors import ExitStatus, UsageError
from lightgesture.fsm import Notice, Rejected, State, Word
from lightgesture.fsm.events import Certainty
from lightgesture.records import FrameRecord, Hand
from lightgesture.results.annotated import open_annotated_video
from lightgesture.results.readings_panel import draw_readings
from lightgesture.results.timeline import NOT_READ, TOKENS, Timeline, open_plot
from lightgesture.sources import read_picture
from tests.makers import hover


def frames_of(path):
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        assert stream.codec_context.name == "h264"
        return [
            (float(frame.pts * frame.time_base), frame.width, frame.height)
            for frame in container.decode(stream)
        ]


def write(path, frames):
    with open_annotated_video(path) as video:
        for time_s, size in frames:
            video.write(np.full((*size, 3), 120, np.uint8), time_s, [])
        assert not path.exists()
    return frames_of(path)


def test_frames_keep_their_own_time(tmp_path):
    times = [0.5, 0.533333, 0.6, 2.0, 2.001, 60.25]
    seen = [time_s for time_s, _, _ in write(tmp_path / "a.mp4", [(time_s, (48, 64)) for time_s in times])]
    assert seen == pytest.approx(times, abs=1e-5)


def test_stamps_that_stand_or_run_back_are_endured(tmp_path):
    seen = [
        time_s for time_s, _, _ in write(tmp_path / "a.mp4", [(each, (48, 64)) for each in (1, 1, 0.2, 1.5)])
    ]
    assert seen == pytest.approx([1.0, 1.00001, 1.00002, 1.5], abs=1e-4)


def test_odd_and_changing_sizes(tmp_path):
    sizes = [(33, 51), (33, 51), (100, 20), (1, 1), (34, 52)]
    seen = write(tmp_path / "a.mp4", [(number / 10, size) for number, size in enumerate(sizes)])
    assert {size for _, *size in map(list, seen) for size in [tuple(size)]} == {(52, 34)}
    assert len(seen) == 5


def test_hostile_names(tmp_path):
    assert len(write(tmp_path / "take:1 %d [x]*ö.mp4", [(0.0, (48, 64))])) == 1


def test_an_annotated_video_that_cannot_be_written(tmp_path):
    (tmp_path / "a.mp4").mkdir()
    with (
        pytest.raises(UsageError, match="cannot be written"),
        open_annotated_video(tmp_path / "a.mp4") as video,
    ):
        video.write(np.zeros((48, 64, 3), np.uint8), 0.0, [])


def test_through_the_command_line(run, make_video, tmp_path, fake):
    out = tmp_path / "out"
    result = run("decode", make_video("dive.avi", 6), "--annotate", "--plot", "--json", "--out", out)
    assert (result.status, result.err) == (ExitStatus.OK, [])
    assert not any('"type":"frame"' in line for line in result.out), "they are for the pictures alone"
    assert [time_s for time_s, _, _ in frames_of(out / "dive_annotated.mp4")] == pytest.approx(
        [0, 0.05, 0.1, 0.15, 0.2, 0.25]
    )
    assert (out / "dive.png").read_bytes().startswith(b"\x89PNG")
    assert (out / "dive.jsonl").read_text().splitlines() == result.out


FULL = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (200, 200))
from lightgesture.results import open_writer
from lightgesture.results.annotated import open_annotated_video
from lightgesture.errors import UsageError
from lightgesture.fsm import Notice
from pathlib import Path
import numpy as np
try:
    if sys.argv[1] == ".mp4":
        with open_annotated_video(Path("a.mp4")) as video:
            for index in range(40):
                image = np.random.default_rng(index).integers(0, 255, (48, 64, 3), dtype=np.uint8)
                video.write(image, index / 10, [])
    else:
        with open_writer("a.jsonl", "a") as writer:
            for index in range(40):
                writer.write(Notice(source="a", frame=index, time_s=0.0, reason="unknown_pair", detail="3,left"))
except UsageError as error:
    print(error)
"""


@pytest.mark.parametrize("suffix", [".jsonl", ".mp4"])
def test_a_disk_that_takes_no_more(tmp_path, suffix):
    """A limit on the size of files stands for a full disk: the same call fails, with another reason."""
    (tmp_path / f"a{suffix}").write_text("earlier result")
    done = subprocess.run(
        [sys.executable, "-c", FULL, suffix],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
    )
    assert done.stdout == f"a{suffix}: cannot be written (File too large); name another folder\n"
    assert [path.name for path in tmp_path.iterdir()] == [f"a{suffix}"]
    assert (tmp_path / f"a{suffix}").read_text() == "earlier result"


def test_timeline_of_everything(tmp_path):
    at = {"source": "a", "frame": 1}
    hand = {"confidence": 0.9, "box": (0, 0, 1, 1), "track": 1}
    hands = (
        Hand(side="left", token="ok", reason=None, **hand),
        Hand(side="right", token=None, reason="partial", **hand),
    )
    with open_plot(tmp_path / "a.png", "$x^ \n\udcff ダイバー.mp4") as timeline:
        for number in range(10):
            timeline.write(FrameRecord(source="a", frame=number, time_s=number / 10, hands=hands))
        timeline.write(Word(time_s=0.3, pair=("ok", "0"), word="$STOP", state="", confidence=1.0, **at))
        timeline.write(Rejected(time_s=0.6, reason="limit", text="STOP $ 5", detail="", **at))
        timeline.write(
            hover(time_s=0.9, start_time_s=0.1, text="STOP HOVER GO", duration_s=None, confidence=0.9, **at)
        )
    assert timeline.end_s == 0.9
    assert timeline.hands["left"][1] == [TOKENS.index("ok")] * 10
    assert timeline.hands["right"][1] == [TOKENS.index(NOT_READ)] * 10
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_own_signs_have_rows_of_their_own():
    timeline = Timeline()
    for number, token in enumerate(("ring", "ok", None, "ring")):
        hand = Hand(side="left", token=token, confidence=0.9, box=(0, 0, 9, 9), track=1, reason=None)
        timeline.write(FrameRecord(source="a", frame=number, time_s=number / 10, hands=(hand,)))
    assert timeline.rows == [*TOKENS, "ring"]
    assert timeline.hands["left"][1] == [len(TOKENS), TOKENS.index("ok"), 0, len(TOKENS)]


def test_timeline_of_nothing(tmp_path):
    with open_plot(tmp_path / "a.png", "a"):
        pass
    assert (tmp_path / "a.png").stat().st_size > 1000


def state(time_s, *words):
    certainty = Certainty(words=words, expected="GO") if words else None
    return State(
        source=None, frame=0, time_s=time_s, state="collecting", sentence="", dwell=None, certainty=certainty
    )


def test_a_timeline_shows_the_readings_of_the_rule_sentence_and_where_a_word_was_doubted():
    figure_axes = Figure().subplots()
    repeat = Notice(source=None, frame=0, time_s=1.0, reason="repeat", detail="3 was not seen well")
    states = [
        state(0.0),
        state(0.5, ("STOP", 0.9)),
        state(0.7, ("STOP", 0.9), ("HOVER", 0.4)),
        state(1.0, ("STOP", 0.9), ("FOLLOW", 0.5)),
        state(9.0, ("CONTD", 0.8)),
    ]
    draw_readings(figure_axes, states, [repeat])
    texts = [text.get_text() for text in figure_axes.texts]
    assert texts == ["STOP", "HOVER", "… FOLLOW", "… CONTD", "3 was not seen well"]
    steps = [
        list(line.get_ydata())
        for line in figure_axes.lines
        if len(line.get_ydata()) and line.get_label()[0] == "_"
    ]
    assert steps[:2] == [[0.9, 0.4, 0.5], [0.8]]  # the line is broken where nothing was read


def test_a_timeline_has_readings_only_where_the_rule_tells_them(tmp_path):
    sizes = []
    for shown in ([state(0.5)], [state(0.5, ("STOP", 0.9))]):
        with open_plot(tmp_path / "a.png", "a") as timeline:
            for record in shown:
                timeline.write(record)
        sizes.append(read_picture(tmp_path / "a.png").shape[0])
    assert sizes[1] > sizes[0]
