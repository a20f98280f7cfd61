"""Reading, breaking off and opening again."""

import threading
import time

import pytest

from lightgesture.backoff import Backoff
from lightgesture.errors import InputError
from lightgesture.live import Mailbox, Reader


def quick():
    return Backoff(first_s=0.01, longest_s=0.02)


class FakeStream:
    """Each opening plays the next of `plays`: pictures and errors in order.

    A play that begins with an error does not open.
    """

    def __init__(self, *plays, is_reopened=True):
        self.name = "cam"
        self.is_reopened = is_reopened
        self.plays = list(plays)
        self.opened = self.closed = 0

    def __enter__(self):
        self.opened += 1
        self.play = self.plays.pop(0) if self.plays else [InputError("cam: nothing left")]
        if self.play and isinstance(self.play[0], Exception):
            raise self.play[0]
        return self

    def __exit__(self, *error):
        self.closed += 1

    def __iter__(self):
        for item in self.play:
            if isinstance(item, Exception):
                raise item
            yield item


class ListBox(Mailbox):
    """Keeps all."""

    def __init__(self):
        super().__init__()
        self.all = []

    def put(self, snapshot):
        self.all.append(snapshot)


def read(stream, until, clock=time.monotonic):
    """Read until there are so many pictures or the end; what came and what was said."""
    box, said = ListBox(), []
    reader = Reader(stream, box, clock, said.append, quick())
    reader.start()
    deadline = time.monotonic() + 5
    while len(box.all) < until and not box.is_closed:
        assert time.monotonic() < deadline
        time.sleep(0.002)
    reader.stop()
    return box, said


def test_a_stream_that_breaks_off_is_told_once_and_opened_again():
    gone = InputError("cam: broke off")
    stream = FakeStream([b"1", b"2", gone], [gone], [gone], [b"3"])
    box, said = read(stream, until=3)
    assert [shot.content for shot in box.all] == [b"1", b"2", b"3"]
    assert [shot.index for shot in box.all] == [0, 1, 2]
    assert said[:2] == ["cam: broke off; trying again until it works", "cam: pictures again"]
    assert said[2:] in ([], ["cam: the stream ended; trying again until it works"])


def test_a_stream_that_ends_is_opened_again():
    box, said = read(FakeStream([b"1"], [b"2"]), until=2)
    assert len(box.all) == 2
    assert said[:2] == ["cam: the stream ended; trying again until it works", "cam: pictures again"]


def test_each_opening_is_closed():
    stream = FakeStream([b"1"], [b"2"], [b"3"])
    read(stream, until=3)
    assert stream.closed in (3, stream.opened)


@pytest.mark.parametrize(("play", "said"), [([b"1"], []), ([b"1", InputError("-: cut off")], ["-: cut off"])])
def test_a_stream_that_cannot_be_opened_again_ends(play, said):
    stream = FakeStream(play, is_reopened=False)
    box, messages = read(stream, until=99)
    assert messages == said
    assert (stream.opened, len(box.all), box.is_closed) == (1, 1, True)


def test_pictures_are_stamped_as_they_come():
    times = iter([0.5, 0.75])
    box, _ = read(FakeStream([b"1", b"2"], is_reopened=False), until=99, clock=lambda: next(times))
    assert [shot.time_s for shot in box.all] == [0.5, 0.75]


def test_a_defect_reaches_the_one_who_decodes():
    stream = FakeStream([b"1", ZeroDivisionError("oops")])
    box = Mailbox()
    reader = Reader(stream, box, time.monotonic, lambda text: None, quick())
    reader.start()
    reader.stop()
    with pytest.raises(ZeroDivisionError, match="oops"):
        box.take(5)


def test_stopping_ends_the_wait_for_the_next_try():
    said, before = [], set(threading.enumerate())
    reader = Reader(FakeStream(), Mailbox(), time.monotonic, said.append, Backoff(60, 60))
    reader.start()
    while not said:
        time.sleep(0.002)
    start = time.monotonic()
    reader.stop()
    assert time.monotonic() - start < 0.5
    assert set(threading.enumerate()) <= before


@pytest.mark.parametrize("plays", [[], [[b"1"]]])
def test_a_stream_is_given_up_after_a_while_without_pictures(plays):
    box, said = ListBox(), []
    reader = Reader(FakeStream(*plays), box, time.monotonic, said.append, quick(), give_up_s=0.15)
    start = time.monotonic()
    reader.start()
    while not box.is_closed:
        assert time.monotonic() < start + 5
        time.sleep(0.005)
    assert 0.14 < time.monotonic() - start < 2
    assert (reader.has_given_up, len(box.all)) == (True, len(plays))
    assert said[0].endswith("; trying again for 0 s")
    assert said[-1] == "cam: no picture for 0.15 s; given up"
    reader.stop()
