"""One slot, the newest wins."""

import threading
import time

import pytest

from lightgesture.live import Mailbox, Snapshot


def snapshot(index):
    return Snapshot(b"", index, index / 10)


def test_the_newest_is_taken_and_what_it_replaced_counts_as_dropped():
    box = Mailbox()
    for index in range(5):
        box.put(snapshot(index))
    assert box.take(0).index == 4
    assert box.take(0) is None
    box.put(snapshot(5))
    assert box.take(0).index == 5
    assert box.dropped == 4


def test_taking_waits_for_one_that_comes():
    box = Mailbox()
    threading.Timer(0.05, box.put, [snapshot(3)]).start()
    assert box.take(5).index == 3


def test_taking_waits_no_longer_than_asked():
    start = time.monotonic()
    assert Mailbox().take(0.05) is None
    assert 0.04 < time.monotonic() - start < 2


def test_what_came_before_the_end_is_still_taken():
    box = Mailbox()
    box.put(snapshot(0))
    box.close()
    assert not box.is_closed
    assert box.take(5).index == 0
    assert box.is_closed
    assert box.take(5) is None


def test_a_defect_of_the_thread_that_reads_is_raised_where_it_is_taken():
    box = Mailbox()
    threading.Timer(0.02, box.close, [ZeroDivisionError("oops")]).start()
    with pytest.raises(ZeroDivisionError, match="oops"):
        box.take(5)
