"""Sentences against single signs: what each rule issues of the suite's clips, of damaged sentences and of idle hands.

`python -m lightgesture.benchmarks.decoder.sentences` reads every clip of the suite once a model, rule and rate, and
lets the decoders work on what was read: right and wrong instructions by part, the curve of caution, sentences damaged
on purpose (`damage`), an hour of idle hands, and milliseconds a frame.
"""

import argparse
import random
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from time import perf_counter

from lightgesture.benchmarks.decoder.damage import KINDS, Damaged, Recorded, damage
from lightgesture.benchmarks.suite.cache import Clip, cache_folder, fetch_clips
from lightgesture.benchmarks.suite.scenarios import NEGATIVE, REAL, SUITES
from lightgesture.benchmarks.suite.scoring import score_instructions
from lightgesture.benchmarks.suite.takes import choose_takes, takes_of
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.console import messages_shown, print_line, say
from lightgesture.fsm import Decoder, Grammar, Pair, Signs, load_grammar
from lightgesture.fsm.language.settings import Rule
from lightgesture.pipeline import Pipeline
from lightgesture.sources import open_source
from lightgesture.training.datasets import Label, find_data

RULES: tuple[Rule, ...] = ("frames", "sentence")
MODELS = ("cnn", "svm")
EVERY = (1, 3)
"""Every so many frames of the clips' 30 a second: 30 and 10."""

CAUTIONS = (0.5, 0.75, 1.0, 1.25, 1.5, 2.0)
FPS = 30.0
SEED = 20261130
IDLE_S = 3600.0

Frames = Iterable[tuple[float, Signs]]


def record(clip: Clip, pipeline: Pipeline, every: int) -> Recorded:
    """What the front end of a pipeline reads of every so many frames of a clip."""
    front = pipeline.front.for_stream()
    times, signs, held = [], [], []
    with open_source(str(clip.video)) as source:
        for frame in source:
            if frame.index % every == 0:
                times.append(frame.time_s)
                signs.append(front.process(frame.image, frame.time_s))
                held.append(_pair(clip.labels[frame.index]))
    scenario = clip.scenario
    sentences = () if scenario.suite == NEGATIVE else tuple(scenario.sentences)
    return Recorded(scenario.name, scenario.suite, sentences, tuple(times), tuple(signs), tuple(held))


def _pair(labels: Sequence[Label]) -> Pair | None:
    tokens = {label.side: label.token for label in labels}
    left, right = tokens.get("left"), tokens.get("right")
    return None if left is None or right is None else (left, right)


def issue(decoder: Decoder, frames: Frames) -> list[str]:
    """The texts that a decoder issues."""
    issued = []
    for frame, (time_s, signs) in enumerate(frames):
        issued += [event.text for event in decoder.step(signs, time_s, frame) if event.type == "instruction"]
    return issued


def new_decoder(grammar: Grammar, rule: Rule, caution: float | None = None) -> Decoder:
    """A decoder by one of RULES, with the hold that it has by default."""
    return Decoder(grammar, rule=rule, caution=caution)


def suite_row(
    clips: Sequence[Recorded], grammar: Grammar, rule: Rule, caution: float | None = None
) -> dict[str, Cell]:
    """Right instructions by part of the suite, and all wrong ones."""
    right: Counter[str] = Counter()
    wrong = 0
    for clip in clips:
        frames = zip(clip.times_s, clip.signs, strict=True)
        found, false, _ = score_instructions(
            clip.sentences, issue(new_decoder(grammar, rule, caution), frames)
        )
        right[clip.suite] += found
        wrong += false
    return {**{suite: right[suite] for suite in SUITES if suite != NEGATIVE}, "wrong": wrong}


def damage_row(
    made: Sequence[Damaged], grammar: Grammar, rule: Rule, caution: float | None = None
) -> tuple[dict[str, Cell], list[Damaged]]:
    """Wrong instructions of damaged sentences by kind, how many right ones, and what led to the wrong ones."""
    wrong: Counter[str] = Counter()
    right = 0
    blamed = []
    for item in made:
        frames = ((frame / FPS, signs) for frame, signs in enumerate(item.frames))
        found, false, _ = score_instructions(item.allowed, issue(new_decoder(grammar, rule, caution), frames))
        right += found
        wrong[item.kind] += false
        blamed += [item] * bool(false)
    total = sum(wrong.values())
    row: dict[str, Cell] = {**{kind: wrong[kind] for kind in KINDS}, "wrong": total}
    row |= {"wrong_percent": 100 * total / len(made), "right": right}
    row["valid"] = sum(len(item.allowed) for item in made)
    return row, blamed


def idle_row(clips: Sequence[Recorded], grammar: Grammar, rule: Rule) -> dict[str, Cell]:
    """Instructions of an hour of clips without signs, in random order before one decoder."""
    idle = [clip for clip in clips if clip.suite == NEGATIVE]
    rng = random.Random(SEED)
    decoder, frame, issued = new_decoder(grammar, rule), 0, 0
    while idle and frame / FPS < IDLE_S:
        for signs in rng.choice(idle).signs:
            issued += sum(event.type == "instruction" for event in decoder.step(signs, frame / FPS, frame))
            frame += 1
    return {"hours": frame / FPS / 3600, "instructions": issued}


