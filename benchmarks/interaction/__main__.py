"""`python -m lightgesture.benchmarks.interaction`: the paper's comparison of three ways to speak to a robot.

Ten people (two beginners, seven medium, one expert), as in the paper, say four instructions and two scenarios with hand
signs, cards and moved cards. Their times and slips follow models (`users`); each of their tries is rendered and read.
"""

import argparse
import json
import multiprocessing
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from functools import partial
from pathlib import Path

from lightgesture.benchmarks.interaction.report import draw_study, trials_table
from lightgesture.benchmarks.interaction.trials import Trial, TrialKey, run_trial
from lightgesture.benchmarks.interaction.users import KINDS, PEOPLE, TASKS, WAYS


def trial_keys(is_quick: bool = False) -> list[TrialKey]:
    """All trials of the study, one person of each kind if quick; these come first."""
    return [
        TrialKey(skill, person, way, kind, task)
        for person in range(1 if is_quick else max(PEOPLE.values()))
        for skill, people in PEOPLE.items()
        if person < people
        for kind in KINDS
        for task in range(len(TASKS[kind]))
        for way in WAYS
    ]


def run_trials(keys: Sequence[TrialKey], jobs: int, is_rendered: bool = True) -> Iterator[Trial]:
    """Every trial, by so many processes. is_rendered: as of `run_trial`."""
    work = partial(run_trial, is_rendered=is_rendered)
    if jobs <= 1 or not is_rendered:
        yield from map(work, keys)
        return
    with ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn")) as pool:
        yield from pool.map(work, keys)


def kept_trials(path: Path | None) -> list[Trial]:
    """The trials of a file, one JSON object a line; none where it is not there yet. SystemExit: it holds others."""
    if path is None or not path.exists():
        return []
    try:
        return [Trial(**json.loads(line)) for line in path.read_text(encoding="utf-8").splitlines()]
    except (ValueError, TypeError) as error:
        raise SystemExit(f"{path}: holds no trials of this study ({error}); name another file") from None


def keep(trial: Trial, path: Path | None) -> None:
    """Add a trial to a file, if there is one."""
    if path is not None:
        with path.open("a", encoding="utf-8") as stream:
            stream.write(json.dumps(asdict(trial)) + "\n")


def main() -> None:
    """Run the study, print its table, draw its picture."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="processes; default 1")
    parser.add_argument("--quick", action="store_true", help="one person of each kind in place of ten")
    parser.add_argument(
        "--models", action="store_true", help="the users' models alone: nothing is drawn, nothing misread"
    )
    parser.add_argument("--picture", type=Path, default=None, metavar="FILE.png", help="draw it too")
    parser.add_argument(
        "--results",
        type=Path,
        default=None,
        metavar="FILE.jsonl",
        help="keep each trial there; those that are there are not run again (another file after a change of code)",
    )
    args = parser.parse_args()
    if args.models and args.results is not None:
        parser.error("--results keeps what was read; leave out --models or --results")
    kept = {trial.key: trial for trial in kept_trials(args.results)}
    keys = trial_keys(args.quick)
    trials = [kept[key] for key in keys if key in kept]
    for trial in run_trials([key for key in keys if key not in kept], args.jobs, not args.models):
        keep(trial, args.results)
        print(
            f"{trial.skill} {trial.person} {trial.way} {trial.kind} {trial.task}: {trial.tries} tries",
            flush=True,
        )
        trials.append(trial)
    print(trials_table(trials).to_text())
    if args.picture is not None:
        draw_study(trials, args.picture)


if __name__ == "__main__":
    main()
