"""`lightgesture doctor`: what runs on this machine and how fast."""

import argparse

from lightgesture.errors import ExitStatus


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument("--json", action="store_true", help="the report as one JSON object")


def run(args: argparse.Namespace) -> int:
    """Examine and report; 0 when all that is needed works, 1 when something is broken."""
    import json

    from lightgesture.actions.doctor import examine
    from lightgesture.console import print_line
    from lightgesture.doctor.text import lines_of

    report = examine()
    if args.json:
        print_line(json.dumps(report.to_dict()))
    else:
        for line in lines_of(report):
            print_line(line)
    return ExitStatus.SOME_FAILED if report.problems else ExitStatus.OK
