"""From tokens to instructions: grammar, dwell, decoder. No NumPy, no clock, no file but the grammar's."""

from lightgesture.fsm.decoder import Decoder
from lightgesture.fsm.events import Event, Instruction, Notice, Rejected, State, Word
from lightgesture.fsm.grammar import Defect, Grammar, GrammarError
from lightgesture.fsm.load import inspect_grammar, load_grammar

__all__ = [
    "Decoder",
    "Defect",
    "Event",
    "Grammar",
    "GrammarError",
    "Instruction",
    "Notice",
    "Rejected",
    "State",
    "Word",
    "inspect_grammar",
    "load_grammar",
]
