"""What `manual` does: the whole command line as a man page, from the same parsers that its help is made of."""

import argparse
from collections.abc import Iterator

from lightgesture._version import __version__
from lightgesture.cli import make_parser, present_commands
from lightgesture.console import print_line
from lightgesture.errors import ExitStatus
from lightgesture.parser import Parser, arguments, children

STATUSES = (
    ("0", "all went well"),
    ("1", "some inputs failed, and the others are done"),
    ("2", "wrong usage or configuration"),
    ("130", "interrupted, by Ctrl-C or SIGTERM; what was finished is kept"),
)


def print_manual() -> ExitStatus:
    """Print the page in troff."""
    for line in manual(make_parser(present_commands())):
        print_line(line)
    return ExitStatus.OK


def manual(parser: Parser) -> Iterator[str]:
    """Lines of the page, section 1."""
    yield f'.TH LIGHTGESTURE 1 "" "lightgesture {__version__}" "User Commands"'
    yield from _section("NAME", r"lightgesture \- a diver's two\-handed signs in video to robot instructions")
    yield from _section(
        "SYNOPSIS", r".B lightgesture", r".I COMMAND", "[options]", ".br", ".B lightgesture", r"\-\-version"
    )
    yield from _section("DESCRIPTION", _escape(parser.description or ""))
    yield "Results go to standard output, progress and messages to standard error."
    yield ".SH COMMANDS"
    for _, child, text in children(parser):
        yield from _command(child, text)
    yield ".SH EXIT STATUS"
    for number, text in STATUSES:
        yield from (".TP", f".B {number}", _escape(text))
    yield from _section(
        "SEE ALSO", _escape("The folder docs of the sources: batch.md, live.md, language.md, models.md.")
    )


def _command(parser: argparse.ArgumentParser, text: str) -> Iterator[str]:
    yield f".SS {_escape(parser.prog)}"
    yield _escape(text)
    for action in arguments(parser):
        yield from (".TP", _heading(action), _escape(_help(parser, action)))
    for _, child, help_text in children(parser):
        yield from _command(child, help_text)


def _heading(action: argparse.Action) -> str:
    value = "" if action.nargs == 0 else str(action.metavar or "|".join(map(str, action.choices or ())))
    names = ", ".join(rf"\fB{_escape(option)}\fR" for option in action.option_strings)
    return " ".join(part for part in (names, rf"\fI{_escape(value)}\fR" if value else "") if part)


def _help(parser: argparse.ArgumentParser, action: argparse.Action) -> str:
    """The help as the terminal shows it."""
    values = {**vars(action), "prog": parser.prog}
    return (action.help or "") % values


def _section(name: str, *lines: str) -> Iterator[str]:
    yield f".SH {name}"
    yield from lines


def _escape(text: str) -> str:
    """A text that troff takes for nothing but text."""
    plain = text.replace("\\", r"\e").replace("-", r"\-")
    return rf"\&{plain}" if plain.startswith((".", "'")) else plain
