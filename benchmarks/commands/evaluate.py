"""`lightgesture evaluate`: score models, selectors and the whole chain on labelled pictures and on the suite."""

import argparse
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from lightgesture.benchmarks.commands import evaluate_divers, evaluate_regions
from lightgesture.benchmarks.progress import progress_bar
from lightgesture.console import native_messages_muted, print_line, say
from lightgesture.errors import ExitStatus, InputError, UsageError

if TYPE_CHECKING:
    from lightgesture.benchmarks.accuracy import Report
    from lightgesture.benchmarks.tables import Table
    from lightgesture.models import Classifier

HANDS, REGIONS, DIVERS, SUITE = "hands", "regions", "divers", "suite"
TARGETS = (HANDS, REGIONS, DIVERS, SUITE)
DEFAULT_MODEL = "cnn"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "target",
        nargs="?",
        metavar="|".join(TARGETS) + "|DIR",
        help="hands: the classifier in given boxes; regions: hands found in whole frames and, with --model, read; "
        "divers: real divers' hands, found and read in whole pictures and in given boxes; suite: the whole chain on "
        "signed clips that are rendered here and cached, which takes long at first; DIR: with --format, a public set "
        "(default: hands and regions with a model, as far as the data folder allows)",
    )
    parser.add_argument(
        "--data",
        metavar="DIR",
        help="folder of labelled pictures (default: ../shared/data beside the checkout or current directory)",
    )
    parser.add_argument(
        "--model",
        action="append",
        metavar="svm|cnn|PATH",
        help=f"classifier (default: {DEFAULT_MODEL}; regions alone: none, hands are found and not read); with hands "
        "and divers repeatable, the models stand side by side",
    )
    evaluate_regions.add_arguments(parser)
    evaluate_divers.add_arguments(parser)
    evaluate_divers.add_public_arguments(parser)
    parser.add_argument("--json", action="store_true", help="one JSON object per table row on stdout")
    parser.add_argument(
        "--only",
        action="append",
        metavar="NAME",
        help="with suite: a part (water, land, real, negative) or a clip such as water-03 (repeatable)",
    )
    parser.add_argument(
        "--jobs", type=int, default=1, metavar="N", help="processes that render clips (default 1)"
    )
    parser.add_argument("--quick", action="store_true", help="with suite or --clips: every fifth clip")
    parser.add_argument("--out", metavar="DIR", help="write contact sheets of the failures here")


def run(args: argparse.Namespace) -> int:
    """Evaluate, print the tables, write the contact sheets; 0 when all was done."""
    import numpy  # noqa: F401 - only libraries that are loaded can be limited to one thread

    from lightgesture.config.opening import make_folder
    from lightgesture.pipeline import OneBlasThread

    refuse_misplaced(args)
    if args.jobs < 1:
        raise UsageError(f"--jobs {args.jobs}: must be at least 1; give a larger number")
    if args.out:
        make_folder(args.out)
    with native_messages_muted(), OneBlasThread().block():
        if args.format or args.target == DIVERS:
            return run_divers(args)
        return run_suite(args) if args.target == SUITE else run_pictures(args)


def refuse_misplaced(args: argparse.Namespace) -> None:
    """UsageError: there is no such target, or an option is not of it."""
    is_of_divers = args.target == DIVERS or args.format is not None
    if args.format is None and args.target not in (None, *TARGETS):
        raise UsageError(
            f"{args.target}: no such target; name {', '.join(TARGETS)}, or a folder with --format"
        )
    if args.format is not None and args.target is None:
        raise UsageError(
            "--format tells how a public set is read; name its folder too: evaluate DIR --format ..."
        )
    if args.target != SUITE and (args.only or (args.quick and not args.clips)):
        raise UsageError("--only and --quick choose clips of the suite; name the target: evaluate suite")
    for option in evaluate_regions.OPTIONS:
        is_fitting = args.target == REGIONS or (
            (option == "selector" and (is_of_divers or args.target == SUITE))
            or (option == "fold" and args.target == DIVERS)
        )
        if getattr(args, option) and not is_fitting:
            raise UsageError(f"--{option} is about finding hands; name the target: evaluate regions")
    for option in evaluate_divers.OPTIONS:
        if getattr(args, option) and not is_of_divers:
            raise UsageError(f"--{option} is about real divers; name the target: evaluate divers")
    if args.target != HANDS and not is_of_divers and len(args.model or ()) > 1:
        raise UsageError("several --model are compared in given boxes only; name the target: evaluate hands")


