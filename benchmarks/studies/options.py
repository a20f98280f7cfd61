"""What the commands that train for a study share: their arguments, and how errors end them."""

import argparse
import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from lightgesture.benchmarks.studies.data import training_of
from lightgesture.benchmarks.tables import Table, to_text
from lightgesture.config.parsers import positive, whole
from lightgesture.console import ReaderGoneError, drop_output, messages_shown, print_line, say
from lightgesture.errors import ExitStatus, InputError, UsageError
from lightgesture.models import ModelError
from lightgesture.training.datasets import find_data
from lightgesture.training.nets.cnn import CnnTraining


def add_data_argument(parser: argparse.ArgumentParser) -> None:
    """Declare the folder of pictures."""
    parser.add_argument("--data", metavar="DIR", help="folder of labelled pictures (default: ../shared/data)")


def add_pool_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the pool and the length of a training."""
    parser.add_argument(
        "--pool",
        required=True,
        metavar="DIR",
        help="folder of the pool of patches, such as the .parts folder of train cnn; drawn there where it is missing",
    )
    parser.add_argument(
        "--steps", type=positive, default=5000, metavar="N", help="of each training (default 5000)"
    )
    parser.add_argument(
        "--copies", type=positive, metavar="N", help="altered copies of a hand, where a pool is drawn"
    )
    parser.add_argument(
        "--rounds",
        type=positive,
        metavar="N",
        help="rounds of regions and of hidden hands, where a pool is drawn",
    )
    parser.add_argument("--rendered", type=whole, metavar="N", help="rendered hands, where a pool is drawn")
    parser.add_argument(
        "--jobs", type=positive, default=1, metavar="N", help="processes that draw (default 1)"
    )
    parser.add_argument("--seed", type=whole, default=0, metavar="N", help="of all that is drawn (default 0)")


def training_from(args: argparse.Namespace) -> CnnTraining:
    """The training that the arguments ask for. InputError: there is no data folder."""
    training = training_of(find_data(args.data), seed=args.seed, jobs=args.jobs, steps=args.steps, teachers=0)
    given = {name: getattr(args, name) for name in ("copies", "rounds", "rendered")}
    changes = {name: value for name, value in given.items() if value is not None}
    return replace(training, pool=replace(training.pool, **changes))


def print_and_write(tables: Sequence[Table], out: str | None, settings: object) -> None:
    """Tables on stdout, and with `out` all rows and the settings, paths as text, in a JSON file."""
    from lightgesture.benchmarks.latency import describe_machine, write_json

    print_line(to_text(tables))
    if out:
        rows = [row for table in tables for row in table.to_dicts()]
        plain = json.loads(json.dumps(settings, default=str))
        write_json(Path(out), {"machine": describe_machine(), "settings": plain, "rows": rows})


@messages_shown()
def run_command(
    parser: argparse.ArgumentParser, argv: Sequence[str] | None, run: Callable[[argparse.Namespace], None]
) -> int:
    """Parse, run, and turn what a user can mend into one line; returns the exit status."""
    try:
        run(parser.parse_args(argv))
    except InputError as error:
        say(str(error))
        return ExitStatus.SOME_FAILED
    except (UsageError, ModelError) as error:
        say(str(error))
        return ExitStatus.USAGE
    except KeyboardInterrupt:
        say("interrupted; the same command goes on where a training was")
        return ExitStatus.INTERRUPTED
    except ReaderGoneError:
        drop_output()
        return ExitStatus.SOME_FAILED
    return ExitStatus.OK
