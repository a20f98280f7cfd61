"""From a grammar file's content to the compiled grammar, or to all that is wrong with it."""

from collections.abc import Mapping
from typing import Any

from lightgesture.fsm.events import Pair
from lightgesture.fsm.forms import Form, FormError, Vocabulary, parse_form
from lightgesture.fsm.grammar import Grammar, GrammarError
from lightgesture.fsm.schema import Defect, GrammarFile, key_path, parse_document
from lightgesture.fsm.settings import DwellSettings, Limits
from lightgesture.fsm.table import Table, compile_table


def build(document: dict[str, Any], file: str) -> Grammar:
    """Check and compile a parsed TOML document; GrammarError names its first defect and counts the rest."""
    result = parse_document(document)
    grammar = compile_grammar(result, file) if isinstance(result, GrammarFile) else result
    if isinstance(grammar, Grammar):
        return grammar
    place, reason, remedy = grammar[0]
    more = f" (and {len(grammar) - 1} more)" if len(grammar) > 1 else ""
    raise GrammarError.at(file, place, reason, remedy + more)


def compile_grammar(content: GrammarFile, file: str) -> Grammar | list[Defect]:
    """The compiled grammar, or every defect that was found in the file's content."""
    defects: list[Defect] = []
    for index, token in enumerate(content.tokens):
        if token in content.tokens[:index]:
            defects.append(Defect(key_path("tokens", index), f"'{token}' stands twice", "keep one"))
    idle_pairs = _read_pairs("idle_pairs", content.idle_pairs, content.tokens, defects)
    pairs = _read_pairs("pairs", content.pairs, content.tokens, defects)
    vocabulary = Vocabulary.of([*idle_pairs.values(), *pairs.values()], content.sentinels.join)
    _check_sentinels(content, vocabulary, defects)
    _check_limits(content, defects)
    if defects:  # what follows would only repeat them
        return defects
    forms = _read_forms(content, vocabulary, defects)
    table = _compile(forms, vocabulary, defects)
    if table is None:
        return defects
    _check_use(content, table, defects)
    if defects:
        return defects
    return Grammar(
        file=file,
        tokens=tuple(content.tokens),
        idle_words={**pairs, **idle_pairs},
        sentence_words=pairs,
        vocabulary=vocabulary,
        table=table,
        programs={int(number): name for number, name in content.programs.items()},
        parameters={int(number): name for number, name in content.parameters.items()},
        limits=Limits(**content.limits.model_dump()),
        dwell=DwellSettings(**content.dwell.model_dump()),
    )


def _read_pairs(
    table: str, entries: Mapping[str, str], tokens: list[str], defects: list[Defect]
) -> dict[Pair, str]:
    pairs: dict[Pair, str] = {}
    known = ", ".join(tokens)
    for key, word in entries.items():
        place = key_path(table, key)
        left, comma, right = (part.strip() for part in key.partition(","))
        unknown = [token for token in (left, right) if token not in tokens]
        if not comma:
            defects.append(Defect(place, "is no pair", 'write "left hand,right hand", such as "ok,5"'))
        elif unknown:
            defects.append(Defect(place, f"unknown token '{unknown[0][:40]}'", f"use one of {known}"))
        elif (left, right) in pairs:
            defects.append(Defect(place, "pair used twice", f"keep one, here or for {pairs[left, right]}"))
        else:
            pairs[left, right] = word
    return pairs


def _check_sentinels(content: GrammarFile, vocabulary: Vocabulary, defects: list[Defect]) -> None:
    sentinels = content.sentinels
    named = [(key_path("sentinels", "start", index), word) for index, word in enumerate(sentinels.start)]
    named.append(("sentinels.end", sentinels.end))
    if sentinels.join is not None:
        named.append(("sentinels.join", sentinels.join))
    seen: set[str] = set()
    for place, word in named:
        if word not in vocabulary.words:
            defects.append(Defect(place, f"unknown word '{word}'", "give it a sign in [pairs]"))
        elif word in seen:
            defects.append(Defect(place, f"'{word}' is a sentinel twice", "give each of them its own word"))
        elif word in vocabulary.digits:
            defects.append(Defect(place, f"'{word}' is a digit", "use a word in capitals"))
        seen.add(word)
    for key, word in content.idle_pairs.items():
        if word not in sentinels.start:
            remedy = "use one of sentinels.start, or move it to [pairs]"
            defects.append(Defect(key_path("idle_pairs", key), f"'{word}' opens no sentence", remedy))


def _check_limits(content: GrammarFile, defects: list[Defect]) -> None:
    limits = content.limits
    if limits.min_seconds > limits.max_seconds:
        reason = f"{limits.min_seconds} is above max_seconds = {limits.max_seconds}"
        defects.append(Defect("limits.min_seconds", reason, "swap or correct them"))


def _read_forms(content: GrammarFile, vocabulary: Vocabulary, defects: list[Defect]) -> list[Form]:
    forms: list[Form] = []
    for index, entry in enumerate(content.forms):
        try:
            form = parse_form(entry.kind, entry.sentence, vocabulary)
            _check_frame(form, content)
        except FormError as error:
            defects.append(Defect(key_path("forms", index, "sentence"), error.reason, error.remedy))
        else:
            forms.append(form)
    return forms


def _check_frame(form: Form, content: GrammarFile) -> None:
    """Start sentinel, action, ..., end sentinel: so that nothing is ever issued without all three."""
    start, end = frozenset(content.sentinels.start), frozenset([content.sentinels.end])
    if len(form.items) < 3:
        raise FormError(f"'{form.sentence}' is too short", "write start word, action and end word")
    first, action, last = form.items[0], form.items[1], form.items[-1]
    if first.optional or not first.words or not first.words <= start:
        raise FormError(f"'{form.sentence}' has no start word", "begin with " + "|".join(sorted(start)))
    if last.optional or last.words != end:
        raise FormError(f"'{form.sentence}' has no end word", f"end with {content.sentinels.end}")
    if action.optional or action.slot:
        raise FormError(f"'{form.sentence}' has no action", "put a word after the start word")
    reserved = start | end | {content.sentinels.join}
    for item in form.items[1:-1]:
        if item.words & reserved:
            word = min(item.words & reserved)
            raise FormError(f"'{word}' stands inside '{form.sentence}'", "use sentinels at the ends alone")


def _compile(forms: list[Form], vocabulary: Vocabulary, defects: list[Defect]) -> Table | None:
    if defects:
        return None
    try:
        return compile_table(forms, vocabulary)
    except FormError as error:
        defects.append(Defect("forms", error.reason, error.remedy))
        return None


def _check_use(content: GrammarFile, table: Table, defects: list[Defect]) -> None:
    used = {word for row in table.transitions for word in row}
    for name, entries in (("idle_pairs", content.idle_pairs), ("pairs", content.pairs)):
        for key, word in entries.items():
            if word not in used:
                remedy = "put it into a sentence of [[forms]] or remove the pair"
                defects.append(Defect(key_path(name, key), f"no form uses '{word}'", remedy))