def run_divers(args: argparse.Namespace) -> int:
    """Score models and selectors on real divers; 0 when all was done."""
    from lightgesture.benchmarks import accuracy

    models = {} if args.join else named_models(args)
    report, written = evaluate_divers.find_and_read(args, models, progress_bar)
    print_report(report, args.json)
    if args.out:
        for path in [*written, *accuracy.save_failures(report, Path(args.out), say)]:
            say(f"wrote {path}")
    return ExitStatus.OK


def run_pictures(args: argparse.Namespace) -> int:
    """Score the models on labelled pictures; 0 when all was done."""
    from lightgesture.benchmarks import accuracy
    from lightgesture.training.datasets import find_data

    data = find_data(args.data)
    available = accuracy.available_targets(data)
    targets = [args.target] if args.target else available
    if not targets or not set(targets) <= set(available):
        raise InputError(f"{data}: holds no pictures for {args.target or 'any evaluation'}; see --data")
    for position, (report, suffix) in enumerate(reports(args, targets, data)):
        print_report(report, args.json, is_first=position == 0)
        if args.out:
            for path in accuracy.save_failures(report, Path(args.out), say, suffix):
                say(f"wrote {path}")
    return ExitStatus.OK


def reports(args: argparse.Namespace, targets: "Sequence[str]", data: Path) -> "Iterator[tuple[Report, str]]":
    """What was asked for, one after the other, with the kind of picture that its failures are drawn to."""
    from lightgesture.benchmarks import accuracy
    from lightgesture.benchmarks.reading import report as reading_report

    is_reading = args.target != REGIONS or args.model is not None
    models = named_models(args) if is_reading else {}
    if models and HANDS in targets:
        yield reading_report.evaluate_reading(models, data, progress_bar), ".jpg"
    if REGIONS in targets:
        for report in evaluate_regions.find_hands(args, data, progress_bar):
            yield report, ".png"
        for model, classifier in models.items():
            methods = accuracy.default_methods(classifier, model, data)
            yield accuracy.evaluate_regions(methods, data, progress_bar), ".jpg"


def named_models(args: argparse.Namespace) -> "dict[str, Classifier]":
    """The classifiers that were asked for, by name or path, each once. UsageError: one cannot be used."""
    from lightgesture.models import ModelError, load_classifier

    try:
        return {model: load_classifier(model) for model in args.model or [DEFAULT_MODEL]}
    except ModelError as error:
        raise UsageError(str(error)) from error


def run_suite(args: argparse.Namespace) -> int:
    """Render or fetch the clips, decode and score them; 0 when all was done."""
    from lightgesture.benchmarks.accuracy import default_methods
    from lightgesture.benchmarks.suite import run as suite
    from lightgesture.benchmarks.suite import tables as suite_tables
    from lightgesture.benchmarks.suite import takes as suite_takes
    from lightgesture.benchmarks.suite.cache import cache_folder
    from lightgesture.benchmarks.suite.scenarios import SUITES

    data = suite_data(args.data)
    takes = [take for name in SUITES for take in suite_takes.takes_of(name, data)]
    known = {*SUITES, *(take.scenario.name for take in takes)}
    if unknown := [name for name in args.only or () if name not in known]:
        raise UsageError(f"--only {unknown[0]}: no such part or clip; parts are {', '.join(SUITES)}")
    ((model, classifier),) = named_models(args).items()
    methods = default_methods(classifier, model, data, evaluate_regions.named_selectors(args))
    chosen = suite_takes.choose_takes(takes, args.only or (), args.quick)
    answers = suite.run_suite(methods, chosen, cache_folder(), progress_bar, args.jobs)
    print_tables(suite_tables.all_tables(answers, methods[0].name), args.json)
    if args.out:
        for path in suite.save_tiles(answers, Path(args.out), say):
            say(f"wrote {path}")
    return ExitStatus.OK


def suite_data(named: str | None) -> Path | None:
    """The data folder, None where there is none and none was named: the suite then does without real hands."""
    from lightgesture.training.datasets import find_data

    try:
        return find_data(named)
    except InputError:
        if named is not None:
            raise
        say("no data folder: the suite goes without real hands and without the rows of the paper's chain")
        return None


def print_report(report: "Report", as_json: bool, is_first: bool = True) -> None:
    """Print the tables of a report on stdout, as text or as one JSON object a row."""
    print_tables(report.tables, as_json, is_first)


def print_tables(tables: "Sequence[Table]", as_json: bool, is_first: bool = True) -> None:
    """Print tables on stdout, as text or as one JSON object a row."""
    from lightgesture.benchmarks.tables import to_text

    if as_json:
        for table in tables:
            for row in table.to_dicts():
                print_line(json.dumps(row, ensure_ascii=False))
    else:
        print_line(("" if is_first else "\n") + to_text(tables))
