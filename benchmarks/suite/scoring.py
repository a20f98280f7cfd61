"""Scoring arithmetic of the scenario suite: sentences against sentences, words against words, tracks against hands.

Pure functions, no I/O, no NumPy. A gesture is right when its word was accepted in its place: accepted words are laid
against the signed ones by their longest common subsequence. An instruction is right when it was issued as it
was signed, wrong when it was issued and not signed, missed when it was signed and not issued.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, fields

from lightgesture.benchmarks.scorer import Reading, Score, matched_readings, percentile, score_frame
from lightgesture.training.datasets import Label


@dataclass(frozen=True, slots=True)
class TimedWord:
    """A word and the time at which it was accepted, seconds."""

    word: str
    time_s: float


@dataclass(frozen=True, slots=True)
class SuiteScore:
    """Counts over clips; scores add up.

    instructions: signed; right, wrong, missed: see the module. readable: signed instructions that a flawless reader
    of every frame would have got, since hands out of view can be read by nobody. gestures, gestures_right: signed
    words and those accepted; gestures_wrong: accepted words that were not signed there. rejected: sentences that the
    decoder refused. hands: boxes, sides and tokens over all frames in which signs are shown. switches: how often a
    hand went on under another track. delays: seconds from the first frame of a sign to its acceptance.
    """

    clips: int = 0
    frames: int = 0
    instructions: int = 0
    readable: int = 0
    right: int = 0
    wrong: int = 0
    missed: int = 0
    gestures: int = 0
    gestures_right: int = 0
    gestures_wrong: int = 0
    rejected: int = 0
    switches: int = 0
    hands: Score = field(default_factory=Score)
    delays: tuple[float, ...] = ()

    def __add__(self, other: "SuiteScore") -> "SuiteScore":
        return SuiteScore(*(getattr(self, item.name) + getattr(other, item.name) for item in fields(self)))

    @property
    def median_delay(self) -> float | None:
        """Median of the delays, None without any."""
        return percentile(self.delays, 50) if self.delays else None


def align(signed: Sequence[str], accepted: Sequence[str]) -> list[tuple[int, int]]:
    """A longest common subsequence as (index in signed, index in accepted), in order."""
    rows, columns = len(signed), len(accepted)
    longest = [[0] * (columns + 1) for _ in range(rows + 1)]
    for row in range(rows - 1, -1, -1):
        for column in range(columns - 1, -1, -1):
            same = signed[row] == accepted[column]
            longest[row][column] = (
                longest[row + 1][column + 1] + 1
                if same
                else max(longest[row + 1][column], longest[row][column + 1])
            )
    pairs: list[tuple[int, int]] = []
    row = column = 0
    while row < rows and column < columns:
        if signed[row] == accepted[column]:
            pairs.append((row, column))
            row, column = row + 1, column + 1
        elif longest[row + 1][column] >= longest[row][column + 1]:
            row += 1
        else:
            column += 1
    return pairs


def accept_delays(shown: Sequence[TimedWord], accepted: Sequence[TimedWord], dwell_s: float) -> list[float]:
    """Seconds from the first frame of each sign to its acceptance, for signs that were accepted.

    shown: words as a flawless reader accepts them, `dwell_s` seconds after their first frame.
    """
    pairs = align([word.word for word in shown], [word.word for word in accepted])
    return [accepted[column].time_s - (shown[row].time_s - dwell_s) for row, column in pairs]


def count_switches(frames: Iterable[tuple[Sequence[Label], Sequence[Reading]]]) -> int:
    """How often a labelled hand is found under another identity than when it was last found.

    The identity is the track, or the side for a method without tracks (IDSW of Bernardin and Stiefelhagen, "Evaluating
    multiple object tracking performance", EURASIP JIVP 2008).
    """
    return len(_switches(frames))


def count_restarts(frames: Iterable[tuple[Sequence[Label], Sequence[Reading]]]) -> int:
    """How many of the switches are to an identity that no hand had before: the track was lost and begun anew."""
    return sum(_switches(frames))


def _switches(frames: Iterable[tuple[Sequence[Label], Sequence[Reading]]]) -> list[bool]:
    """For each switch whether it is a restart."""
    last: dict[str, int | str | None] = {}
    known: set[int | str | None] = set()
    switches = []
    for labels, readings in frames:
        for label, (reading, _) in zip(labels, matched_readings(labels, readings), strict=True):
            if reading is None or label.side is None:
                continue
            identity = reading.side if reading.track is None else reading.track
            if label.side in last and last[label.side] != identity:
                switches.append(identity not in known)
            last[label.side] = identity
            known.add(identity)
    return switches


def score_instructions(signed: Sequence[str], issued: Sequence[str]) -> tuple[int, int, int]:
    """Right, wrong and missed instructions of a clip, whatever their order."""
    common = sum((Counter(signed) & Counter(issued)).values())
    return common, len(issued) - common, len(signed) - common


def score_hands(frames: Iterable[tuple[Sequence[Label], Sequence[Reading]]]) -> Score:
    """Boxes, sides and tokens of the labelled hands; other boxes, as on lowered hands, do not count."""
    return sum((score_frame(labels, readings, complete=False) for labels, readings in frames), Score())
