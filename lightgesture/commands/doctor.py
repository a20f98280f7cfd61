"""`lightgesture doctor`: what runs on this machine and how fast."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument("--json", action="store_true", help="the report as one JSON object")


def run(args: argparse.Namespace) -> int:
    """Examine and report; 0 when all that is needed works, 1 when something is broken."""
    from lightgesture.actions.doctor import run_doctor

    return run_doctor(args.json)
