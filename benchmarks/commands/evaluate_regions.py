"""`lightgesture evaluate regions`: hands found by every selector, and with `--model` what is read of them."""

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from lightgesture.benchmarks.progress import Progress
from lightgesture.console import say
from lightgesture.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lightgesture.benchmarks.accuracy import Report
    from lightgesture.features.find.selector import SelectorName

OPTIONS = ("selector", "fold", "compare", "clips", "ablation")
"""Options that only this target has."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this target."""
    parser.add_argument(
        "--selector",
        action="append",
        metavar="NAME|PATH",
        help="what finds the hands (repeatable): with regions names or selector files, default: every name; with "
        "divers likewise, default: learned; with suite names, default: learned",
    )
    parser.add_argument(
        "--fold",
        action="append",
        metavar="FILE",
        help="with regions: a selector file that was trained with --fold or --without; all such files together are "
        "scored on the sources that they did not see, those of webcam/train too; with divers: on such dives "
        "(repeatable)",
    )
    parser.add_argument(
        "--compare",
        action="append",
        metavar="FILE",
        help="with regions: JSON Lines of boxes that another program found, as further rows (repeatable)",
    )
    parser.add_argument(
        "--clips",
        action="store_true",
        help="with regions: also on the suite's clips and on short ones of one difficulty each, rendered at first",
    )
    parser.add_argument(
        "--ablation",
        action="store_true",
        help="with regions: also what each stage buys, by variants of both selectors that do without it; with --clips "
        "on the short clips too",
    )


def named_selectors(args: argparse.Namespace) -> "Sequence[SelectorName]":
    """The selectors of the whole chain, which are known by name only. UsageError: there is no such selector."""
    from lightgesture.features.find.selector import SELECTORS

    named = args.selector or SELECTORS[:1]
    if unknown := [name for name in named if name not in SELECTORS]:
        raise UsageError(f"--selector {unknown[0]}: with suite it must be {' or '.join(SELECTORS)}")
    return [selector for name in named for selector in SELECTORS if selector == name]


def find_hands(args: argparse.Namespace, data: Path, progress: Progress) -> "Iterator[Report]":
    """Score the finding of hands, one report after the other. UsageError: a selector file is damaged."""
    from lightgesture.features.find.selector_file import SelectorError

    try:
        yield from _reports(args, data, progress)
    except SelectorError as error:
        raise UsageError(str(error)) from error


def _reports(args: argparse.Namespace, data: Path, progress: Progress) -> "Iterator[Report]":
    from lightgesture.benchmarks.finding.report import FindingRequest, evaluate_finding
    from lightgesture.benchmarks.suite.cache import cache_folder
    from lightgesture.features.find.selector import SELECTORS

    selectors = args.selector or SELECTORS
    request = FindingRequest(
        selectors=selectors,
        left_out=args.fold or (),
        by=[name for name in selectors if name in SELECTORS],
        recorded=args.compare or (),
    )
    yield evaluate_finding(request, data, progress, say)
    if args.clips:
        from lightgesture.benchmarks.finding.clips import evaluate_clips

        yield evaluate_clips(selectors, cache_folder(), progress, args.jobs, args.quick)
    if args.ablation:
        from lightgesture.benchmarks.finding.ablation import evaluate_ablation

        yield evaluate_ablation(data, progress, cache_folder() if args.clips else None, args.jobs)
