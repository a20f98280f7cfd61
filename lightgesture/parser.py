"""The parser of the command line: what is wrong in one line, with what was probably meant and where the help is."""

import argparse
import difflib
import re
from collections.abc import Iterator, Sequence
from typing import Any, Final, NoReturn, cast

from lightgesture.errors import UsageError

_CHOICE: Final = re.compile(
    r"argument (?P<name>.+?): invalid choice: (?P<word>'.*?'|\S+) \(choose from (?P<known>.*)\)"
)
"""What argparse says of a word that is none of those that it knows; releases differ in the quotes."""


CLOSE: Final = 0.75
"""Least likeness of an option to what may have been meant, 0 to 1: --hold is not --threshold."""


class Parser(argparse.ArgumentParser):
    """Tells what is wrong in one line, without the usage; options are never guessed from their first letters."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**{"allow_abbrev": False, **settings})

    def error(self, message: str) -> NoReturn:
        """Leave with the exit status of wrong usage."""
        if (found := _CHOICE.fullmatch(message)) is not None:
            word = found["word"].strip("'")
            known = [part.strip(" '") for part in found["known"].split(",")]
            message = f"argument {found['name']}: {word}: unknown; {suggestion(word, known)}"
        end = "" if message.endswith("?") else ";"
        raise UsageError(f"{message}{end} see {self.prog} --help")

    def parse_known_args(  # pyright: ignore[reportIncompatibleMethodOverride]
        self, args: Any = None, namespace: Any = None
    ) -> Any:
        """As in the library, with the values put in that options may go without."""
        words = [] if args is None else list(args)
        return super().parse_known_args(list(self._completed(words)), namespace)

    def _completed(self, words: Sequence[str]) -> Iterator[str]:
        """An option that may stand alone takes the next word only where that is one of its own: else an input that
        follows it would be taken for its value."""
        alone = {
            option: action
            for action in self._actions
            if isinstance(action, MayStandAlone)
            for option in action.option_strings
        }
        for place, word in enumerate(words):
            if word == "--":
                yield from words[place:]
                return
            action = alone.get(word)
            following = words[place + 1] if place + 1 < len(words) else None
            yield word if action is None or following in action.words else f"{word}={action.default_word}"


class MayStandAlone(argparse._StoreAction):
    """An option whose value is one of a few words, the first of which it has where none is given.

    words: those that it takes.
    """

    def __init__(
        self, option_strings: Sequence[str], dest: str, words: Sequence[str], **settings: Any
    ) -> None:
        super().__init__(option_strings, dest, **settings)
        self.words, self.default_word = tuple(words), words[0]


def parse(parser: Parser, words: Sequence[str]) -> argparse.Namespace:
    """The parsed words. UsageError: what is left over, told by the parser of the command that was asked for."""
    args, rest = parser.parse_known_args(words)
    if rest:
        chosen = _chosen(parser, args)
        options = [word.partition("=")[0] for word in rest if word.startswith("-")]
        known = [text for action in chosen._actions for text in action.option_strings]
        close = difflib.get_close_matches(options[0], known, n=1, cutoff=CLOSE) if options else []
        meant = f"; did you mean {close[0]}?" if close else ""
        chosen.error(f"unrecognized arguments: {' '.join(options or rest)}{meant}")
    return cast(argparse.Namespace, args)


def suggestion(word: str, known: Sequence[str]) -> str:
    """What to do about an unknown word: the one that is spelt like it, else all of them."""
    close = difflib.get_close_matches(word, known, n=1)
    return f"did you mean '{close[0]}'?" if close else f"use {', '.join(known)}"


def _chosen(parser: argparse.ArgumentParser, args: argparse.Namespace) -> argparse.ArgumentParser:
    """The parser of the command, and of its action, that were asked for."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            name = getattr(args, action.dest, None)
            return _chosen(action.choices[name], args) if name in action.choices else parser
    return parser


def children(parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.ArgumentParser, str]]:
    """Name, parser and line of help of the commands of a parser, or of the actions of a command."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            helps = {choice.dest: choice.help or "" for choice in action._choices_actions}
            for name, child in action.choices.items():
                yield name, child, helps.get(name, "")


def arguments(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    """All arguments and options of a parser but the help and its commands."""
    skipped = (argparse._HelpAction, argparse._SubParsersAction)
    return [action for action in parser._actions if not isinstance(action, skipped)]
