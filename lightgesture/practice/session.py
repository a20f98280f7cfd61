"""The course of a practice: records in, what was signed, misread and mistaken out. No clock and no picture."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Final

from lightgesture.fsm import Grammar, Instruction, Notice, Rejected, State, Word
from lightgesture.practice.tasks import Task
from lightgesture.records import FrameRecord, Record
from lightgesture.signs.sentences import SignedWord, split_words

STEADY_S: Final = 0.3
"""Seconds for which a hand must be read alike to count as a reading: shorter ones are passages from sign to sign."""

NOT_READ: Final = "not read"
"""Stands for a hand that was in view and got no token."""

SIDES: Final = ("left", "right")


@dataclass(frozen=True, slots=True)
class Mistake:
    """What went wrong, at which word, when (seconds of the stream).

    reason: that of the rejection or the notice, "wrong_word" where a word was read that was not asked for,
    "other_sentence" where another sentence was issued, "time" where the time was over. is_fatal: the sentence had to be
    begun again; else only this sign.
    """

    reason: str
    detail: str
    word: str
    time_s: float
    is_fatal: bool


@dataclass(slots=True)
class Progress:
    """One task. seconds: of each sign until it was read, None where it was not; total_s: of the whole, from the first
    hand in view; None: it was not finished."""

    task: Task
    seconds: list[float | None] = field(default_factory=list)
    mistakes: list[Mistake] = field(default_factory=list)
    total_s: float | None = None
    is_done: bool = False
    place: int = 0
    started_s: float | None = None

    @property
    def fatal(self) -> int:
        """Mistakes after which the sentence was begun again: the paper's measure."""
        return sum(mistake.is_fatal for mistake in self.mistakes)

    @property
    def slips(self) -> int:
        """Signs that were shown again and did not cost the sentence."""
        return len(self.mistakes) - self.fatal


class _Steady:
    """How long a hand has been read alike."""

    def __init__(self) -> None:
        self.read: str | None = None
        self._since_s = 0.0
        self._is_told = False

    def look(self, read: str | None, time_s: float) -> str | None:
        """The reading once it is steady, and only then; None otherwise. read: None where the hand is not in view."""
        if read != self.read or time_s < self._since_s:
            self.read, self._since_s, self._is_told = read, time_s, False
        if read is None or self._is_told or time_s - self._since_s < STEADY_S:
            return None
        self._is_told = True
        return read


