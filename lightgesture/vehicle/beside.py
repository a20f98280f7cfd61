"""What runs beside the task: pictures and parameters, of each kind one at a time, the others in a queue."""

from collections import deque
from typing import Final

from lightgesture.vehicle.bench import Bench
from lightgesture.vehicle.guard import Fault
from lightgesture.vehicle.task import Plan, Say, Task

MOST_WAITING: Final = 4
"""Instructions that wait for one of their kind to end; one more is refused."""


class Beside:
    """Tasks that leave the vehicle's motion alone."""

    def __init__(self, bench: Bench, say: Say) -> None:
        self._bench, self._say = bench, say
        self._tasks: list[Task] = []
        self._waiting: deque[Plan] = deque()

    @property
    def takes_pictures(self) -> bool:
        """Whether pictures are being taken, or will be."""
        plans = [*(task.plan for task in self._tasks), *self._waiting]
        return any(plan.takes_pictures for plan in plans)

    def add(self, plan: Plan, now_s: float) -> None:
        """Begin, or wait for one of the same action to end."""
        action = plan.record.action
        if not self._is_running(action):
            self._begin(plan, now_s)
        elif len(self._waiting) < MOST_WAITING:
            self._waiting.append(plan)
            self._say("accepted", plan.record.text, f"begins when {action} is done")
        else:
            self._say("refused", plan.record.text, f"{MOST_WAITING} others wait for {action} already")

    def tick(self, now_s: float) -> None:
        """Go on with all."""
        for task in self._tasks:
            task.tick(self._bench, now_s)
        self._tasks = [task for task in self._tasks if not task.is_over]
        for plan in list(self._waiting):
            if not self._is_running(plan.record.action):
                self._waiting.remove(plan)
                self._begin(plan, now_s)

    def stop(self, found: Fault, now_s: float) -> None:
        """End all, and what waits."""
        for task in self._tasks:
            task.stop(self._bench, now_s, found)
        for plan in self._waiting:
            self._say("aborted", plan.record.text, found.reason)
        self._tasks.clear()
        self._waiting.clear()

    def _is_running(self, action: str) -> bool:
        return any(task.plan.record.action == action for task in self._tasks)

    def _begin(self, plan: Plan, now_s: float) -> None:
        task = Task(plan, self._say, self._bench.status, now_s)
        self._tasks.append(task)
        task.begin(self._bench, now_s)
