"""From tokens to instructions: grammar, dwell, decoder. No NumPy, no clock, no file but the grammar's."""

from lightgesture.fsm.decoder import Decoder
from lightgesture.fsm.events import Event, Instruction, Notice, Rejected, State, Word
from lightgesture.fsm.grammar import Grammar, GrammarError
from lightgesture.fsm.load import load_grammar

__all__ = [
    "Decoder",
    "Event",
    "Grammar",
    "GrammarError",
    "Instruction",
    "Notice",
    "Rejected",
    "State",
    "Word",
    "load_grammar",
]
