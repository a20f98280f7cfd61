"""The loop, with a clock that a test turns by hand where it can."""

import threading
import time

import cv2
import numpy as np
import pytest

from lightgesture.fsm import Instruction, State
from lightgesture.live import LiveLoop, Mailbox, Snapshot
from lightgesture.records import FrameRecord, HeartbeatRecord, SummaryRecord

IMAGE = np.full((48, 64, 3), 90, np.uint8)


class ListOutlet:
    def __init__(self):
        self.is_gone = False
        self.records = []

    def put(self, record):
        self.records.append(record)

    def of(self, kind):
        return [record for record in self.records if isinstance(record, kind)]


class ListListener:
    def __init__(self):
        self.shown = []

    def show(self, image_bgr, records):
        self.shown.append((image_bgr, [record.type for record in records]))


class Scene:
    """A loop with a mailbox to fill; `said`: its messages."""

    def __init__(self, fake, *, clock=None, listeners=(), frames=False, heartbeat_s=1.0):
        self.box, self.outlet, self.said = Mailbox(), ListOutlet(), []
        self.pipeline = fake(model="svm", source="cam", frames=True, debug=None)
        self.stopping = threading.Event()
        self.loop = LiveLoop(
            "cam",
            self.box,
            self.pipeline,
            [self.outlet],
            clock=clock or time.monotonic,
            report=self.said.append,
            listeners=listeners,
            frames=frames,
            heartbeat_s=heartbeat_s,
        )

    def feed(self, *contents, gap_s=0.0):
        """Give the contents from a thread, each when the last one was taken, then close."""

        def play():
            for index, content in enumerate(contents):
                self.box.put(Snapshot(content, index, index / 10))
                while not self.box.is_empty:
                    time.sleep(0.001)
                time.sleep(gap_s)
            self.box.close()

        threading.Thread(target=play, daemon=True).start()
        self.loop.run(self.stopping)


def test_records_in_order_and_the_summary_last(fake):
    scene = Scene(fake)
    scene.feed(IMAGE, IMAGE, IMAGE)
    assert scene.pipeline.seen == [(0, 0.0, IMAGE.shape), (1, 0.1, IMAGE.shape), (2, 0.2, IMAGE.shape)]
    types = [record.type for record in scene.outlet.records]
    assert types == ["word", "state", "instruction", "notice", "rejected", "summary"]
    assert scene.loop.processed == 3


@pytest.mark.parametrize(("frames", "count"), [(False, 0), (True, 3)])
def test_frame_records_go_to_the_outlets_where_they_are_wanted(fake, frames, count):
    listener = ListListener()
    scene = Scene(fake, listeners=[listener], frames=frames)
    scene.feed(IMAGE, IMAGE, IMAGE)
    assert len(scene.outlet.of(FrameRecord)) == count
    assert [types[0] for image, types in listener.shown if image is not None] == ["frame"] * 3
    assert all(image is IMAGE for image, _ in listener.shown[:3])
    assert listener.shown[-1] == (None, ["summary"])


def test_a_slow_decoder_gets_the_newest_picture(fake):
    """Four pictures come while one is processed: the last of them is next."""
    scene = Scene(fake)
    process, coming = scene.pipeline.process, iter(range(1, 41))

    def slow(*arguments):
        for _, index in zip(range(4), coming, strict=False):
            scene.box.put(Snapshot(IMAGE, index, index / 10))
        if arguments[2] == 40:
            scene.box.close()
        return process(*arguments)

    scene.pipeline.process = slow
    scene.box.put(Snapshot(IMAGE, 0, 0.0))
    scene.loop.run(scene.stopping)
    assert [seen[0] for seen in scene.pipeline.seen] == list(range(0, 41, 4))
    assert scene.box.dropped == 30


def test_heartbeats_come_each_second_with_and_without_pictures(fake):
    scene = Scene(fake, heartbeat_s=0.1)
    threading.Timer(0.75, scene.box.close).start()
    for index in range(3):
        scene.box.put(Snapshot(IMAGE, index, 0.0))
    scene.loop.run(scene.stopping)
    beats = scene.outlet.of(HeartbeatRecord)
    assert 4 <= len(beats) <= 7
    assert {beat.source for beat in beats} == {"cam"}
    assert (beats[0].frames, beats[0].dropped, beats[0].state) == (1, 2, "idle")
    assert (beats[0].ms_per_frame > 0, beats[-1].ms_per_frame) == (True, 0.0)
    times = [beat.time_s for beat in beats]
    assert times == sorted(times)


def test_a_heartbeat_tells_the_state_of_the_decoder(fake):
    scene = Scene(fake, heartbeat_s=0.05)
    scene.feed(IMAGE, IMAGE, gap_s=0.3)
    assert [beat.state for beat in scene.outlet.of(HeartbeatRecord)][-1] == "collecting"
    assert scene.outlet.of(State)[0].state == "collecting"


def test_missed_heartbeats_are_not_made_up_for(fake):
    now = [0.0]
    scene = Scene(fake, clock=lambda: now[0])

    def jump(image, *arguments):
        now[0] += 60.0
        return []

    scene.pipeline.process = jump
    scene.box.put(Snapshot(IMAGE, 0, 0.0))
    scene.box.close()
    scene.loop.run(scene.stopping)
    assert len(scene.outlet.of(HeartbeatRecord)) == 1


def test_pictures_that_cannot_be_decoded_are_told_once_and_passed_over(fake):
    scene = Scene(fake)
    good = cv2.imencode(".jpg", IMAGE)[1].tobytes()
    scene.feed(b"\xff\xd8\xffgarbage", good, b"\xff\xd8\xffgarbage", good)
    assert [seen[0] for seen in scene.pipeline.seen] == [1, 3]
    assert scene.said == ["cam: picture 0 is damaged; such pictures are passed over"]


def test_a_picture_may_change_its_size(fake):
    scene = Scene(fake)
    scene.feed(IMAGE, np.zeros((9, 7, 3), np.uint8), IMAGE)
    assert [seen[2] for seen in scene.pipeline.seen] == [(48, 64, 3), (9, 7, 3), (48, 64, 3)]


def test_silence_is_told_once(fake, monkeypatch):
    monkeypatch.setattr("lightgesture.live.loop.SILENCE_S", 0.05)
    scene = Scene(fake, heartbeat_s=0.02)
    threading.Timer(0.3, scene.stopping.set).start()
    scene.loop.run(scene.stopping)
    assert scene.said == ["cam: no picture for 0 s"]


def test_stopping_ends_with_the_summary(fake):
    scene = Scene(fake)
    threading.Timer(0.05, scene.stopping.set).start()
    start = time.monotonic()
    scene.loop.run(scene.stopping)
    assert time.monotonic() - start < 1
    assert [record.type for record in scene.outlet.records] == ["summary"]


def test_without_anybody_who_takes_the_records_it_ends(fake):
    scene = Scene(fake)
    scene.outlet.is_gone = True
    scene.loop.run(scene.stopping)
    assert scene.outlet.of(SummaryRecord)
    assert not scene.outlet.of(Instruction)
