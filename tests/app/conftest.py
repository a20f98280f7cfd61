"""Small videos, pictures and folders drawn on the spot, and a pipeline that needs no hands."""

from typing import ClassVar

import cv2
import numpy as np
import pytest

from lightgesture.cli import main
from lightgesture.fsm import Decoder, Notice, Rejected, State, Word, load_grammar
from lightgesture.models import ModelError
from lightgesture.records import FrameRecord, Hand, SummaryRecord
from tests.makers import hover

SIZE = (64, 48)
"""Width and height of the drawn videos, pixels."""


def draw(value, size=SIZE):
    """A grey picture with a lighter square, different for every value from 0 to 255."""
    image = np.full((size[1], size[0], 3), value % 256, np.uint8)
    image[8:24, 8 : 24 + value % 16] = (value + 90) % 256
    return image


class FakeFront:
    """Sees nothing, whatever it is shown."""

    def for_stream(self):
        return self

    def recognize(self, image):
        assert image.dtype == np.uint8

    def shown(self):
        return {}


class FakePipeline:
    """Says HOVER at the second frame, one instruction, notice and rejection at the third.

    made: all that were made, newest last. interrupt_at: number of frames, all pipelines together, after
    which a KeyboardInterrupt comes.
    """

    made: ClassVar = []
    interrupt_at = None
    unknown = False
    front = FakeFront()

    @property
    def decoder(self):
        return Decoder(load_grammar())

    def __init__(self, *, model, source, frames, debug, **options):
        if model == "broken.npz":
            raise ModelError("broken.npz: is damaged (no scores); restore it or train it again")
        self.options = {"model": model, **options}
        self.source, self.frames, self.debug = source, frames, debug
        self.seen = []
        FakePipeline.made.append(self)

    def for_stream(self, source, debug=None):
        return FakePipeline(source=source, frames=self.frames, debug=debug, **self.options)

    def check_language(self):
        return "classes of the model that the grammar does not know: shaka" if self.unknown else None

    def interrupt(self, detail, time_s, index=None):
        return [Notice(reason="gap", detail=detail, source=self.source, frame=index, time_s=time_s)]

    def process(self, image_bgr, time_s, index=None):
        assert image_bgr.dtype == np.uint8
        assert image_bgr.ndim == 3
        self.seen.append((index, time_s, image_bgr.shape))
        if sum(len(pipeline.seen) for pipeline in FakePipeline.made) == FakePipeline.interrupt_at:
            raise KeyboardInterrupt
        if self.debug is not None:
            self.debug.write("mask", index, image_bgr)
        at = {"source": self.source, "frame": index, "time_s": time_s}
        records = [FrameRecord(hands=(), **at)] if self.frames else []
        if index == 1:
            records += [
                Word(pair=("5", "5"), word="HOVER", state="STOP HOVER", confidence=0.97, **at),
                State(state="collecting", sentence="STOP HOVER", dwell=None, **at),
            ]
        if index == 2:
            records += [
                hover(
                    start_frame=0,
                    start_time_s=0.0,
                    text="STOP HOVER GO",
                    duration_s=None,
                    words=("STOP", "HOVER", "GO"),
                    **at,
                ),
                Notice(reason="unknown_pair", detail="3,left is no word; repeat it", **at),
                Rejected(reason="unknown_program", text="STOP EXEC 5 GO", detail="no program 5", **at),
            ]
        return records

    def finish(self):
        return [
            SummaryRecord(
                source=self.source,
                frames=len(self.seen),
                seconds=self.seen[-1][1] if self.seen else 0.0,
                instructions=int(len(self.seen) > 2),
                rejected=int(len(self.seen) > 2),
                status="ok",
                ms_per_frame={"median": 0.5, "p95": 0.9},
                stages_ms={},
            )
        ]

    def recognize(self, image_bgr):
        assert image_bgr.dtype == np.uint8
        if self.debug is not None:
            self.debug.write("mask", 0, image_bgr)
        hands = (
            Hand(side="left", token=None, confidence=0.3, box=(1, 2, 3, 4), track=None, reason="partial"),
            Hand(side="right", token="5", confidence=0.98, box=(5, 6, 7, 8), track=None, reason=None),
        )
        is_bright = image_bgr.mean() > 40
        return FrameRecord(source=self.source, frame=None, time_s=None, hands=hands if is_bright else ())


@pytest.fixture
def fake(monkeypatch):
    """Put the fake in the pipeline's place."""
    monkeypatch.setattr(FakePipeline, "made", [])
    monkeypatch.setattr(FakePipeline, "interrupt_at", None)
    monkeypatch.setattr("lightgesture.config.opening.Pipeline", FakePipeline)
    monkeypatch.setattr(
        "lightgesture.actions.decode.usable_cores", lambda: 1
    )  # worker processes have the real one
    return FakePipeline


class Result:
    """What a run of the command line left behind."""

    def __init__(self, status, captured):
        self.status = status
        self.out = captured.out.splitlines()
        self.err = captured.err.splitlines()


@pytest.fixture
def run(capsys):
    """Runs the command line with the arguments made texts."""

    def call(*arguments):
        status = main([str(argument) for argument in arguments])
        return Result(status, capsys.readouterr())

    return call


@pytest.fixture
def make_video(tmp_path):
    """Writes a video of drawn frames, 20 a second."""

    def make(name="dive.avi", frames=6, fourcc="MJPG"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        # OpenCV's writer takes some characters of a name for a pattern, so the name comes afterwards
        plain = tmp_path / f"plain{path.suffix}"
        writer = cv2.VideoWriter(str(plain), cv2.VideoWriter_fourcc(*fourcc), 20.0, SIZE)
        assert writer.isOpened()
        for index in range(frames):
            writer.write(draw(index * 9))
        writer.release()
        return plain.replace(path)

    return make


@pytest.fixture
def make_picture(tmp_path):
    """Writes a picture in the format of its suffix, whatever its name."""

    def make(name, image=None):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(cv2.imencode(path.suffix, draw(50) if image is None else image)[1].tobytes())
        return path

    return make


@pytest.fixture
def make_folder(make_picture):
    """Writes a folder of frames 1.png, 2.png and so on."""

    def make(name="frames", count=12):
        for number in range(1, count + 1):
            path = make_picture(f"{name}/{number}.png", draw(number * 7))
        return path.parent

    return make
