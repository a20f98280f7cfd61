"""`lightgesture synth`: renders synthetic dives with their truth."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lightgesture.synth.spec import SceneSpec

DEFAULT_HOLD = 15


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "scenes", nargs="*", metavar="SCENE.toml", help="scene file; see lightgesture/synth/spec.py"
    )
    parser.add_argument(
        "--seed", type=int, action="append", metavar="N", help="draw a whole scene from N (repeatable)"
    )
    parser.add_argument(
        "--sentence",
        action="append",
        metavar="TEXT",
        help='what to sign, e.g. "STOP HOVER 50 GO", or ~wave, ~swim (with --seed)',
    )
    parser.add_argument(
        "--place", choices=("any", "water", "room"), default="any", help="with --seed; default any"
    )
    parser.add_argument(
        "--difficulty",
        type=float,
        default=0.5,
        metavar="D",
        help="0 calm and clear .. 1 hard (with --seed); default 0.5",
    )
    parser.add_argument(
        "--hold", type=int, default=DEFAULT_HOLD, metavar="N", help="frames a sign counts from; default 15"
    )
    parser.add_argument("--pictures", action="store_true", help="write PNG pictures instead of a video")
    parser.add_argument(
        "--out", type=Path, default=Path("."), metavar="DIR", help="folder of the output; default here"
    )
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="processes that render; default 1")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")


def run(args: argparse.Namespace) -> int:
    """Render every scene that was named; 0 when all are written."""
    from lightgesture.console import Progress, print_line
    from lightgesture.errors import ExitStatus, UsageError
    from lightgesture.synth.output import write_scene
    from lightgesture.synth.scene import Scene

    try:
        scenes = {stem: Scene(spec) for stem, spec in _specs(args).items()}
    except ValueError as error:
        raise UsageError(str(error)) from error
    for stem, scene in scenes.items():
        with Progress(stem, scene.frame_count, "frame", args.quiet) as bar:
            path = write_scene(scene, args.out, stem, args.hold, args.pictures, args.jobs, bar.advance)
        print_line(f"{path}: {scene.frame_count} frames of {'; '.join(scene.spec.sentences)}")
    return ExitStatus.OK


def _specs(args: argparse.Namespace) -> "dict[str, SceneSpec]":
    """Name to spec of everything that is to be rendered. UsageError: what cannot be."""
    from lightgesture.errors import UsageError
    from lightgesture.synth.spec import load_scene_spec
    from lightgesture.synth.variety import draw_spec

    seeds = args.seed or []
    if not args.scenes and not seeds:
        raise UsageError("nothing to render; name a SCENE.toml or give --seed N")
    if not 0.0 <= args.difficulty <= 1.0:
        raise UsageError(f"--difficulty {args.difficulty}: outside 0 to 1; choose a value between")
    if args.hold < 1 or args.jobs < 1 or any(seed < 0 for seed in seeds):
        raise UsageError("--hold and --jobs must be at least 1, --seed at least 0; give a larger number")
    sentences = tuple(args.sentence) if args.sentence else None
    specs = {
        f"seed_{seed}": draw_spec(seed, "demo", args.place, sentences, args.difficulty) for seed in seeds
    }
    for name in args.scenes:
        stem = Path(name).stem
        if stem in specs:
            raise UsageError(f"{name}: another scene is named {stem} too and would overwrite it; rename one")
        specs[stem] = load_scene_spec(name)
    return specs
