"""How many of the paper's sentences come through with cards, and with two cards that are moved.

`python -m lightgesture.benchmarks.cards.suite` renders 30 sentences under water and 20 on land, each way, reads them
with the product's own pipeline and prints tables. It takes half an hour of one core; clips stay in the user's cache.
"""

import argparse
import json
import multiprocessing
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import cv2

from lightgesture import Pipeline
from lightgesture.benchmarks.cards.scenes import SIGNINGS, SUITES, CardTake, clip_of, takes_of
from lightgesture.benchmarks.suite.cache import cache_folder
from lightgesture.benchmarks.suite.scoring import align, score_instructions
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.features.tags.detector import DetectorName
from lightgesture.sources import open_source
from lightgesture.synth.script import sentence_words

QUICK_STEP = 5
"""A quick run takes every fifth clip."""


@dataclass(frozen=True, slots=True)
class CardAnswer:
    """What came of one clip. readable: sentences that a flawless reader gets. tags, tags_read: in view by the truth,
    and those read with their id; tags_wrong: read and not there. frame_ms: the median of a frame."""

    take: CardTake
    issued: tuple[str, ...]
    rejected: tuple[str, ...]
    words: tuple[str, ...]
    readable: int
    tags: int
    tags_read: int
    tags_wrong: int
    frames: int
    frame_ms: float

    @property
    def counts(self) -> tuple[int, int, int]:
        """Sentences issued as they were shown, issued and not shown, and missed."""
        return score_instructions(self.take.scenario.sentences, self.issued)

    @property
    def words_right(self) -> int:
        """Words accepted in their place."""
        return len(align(self.words_shown, self.words))

    @property
    def words_shown(self) -> list[str]:
        """Words of the sentences."""
        return [word for sentence in self.take.scenario.sentences for word in sentence_words(sentence)]


def run_take(take: CardTake, folder: Path, detector: DetectorName = "aruco") -> CardAnswer:
    """Render a clip, or take it from the folder, and read it."""
    cv2.setNumThreads(1)
    video = clip_of(take, folder)
    truth = [
        json.loads(line) for line in video.with_suffix(".jsonl").read_text(encoding="utf-8").splitlines()
    ]
    shown = [record["signs"] for record in truth if record["type"] == "frame"]
    records: list[dict[str, Any]] = []
    with (
        open_source(str(video)) as source,
        Pipeline(front_end=take.signing, tag_detector=detector) as pipeline,
    ):
        for frame in source:
            records += [
                record.to_dict() for record in pipeline.process(frame.image, frame.time_s, frame.index)
            ]
        records += [record.to_dict() for record in pipeline.finish()]
    seen = [record["signs"] for record in records if record["type"] == "frame"]
    pairs = [
        ({sign["id"] for sign in a}, {sign["id"] for sign in b}) for a, b in zip(shown, seen, strict=True)
    ]
    known = {record["id"] for signs in shown for record in signs}
    texts = {
        kind: tuple(one["text"] for one in records if one["type"] == kind)
        for kind in ("instruction", "rejected")
    }
    return CardAnswer(
        take,
        issued=texts["instruction"],
        rejected=texts["rejected"],
        words=tuple(record["word"] for record in records if record["type"] == "word"),
        readable=sum(record["type"] == "instruction" for record in truth),
        tags=sum(len(a) for a, _ in pairs),
        tags_read=sum(len(a & b) for a, b in pairs),
        # A card that is put away may still be read while the truth calls it too far turned.
        tags_wrong=sum(len(b - known) for _, b in pairs),
        frames=len(seen),
        frame_ms=records[-1]["ms_per_frame"]["median"],
    )


def run_takes(
    takes: Sequence[CardTake], folder: Path, jobs: int, detector: DetectorName
) -> Iterator[CardAnswer]:
    """Every take, by so many processes."""
    folder.mkdir(parents=True, exist_ok=True)
    work = partial(run_take, folder=folder, detector=detector)
    if jobs <= 1:
        yield from map(work, takes)
        return
    with ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn")) as pool:
        yield from pool.map(work, takes)


def suite_table(answers: Sequence[CardAnswer], key: str) -> Table:
    """One row a way of signing and suite, or difficulty. key: "suite" or "difficulty"."""
    groups: dict[tuple[str, str], list[CardAnswer]] = {}
    for answer in answers:
        groups.setdefault((answer.take.signing, getattr(answer.take.scenario, key)), []).append(answer)
    rows: list[dict[str, Cell]] = []
    for (signing, name), group in groups.items():
        right, wrong, missed = (sum(answer.counts[place] for answer in group) for place in range(3))
        tags = sum(answer.tags for answer in group)
        rows.append(
            {
                "front_end": signing,
                key: name,
                "sentences": len(group),
                "readable": sum(answer.readable for answer in group),
                "right": right,
                "wrong": wrong,
                "missed": missed,
                "words": sum(len(answer.words_shown) for answer in group),
                "words_right": sum(answer.words_right for answer in group),
                "tags_read": round(sum(answer.tags_read for answer in group) / max(tags, 1), 3),
                "tags_wrong": sum(answer.tags_wrong for answer in group),
                "frames": sum(answer.frames for answer in group),
            }
        )
    return Table(f"cards_{key}", f"Sentences of cards by {key}", tuple(rows[0]), tuple(rows))


def missed_table(answers: Sequence[CardAnswer]) -> Table:
    """The clips that were not read as shown."""
    rows: list[dict[str, Cell]] = [
        {
            "front_end": answer.take.signing,
            "clip": answer.take.scenario.name,
            "difficulty": answer.take.scenario.difficulty,
            "shown": " ".join(answer.take.scenario.sentences),
            "issued": "; ".join(answer.issued) or "none",
            "words": " ".join(answer.words) or "none",
        }
        for answer in answers
        if answer.counts[1] or answer.counts[2]
    ]
    columns = ("front_end", "clip", "difficulty", "shown", "issued", "words")
    return Table("cards_missed", "Clips not read as shown", columns, tuple(rows))


def main() -> None:
    """Render, read, print."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="processes; default 1")
    parser.add_argument("--only", choices=SIGNINGS, action="append", help="one way of signing")
    parser.add_argument("--suite", choices=SUITES, action="append", help="one suite")
    parser.add_argument("--quick", action="store_true", help="every fifth clip")
    parser.add_argument(
        "--tag-detector", choices=("aruco", "apriltag"), default="aruco", help="what finds the tags"
    )
    parser.add_argument(
        "--clips", type=Path, default=None, metavar="DIR", help="folder of the clips; default the cache"
    )
    args = parser.parse_args()
    takes = [
        take
        for signing in args.only or SIGNINGS
        for suite in args.suite or SUITES
        for take in takes_of(signing, suite)
    ]
    folder = args.clips or cache_folder().parent / "cards"
    answers = []
    for answer in run_takes(takes[:: QUICK_STEP if args.quick else 1], folder, args.jobs, args.tag_detector):
        right, wrong, _ = answer.counts
        mark = "wrong" if wrong else "right" if right else "missed"
        print(f"{answer.take.signing} {answer.take.scenario.name} {mark}", flush=True)
        answers.append(answer)
    for table in (suite_table(answers, "suite"), suite_table(answers, "difficulty"), missed_table(answers)):
        if table.rows:
            print(table.to_text())


if __name__ == "__main__":
    main()
