"""A diver who practises, in tests."""

from lightgesture.fsm import Decoder, Signs, load_grammar
from lightgesture.practice.session import Session
from lightgesture.records import FrameRecord, Hand

GRAMMAR = load_grammar()
STEP_S = 0.1
HOLD_S = 0.5


class Diver:
    """Signs to a decoder, ten frames a second, and gives what comes of it to a session."""

    def __init__(self, tasks, grammar=GRAMMAR, limit_s=60.0):
        self.decoder = Decoder(grammar, rule="seconds", hold_seconds=HOLD_S)
        self.session = Session(tasks, grammar, limit_s, is_revised=False)
        self.frame = 0

    def look(self, left, right):
        """One frame; None: a hand that is not read."""
        time_s = self.frame * STEP_S
        box = (0, 0, 10, 10)
        hands = tuple(
            Hand(
                side=side,
                token=token,
                confidence=0.9,
                box=box,
                track=1,
                reason=None if token else "low_confidence",
            )
            for side, token in (("left", left), ("right", right))
        )
        at = {"source": "test", "frame": self.frame, "time_s": time_s}
        events = self.decoder.step(Signs.of_tokens(left, right), time_s, self.frame)
        self.session.take([FrameRecord(hands=hands, **at), *events])
        if self.session.wants_fresh:
            self.decoder.interrupt("again", time_s, self.frame)
            self.session.freshened()
        self.frame += 1

    def sign(self, text, frames=8):
        for pair in text.split():
            for _ in range(frames):
                self.look(*pair.split(","))
            self.look(None, None)
