"""What `grammar` does: a grammar file is begun, checked, shown, drawn, or led through pairs or a recording.

path: of the file, None for the bundled one. UsageError: it cannot be read, or not be used.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from lightgesture.console import print_line
from lightgesture.errors import ExitStatus, UsageError
from lightgesture.fsm import Grammar, GrammarError, load_grammar
from lightgesture.grammar.report import check, explain, init, show

Path = str | None


def check_grammar(path: Path) -> ExitStatus:
    """Name every defect; USAGE where there is one."""
    with _told():
        lines, is_sound = check(path)
    _print(lines)
    return ExitStatus.OK if is_sound else ExitStatus.USAGE


def show_grammar(path: Path) -> ExitStatus:
    """Print signs, table and settings."""
    return _print(show(_load(path)))


def draw_grammar(path: Path, out: str) -> ExitStatus:
    """Write the state graph to `out`, SVG or PNG."""
    from lightgesture.grammar.drawing import draw

    return _print([draw(_load(path), out)])


def init_grammar(file: str) -> ExitStatus:
    """Write the bundled grammar where no file is yet."""
    return _print([init(file)])


def explain_signs(path: Path, sequence: str) -> ExitStatus:
    """Print what each pair of a sequence does, or what became of the sentences of a recording (`.jsonl`)."""
    if not sequence.endswith(".jsonl"):
        return _print(explain(_load(path), sequence))
    from lightgesture.grammar.replay import explain_records

    return _print(explain_records(_load(path), sequence))


def _load(path: Path) -> Grammar:
    with _told():
        return load_grammar(path)


@contextmanager
def _told() -> Iterator[None]:
    try:
        yield
    except GrammarError as error:
        raise UsageError(str(error)) from error


def _print(lines: Iterable[str]) -> ExitStatus:
    for line in lines:
        print_line(line)
    return ExitStatus.OK
