"""`lightgesture evaluate`: score the models and the whole chain on labelled pictures."""

import argparse
import json
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from lightgesture.console import print_line, say
from lightgesture.errors import ExitStatus, InputError, UsageError

if TYPE_CHECKING:
    from lightgesture.benchmarks.accuracy import Report
    from lightgesture.datasets import Sample

TARGETS = ("hands", "regions")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "target",
        nargs="?",
        choices=TARGETS,
        help="hands: the classifier in given boxes; regions: the whole chain on whole frames "
        "(default: all that the data folder allows)",
    )
    parser.add_argument(
        "--data",
        metavar="DIR",
        help="folder of labelled pictures (default: ../shared/data beside the checkout or current directory)",
    )
    parser.add_argument("--model", default="svm", metavar="svm|cnn|PATH", help="classifier (default: svm)")
    parser.add_argument("--json", action="store_true", help="one JSON object per table row on stdout")
    parser.add_argument("--out", metavar="DIR", help="write contact sheets of the failures here")


def run(args: argparse.Namespace) -> int:
    """Evaluate, print the tables, write the contact sheets; 0 when all was done."""
    from lightgesture.benchmarks import accuracy
    from lightgesture.datasets import find_data
    from lightgesture.models import ModelError, load_classifier
    from lightgesture.opening import make_folder

    if args.out:
        make_folder(args.out)
    data = find_data(args.data)
    available = accuracy.available_targets(data)
    targets = [args.target] if args.target else available
    if not targets or not set(targets) <= set(available):
        raise InputError(f"{data}: holds no pictures for {args.target or 'any evaluation'}; see --data")
    try:
        classifier = load_classifier(args.model)
    except ModelError as error:
        raise UsageError(str(error)) from error
    for position, target in enumerate(targets):
        if target == accuracy.HANDS:
            report = accuracy.evaluate_hands(classifier, args.model, data, show_progress)
        else:
            methods = accuracy.default_methods(classifier, args.model, data)
            report = accuracy.evaluate_regions(methods, data, show_progress)
        print_report(report, args.json, is_first=position == 0)
        if args.out:
            for path in accuracy.save_failures(report, Path(args.out), say):
                say(f"wrote {path}")
    return ExitStatus.OK


def print_report(report: "Report", as_json: bool, is_first: bool = True) -> None:
    """Print the tables of a report on stdout, as text or as one JSON object a row."""
    from lightgesture.benchmarks.tables import to_text

    if as_json:
        for table in report.tables:
            for row in table.to_dicts():
                print_line(json.dumps(row, ensure_ascii=False))
    else:
        print_line(("" if is_first else "\n") + to_text(report.tables))


def show_progress(samples: "Iterable[Sample]", heading: str) -> "Iterable[Sample]":
    """Pass samples on behind a progress bar on stderr; silent where stderr is no terminal."""
    from tqdm import tqdm

    bar: Iterable[Sample] = tqdm(samples, desc=heading, unit="picture", leave=False, disable=None)
    return bar
