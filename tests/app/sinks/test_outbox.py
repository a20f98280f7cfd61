"""Queues before sinks that fail, block and leave."""

import threading
import time

import pytest

import lightgesture.sinks.outbox as outbox_module
from lightgesture.backoff import Backoff
from lightgesture.sinks import Outbox, RecordError, SinkError, SinkGoneError


@pytest.fixture(autouse=True)
def _small(monkeypatch):
    monkeypatch.setattr(outbox_module, "CAPACITY", 4)
    monkeypatch.setattr(outbox_module, "DRAIN_S", 1.0)


def quick():
    return Backoff(first_s=0.01, longest_s=0.02)


class FakeSink:
    """Keeps what it is sent; raises what stands next in `opening` and `sending`, None being a success."""

    poll_s = None

    def __init__(self, opening=(), sending=(), *, keeps_old=False):
        self.name = "fake"
        self.keeps_old = keeps_old
        self.opening, self.sending = list(opening), list(sending)
        self.sent, self.opened, self.closed = [], 0, 0
        self.may_open, self.may_send = threading.Event(), threading.Event()
        self.may_open.set()
        self.may_send.set()

    def wants(self, record):
        return record.frames >= 0

    def open(self):
        assert self.may_open.wait(5)
        self.opened += 1
        if self.opening and (error := self.opening.pop(0)):
            raise error

    def send(self, record):
        assert self.may_send.wait(5)
        if self.sending and (error := self.sending.pop(0)):
            raise error
        self.sent.append(record.frames)

    def close(self):
        self.closed += 1


def wait_for(condition):
    deadline = time.monotonic() + 5
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.002)


def run(sink, records, backoff=None):
    """Send all, stop, and give the messages."""
    messages = []
    outbox = Outbox(sink, messages.append, backoff or quick())
    outbox.start()
    for record in records:
        outbox.put(record)
    outbox.stop()
    return messages


def test_records_in_order_and_only_those_wanted(heartbeat):
    sink = FakeSink()
    assert run(sink, [heartbeat(frames) for frames in (1, -1, 2, 3)]) == []
    assert (sink.sent, sink.opened, sink.closed) == ([1, 2, 3], 1, 1)


def test_a_failure_is_told_once_and_what_failed_is_repeated(heartbeat):
    down = SinkError("fake: no route")
    sink = FakeSink(opening=[down, down, None], sending=[None, down, None])
    messages = []
    outbox = Outbox(sink, messages.append, quick())
    outbox.start()
    for frames in (1, 2, 3):
        outbox.put(heartbeat(frames))
    wait_for(lambda: len(sink.sent) == 3)
    outbox.stop()
    assert sink.sent == [1, 2, 3]
    assert sink.opened == 4
    first = ["fake: no route; trying again until it works", "fake: works again"]
    assert messages == first + first


def test_a_record_that_cannot_be_sent_is_not_repeated(heartbeat):
    sink = FakeSink(sending=[RecordError("fake: too long"), RecordError("fake: too long"), None])
    assert run(sink, [heartbeat(frames) for frames in (1, 2, 3)]) == ["fake: too long", "fake: works again"]
    assert (sink.sent, sink.opened) == ([3], 1)


def test_a_sink_that_blocks_delays_nobody_and_the_oldest_is_dropped(heartbeat):
    sink = FakeSink()
    sink.may_send.clear()
    messages = []
    outbox = Outbox(sink, messages.append, quick())
    outbox.start()
    outbox.put(heartbeat(0))
    wait_for(lambda: not outbox.waiting)  # the first is being sent
    start = time.monotonic()
    for frames in range(1, 1001):
        outbox.put(heartbeat(frames))
    assert time.monotonic() - start < 1
    sink.may_send.set()
    outbox.stop()
    assert sink.sent == [0, 997, 998, 999, 1000]
    assert messages == ["fake: 996 records were dropped"]


@pytest.mark.parametrize(("keeps_old", "sent"), [(False, [2]), (True, [1, 2])])
def test_what_waited_for_too_long_is_not_sent_late(heartbeat, monkeypatch, keeps_old, sent):
    """An instruction that reaches a vehicle when the link is back may meet another situation."""
    sink = FakeSink(opening=[SinkError("fake: down"), None], keeps_old=keeps_old)
    sink.may_open.clear()
    # Long enough for a slow machine to send the second record while it is young.
    monkeypatch.setattr(outbox_module, "MAX_AGE_S", 0.8)
    outbox = Outbox(sink, lambda text: None, Backoff(first_s=0.001))
    outbox.start()
    outbox.put(heartbeat(1))
    time.sleep(0.9)
    outbox.put(heartbeat(2))
    sink.may_open.set()
    wait_for(lambda: len(sink.sent) == len(sent))
    outbox.stop()
    assert sink.sent == sent


def test_a_reader_that_has_gone(heartbeat):
    sink = FakeSink(sending=[None, SinkGoneError()])
    messages = []
    outbox = Outbox(sink, messages.append, quick())
    outbox.start()
    outbox.put(heartbeat(1))
    assert not outbox.is_gone
    outbox.put(heartbeat(2))
    wait_for(lambda: outbox.is_gone)
    outbox.put(heartbeat(3))
    outbox.stop()
    assert (sink.sent, messages) == ([1], [])


def test_the_end_does_not_wait_for_a_sink_that_is_down(heartbeat):
    sink = FakeSink(opening=[SinkError("fake: down")] * 99)
    start = time.monotonic()
    assert run(sink, [heartbeat(1)], Backoff(60.0, 60.0)) == [
        "fake: down; trying again until it works",
        "fake: 1 records were dropped",
    ]
    assert time.monotonic() - start < 1
    assert sink.sent == []


def test_the_end_does_not_wait_for_a_sink_that_blocks(heartbeat, monkeypatch):
    monkeypatch.setattr(outbox_module, "DRAIN_S", 0.05)
    sink = FakeSink()
    sink.may_send.clear()
    messages = []
    outbox = Outbox(sink, messages.append)
    outbox.start()
    outbox.put(heartbeat(1))
    wait_for(lambda: not outbox.waiting)  # the first is being sent
    outbox.put(heartbeat(2))
    outbox.stop()
    sink.may_send.set()
    assert messages == ["fake: 1 records were dropped"]


def test_a_sink_that_wants_it_is_polled_and_opened_again_where_that_fails(heartbeat):
    class Polled(FakeSink):
        poll_s = 0.005
        polls = 0

        def poll(self):
            self.polls += 1
            if self.polls == 3:
                raise SinkError("the link is dead")

    sink, messages = Polled(), []
    box = Outbox(sink, messages.append, Backoff(first_s=0.01))
    box.start()
    wait_for(lambda: sink.polls > 5)
    box.put(heartbeat(1))
    box.stop()
    assert messages == ["the link is dead; trying again until it works", "fake: works again"]


def test_a_defect_of_a_sink_is_told_and_ends_it_alone(heartbeat):
    sink = FakeSink(sending=[ZeroDivisionError("oops")])
    messages = run(sink, [heartbeat(1)])
    assert messages == ["fake: gives up, which is a defect (ZeroDivisionError: oops)"]
    assert sink.closed == 1


def test_waits_grow_up_to_the_longest():
    backoff = Backoff(first_s=1.0, longest_s=5.0)
    assert [backoff.next_wait() for _ in range(5)] == [1.0, 2.0, 4.0, 5.0, 5.0]
    backoff.reset()
    assert backoff.next_wait() == 1.0
