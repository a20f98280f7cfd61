"""A diver who signs words to a decoder, and what comes of it."""

from lightgesture.fsm import Decoder, Sign, Signs
from lightgesture.fsm.reader import Reader
from lightgesture.fsm.reporter import Reporter, Timeline
from lightgesture.fsm.rules.sentence import SentenceRule

UNREAD = Signs(Sign(None, 0.97, {"none": 0.97}), Sign(None, 0.97, {"none": 0.97}))


def likely(token, chance=0.97, others=None):
    """A hand whose reader names a token with this probability; others: probabilities of other tokens."""
    return Sign(token, chance, {token: chance, **(others or {})})


class Diver:
    """Signs words for `held_s` each, hands passing from one to the next for `passage_s`, at `rate` frames a second."""

    def __init__(self, grammar, rate=30, held_s=0.8, passage_s=0.25, **options):
        self.decoder = Decoder(grammar, rule="sentence", **options)
        self.rate, self.held_s, self.passage_s = rate, held_s, passage_s
        self.pairs = {word: pair for pair, word in grammar.sentence_words.items()}
        self.pairs |= {word: pair for pair, word in grammar.menu_words.items()}
        self.pairs |= {word: pair for pair, word in grammar.idle_words.items() if word not in self.pairs}
        self.pairs["STOP"] = ("0", "0")
        self.frame = 0
        self.events = []

    def show(self, signs, seconds):
        events = []
        for _ in range(max(1, round(seconds * self.rate))):
            events += self.decoder.step(signs, self.frame / self.rate, self.frame)
            self.frame += 1
        self.events += events
        return events

    def pair(self, left, right, chance=0.97, seconds=None):
        signs = Signs(likely(left, chance), likely(right, chance))
        return self.show(signs, self.held_s if seconds is None else seconds) + self.show(
            UNREAD, self.passage_s
        )

    def words(self, words, **how):
        events = []
        for word in words.split() if isinstance(words, str) else words:
            events += self.pair(*self.pairs[word.replace("_", " ")], **how)
        return events

    def pause(self, seconds=1.0):
        return self.show(Signs(), seconds)


def issued(events):
    return [event.text for event in events if event.type == "instruction"]


def rejected(events):
    return [event.reason for event in events if event.type == "rejected"]


def rule_and_timeline(grammar):
    """The rule by itself, without the decoder round it."""
    timeline = Timeline()
    reporter = Reporter(None, timeline)
    reader = Reader(grammar, reporter, timeline)
    return SentenceRule(grammar, grammar.sentence, reader, reporter, timeline), timeline
