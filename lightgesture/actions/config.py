"""What `config` does: options that were given, and all others as comments, become a configuration file."""

import argparse
import os

from lightgesture.config.options import load_settings
from lightgesture.config.settings import change_paths
from lightgesture.config.writing import to_toml
from lightgesture.console import print_line
from lightgesture.errors import ExitStatus, UsageError

STANDARD_OUTPUT = "-"


def write_config(args: argparse.Namespace) -> ExitStatus:
    """Write `args.file`. UsageError: an option is wrong, or the file is there or cannot be written."""
    settings = load_settings(args)
    folder = os.path.abspath(os.path.dirname(args.file) if args.file != STANDARD_OUTPUT else "")
    moved = change_paths(settings.model_dump(), lambda path: os.path.relpath(path, folder))
    given = settings.model_copy(update=moved).model_dump(by_alias=True, exclude_unset=True)
    text = to_toml(
        {key: value for key, value in given.items() if key not in moved or key in settings.model_fields_set}
    )
    if args.file == STANDARD_OUTPUT:
        print_line(text.rstrip("\n"))
        return ExitStatus.OK
    try:
        with open(args.file, "x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError:
        raise UsageError(f"{args.file}: is there already; name a new file") from None
    except OSError as error:
        raise UsageError(f"{args.file}: cannot be written ({error.strerror}); name another place") from None
    print_line(f"{args.file}: written; use it with: --config {args.file}")
    return ExitStatus.OK
