"""From a grammar file's content to the compiled grammar, or to all that is wrong with it."""

from collections.abc import Mapping
from typing import Any

from lightgesture.fsm.language.cards import CANCEL, cancel_word, read_motions, read_tags
from lightgesture.fsm.language.checks import (
    check_control,
    check_frame,
    check_limits,
    check_parameters,
    check_sentinels,
    check_use,
)
from lightgesture.fsm.language.document import key_path, parse_document
from lightgesture.fsm.language.forms import MENU, SELECT, Form, FormError, Item, Vocabulary, parse_form
from lightgesture.fsm.language.grammar import Defect, Grammar, GrammarError
from lightgesture.fsm.language.schema import GrammarFile
from lightgesture.fsm.language.settings import Control, DwellSettings, Limits, Parameter, SentenceSettings
from lightgesture.fsm.language.table import Table, compile_table, walk
from lightgesture.fsm.signs import Pair


def build(document: dict[str, Any], file: str) -> Grammar:
    """Check and compile a parsed TOML document; GrammarError names its first defect and counts the rest."""
    grammar, defects = inspect(document, file)
    if grammar is not None:
        return grammar
    place, reason, remedy, _ = defects[0]
    more = f" (and {len(defects) - 1} more)" if len(defects) > 1 else ""
    raise GrammarError.at(file, place, reason, remedy + more)


def inspect(document: dict[str, Any], file: str) -> tuple[Grammar | None, list[Defect]]:
    """The compiled grammar of a document, None where a defect is fatal, and every defect, the fatal ones first.

    What is wrong in the document is taken out of it.
    """
    content, defects = parse_document(document)
    grammar = None if content is None else compile_grammar(content, file, defects)
    defects.sort(key=lambda defect: not defect.is_fatal)
    return grammar, defects


def compile_grammar(content: GrammarFile, file: str, defects: list[Defect]) -> Grammar | None:
    """The compiled grammar, None where one of the defects, to which those of the content are added, is fatal."""
    for index, token in enumerate(content.tokens):
        if token in content.tokens[:index]:
            defects.append(Defect(key_path("tokens", index), f"'{token}' stands twice", "keep one"))
    idle_pairs = _read_pairs("idle_pairs", content.idle_pairs, content.tokens, defects)
    pairs = _read_pairs("pairs", content.pairs, content.tokens, defects)
    menu_pairs = _read_menu(content, idle_pairs, defects)
    tags, motions = read_tags(content, defects), read_motions(content, defects)
    cancel = cancel_word(content)
    words = [*content.idle_pairs.values(), *content.pairs.values(), *([cancel] if cancel == CANCEL else [])]
    vocabulary = Vocabulary.of(words, content.sentinels.join)
    check_sentinels(content, vocabulary, defects)
    check_limits(content, defects)
    check_parameters(content, defects)
    check_control(content, vocabulary, defects)
    forms = _read_forms(content, vocabulary, defects)
    if menu_pairs:
        forms.append(_menu_form(menu_pairs))
    table = _compile(forms, vocabulary, defects)
    # Where a form is missing, what it would have used is not the defect.
    if table is not None and not any(defect.place.startswith("forms") for defect in defects):
        check_use(content, forms, vocabulary, {**pairs, **idle_pairs}, defects)
    if table is None or any(defect.is_fatal for defect in defects):
        return None
    control = {
        pair: word for pair, word in pairs.items() if word in (content.control.kill, content.control.cancel)
    }
    return Grammar(
        file=file,
        tokens=tuple(content.tokens),
        idle_words={**pairs, **idle_pairs},
        sentence_words=pairs,
        menu_words={**menu_pairs, **control} if menu_pairs else {},
        vocabulary=vocabulary,
        table=table,
        end=content.sentinels.end,
        programs={int(number): name for number, name in content.programs.items()},
        parameters={
            int(number): Parameter(**parameter.model_dump())
            for number, parameter in content.parameters.items()
        },
        limits=Limits(**content.limits.model_dump()),
        dwell=DwellSettings(**content.dwell.model_dump()),
        sentence=SentenceSettings(**content.sentence.model_dump()),
        control=Control(
            cancel=cancel,
            kill=content.control.kill,
            confirm=frozenset(content.control.confirm),
            confirm_unknown=content.control.confirm_unknown,
        ),
        tags=tags,
        motions=motions,
    )


