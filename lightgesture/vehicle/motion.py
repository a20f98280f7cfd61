"""A nod or a shake of the vehicle, as an answer to the diver: only while it does nothing else."""

from typing import Literal

from lightgesture.vehicle.bench import Bench
from lightgesture.vehicle.guard import Senses, fault, obstacle, obstacle_to_motion
from lightgesture.vehicle.interface import Status, Stick
from lightgesture.vehicle.profile import MotionTable
from lightgesture.vehicle.sticks import ramped

Word = Literal["nod", "shake"]


def swing(table: MotionTable, word: Word, elapsed_s: float, ramp_s: float, cap: float) -> Stick | None:
    """Where the sticks are `elapsed_s` after the beginning: to one side and to the other, some times; None: over."""
    where = Stick(**(table.nod if word == "nod" else table.shake))
    beat = int(elapsed_s // table.beat_s)
    if beat >= 2 * table.times:
        return None
    share = ramped(elapsed_s - beat * table.beat_s, table.beat_s, min(ramp_s, table.beat_s / 4))
    within = min(1.0, cap / where.largest) if where.largest else 0.0
    return where.scaled(share * within * (1 if beat % 2 == 0 else -1))


class Motion:
    """Moves the vehicle for an answer, under the same guard as any task.

    is_allowed: not after something was broken off, before the next instruction: who wanted it still wants no motion.
    """

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self._word: Word | None = None
        self._begun: tuple[Status, float] | None = None
        self.is_allowed = True

    def ask(self, word: Word) -> None:
        """Answer at the next tick, if that may be; a profile without `[motion]` has no answer."""
        if self.is_allowed and self._bench.profile.motion is not None and self._word is None:
            self._word = word

    def tick(self, senses: Senses, now_s: float) -> None:
        """Go on; what stands against it ends it without a word, for it is an answer and no instruction."""
        table, profile = self._bench.profile.motion, self._bench.profile
        if self._word is None or table is None:
            return
        status = self._bench.status
        if self._begun is None:
            blocked = obstacle(status, senses, now_s, profile) or obstacle_to_motion(
                status, now_s, profile, uses_sticks=True
            )
            self._begun = None if blocked else (status, now_s)
        elif fault(status, *self._begun, senses, now_s, profile, uses_sticks=True) is not None:
            self._begun = None
        stick = None
        if self._begun is not None:
            elapsed_s = now_s - self._begun[1]
            stick = swing(table, self._word, elapsed_s, profile.stick.ramp_s, self._bench.cap)
        if stick is None:
            self.stop(now_s)
        else:
            self._bench.sticks.hold(stick)

    def stop(self, now_s: float) -> None:
        """To the middle, and forget what was asked."""
        if self._begun is not None or self._word is not None:
            self._word = self._begun = None
            self._bench.sticks.release(now_s)
