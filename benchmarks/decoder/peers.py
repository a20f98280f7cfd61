"""The bundled grammar as a machine of two state-machine libraries, to compare their times with the decoder's."""

from collections.abc import Callable, Iterator
from typing import Any

from lightgesture.fsm import Grammar
from lightgesture.fsm.rules.dwell import Dwell, Hold
from lightgesture.fsm.signs import Shown, Signs

Arguments = tuple[Signs, float, int]
"""Those of `Decoder.step`, in its order."""

Step = Callable[[*Arguments], object]


class Guarded:
    """The dwell as the guard of a library's transitions, and what the library is asked for each pair.

    always: whether it is asked in every frame that shows a word, or only once a sign was held.
    """

    def __init__(self, grammar: Grammar, always: bool) -> None:
        self._grammar = grammar
        self._always = always
        self._dwell = Dwell(grammar.dwell.hold, 3)
        self._hold: Hold | None = None
        self._idle: dict[Shown, Callable[[], object]] = {}
        self._inside: dict[Shown, Callable[[], object]] = {}

    def ask(self, machine: object) -> None:
        """The machine whose methods have the words' names."""
        for asked, words in (
            (self._idle, self._grammar.idle_words),
            (self._inside, self._grammar.sentence_words),
        ):
            asked.update((pair, getattr(machine, method(word))) for pair, word in words.items())

    def step(self, signs: Signs, time_s: float, frame: int, is_idle: bool) -> object:
        """Show a frame to the dwell and, if it is time, ask the machine."""
        shown = signs.shown
        self._hold = self._dwell.process(shown, signs.confidence, frame, time_s, time_s)
        if shown is None or (self._hold is None and not self._always):
            return None
        move = (self._idle if is_idle else self._inside).get(shown)
        return None if move is None else move()

    def is_held(self) -> bool:
        """Whether the frame's pair was held for long enough."""
        return self._hold is not None


def method(word: str) -> str:
    """The name of the method that a library makes of a word."""
    return f"w_{word.replace(' ', '_')}"


def edges(grammar: Grammar) -> Iterator[tuple[str, int, int]]:
    """Word, state, next state; complete sentences are idle again."""
    for state, row in enumerate(grammar.table.transitions):
        for word, target in row.items():
            yield method(word), state, 0 if target in grammar.table.accepting else target


def _step(guarded: Guarded, is_idle: Callable[[], bool]) -> Step:
    """What is called as the decoder's own `step` is."""
    return lambda signs, time_s, frame: guarded.step(signs, time_s, frame, is_idle())


def transitions_step(grammar: Grammar, always: bool = True) -> Step:
    """The grammar as a machine of the package `transitions`."""
    import transitions

    guarded = Guarded(grammar, always)
    machine: Any = transitions.Machine(
        states=[f"s{state}" for state in range(len(grammar.table.transitions))],
        initial="s0",
        ignore_invalid_triggers=True,
        auto_transitions=False,
        transitions=[
            {"trigger": word, "source": f"s{state}", "dest": f"s{target}", "conditions": guarded.is_held}
            for word, state, target in edges(grammar)
        ],
    )
    guarded.ask(machine)

    return _step(guarded, lambda: bool(machine.state == "s0"))


def statemachine_step(grammar: Grammar, always: bool = True) -> Step:
    """The grammar as a machine of the package `python-statemachine`."""
    import statemachine

    used = {state for _, *pair in edges(grammar) for state in pair}
    states = {state: statemachine.State(initial=state == 0) for state in sorted(used)}
    guarded = Guarded(grammar, always)
    body: dict[str, Any] = {f"s{state}": value for state, value in states.items()}
    body["allow_event_without_transition"] = True
    body["is_held"] = lambda _: guarded.is_held()
    for word, state, target in edges(grammar):
        edge = states[state].to(states[target], cond="is_held")
        body[word] = body[word] | edge if word in body else edge
    machine: Any = type("GrammarMachine", (statemachine.StateMachine,), body)()
    guarded.ask(machine)
    idle = machine.s0

    return _step(guarded, lambda: bool(idle.is_active))
