"""What `signs` does: a language or a sentence, printed as text or written as a page with drawn hands."""

from typing import Final, Literal

from lightgesture.console import print_line
from lightgesture.errors import ExitStatus, UsageError
from lightgesture.fsm import Grammar, GrammarError, load_grammar
from lightgesture.signs.sentences import read_sentence
from lightgesture.signs.text import tell_language, tell_sentence, terminal_width

CARD: Final = "card.svg"
"""Where the card goes unless the user says."""


def show_signs(
    sentence: str, grammar_path: str | None, *, is_card: bool, out: str | None, is_gloved: bool
) -> ExitStatus:
    """Print or write the language, a sentence or the card.

    UsageError: the grammar is wrong, cannot say the sentence, or the file cannot be written.
    """
    grammar = open_grammar(grammar_path)
    if is_card and sentence:
        raise UsageError("--card: is of the whole language; leave out the sentence or --card")
    if not is_card and out is None:
        width = terminal_width()
        lines = (
            tell_sentence(read_sentence(grammar, sentence), width)
            if sentence
            else tell_language(grammar, width)
        )
    else:
        lines = _write(grammar, sentence, is_card, out or CARD, is_gloved)
    for line in lines:
        print_line(line)
    return ExitStatus.OK


def open_grammar(path: str | None) -> Grammar:
    """The grammar of that file. UsageError: it cannot be read or used."""
    try:
        return load_grammar(path)
    except GrammarError as error:
        raise UsageError(str(error)) from error


def _write(grammar: Grammar, sentence: str, is_card: bool, out: str, is_gloved: bool) -> list[str]:
    """Write pages; a line for each file."""
    # OpenCV takes a moment to load, and text needs none of it.
    from lightgesture.signs.layout import card_pages, sentence_pages, signs_pages
    from lightgesture.signs.sheet import write_pages

    kind: Literal["bare", "gloved"] = "gloved" if is_gloved else "bare"
    if is_card:
        pages, what = card_pages(grammar, kind), "card"
    elif sentence:
        signed = read_sentence(grammar, sentence)
        pages, what = sentence_pages(signed, grammar, kind), signed.text
    else:
        pages, what = signs_pages(grammar.tokens), "signs"
    return [f"{name}: {what}" for name in write_pages(pages, out)]
