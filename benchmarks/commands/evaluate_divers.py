"""`lightgesture evaluate divers`: real divers' hands, found and read in whole pictures and in given boxes."""

import argparse
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from lightgesture.benchmarks.progress import Progress
from lightgesture.config.parsers import positive
from lightgesture.console import say
from lightgesture.errors import InputError, UsageError

if TYPE_CHECKING:
    from lightgesture.benchmarks.accuracy import Report
    from lightgesture.benchmarks.divers.pictures import DiverFrame
    from lightgesture.benchmarks.divers.scoring import DiverMethod
    from lightgesture.features.profile import ColourProfile
    from lightgesture.models import Classifier

OPTIONS = ("place", "dive", "join", "most", "profile")
"""Options that only this target, and public sets, have."""

FORMATS = ("scubanet", "caddy", "hagrid")
"""Those of `benchmarks.public.registry`, which is not imported before it is needed."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this target."""
    for name, text in (("place", "places"), ("dive", "dives")):
        parser.add_argument(
            f"--{name}",
            action="append",
            metavar="NAME",
            help=f"with divers and --format: only pictures of these {text}, such as those that a model was trained "
            "without (repeatable)",
        )
    parser.add_argument(
        "--profile",
        metavar="FILE",
        help="with divers and --format: score every selector with this colour profile of calibrate, too",
    )
    parser.add_argument(
        "--join",
        action="append",
        metavar="DIR",
        help="with divers: score nothing, but print the tables of several runs together, each of other places or "
        "dives, from what they wrote with --out (repeatable)",
    )


def add_public_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of public sets."""
    parser.add_argument(
        "--format",
        choices=FORMATS,
        help="the target is the folder of a public set in its published form, which gives the tables of divers",
    )
    parser.add_argument(
        "--most",
        type=positive,
        metavar="N",
        help="with divers and --format: at most N pictures, evenly spread",
    )


def find_and_read(
    args: argparse.Namespace, models: "Mapping[str, Classifier]", progress: Progress
) -> "tuple[Report, list[Path]]":
    """The report, and the files of rows that were written. UsageError: a selector or a profile cannot be used."""
    from lightgesture.benchmarks.divers import report as divers
    from lightgesture.features.find.selector_file import SelectorError
    from lightgesture.features.profile import ProfileError, load_profile

    if args.join:
        return divers.joined([Path(folder) for folder in args.join]), []
    if args.fold and (args.selector or args.profile or len(models) > 1):
        raise UsageError(
            "--fold names the selectors itself; give one --model, no --selector and no --profile"
        )
    frames = _frames(args)
    try:
        profile = load_profile(args.profile) if args.profile else None
        if args.fold:
            report, scored = divers.evaluate_folds(_folds(models, args.fold, frames), progress)
        else:
            methods = list(named_methods(models, args.selector, profile))
            report, scored = divers.evaluate_divers(methods, frames, progress, args.out is not None)
    except (SelectorError, ProfileError) as error:
        raise UsageError(str(error)) from error
    written = divers.save_rows(Path(args.out), scored.hands, scored.frames) if args.out else []
    return report, written


def _frames(args: argparse.Namespace) -> "list[DiverFrame]":
    """The pictures that were asked for, of the data folder or of a public set."""
    from lightgesture.benchmarks.divers.pictures import TABLE, choose_frames, read_divers, spread
    from lightgesture.benchmarks.public.registry import read_public
    from lightgesture.training.datasets import find_data

    if args.format:
        frames = read_public(Path(args.target), args.format, say)
    else:
        data = find_data(args.data)
        if not (data / TABLE).is_file():
            raise InputError(f"{data}: holds no pictures for divers; see --data")
        frames = read_divers(data)
    return spread(choose_frames(frames, args.place or (), args.dive or ()), args.most)


def _folds(
    models: "Mapping[str, Classifier]", files: "list[str]", frames: "list[DiverFrame]"
) -> "list[tuple[DiverMethod, list[DiverFrame]]]":
    """The model with each selector file, and the pictures of dives that its card, as the first, says it did not
    see. InputError: a card is missing. Raises SelectorError."""
    from lightgesture.training.pool.divers import SOURCE
    from lightgesture.training.pool.left_out import read_left_out

    ((name, classifier),) = models.items()
    folds, left = [], frames
    for file in files:
        left_out = read_left_out(Path(file))
        own = [frame for frame in left if left_out.covers(f"{SOURCE} {frame.dive}")]
        left = [frame for frame in left if frame not in own]
        folds.append((next(named_methods({name: classifier}, [file])), own))
    return folds


def named_methods(
    models: "Mapping[str, Classifier]", selectors: "list[str] | None", profile: "ColourProfile | None" = None
) -> "Iterator[DiverMethod]":
    """Every model with every selector, a name or a file, and again with the profile. Raises SelectorError."""
    from lightgesture.benchmarks.divers.scoring import DiverMethod
    from lightgesture.benchmarks.methods import reading_method
    from lightgesture.features.find.selector import SELECTORS

    for model, classifier in models.items():
        for selector in selectors or SELECTORS[:1]:
            name = model if selector == SELECTORS[0] else f"{model}, {selector}"
            yield DiverMethod(name, reading_method(name, classifier, selector), classifier)
            if profile is not None:
                name = f"{name}, profile"
                yield DiverMethod(name, reading_method(name, classifier, selector, profile), classifier)