class Session:
    """Leads through tasks.

    limit_s: seconds after which a task is given up, from the first hand in view. is_revised: words may be taken back,
    as by the rule "sentence". wants_fresh: the open sentence is of no use any more; who runs the decoder lets it drop
    it, and calls `freshened`.
    """

    def __init__(self, tasks: Sequence[Task], grammar: Grammar, limit_s: float, is_revised: bool) -> None:
        self.progress = [Progress(task, [None] * len(task.sentence.signs)) for task in tasks]
        self.confusions: Counter[tuple[str, str]] = Counter()
        self.readings: Counter[str] = Counter()
        self.number = 0
        self.wants_fresh = False
        self.last: tuple[str, str] | None = None
        self._grammar, self._limit_s, self._is_revised = grammar, limit_s, is_revised
        self._steady = {side: _Steady() for side in SIDES}
        self._touched_s = self._now_s = 0.0
        self._shown: tuple[str, ...] | None = None

    @property
    def is_done(self) -> bool:
        """Whether no task is left."""
        return self.number == len(self.progress)

    @property
    def current(self) -> Progress | None:
        """The task that is being signed."""
        return None if self.is_done else self.progress[self.number]

    @property
    def asked(self) -> SignedWord | None:
        """The sign that is to be shown now."""
        current = self.current
        return None if current is None else current.task.sentence.signs[current.place]

    @property
    def elapsed_s(self) -> float:
        """Seconds since the first hand came into view in this task."""
        current = self.current
        return 0.0 if current is None or current.started_s is None else self._now_s - current.started_s

    def freshened(self) -> None:
        """The decoder has dropped the open sentence."""
        self.wants_fresh = False

    def take(self, records: Iterable[Record]) -> None:
        """The records of one frame."""
        for record in records:
            current = self.current
            if current is None:
                return
            match record:
                case FrameRecord(time_s=float() as time_s):
                    self._see(current, record, time_s)
                case State(dwell=dwell):
                    self._shown = self._shown if dwell is None else dwell.pair
                case Word():
                    self._hear(current, record)
                case Instruction():
                    self._conclude(current, record)
                case Rejected():
                    if not self.wants_fresh:
                        self._fail(current, record.reason, record.detail, record.time_s)
                case Notice(reason=reason) if reason not in ("gap", "confirm"):
                    self._slip(current, record)
                case _:
                    pass

    def _see(self, current: Progress, record: FrameRecord, time_s: float) -> None:
        self._now_s = time_s
        hands = {hand.side: hand.token or NOT_READ for hand in record.hands}
        if hands and current.started_s is None:
            current.started_s = self._touched_s = time_s
        for place, side in enumerate(SIDES):
            read = self._steady[side].look(hands.get(side), time_s)
            if read is not None:
                self._count(current, place, read)
        if current.started_s is not None and time_s - current.started_s > self._limit_s:
            self._fail(current, "time", f"not signed within {self._limit_s:g} s", time_s)
            self._next()

    def _count(self, current: Progress, place: int, read: str) -> None:
        """A steady reading of the hand at this place of the pair, against what was asked for."""
        asked = current.task.sentence.signs[current.place].pair[place]
        before = self._before(current)
        # The last sign is held on for a moment; that is no confusion.
        if read != asked and before is not None and read == before.pair[place]:
            return
        self.readings[asked] += 1
        if read != asked:
            self.confusions[asked, read] += 1

    def _before(self, current: Progress) -> SignedWord | None:
        """The sign before the one that is asked for, that of the last task included."""
        if current.place:
            return current.task.sentence.signs[current.place - 1]
        return self.progress[self.number - 1].task.sentence.signs[-1] if self.number else None

    def _hear(self, current: Progress, word: Word) -> None:
        signs = current.task.sentence.signs
        if word.state == "idle":  # the end word: what comes of the sentence follows
            return
        words = split_words(self._grammar, word.state)
        wanted = [sign.word for sign in signs[: len(words)]]
        agreed = next(
            (n for n, pair in enumerate(zip(words, wanted, strict=False)) if pair[0] != pair[1]), len(wanted)
        )
        if agreed == len(words):
            if agreed > current.place:
                current.seconds[agreed - 1] = round(word.time_s - self._touched_s, 3)
            current.place, self._touched_s = min(agreed, len(signs) - 1), word.time_s
        elif not self._is_revised:
            self._fail(
                current,
                "wrong_word",
                f"{word.word} was read instead of {signs[current.place].word}",
                word.time_s,
            )

    def _conclude(self, current: Progress, instruction: Instruction) -> None:
        if instruction.text != current.task.sentence.text:
            self._fail(current, "other_sentence", f"{instruction.text} was issued", instruction.time_s)
            return
        start_s = instruction.time_s if current.started_s is None else current.started_s
        current.seconds[-1] = round(instruction.time_s - self._touched_s, 3)
        current.total_s, current.is_done = round(instruction.time_s - start_s, 3), True
        self.last = ("right", f"{instruction.text} in {current.total_s:.1f} s")
        self._next()

    def _fail(self, current: Progress, reason: str, detail: str, time_s: float) -> None:
        word = current.task.sentence.signs[current.place].word
        current.mistakes.append(Mistake(reason, detail, word, round(time_s, 3), is_fatal=True))
        self.last = ("mistake", detail)
        # Only an open sentence is dropped; after a rejection there is none.
        self.wants_fresh = reason in ("wrong_word", "time")
        current.place, self._touched_s = 0, time_s

    def _slip(self, current: Progress, notice: Notice) -> None:
        word = current.task.sentence.signs[current.place].word
        detail = notice.detail
        if notice.reason == "unknown_pair" and self._shown is not None:
            detail = f"{','.join(self._shown)} was read for {word}, and is no word; show it again"
        current.mistakes.append(Mistake(notice.reason, detail, word, round(notice.time_s, 3), is_fatal=False))
        self.last = ("slip", detail)

    def _next(self) -> None:
        self.number += 1
