"""`lightgesture evaluate regions`: hands found by every selector, and with `--model` what is read of them."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from lightgesture.console import say
from lightgesture.errors import UsageError

if TYPE_CHECKING:
    from lightgesture.benchmarks.accuracy import Report
    from lightgesture.benchmarks.regions import Progress

OPTIONS = ("selector", "fold", "compare")
"""Options that only this target has."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this target."""
    parser.add_argument(
        "--selector",
        action="append",
        metavar="NAME|PATH",
        help="with regions: what finds the hands, by name, or a selector file (repeatable; default: every name)",
    )
    parser.add_argument(
        "--fold",
        action="append",
        metavar="FILE",
        help="with regions: a selector file that was trained with --fold or --without; all such files together are "
        "scored on the sources that they did not see, those of webcam/train too (repeatable)",
    )
    parser.add_argument(
        "--compare",
        action="append",
        metavar="FILE",
        help="with regions: JSON Lines of boxes that another program found, as further rows (repeatable)",
    )


def find_hands(args: argparse.Namespace, data: Path, progress: "Progress") -> "Report":
    """Score the finding of hands on the pictures of a data folder. UsageError: a selector file is damaged."""
    from lightgesture.benchmarks.finding_report import FindingRequest, evaluate_finding
    from lightgesture.features.selector import SELECTORS
    from lightgesture.features.selector_file import SelectorError

    selectors = args.selector or SELECTORS
    request = FindingRequest(
        selectors=selectors,
        left_out=args.fold or (),
        by=[name for name in selectors if name in SELECTORS],
        recorded=args.compare or (),
    )
    try:
        return evaluate_finding(request, data, progress, say)
    except SelectorError as error:
        raise UsageError(str(error)) from error
