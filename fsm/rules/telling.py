"""What the diver was told of the open sentence by the rule "sentence", word by word."""

from lightgesture.fsm.language.forms import spell
from lightgesture.fsm.language.grammar import Grammar
from lightgesture.fsm.reader import Reader
from lightgesture.fsm.reporter import Reporter
from lightgesture.fsm.rules.doubts import MARGIN, MISFIT, Doubt, is_weak
from lightgesture.fsm.rules.dwell import Hold
from lightgesture.fsm.rules.readings import Reading
from lightgesture.fsm.rules.search import Search
from lightgesture.fsm.sentence import Sentence


class Telling:
    """Tells words as soon as no near reading speaks against them.

    told: the words so far, none while no sentence is open. is_sure: whether its first word was beyond doubt.
    """

    def __init__(
        self, grammar: Grammar, caution: float, search: Search, reader: Reader, reporter: Reporter
    ) -> None:
        self._grammar, self._caution = grammar, caution
        self._search, self._reader, self._reporter = search, reader, reporter
        self.reset()

    def reset(self) -> None:
        """As at the start of a stream."""
        self.told: tuple[str, ...] = ()
        self._told_s = 0.0
        self.is_sure = False

    @property
    def text(self) -> str:
        """What was told, digits joined."""
        return spell(self.told, self._grammar.vocabulary.join)

    def is_another(self, reading: Reading) -> bool:
        """Whether a reading is of a sentence that began after the one that was told, which is not over."""
        return bool(self.told) and self.is_sure and reading.began > self._told_s

    def tell(self, lead: int, reading: Reading, now_s: float) -> Doubt | None:
        """Tell the words on which all near readings agree, once each; what rejects the sentence that was told."""
        words = reading.words
        standing = self._search.standing
        if words == self.told:
            self.is_sure = self.is_sure or self._is_sure(reading, standing.certainties(lead))
            return None
        if standing.behind(lead) > MISFIT / self._caution:
            return None
        agreed = self._agreed(lead, reading)
        kept = common(agreed, self.told)
        if agreed and self.is_another(reading):
            return self.inside(agreed[0]) if len(self.told) == 1 else None
        if len(agreed) <= kept or (kept == 0 and len(self.told) > 1):
            return None
        certainties = standing.certainties(lead)
        if not is_weak(words[0], certainties[0], self._caution):
            self.open(reading, agreed, certainties, now_s)
            self.tell_words(reading, agreed, kept, certainties)
            self.told, self._told_s = agreed, self._search.windows.now
            self.is_sure = len(agreed) > 1 or self._is_sure(reading, certainties)
        return None

    def _is_sure(self, reading: Reading, certainties: list[float]) -> bool:
        """Whether the first word was seen well enough to be issued with; until then it may be shown again."""
        return not is_weak(reading.words[0], certainties[0], self._caution, opens=True)

    def _agreed(self, lead: int, reading: Reading) -> tuple[str, ...]:
        """The words with which all near readings begin; the end word comes with the verdict."""
        agreed = reading.words
        for other in self._search.standing.near(lead, MARGIN):
            agreed = agreed[: common(agreed, other.words)]
        if reading.state in self._grammar.table.accepting:
            agreed = agreed[: len(reading.words) - 1]
        return agreed

    def tell_words(
        self, reading: Reading, words: tuple[str, ...], first: int, certainties: list[float]
    ) -> None:
        """Words of a reading, from `first` on, have their place."""
        for place in range(first, len(words)):
            text = spell(words[: place + 1], self._grammar.vocabulary.join)
            self._reporter.word(self.hold(reading, place, certainties[place]), words[place], text)

    def open(
        self, reading: Reading, words: tuple[str, ...], certainties: list[float], now_s: float
    ) -> Sentence:
        """The sentence of the first words of a reading is the open one."""
        sentence = self._reader.begin(self.hold(reading, 0, certainties[0]), words[0])
        transitions, state = self._grammar.table.transitions, 0
        for place, word in enumerate(words):
            state = transitions[state][word]
            hold = self.hold(reading, place, certainties[place])
            sentence.add(word, hold, state, now_s, self._grammar.vocabulary.join)
        return sentence

    def hold(self, reading: Reading, place: int, certainty: float) -> Hold:
        """The sign of a word of a reading."""
        spoken = reading.spoken[place]
        return Hold(
            pair=self._search.scores.shown(spoken.column),
            frames=1,
            confidence=certainty,
            first_frame=spoken.frame,
            first_time_s=spoken.time_s,
        )

    def inside(self, word: str) -> Doubt:
        """A start word came in mid-sentence."""
        detail = f"{word} cannot follow {self.text}; expected {self._reader.expected}"
        return Doubt(reason="out_of_order", detail=detail)


def common(one: tuple[str, ...], other: tuple[str, ...]) -> int:
    """Length of the beginning that two sequences share."""
    for place, (left, right) in enumerate(zip(one, other, strict=False)):
        if left != right:
            return place
    return min(len(one), len(other))