def _read_pairs(
    table: str, entries: Mapping[str, str], tokens: list[str], defects: list[Defect]
) -> dict[Pair, str]:
    pairs: dict[Pair, str] = {}
    for key, word in entries.items():
        place = key_path(*table.split("."), key)
        pair = _read_pair(place, key, tokens, defects)
        if pair in pairs:
            reason, remedy = "pair used twice", f"keep one, here or for {pairs[pair]}"
            defects.append(Defect(place, reason, remedy))
        elif pair is not None:
            pairs[pair] = word
    return pairs


def _read_pair(place: str, key: str, tokens: list[str], defects: list[Defect]) -> Pair | None:
    left, comma, right = (part.strip() for part in key.partition(","))
    unknown = [token for token in (left, right) if token not in tokens]
    if not comma:
        defects.append(Defect(place, "is no pair", 'write "left hand,right hand", such as "ok,5"'))
    elif unknown:
        known = ", ".join(tokens[:12]) + (", ..." if len(tokens) > 12 else "")
        defects.append(Defect(place, f"unknown token '{unknown[0][:40]}'", f"use one of {known}"))
    else:
        return left, right
    return None


def _read_menu(content: GrammarFile, idle_pairs: dict[Pair, str], defects: list[Defect]) -> dict[Pair, str]:
    """The menu's pairs; the one that opens it joins those that are read while idle."""
    if content.menu is None:
        return {}
    opening = _read_pair("menu.open", content.menu.open, content.tokens, defects)
    if opening in idle_pairs:
        reason = f"the pair is {idle_pairs[opening]} while idle"
        defects.append(Defect("menu.open", reason, "use another, or remove it from [idle_pairs]"))
    elif opening is not None:
        idle_pairs[opening] = MENU
    entries = {key: f"{SELECT} {number}" for key, number in content.menu.entries.items()}
    return _read_pairs("menu.entries", entries, content.tokens, defects)


def _menu_form(pairs: Mapping[Pair, str]) -> Form:
    """A sentence of two words that needs no end word: the published decoder's."""
    opening, entry = Item(frozenset([MENU]), None, False), Item(frozenset(pairs.values()), None, False)
    return Form(kind="menu", sentence=f"{MENU} {SELECT} n", items=(opening, entry))


def _read_forms(content: GrammarFile, vocabulary: Vocabulary, defects: list[Defect]) -> list[Form]:
    forms: list[Form] = []
    for index, entry in enumerate(content.forms):
        try:
            form = parse_form(entry.kind, entry.sentence, vocabulary, entry.confirm)
            check_frame(form, content.sentinels.start, content.sentinels.end, content.sentinels.join)
            walk(form, vocabulary)
        except FormError as error:
            defects.append(Defect(key_path("forms", index, "sentence"), error.reason, error.remedy))
        else:
            forms.append(form)
    return forms


def _compile(forms: list[Form], vocabulary: Vocabulary, defects: list[Defect]) -> Table | None:
    """The table of the forms that can be read; None where there are none, or too many."""
    ambiguous: list[tuple[Form, Form]] = []
    try:
        table = compile_table(forms, vocabulary, ambiguous) if forms else None
    except FormError as error:
        defects.append(Defect("forms", error.reason, error.remedy))
        return None
    for one, other in ambiguous:
        reason = f"'{one.sentence}' and '{other.sentence}' read the same sentence"
        defects.append(Defect("forms", reason, "keep one of them"))
    return table
