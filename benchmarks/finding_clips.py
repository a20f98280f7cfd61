"""`evaluate regions --clips`: hands found in the scenario suite and in short clips of one difficulty each."""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from lightgesture.benchmarks.accuracy import Report
from lightgesture.benchmarks.difficulties import GLOVES, difficulty_takes, profile_take
from lightgesture.benchmarks.finding import selector_method
from lightgesture.benchmarks.finding_suite import clip_tables, find_in_clips, missed_sheets
from lightgesture.benchmarks.methods import Method
from lightgesture.benchmarks.suite import choose_takes, synthetic_takes
from lightgesture.benchmarks.suite_cache import Clip, Take, fetch_clip
from lightgesture.benchmarks.suite_scenarios import LAND, WATER
from lightgesture.features.profile import ColourProfile
from lightgesture.features.profile_learning import learn_profile
from lightgesture.sources import open_source

BOTH = 2
"""Hands of a frame from which a profile is learnt: one without a label would count as something else."""

Progress = Callable[[Iterable[Take], str], Iterable[Take]]
"""Passes takes on and shows how far they are, under a heading."""


def evaluate_clips(
    selectors: Sequence[str], folder: Path, progress: Progress, jobs: int = 1, is_quick: bool = False
) -> Report:
    """Every selector in every clip; on gloves also with a colour profile that was learnt from other frames of them.

    folder: the cache; jobs: processes that render what it lacks; is_quick: every fifth clip of the suite. Raises
    lightgesture.features.find.selector_file.SelectorError.
    """
    methods = [selector_method(selector) for selector in selectors]

    def methods_for(clip: Clip) -> list[Method]:
        if clip.scenario.difficulty != GLOVES:
            return [*methods]
        profile = glove_profile(fetch_clip(profile_take(clip.scenario), folder))
        return [*methods, *(selector_method(selector, profile=profile) for selector in selectors)]

    takes = choose_takes([*synthetic_takes(WATER), *synthetic_takes(LAND)], (), is_quick)
    suite = find_in_clips(lambda _: methods, takes, folder, progress, jobs)
    alone = find_in_clips(methods_for, difficulty_takes(), folder, progress, jobs)
    return Report(tuple(clip_tables(suite, alone)), {}, missed_sheets([*suite, *alone]))


def glove_profile(clip: Clip) -> ColourProfile:
    """What `learn_profile` makes of the frames of a clip in which both hands are labelled."""
    with open_source(str(clip.video)) as source:
        shown = [(frame.image, clip.labels[frame.index]) for frame in source]
    known = [(image, [label.box for label in labels]) for image, labels in shown if len(labels) == BOTH]
    return learn_profile(
        [image for image, _ in known], [boxes for _, boxes in known], "glove", f"clip {clip.scenario.name}"
    )
