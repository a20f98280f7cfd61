"""From tokens to instructions: grammar, rules, decoder.

No NumPy but in the rule "sentence", no clock, no file but the grammar's.
"""

from lightgesture.fsm.decoder import Decoder
from lightgesture.fsm.events import Event, Instruction, Notice, Rejected, State, Word
from lightgesture.fsm.language.grammar import Defect, Grammar, GrammarError
from lightgesture.fsm.language.load import inspect_grammar, load_grammar
from lightgesture.fsm.signs import UNSEEN, Pair, Shown, Sign, Signs

__all__ = [
    "UNSEEN",
    "Decoder",
    "Defect",
    "Event",
    "Grammar",
    "GrammarError",
    "Instruction",
    "Notice",
    "Pair",
    "Rejected",
    "Shown",
    "Sign",
    "Signs",
    "State",
    "Word",
    "inspect_grammar",
    "load_grammar",
]
