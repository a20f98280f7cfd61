"""A parameter that a diver changes by a step, within the profile's limits."""

from typing import Final

from lightgesture.fsm import Instruction
from lightgesture.vehicle.bench import Bench
from lightgesture.vehicle.interface import ReadParameter, Reply, WriteParameter
from lightgesture.vehicle.profile import ParameterTable
from lightgesture.vehicle.runs import Outcome, Run

_SIGNS: Final = {"INCREASE": 1.0, "DECREASE": -1.0}


def changed(table: ParameterTable, change: str | None, value: float) -> float | str:
    """The new value of a parameter, or why there is none."""
    if change == "DEFAULT":
        return table.default
    sign = _SIGNS.get(change or "")
    if sign is None:
        return f"{change} is no change of a parameter"
    if not table.minimum <= value <= table.maximum:
        return f"{table.name} is {value:g}, outside of {table.minimum:g} to {table.maximum:g}"
    new = min(max(value + sign * table.step, table.minimum), table.maximum)
    return new if new != value else f"{table.name} is {value:g}, at its limit already"


class ParameterRun(Run):
    """Reads, sets and reads again; one of the executor's own is changed here."""

    is_moving = False

    def __init__(self, record: Instruction, table: ParameterTable) -> None:
        super().__init__(record)
        self._table = table
        self.detail = table.name
        self._reading: Reply | None = None
        self._writing: Reply | None = None

    def begin(self, bench: Bench, now_s: float) -> None:
        """Ask the vehicle what it is."""
        if not self._table.own:
            self._reading = bench.vehicle.order(ReadParameter(name=self._table.name), now_s)

    def tick(self, bench: Bench, now_s: float) -> Outcome:
        """Until the vehicle says that it is what it should be."""
        if self._reading is None:
            return self._change_own(bench)
        if self._writing is not None:
            return self._outcome(self._writing)
        if self._reading.state != "accepted":
            return self._outcome(self._reading)
        old = self._reading.value or 0.0
        new = changed(self._table, self.record.change, old)
        if isinstance(new, str):
            return self.refuse(new)
        self.detail = f"{self._table.name} {old:g} to {new:g}"
        self._writing = bench.vehicle.order(WriteParameter(name=self._table.name, value=new), now_s)
        return "pending"

    def _outcome(self, reply: Reply) -> Outcome:
        if reply.state == "refused":
            return self.refuse(f"{self.detail}: {reply.detail}")
        return "pending" if reply.state == "pending" else "done"

    def _change_own(self, bench: Bench) -> Outcome:
        name = self._table.name
        found: float | None = getattr(bench, name)
        old = self._table.default if found is None else found
        new = changed(self._table, self.record.change, old)
        if isinstance(new, str):
            return self.refuse(new)
        setattr(bench, name, new)
        self.detail = f"{name} {old:g} to {new:g}"
        return "done"
