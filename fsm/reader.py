"""What held signs do to the sentence that is being signed."""

from lightgesture.fsm.events import Certainty, Growth
from lightgesture.fsm.language.forms import MENU, Form, Item, spell
from lightgesture.fsm.language.grammar import Grammar
from lightgesture.fsm.language.table import Arguments, bind
from lightgesture.fsm.reporter import Reporter, Timeline
from lightgesture.fsm.rules.dwell import Hold
from lightgesture.fsm.rules.unread import UnreadSigning
from lightgesture.fsm.sentence import Sentence, name_expected, needs_confirmation, objection
from lightgesture.fsm.signs import Shown, are_two_cards

IDLE = "idle"
COLLECTING = "collecting"
CONFIRMING = "confirming"


class Reader:
    """Walks the open sentence through the grammar's table, one held pair after the other, and tells what comes of it.

    sentence: the open one, or None. words: what each pair says at this point. unread: is told when a sign was read, or
    was no word; None: nobody asks.
    """

    def __init__(
        self, grammar: Grammar, reporter: Reporter, timeline: Timeline, unread: UnreadSigning | None = None
    ) -> None:
        self._grammar = grammar
        self._reporter = reporter
        self._timeline = timeline
        self._unread = unread
        self.sentence: Sentence | None = None
        self.words = grammar.idle_words

    @property
    def state(self) -> str:
        """ "idle", "collecting", or "confirming" while a complete sentence waits for its second end word."""
        if self.sentence is None:
            return IDLE
        return COLLECTING if self.sentence.complete is None else CONFIRMING

    @property
    def text(self) -> str:
        """The open sentence so far, digits joined; empty while idle."""
        return "" if self.sentence is None else self.sentence.text

    @property
    def expected(self) -> str:
        """What may follow, for the diver: "GO or a digit"."""
        if self.sentence is None:
            return name_expected(self._grammar.table.transitions[0])
        if self.sentence.complete is not None:
            return self._grammar.end
        return name_expected(self._grammar.table.transitions[self.sentence.state])

    def read(self, hold: Hold) -> None:
        """A pair was held long enough."""
        word = self.word_of(hold.pair)
        sentence, control = self.sentence, self._grammar.control
        if word is None:
            self._report_unknown(hold.pair)
        elif word == control.kill:
            self._kill(hold, word)
        elif sentence is None:
            self._open(hold, word)
        elif word == control.cancel:
            self.drop("cancelled", f"{word} was signed")
        elif sentence.complete is not None:
            self._confirm(hold, word, sentence, sentence.complete)
        else:
            self._continue(hold, word, sentence)

    def word_of(self, shown: Shown) -> str | None:
        """What is said at this point by a pair, or by a word that says itself; None: nothing."""
        if len(shown) == 2:
            return self.words.get((shown[0], shown[1]))
        return shown[0] if shown[0] in self._grammar.vocabulary.words else None

    def _report_unknown(self, pair: Shown) -> None:
        if self._unread is not None:
            self._unread.pass_over()
        if self.sentence is not None:
            self.sentence.has_unknown = True
        if are_two_cards(pair):
            self._reporter.notice("two_cards", f"{pair[0]} are two cards at once; show one")
            return
        inside = self.sentence is not None and pair in self._grammar.idle_words
        place = "no word inside a sentence" if inside else "no word"
        self._reporter.notice("unknown_pair", f"{','.join(pair)} is {place}; repeat it")

    def _open(self, hold: Hold, word: str) -> None:
        """A word while no sentence is open."""
        row = self._grammar.table.transitions[0]
        if word in row:
            self._accept(hold, word, row[word], self.begin(hold, word))
        else:
            detail = f"{word} opens no sentence; expected {self.expected}"
            self._reporter.notice("out_of_order", detail)

    def begin(self, hold: Hold, word: str) -> Sentence:
        """A sentence is open, whose first word this is, held like this."""
        self.words = self._grammar.menu_words if word == MENU else self._grammar.sentence_words
        self.sentence = Sentence(
            start_frame=hold.first_frame, start_time_s=hold.first_time_s, touched_s=self._timeline.now_s
        )
        return self.sentence

    def _continue(self, hold: Hold, word: str, sentence: Sentence) -> None:
        """A word inside a sentence: it has its place, or rejects the sentence."""
        row = self._grammar.table.transitions[sentence.state]
        if word in row:
            self._accept(hold, word, row[word], sentence)
        else:
            detail = f"{word} cannot follow {sentence.text}; expected {self.expected}"
            self.drop("out_of_order", detail, spell([*sentence.words, word], self._grammar.vocabulary.join))

    def _accept(self, hold: Hold, word: str, target: int, sentence: Sentence) -> None:
        """A word has its place: the sentence goes on or is complete."""
        if self._unread is not None:
            self._unread.reset()
        sentence.add(word, hold, target, self._timeline.now_s, self._grammar.vocabulary.join)
        form = self._grammar.table.accepting.get(target)
        limits = self._grammar.limits
        if form is not None:
            self.conclude(hold, word, form, sentence)
            return
        self._reporter.word(hold, word, sentence.text)
        if sentence.digits > limits.max_digits:
            self.drop("limit", f"a number has at most {limits.max_digits} digits")
        elif len(sentence.words) >= limits.max_words:
            self.drop("limit", f"a sentence has at most {limits.max_words} words")
        else:
            self.show()

    def conclude(self, hold: Hold, word: str, form: Form, sentence: Sentence) -> None:
        """A sentence is complete: issue it, ask for its second end word, or reject it for what it says."""
        arguments = bind(form, sentence.words, self._grammar.table)
        refused = objection(arguments, self._grammar)
        if refused is None and needs_confirmation(form, sentence, self._grammar.control):
            sentence.complete = form
            self._reporter.word(hold, word, sentence.text)
            self._reporter.notice("confirm", f"{sentence.text}: sign {self._grammar.end} again to confirm")
            self.show()
            return
        self._reporter.word(hold, word, IDLE)
        if refused is None:
            self._issue(form, sentence, arguments)
        else:
            self.drop(*refused)

    def _confirm(self, hold: Hold, word: str, sentence: Sentence, form: Form) -> None:
        """A word after a complete sentence that waits for its second end word."""
        if word == self._grammar.end:
            self._reporter.word(hold, word, IDLE)
            self._issue(form, sentence, bind(form, sentence.words, self._grammar.table))
        else:
            self.drop("unconfirmed", f"{word} instead of {self._grammar.end} for {sentence.text}")

    def _kill(self, hold: Hold, word: str) -> None:
        """The one word that is an instruction by itself, in every state."""
        if self.sentence is not None:
            self.drop("cancelled", f"{word} was signed")
        self._reporter.word(hold, word, IDLE)
        sentence = self.begin(hold, word)
        sentence.add(word, hold, 0, self._timeline.now_s, None)
        alone = Form(kind="kill", sentence=word, items=(Item(frozenset([word]), None, False),))
        self._issue(alone, sentence, Arguments(action=word))

    def _issue(self, form: Form, sentence: Sentence, arguments: Arguments) -> None:
        self._reporter.instruction(form, sentence, arguments)
        self._close()

    def drop(self, reason: str, detail: str, text: str | None = None) -> None:
        """The open sentence is rejected. text: what was signed, where that is more than the sentence."""
        self._reporter.rejected(reason, self.text if text is None else text, detail)
        self._close()

    def _close(self) -> None:
        self.sentence = None
        self.words = self._grammar.idle_words
        self.show()

    def show(self, growth: Growth | None = None, certainty: Certainty | None = None) -> None:
        """Tell displays of the sentence, and of the hold that is growing."""
        self._reporter.state(self.state, self.text, growth, certainty)
