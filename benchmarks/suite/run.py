"""The scenario suite from end to end: clips rendered or fetched, decoded by every method, scored and tabled.

`lightgesture evaluate suite` is the thin command in front of this module.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from lightgesture.benchmarks.contact_sheet import Image, choose_evenly, draw_tile, save_sheet
from lightgesture.benchmarks.finding.regions import MAX_BOXES
from lightgesture.benchmarks.methods import Decoded, Method
from lightgesture.benchmarks.progress import Progress
from lightgesture.benchmarks.scorer import Reading
from lightgesture.benchmarks.suite.cache import HOLD, Clip, Take, fetch_clips
from lightgesture.benchmarks.suite.scenarios import (
    FPS,
    NEGATIVE,
    Scenario,
)
from lightgesture.benchmarks.suite.scoring import (
    SuiteScore,
    TimedWord,
    accept_delays,
    align,
    count_switches,
    score_hands,
    score_instructions,
)
from lightgesture.sources import open_source
from lightgesture.synth.script import sentence_words
from lightgesture.training.datasets import Label

DWELL_S = (HOLD - 1) / FPS
"""From the first frame of a sign to the one in which a flawless reader accepts it."""


@dataclass(frozen=True, slots=True, eq=False)
class ClipAnswer:
    """What one method made of one clip. tiles: the signs that were not accepted, as pictures to look at."""

    method: str
    scenario: Scenario
    decoded: Decoded
    score: SuiteScore
    tiles: tuple[Image, ...]


def run_suite(
    methods: Sequence[Method], takes: Sequence[Take], folder: Path, progress: Progress, jobs: int = 1
) -> list[ClipAnswer]:
    """Every method on every take; `folder` is the cache, `jobs` the processes that render what it lacks."""
    answers = []
    for _, clip in zip(progress(takes, "suite"), fetch_clips(takes, folder, jobs), strict=True):
        answers += [run_clip(method, clip) for method in methods]
    return answers


def run_clip(method: Method, clip: Clip) -> ClipAnswer:
    """Decode a clip with a fresh memory and the default dwell."""
    stream = method.stream(None)
    seen: list[tuple[tuple[Label, ...], tuple[Reading, ...]]] = []
    tiles: dict[int, Image] = {}
    # A few frames before a flawless reader accepts a sign it is shown at its clearest.
    moments = {round((word.time_s - 0.25 * DWELL_S) * FPS): index for index, word in enumerate(clip.words)}
    with open_source(str(clip.video)) as source:
        for frame in source:
            readings = tuple(stream.process(frame.image, frame.time_s)[:MAX_BOXES])
            labels = clip.labels[frame.index]
            seen.append((labels, readings))
            if frame.index in moments:
                word = clip.words[moments[frame.index]].word
                caption = f"{clip.scenario.name}, {clip.scenario.difficulty}: {word}"
                tiles[moments[frame.index]] = draw_tile(frame.image, labels, readings, caption)
    decoded = stream.finish()
    accepted = {row for row, _ in align([word.word for word in clip.words], decoded.words)}
    return ClipAnswer(
        method.name,
        clip.scenario,
        decoded,
        score_clip(clip, decoded, seen),
        tuple(tile for index, tile in sorted(tiles.items()) if index not in accepted),
    )


def score_clip(
    clip: Clip, decoded: Decoded, seen: Sequence[tuple[Sequence[Label], Sequence[Reading]]]
) -> SuiteScore:
    """The score of one clip. seen: labels and readings, frame by frame."""
    is_negative = clip.scenario.suite == NEGATIVE
    signed = () if is_negative else clip.scenario.sentences
    words = [word for sentence in signed for word in sentence_words(sentence)]
    right, wrong, missed = score_instructions(signed, decoded.instructions)
    gestures_right = len(align(words, decoded.words))
    accepted = [TimedWord(word, time) for word, time in zip(decoded.words, decoded.word_times, strict=True)]
    return SuiteScore(
        clips=1,
        frames=len(seen),
        instructions=len(signed),
        readable=score_instructions(signed, clip.instructions)[0],
        right=right,
        wrong=wrong,
        missed=missed,
        gestures=len(words),
        gestures_right=gestures_right,
        gestures_wrong=len(decoded.words) - gestures_right,
        rejected=decoded.rejected,
        switches=0 if is_negative else count_switches(seen),
        hands=score_hands(() if is_negative else [frame for frame in seen if frame[0]]),
        delays=() if is_negative else tuple(accept_delays(clip.words, accepted, DWELL_S)),
    )


def save_tiles(answers: Sequence[ClipAnswer], folder: Path, warn: Callable[[str], None]) -> list[Path]:
    """A contact sheet per suite and method of the signs that were not accepted; returns the files written."""
    sheets: dict[str, list[Image]] = {}
    for answer in answers:
        name = f"{answer.scenario.suite} {answer.method}".replace(",", "").replace(" ", "_")
        sheets.setdefault(name, []).extend(answer.tiles)
    written = []
    for name, tiles in sheets.items():
        chosen = choose_evenly(len(tiles))
        if len(chosen) < len(tiles):
            warn(f"{name}: shows {len(chosen)} of {len(tiles)} signs that were not accepted")
        if chosen:
            save_sheet(folder / f"{name}.jpg", [tiles[index] for index in chosen])
            written.append(folder / f"{name}.jpg")
    return written
