"""The study's tables and its picture, beside the paper's own table of mistakes."""

from collections.abc import Sequence
from pathlib import Path

from lightgesture.benchmarks.interaction.trials import Trial
from lightgesture.benchmarks.interaction.users import (
    KINDS,
    NAMES,
    PAPER_MISTAKES,
    USERS,
    WAYS,
    Kind,
    Skill,
    Way,
)
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.results.atomic import replacing

COLOURS = {"hands": "#2a9d4a", "tags": "#1f77b4", "tag-motion": "#d95f02"}


def trials_table(trials: Sequence[Trial]) -> Table:
    """One row a kind of user, a kind of instruction and a way, per person and both tasks of the kind."""
    rows: list[dict[str, Cell]] = []
    for skill in USERS:
        for kind in KINDS:
            for way in WAYS:
                chosen = _of(trials, skill, kind, way)
                people = len({trial.person for trial in chosen})
                if not people:
                    continue
                rows.append(
                    {
                        "user": skill,
                        "instructions": kind,
                        "way": NAMES[way],
                        "people": people,
                        "seconds": round(sum(trial.seconds for trial in chosen) / people, 1),
                        "slips": round(sum(trial.slips for trial in chosen) / people, 2),
                        "misread": round(sum(trial.misread for trial in chosen) / people, 2),
                        "paper": PAPER_MISTAKES[skill][kind][WAYS.index(way)],
                        "wrong_by_slip": sum(trial.wrong_slips for trial in chosen),
                        "wrong_by_reading": sum(trial.wrong_misread for trial in chosen),
                        "given_up": sum(not trial.is_done for trial in chosen),
                    }
                )
    columns = tuple(rows[0]) if rows else ("user",)
    note = (
        "seconds, slips, misread: per person over both tasks of a kind, all tries; misread: tries without a slip "
        "that were not issued;\npaper: mistakes before success in the paper's own table; wrong: instructions in all "
        "that were not meant."
    )
    return Table("interaction", "The paper's study by simulated users", columns, tuple(rows), note)


def draw_study(trials: Sequence[Trial], path: Path) -> None:
    """Time and mistakes as bars, one group a kind of instruction, one row a kind of user. OSError: it cannot be
    written."""
    from matplotlib.figure import Figure

    skills: list[Skill] = [skill for skill in USERS if any(trial.skill == skill for trial in trials)]
    figure = Figure(figsize=(9.0, 2.6 * len(skills) + 0.6), layout="constrained")
    axes = figure.subplots(len(skills), 2, squeeze=False, sharex=True)
    for row, skill in enumerate(skills):
        times, mistakes = axes[row]
        most = 1.0
        for place, way in enumerate(WAYS):
            where = [order + 0.27 * (place - 1) for order in range(len(KINDS))]
            people = [
                max(len({trial.person for trial in _of(trials, skill, kind, way)}), 1) for kind in KINDS
            ]
            per = [
                [
                    _sum(trials, name, skill, kind, way) / count
                    for kind, count in zip(KINDS, people, strict=True)
                ]
                for name in ("seconds", "slips", "misread")
            ]
            times.bar(where, per[0], 0.25, color=COLOURS[way], label=NAMES[way])
            mistakes.bar(where, per[1], 0.25, color=COLOURS[way])
            mistakes.bar(where, per[2], 0.25, bottom=per[1], color=COLOURS[way], alpha=0.4, hatch="//")
            paper = [PAPER_MISTAKES[skill][kind][place] for kind in KINDS]
            mistakes.plot(where, paper, "k_", markersize=12, markeredgewidth=2)
            most = max([most, *paper, *(a + b for a, b in zip(per[1], per[2], strict=True))])
        mistakes.set_ylim(0.0, 1.1 * most)
        times.set_ylabel(f"{skill}\nseconds")
        mistakes.set_ylabel("mistakes")
        for one in (times, mistakes):
            one.set_xticks(range(len(KINDS)), KINDS)
            one.grid(axis="y", color="#e5e5e5")
            one.set_axisbelow(True)
    axes[0][0].legend(frameon=False)
    axes[0][0].set_title("time until success")
    axes[0][1].set_title("slips; hatched: misread; line: the paper")
    with replacing(path) as temporary:
        figure.savefig(temporary, format="png", dpi=100)


def _of(trials: Sequence[Trial], skill: Skill, kind: Kind, way: Way) -> list[Trial]:
    return [trial for trial in trials if (trial.skill, trial.kind, trial.way) == (skill, kind, way)]


def _sum(trials: Sequence[Trial], name: str, skill: Skill, kind: Kind, way: Way) -> float:
    return float(sum(getattr(trial, name) for trial in _of(trials, skill, kind, way)))
