"""What steps of a task work with, in tests."""

from concurrent.futures import Future

import numpy as np

from lightgesture.vehicle import (
    Reply,
    Status,
)

IMAGE = np.zeros((8, 8, 3), np.uint8)
START_S = 16.0


class Bench:
    """What a step works with; a helper that works at once, or not before it is told to.

    answer: what becomes of an order.
    """

    def __init__(self, answer="accepted", interval_s=None, value=None):
        self.vehicle, self.helper = self, self
        self.orders, self.waiting, self.is_slow = [], [], False
        self.answer, self.interval_s, self.cap = answer, interval_s, 0.4
        self.status, self.frame, self.value = Status(), None, value

    def order(self, order, now_s):
        self.orders.append(order)
        return Reply(state=self.answer, detail="as it says", value=self.value)

    def start(self, work):
        future = Future()
        self.waiting.append((future, work))
        if not self.is_slow:
            self.work()
        return future

    def work(self):
        for future, work in self.waiting:
            try:
                future.set_result(work())
            except Exception as error:
                future.set_exception(error)
        self.waiting = []