def time_row(clips: Sequence[Recorded], grammar: Grammar, rule: Rule, rounds: int = 3) -> dict[str, Cell]:
    """Milliseconds a frame, the least of some rounds, for other work on the cores is not the decoder's."""
    best: list[float] = []
    for _ in range(rounds):
        times = []
        for clip in clips:
            decoder = new_decoder(grammar, rule)
            for frame, (time_s, signs) in enumerate(zip(clip.times_s, clip.signs, strict=True)):
                start = perf_counter()
                decoder.step(signs, time_s, frame)
                times.append((perf_counter() - start) * 1e3)
        best = [min(pair) for pair in zip(best, times, strict=True)] if best else times
    best.sort()
    return {
        "frames": len(best),
        **{
            f"{name}_ms": best[int(len(best) * share)]
            for name, share in (("median", 0.5), ("p95", 0.95), ("p99", 0.99))
        },
    }


PARTS = tuple(suite for suite in SUITES if suite != NEGATIVE)
SLOW_PARTS = tuple(f"{suite}_10" for suite in PARTS)
DAMAGED_NOTE = "right: sound instructions that are left in them and were issued, of `valid`."
TABLES: dict[str, tuple[str, tuple[str, ...], str]] = {
    "suite": ("Instructions of the suite", ("model", "rule", "fps", *PARTS, "wrong"), ""),
    "damaged": (
        "Wrong instructions of sentences damaged on purpose",
        ("model", "rule", "count", *KINDS, "wrong", "wrong_percent", "right", "valid"),
        DAMAGED_NOTE,
    ),
    "caution": (
        "What caution costs, rule sentence",
        (
            "model",
            "caution",
            *PARTS,
            "wrong",
            *SLOW_PARTS,
            "wrong_10",
            "damaged_right",
            "damaged_wrong_percent",
        ),
        "…_10: at 10 frames a second.",
    ),
    "idle": ("Idle hands", ("model", "rule", "hours", "instructions"), ""),
    "time": ("Milliseconds a frame", ("model", "rule", "frames", "median_ms", "p95_ms", "p99_ms"), ""),
    "blamed": (
        "Damaged sentences that led to wrong ones",
        ("model", "rule", "clip", "kind", "shown"),
        "",
    ),
}
"""Table -> its title, columns and note."""


def measure(
    recorded: dict[tuple[str, Rule, int], list[Recorded]], count: int, seed: int = SEED
) -> list[Table]:
    """All tables. recorded: clips by model, rule and step; count: damaged sentences a model."""
    grammar = load_grammar()
    rows: dict[str, list[dict[str, Cell]]] = {name: [] for name in TABLES}
    for (model, rule, every), clips in recorded.items():
        key: dict[str, Cell] = {"model": model, "rule": rule}
        rows["suite"].append({**key, "fps": FPS / every, **suite_row(clips, grammar, rule)})
        if every != 1:
            continue
        made = damage(clips, count, grammar, seed)
        row, items = damage_row(made, grammar, rule)
        rows["damaged"].append({**key, "count": count, **row})
        rows["blamed"] += [
            {**key, "clip": item.name, "kind": item.kind, "shown": _shown(item)} for item in items
        ]
        rows["idle"].append({**key, **idle_row(clips, grammar, rule)})
        rows["time"].append({**key, **time_row(clips[::4], grammar, rule)})
        if rule == "sentence":
            slow = recorded[model, rule, EVERY[-1]]
            rows["caution"] += [{"model": model, **one} for one in caution_rows(clips, slow, made, grammar)]
    return [
        Table(f"sentences_{name}", title, columns, tuple(rows[name]), note)
        for name, (title, columns, note) in TABLES.items()
    ]


def caution_rows(
    clips: Sequence[Recorded], slow: Sequence[Recorded], made: Sequence[Damaged], grammar: Grammar
) -> Iterable[dict[str, Cell]]:
    """What each caution issues of the clips, at 30 and at 10 frames a second, and of what was damaged in them, by the
    rule sentence."""
    for caution in CAUTIONS:
        whole, _ = damage_row(made, grammar, "sentence", caution)
        yield {
            "caution": caution,
            **suite_row(clips, grammar, "sentence", caution),
            **{f"{name}_10": cell for name, cell in suite_row(slow, grammar, "sentence", caution).items()},
            "damaged_right": whole["right"],
            "damaged_wrong_percent": whole["wrong_percent"],
        }


def _shown(item: Damaged) -> str:
    return " ".join(",".join(pair) for pair in item.shown)


def record_suite(
    models: Sequence[str], data: Path | None, is_quick: bool
) -> dict[tuple[str, Rule, int], list[Recorded]]:
    """Every clip of the suite by model, rule and step."""
    takes = choose_takes([take for suite in SUITES for take in takes_of(suite, data)], (), is_quick)
    recorded: dict[tuple[str, Rule, int], list[Recorded]] = {}
    pipelines: dict[tuple[str, Rule], Pipeline] = {
        (model, rule): Pipeline(model=model, rule=rule) for model in models for rule in RULES
    }
    for clip in fetch_clips(takes, cache_folder()):
        say(clip.scenario.name)
        for (model, rule), pipeline in pipelines.items():
            for every in EVERY:
                recorded.setdefault((model, rule, every), []).append(record(clip, pipeline, every))
    return recorded


@messages_shown()
def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.decoder.sentences",
        description="What the rules frames and sentence issue of the suite, of damaged sentences and of idle hands.",
    )
    parser.add_argument(
        "--model", action="append", metavar="cnn|svm|PATH", help="classifier (default: cnn and svm)"
    )
    parser.add_argument("--data", metavar="DIR", help=f"data folder, without which there is no part {REAL}")
    parser.add_argument(
        "--damaged", type=int, default=2000, metavar="N", help="damaged sentences (default 2000)"
    )
    parser.add_argument("--quick", action="store_true", help="every fifth clip")
    args = parser.parse_args(argv)
    recorded = record_suite(args.model or MODELS, find_data(args.data), args.quick)
    print_line(to_text(measure(recorded, args.damaged)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
