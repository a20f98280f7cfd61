"""Finding and reading hands in whole frames: one row per method, group of frames and mode.

A frame may be read alone ("single") or, where a group is an ordered sequence, with the memory of the frames
before it ("sequence"). At most two boxes a frame count.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from lightgesture.benchmarks.methods import Decoded, Method
from lightgesture.benchmarks.progress import Progress
from lightgesture.benchmarks.scorer import Reading, Score, score_frame, total
from lightgesture.sources import DEFAULT_FPS, read_picture
from lightgesture.training.datasets import Sample, group_samples, is_sequence

MAX_BOXES = 2
"""A diver has two hands; a method may not win by guessing more boxes."""

SINGLE = "single"
SEQUENCE = "sequence"


@dataclass(frozen=True, slots=True)
class Script:
    """What a sequence shows: the instruction that its signs mean, with the dwell (frames) it is held for."""

    hold: int
    instructions: tuple[str, ...]


SCRIPTS = {"hover": Script(3, ("STOP HOVER GO",))}
"""Sequences that were signed as an instruction; the frames of `hover` are few, so it is held for 3."""


@dataclass(frozen=True, slots=True)
class Answer:
    """The readings of one sample and their score."""

    sample: Sample
    readings: tuple[Reading, ...]
    score: Score

    @property
    def failed(self) -> bool:
        """A labelled hand not found or its token not read, or a box where nothing is."""
        score = self.score
        return self.misfound or score.read < score.tokens

    @property
    def misfound(self) -> bool:
        """A labelled hand not found, or a box where nothing is."""
        return self.score.found < self.score.hands or self.score.extra > 0


@dataclass(frozen=True, slots=True)
class Run:
    """One method over one group in one mode; decoded is None for single pictures and where nothing was read.

    seen: what the method was trained on that the group shows, where that is not as for the shipped models.
    """

    method: str
    group: str
    mode: str
    hold: int | None
    answers: tuple[Answer, ...]
    decoded: Decoded | None
    seen: str | None = None

    @property
    def score(self) -> Score:
        return total(answer.score for answer in self.answers)


def run_methods(methods: Sequence[Method], samples: Sequence[Sample], progress: Progress) -> list[Run]:
    """Every method over every group of samples, sequences in both modes."""
    runs = []
    for group, members in group_samples(samples).items():
        for method in methods:
            shown = progress(members, f"{method.name}: {group}")
            runs.append(run_single(method, group, shown))
            if is_sequence(members):
                shown = progress(members, f"{method.name}: {group}, {SEQUENCE}")
                runs.append(run_sequence(method, group, shown))
    return runs


def run_single(method: Method, group: str, samples: Iterable[Sample]) -> Run:
    """Read every picture alone."""
    answers = [make_answer(sample, method.read(read_picture(sample.path))) for sample in samples]
    return Run(method.name, group, SINGLE, None, tuple(answers), None)


def run_sequence(method: Method, group: str, samples: Iterable[Sample]) -> Run:
    """Read the frames in order with a fresh memory, at the rate of a folder of frames."""
    hold = SCRIPTS[group].hold if group in SCRIPTS else None
    stream = method.stream(hold)
    answers = [
        make_answer(sample, stream.process(read_picture(sample.path), index / DEFAULT_FPS))
        for index, sample in enumerate(samples)
    ]
    return Run(method.name, group, SEQUENCE, hold, tuple(answers), stream.finish())


def make_answer(sample: Sample, readings: Sequence[Reading]) -> Answer:
    """The score of what was found in a picture; boxes beyond MAX_BOXES do not count."""
    counted = tuple(readings[:MAX_BOXES])
    return Answer(sample, counted, score_frame(sample.labels, counted, sample.complete))
