"""Ways side by side: frames in turn, kinds apart, one core while it lasts, and peers that do not start."""

import os
import sys

import numpy as np
import pytest

from lightgesture.benchmarks import peers
from lightgesture.benchmarks.contenders import (
    BLOCK,
    COPY,
    TEXTBOOK,
    Contender,
    interleave,
    textbook,
    yardsticks,
)
from lightgesture.benchmarks.mediapipe_server import main as serve
from lightgesture.benchmarks.side_by_side import COLUMNS, draw, on_one_core, scaled
from lightgesture.benchmarks.timing import WARM_UP
from lightgesture.errors import InputError

FRAMES = [np.full((48, 64, 3), value, np.uint8) for value in range(12)]


def test_all_take_a_few_frames_in_turn_and_the_warm_up_does_not_count():
    seen = []
    contenders = [
        Contender("one", lambda image, time_s: seen.append(("one", int(image[0, 0, 0])))),
        Contender("two", lambda image, time_s: "odd" if image[0, 0, 0] % 2 else "even"),
    ]
    times = interleave(contenders, FRAMES, 2)
    assert list(times) == ["one", "two", "two, even", "two, odd"]
    assert len(times["one"]) == len(times["two"]) == 24
    assert len(times["two, even"]) == len(times["two, odd"]) == 12
    assert len(seen) == WARM_UP + 24
    assert [value for _, value in seen[:BLOCK]] == list(range(BLOCK))
    assert all(spent >= 0.0 for own in times.values() for spent in own)


def test_the_textbook_finds_skin_and_the_yardsticks_run():
    skin = np.full((120, 160, 3), (60, 40, 20), np.uint8)
    assert textbook(skin, 0.0) == 0
    skin[30:80, 40:90] = (120, 150, 210)
    assert textbook(skin, 0.0) == 1
    assert list(interleave(yardsticks(), FRAMES, 1)) == [COPY, TEXTBOOK]


@pytest.mark.skipif(not hasattr(os, "sched_getaffinity"), reason="this system keeps no process on a core")
def test_the_cores_are_given_back_even_after_an_error():
    before = os.sched_getaffinity(0)

    def fail():
        with on_one_core():
            assert len(os.sched_getaffinity(0)) == 1
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert os.sched_getaffinity(0) == before


def test_a_picture_of_the_times_is_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    row = dict(zip(COLUMNS, ("640x480", "learned, CNN", 9, 1.0, 2.0, 3.0, 50.0), strict=True))
    draw([row, {**row, "what": "followed"}, {**row, "size": "1280x720"}], tmp_path / "times.png")
    assert (tmp_path / "times.png").read_bytes().startswith(b"\x89PNG")
    assert scaled(FRAMES[:1], (32, 24))[0].shape == (24, 32, 3)


class FakePeer:
    def ask(self, frame):
        assert 0 <= frame < len(FRAMES)
        return [10.0, 20.0]


def test_peers_are_compared_with_ours(monkeypatch):
    made = type("Product", (), {"call": lambda self, image, time_s: "followed"})
    monkeypatch.setattr(peers, "Product", lambda model: made())
    table = peers.measure(FRAMES, FakePeer(), 1)
    rows = {row["what"]: row for row in table.rows}
    assert list(rows)[-2:] == ["MediaPipe lite", "MediaPipe full"]
    assert rows["MediaPipe full"]["median_ms"] == 20.0
    assert rows["learned, CNN"]["times_ours"] == pytest.approx(1.0)
    assert rows["MediaPipe lite"]["calls"] == 12


@pytest.mark.parametrize(
    ("python", "message"), [("/nowhere/python", "does not start"), (sys.executable, "MediaPipe")]
)
def test_an_environment_without_it_is_told_in_one_line(python, message, monkeypatch, tmp_path):
    if python == sys.executable:
        broken = tmp_path / "server.py"
        broken.write_text("import nothing_of_that_name\n")
        monkeypatch.setattr(peers, "SERVER", broken)
    with pytest.raises(InputError, match=message), peers.open_peer(python, FRAMES):
        pass


def test_the_server_answers_with_a_time_for_each_net(tmp_path, monkeypatch, capsys):
    class Hands:
        def __init__(self, **options):
            assert options["max_num_hands"] == 2

        def process(self, image):
            assert image.shape == (48, 64, 3)

    hands = type("hands", (), {"Hands": Hands})
    solutions = type("solutions", (), {"hands": hands})
    monkeypatch.setitem(sys.modules, "mediapipe", type("mediapipe", (), {"solutions": solutions}))
    np.save(tmp_path / "frames.npy", np.array(FRAMES))
    monkeypatch.setattr(sys, "stdin", iter(["3\n", "0\n"]))
    serve(str(tmp_path / "frames.npy"), [0, 1])
    lines = capsys.readouterr().out.split("\n")
    assert lines[0] == "ready"
    assert all(line.count(",") == 1 for line in lines[1:3])
