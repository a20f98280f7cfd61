"""`python -m lightgesture.benchmarks.interaction`: the paper's comparison of three ways to speak to a robot.

Ten people (two beginners, seven medium, one expert), as in the paper, say four instructions and two scenarios with hand
signs, cards and moved cards. Their times and slips follow models (`users`); each of their tries is rendered and read.
"""

import argparse
import multiprocessing
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from lightgesture.benchmarks.interaction.report import draw_study, trials_table
from lightgesture.benchmarks.interaction.trials import Trial, TrialKey, run_trial
from lightgesture.benchmarks.interaction.users import KINDS, PEOPLE, TASKS, WAYS


def trial_keys(is_quick: bool = False) -> list[TrialKey]:
    """All trials of the study, one person of each kind if quick."""
    return [
        TrialKey(skill, person, way, kind, task)
        for skill, people in PEOPLE.items()
        for person in range(1 if is_quick else people)
        for kind in KINDS
        for task in range(len(TASKS[kind]))
        for way in WAYS
    ]


def run_trials(keys: Sequence[TrialKey], jobs: int) -> Iterator[Trial]:
    """Every trial, by so many processes."""
    if jobs <= 1:
        yield from map(run_trial, keys)
        return
    with ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn")) as pool:
        yield from pool.map(run_trial, keys)


def main() -> None:
    """Run the study, print its table, draw its picture."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="processes; default 1")
    parser.add_argument("--quick", action="store_true", help="one person of each kind in place of ten")
    parser.add_argument("--picture", type=Path, default=None, metavar="FILE.png", help="draw it too")
    args = parser.parse_args()
    trials = []
    for trial in run_trials(trial_keys(args.quick), args.jobs):
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
