"""What can be wrong with a grammar though every value by itself is right."""

from collections.abc import Mapping, Sequence

from lightgesture.fsm.language.cards import check_words
from lightgesture.fsm.language.document import key_path
from lightgesture.fsm.language.forms import Form, FormError, Vocabulary
from lightgesture.fsm.language.grammar import Defect
from lightgesture.fsm.language.schema import GrammarFile
from lightgesture.fsm.signs import Pair


def check_sentinels(content: GrammarFile, vocabulary: Vocabulary, defects: list[Defect]) -> None:
    """Every sentinel is a word of its own that has a sign."""
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


def check_limits(content: GrammarFile, defects: list[Defect]) -> None:
    """Limits are in order, and numbers that keep them can be signed."""
    limits = content.limits
    if limits.min_seconds > limits.max_seconds:
        reason = f"{limits.min_seconds} is above max_seconds = {limits.max_seconds}"
        defects.append(Defect("limits.min_seconds", reason, "swap or correct them"))
    digits = limits.max_digits
    for number in content.programs:
        if len(number) > digits:
            reason = f"has more than max_digits = {digits} digits"
            defects.append(
                Defect(key_path("programs", number), reason, "use a shorter number", is_fatal=False)
            )


def check_parameters(content: GrammarFile, defects: list[Defect]) -> None:
    """The limits of every parameter are in order and hold its default and one step."""
    for number, parameter in content.parameters.items():
        low, high = parameter.minimum, parameter.maximum
        place = key_path("parameters", number)
        if low is not None and high is not None:
            if low > high:
                reason = f"{low:g} is above maximum = {high:g}"
                defects.append(Defect(f"{place}.minimum", reason, "swap or correct them"))
                continue
            if parameter.step is not None and parameter.step > high - low:
                reason = f"{parameter.step:g} is more than from minimum to maximum"
                defects.append(Defect(f"{place}.step", reason, "use a smaller one"))
        default = parameter.default
        if default is not None and (
            (low is not None and default < low) or (high is not None and default > high)
        ):
            reason = f"{default:g} is outside minimum and maximum"
            defects.append(Defect(f"{place}.default", reason, "use one between them"))


def check_control(content: GrammarFile, vocabulary: Vocabulary, defects: list[Defect]) -> None:
    """Words of control have a sign in every state and no other use."""
    control, sentinels = content.control, content.sentinels
    taken = {*sentinels.start, sentinels.end, sentinels.join, *vocabulary.digits}
    inside = {word: key for key, word in content.pairs.items()}
    idle = {"".join(key.split()) for key in content.idle_pairs}
    if content.menu is not None:
        idle |= {"".join(key.split()) for key in (content.menu.open, *content.menu.entries)}
    for place, word in (("control.cancel", control.cancel), ("control.kill", control.kill)):
        if word is None:
            continue
        if word not in inside:
            defects.append(Defect(place, f"unknown word '{word}'", "give it a sign in [pairs]"))
        elif word in taken:
            defects.append(Defect(place, f"'{word}' has another use", "give it its own word"))
        elif "".join(inside[word].split()) in idle:
            reason = f"the pair {inside[word]} has another meaning in [idle_pairs] or [menu]"
            defects.append(Defect(place, reason, "use a pair that is free in every state"))
    if control.cancel is not None and control.cancel == control.kill:
        defects.append(Defect("control.kill", f"'{control.kill}' cancels too", "give each its own word"))
    for index, word in enumerate(control.confirm):
        if word not in vocabulary.words and word not in vocabulary.carriers:
            place = key_path("control", "confirm", index)
            defects.append(Defect(place, f"unknown word '{word}'", "use a word that has a sign"))


def check_use(
    content: GrammarFile,
    forms: list[Form],
    vocabulary: Vocabulary,
    idle_words: Mapping[Pair, str],
    defects: list[Defect],
) -> None:
    """Every pair says a word that some form uses, every sentence can be opened, every number is listed."""
    used = {word for form in forms for item in form.items for word in item.words}
    if any(item.slot for form in forms for item in form.items):
        used |= vocabulary.digits | {content.sentinels.join or ""}
    control = {content.control.cancel, content.control.kill}
    defects += [
        Defect("control", f"a form uses '{word}'", "give one of them another word")
        for word in sorted(filter(None, control & used))
    ]
    for name, entries in (("idle_pairs", content.idle_pairs), ("pairs", content.pairs)):
        for key, word in entries.items():
            if word not in used | control:
                remedy = "put it into a sentence of [[forms]] or remove the pair"
                defects.append(Defect(key_path(name, key), f"no form uses '{word}'", remedy))
    check_words(content, {word for word in used | control if word}, defects)
    for index, word in enumerate(content.sentinels.start):
        if word in used and word not in idle_words.values():
            reason = f"'{word}' cannot be signed: all its pairs mean something else while idle"
            defects.append(Defect(key_path("sentinels", "start", index), reason, "give it another pair"))
    _check_numbers(content, forms, vocabulary, defects)


def _check_numbers(
    content: GrammarFile, forms: list[Form], vocabulary: Vocabulary, defects: list[Defect]
) -> None:
    """Numbers that are signed are listed, and those that are listed can be signed. None of it is fatal."""
    slots = {item.slot for form in forms for item in form.items}
    if "program" in slots and not content.programs:
        defects.append(
            Defect("programs", "lists no program", 'add a line such as 1 = "surface"', is_fatal=False)
        )
    for number in content.programs:
        missing = sorted({*number} - vocabulary.digits)
        if missing:
            reason, remedy = f"no sign for the digit {missing[0]}", "use other digits or add a pair for it"
            defects.append(Defect(key_path("programs", number), reason, remedy, is_fatal=False))
    carried = {
        word.partition(" ")[2]
        for form in forms
        if form.kind != "menu"
        for item in form.items
        for word in item.words
    } - {""}
    for number in sorted(carried - {*content.parameters}, key=int):
        reason, remedy = "is signed and not listed", "add it, or remove the pair that carries it"
        defects.append(Defect(key_path("parameters", number), reason, remedy, is_fatal=False))
    for number in sorted({*content.parameters} - carried, key=int):
        reason, remedy = "has no sign", "add a pair for a word that carries it"
        defects.append(Defect(key_path("parameters", number), reason, remedy, is_fatal=False))


def check_frame(form: Form, starts: Sequence[str], end: str, join: str | None) -> None:
    """FormError unless nothing can ever be issued without start word, action and end word."""
    if len(form.items) < 3:
        raise FormError(f"'{form.sentence}' is too short", "write start word, action and end word")
    first, action, last = form.items[0], form.items[1], form.items[-1]
    if first.optional or not first.words or not first.words <= frozenset(starts):
        raise FormError(f"'{form.sentence}' has no start word", "begin with " + "|".join(sorted(starts)))
    if last.optional or last.words != frozenset([end]):
        raise FormError(f"'{form.sentence}' has no end word", f"end with {end}")
    if action.optional or action.slot:
        raise FormError(f"'{form.sentence}' has no action", "put a word after the start word")
    if any(form.is_repeated(item) for item in (0, 1, len(form.items) - 1)):
        raise FormError(
            f"'{form.sentence}' repeats its frame", "put {...} after the action and before the end"
        )
    reserved = {*starts, end, join}
    for item in form.items[1:-1]:
        if item.words & reserved:
            word = min(item.words & reserved)
            raise FormError(f"'{word}' stands inside '{form.sentence}'", "use sentinels at the ends alone")
