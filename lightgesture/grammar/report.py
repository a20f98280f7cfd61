"""A grammar told in lines of text: what is wrong with it, what is in it, and what a sequence of pairs does."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict

from lightgesture.errors import UsageError
from lightgesture.fsm import Decoder, Event, Grammar, Signs, inspect_grammar
from lightgesture.fsm.language.forms import is_digit, split_carrier
from lightgesture.fsm.language.load import BUNDLED

Path = str | None


def init(path: str) -> str:
    """Write the bundled grammar to a new file; what was done, in a line. UsageError: it is there, or cannot be
    written."""
    try:
        with open(path, "x", encoding="utf-8") as stream:
            stream.write(BUNDLED.read_text(encoding="utf-8"))
    except FileExistsError:
        raise UsageError(f"{path}: is there already; name a new file") from None
    except OSError as error:
        raise UsageError(f"{path}: cannot be written ({error.strerror}); name another place") from None
    return f"{path}: written; edit it, then run: lightgesture grammar check {path}"


def check(path: Path) -> tuple[list[str], bool]:
    """Every defect of a grammar file, one line each, or what it holds; and whether it is sound.

    GrammarError: the file cannot be read or is no TOML.
    """
    grammar, defects = inspect_grammar(path)
    name = "bundled grammar" if path is None else path
    lines = [f"{name}: {defect}" for defect in defects]
    if grammar is None:
        return [*lines, f"{name}: {_count(len(defects), 'defect')}; it cannot be used"], False
    if defects:
        return [*lines, f"{name}: {_count(len(defects), 'defect')}; it can be used, but not all of it"], False
    words = {*grammar.idle_words.values(), *grammar.sentence_words.values(), *grammar.menu_words.values()}
    forms = len({form.sentence for form in grammar.table.accepting.values()})
    states = len(grammar.table.transitions)
    counts = (_count(len(words), "word"), _count(forms, "form"), _count(states, "state"))
    return [f"{name}: sound; {', '.join(counts)}"], True


def show(grammar: Grammar) -> list[str]:
    """The signs, the table and the settings of a grammar."""
    lines = ["Signs (left hand,right hand)", *_signs(grammar.sentence_words, {})]
    lines += ["", "Signs that differ while idle", *_signs(grammar.idle_words, grammar.sentence_words)]
    lines += ["", "Signs in the menu", *_signs(grammar.menu_words, {})]
    lines += ["", "Table: state, word, next state", *_table(grammar)]
    lines += ["", "Programs", *_entries(grammar.programs)]
    lines += ["", "Parameters"]
    for number, parameter in sorted(grammar.parameters.items()):
        details = [f"{key} {value}" for key, value in asdict(parameter).items() if value is not None]
        lines.append(f"  {number}  {', '.join([parameter.name, *details[1:]])}")
    settings = {**asdict(grammar.limits), **asdict(grammar.dwell)}
    settings |= {f"sentence.{name}": value for name, value in asdict(grammar.sentence).items()}
    settings |= asdict(grammar.control)
    settings["confirm"] = ", ".join(sorted(grammar.control.confirm)) or None
    lines += [
        "",
        "Settings",
        *_entries({name: value for name, value in settings.items() if value is not None}),
    ]
    return [line if is_filled else f"{line}: none" for line, is_filled in _headed(lines)]


def _headed(lines: Sequence[str]) -> Iterator[tuple[str, bool]]:
    """Each line, and whether it is no heading that nothing follows."""
    for line, following in zip(lines, [*lines[1:], ""], strict=True):
        yield line, not line or line.startswith(" ") or following.startswith(" ")


def explain(grammar: Grammar, sequence: str) -> list[str]:
    """What each pair of a sequence such as "ok,0 5,5 ok,ok" does, held once and released.

    UsageError: a pair is none, or has a token that the grammar has not.
    """
    pairs = [_read_pair(grammar, text) for text in sequence.split()]
    if not pairs:
        raise UsageError('no pairs; give some, such as "ok,0 5,5 ok,ok"')
    decoder = Decoder(grammar, hold=1)
    lines = []
    for number, (left, right) in enumerate(pairs, start=1):
        events = decoder.step(Signs.of_tokens(left, right), 0.0) + decoder.step(Signs(), 0.0)
        lines.append(f"{number}. {left},{right}: {'; '.join(tell(events)) or 'nothing'}")
        lines.append(f"   {decoder.sentence or decoder.state}; expected: {decoder.expected}")
    return lines


def merge_words(words: Iterable[str]) -> list[str]:
    """Words in short: a run of digits is "0..5", the words that carry a number are "PARAM n"."""
    digits = sorted(word for word in words if is_digit(word))
    names: dict[str, None] = {}  # keeps the order, drops repeats
    for word in sorted(words):
        name, number = split_carrier(word)
        if not is_digit(word):
            names[name if number is None else f"{name} n"] = None
    is_run = len(digits) > 1 and len(digits) == int(digits[-1]) - int(digits[0]) + 1
    return [*names, *([f"{digits[0]}..{digits[-1]}"] if is_run else digits)]


def targets(row: Mapping[str, int]) -> dict[int, list[str]]:
    """Next state -> the words that lead there, in short."""
    words: dict[int, list[str]] = {}
    for word, target in row.items():
        words.setdefault(target, []).append(word)
    return {target: merge_words(found) for target, found in sorted(words.items())}


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _signs(words: Mapping[tuple[str, str], str], known: Mapping[tuple[str, str], str]) -> Iterator[str]:
    """Words with their pairs, without those that another table has too."""
    signs: dict[str, list[str]] = {}
    for pair, word in words.items():
        if known.get(pair) != word:
            signs.setdefault(word, []).append(",".join(pair))
    width = max(map(len, signs), default=0)
    for word, pairs in signs.items():
        yield f"  {word:<{width}}  {'  '.join(pairs)}"


def _table(grammar: Grammar) -> Iterator[str]:
    for state, row in enumerate(grammar.table.transitions):
        name = "idle" if state == 0 else str(state)
        form = grammar.table.accepting.get(state)
        if form is not None:
            yield f"  {name:>4}  complete: {form.kind}{', to be confirmed' if form.confirm else ''}"
        for target, words in targets(row).items():
            yield f"  {name:>4}  {'|'.join(words)} -> {target}"


def _entries(entries: Mapping[int, object] | Mapping[str, object]) -> Iterator[str]:
    width = max((len(str(key)) for key in entries), default=0)
    for key, value in entries.items():
        yield f"  {key!s:<{width}}  {value}"


def _read_pair(grammar: Grammar, text: str) -> tuple[str, str]:
    left, comma, right = text.partition(",")
    if not comma:
        raise UsageError(f'{text[:40]}: is no pair; write "left hand,right hand", such as ok,5')
    for token in (left, right):
        if token not in grammar.tokens:
            known = ", ".join(grammar.tokens[:12])
            raise UsageError(f"{text[:40]}: unknown token '{token[:40]}'; use one of {known}")
    return left, right


def tell(events: Sequence[Event]) -> Iterator[str]:
    """Events in words, those for displays left out."""
    for event in events:
        if event.type == "word":
            yield event.word
        elif event.type == "instruction":
            yield f"issued: {event.text} ({event.kind})"
        elif event.type == "rejected":
            yield f"rejected: {event.reason}, {event.detail}"
        elif event.type == "notice":
            yield f"{event.reason}: {event.detail}"
