"""From a sentence to the pairs that sign it, and from a sentence so far to what may follow."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

from lightgesture.errors import UsageError
from lightgesture.fsm import Decoder, Event, Grammar, Instruction, Notice, Pair, Rejected, Signs
from lightgesture.fsm.language.forms import MENU, is_digit, split_carrier

MOST_WORDS = 1000
"""Longest sentence that is looked at; a grammar allows no longer one."""

SHOWN = 80
"""Letters of a sentence that a message repeats."""


@dataclass(frozen=True, slots=True)
class SignedWord:
    """A word of a sentence with the pair that signs it, the left hand first, and other pairs that say the same here."""

    word: str
    pair: Pair
    others: tuple[Pair, ...] = ()


@dataclass(frozen=True, slots=True)
class SignedSentence:
    """A sentence that the grammar can say: its text as an instruction has it, and its signs in order.

    is_confirmed: the end word comes twice.
    """

    text: str
    signs: tuple[SignedWord, ...]
    is_confirmed: bool = False


def read_sentence(grammar: Grammar, text: str) -> SignedSentence:
    """The signs of a sentence such as "STOP HOVER 50 GO", small letters too, digits joined or apart.

    UsageError: the grammar cannot say it, or what it says would be rejected.
    """
    words = split_words(grammar, text)
    text = text if len(text) <= SHOWN else f"{text[: SHOWN - 3]}..."
    if not words:
        raise UsageError('no sentence; write one, such as "STOP HOVER 50 GO"')
    decoder = Decoder(grammar, hold=1)
    signs: list[SignedWord] = []
    for number, word in enumerate(words):
        signs.append(_signed(grammar, word, words[:number], text))
        issued = _issued(_held(decoder, signs[-1].pair), text)
        if issued is None and number == len(words) - 1 and decoder.state == "confirming":
            signs.append(signs[-1])
            issued = _issued(_held(decoder, signs[-1].pair), text)
            return SignedSentence(issued or text, tuple(signs), is_confirmed=True)
        if issued is not None:
            if number < len(words) - 1:
                raise UsageError(f"{text}: {issued} is a whole sentence; write one sentence at a time")
            return SignedSentence(issued, tuple(signs))
    raise UsageError(f"{text}: is not complete; expected {decoder.expected}")


def split_words(grammar: Grammar, text: str) -> list[str]:
    """The words of a text: "PARAM 3" is one, a number is its digits with the joining word between them."""
    parts = text.upper().split()[:MOST_WORDS]
    carriers = (
        {*grammar.vocabulary.carriers, "SELECT"} if grammar.menu_words else {*grammar.vocabulary.carriers}
    )
    join = grammar.vocabulary.join
    words: list[str] = []
    while parts:
        part = parts.pop(0)
        if part in carriers and parts:
            words.append(f"{part} {parts.pop(0)}")
        elif part.isascii() and part.isdigit():
            for digit in part:
                if words and words[-1].isdigit() and join is not None:
                    words.append(join)
                words.append(digit)
        else:
            words.append(part)
    return words


def following(grammar: Grammar, sentence: str, state: str) -> list[str]:
    """The words that may follow the sentence so far, sorted; state: as `state` records have it.

    Empty where the grammar does not know the sentence.
    """
    if state == "confirming":
        return [grammar.end]
    place = 0
    for word in split_words(grammar, sentence):
        row = grammar.table.transitions[place]
        if word not in row:
            return []
        place = row[word]
    return sorted(grammar.table.transitions[place])


def words_at(grammar: Grammar, before: Sequence[str]) -> Mapping[Pair, str]:
    """What each pair says after these words of an open sentence; none: while idle."""
    if not before:
        return grammar.idle_words
    return grammar.menu_words if before[0] == MENU else grammar.sentence_words


def pairs_by_word(grammar: Grammar) -> dict[str, list[Pair]]:
    """Every word with its pairs: those that open a sentence, end it and join digits, the others as in the file, numbers
    in order."""
    pairs: dict[str, list[Pair]] = {}
    for table in (grammar.idle_words, grammar.sentence_words, grammar.menu_words):
        for pair, word in table.items():
            known = pairs.setdefault(word, [])
            if pair not in known:
                known.append(pair)
    return {word: pairs[word] for word in sorted(pairs, key=_place_of(grammar, list(pairs)))}


def _place_of(grammar: Grammar, words: Sequence[str]) -> Callable[[str], tuple[int, int]]:
    """What the words are sorted by."""
    opening: dict[str, int] = {}
    for form in grammar.table.walks:
        opening.setdefault(form.partition(" ")[0], len(opening))
    firsts: dict[str, int] = {}
    for number, word in enumerate(words):
        firsts.setdefault(_family(word), number)

    def place(word: str) -> tuple[int, int]:
        if word in grammar.table.transitions[0]:
            return 0, opening.get(word, len(opening))
        if word == grammar.end:
            return 1, 0
        if word == grammar.vocabulary.join:
            return 2, 0
        number = int(word) if is_digit(word) else split_carrier(word)[1]
        return 3 + firsts[_family(word)], number or 0

    return place


def _family(word: str) -> str:
    return "0" if is_digit(word) else split_carrier(word)[0]


def _signed(grammar: Grammar, word: str, before: Sequence[str], text: str) -> SignedWord:
    pairs = [pair for pair, said in words_at(grammar, before).items() if said == word]
    if pairs:
        return SignedWord(word, pairs[0], tuple(pairs[1:]))
    known = pairs_by_word(grammar)
    if word in known:
        place = f"after {' '.join(before)}" if before else "at the beginning"
        raise UsageError(f"{text}: {word} cannot be signed {place}; `lightgesture signs` lists the sentences")
    near = get_close_matches(word, known, 1, 0.6)
    hint = f"did you mean {near[0]}?" if near else "`lightgesture signs` lists the words"
    raise UsageError(f"{text}: {word[:40]} is no word of the language; {hint}")


def _held(decoder: Decoder, pair: Pair) -> list[Event]:
    """What comes of a pair that is held and let go."""
    return decoder.step(Signs.of_tokens(*pair), 0.0) + decoder.step(Signs(), 0.0)


def _issued(events: Sequence[Event], text: str) -> str | None:
    """The text of the instruction among events. UsageError: the sentence is refused."""
    for event in events:
        if isinstance(event, Instruction):
            return event.text
        if isinstance(event, Rejected) or (isinstance(event, Notice) and event.reason != "confirm"):
            raise UsageError(f"{text}: {event.detail}")
    return None
