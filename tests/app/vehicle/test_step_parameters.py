"""Parameters as steps of a task, tick by tick, without a link and without a wait."""

import pytest

from lightgesture.vehicle import (
    ReadParameter,
    WriteParameter,
)
from lightgesture.vehicle.parameter_run import ParameterRun, changed
from lightgesture.vehicle.profile import ParameterTable
from tests.app.vehicle.step_bench import START_S, Bench

TABLE = ParameterTable(number=1, name="SPEED", step=2.0, minimum=1.0, maximum=6.0, default=3.0)


@pytest.mark.parametrize(
    ("change", "value", "expected"),
    [
        ("INCREASE", 3.0, 5.0),
        ("INCREASE", 5.0, 6.0),
        ("INCREASE", 6.0, "SPEED is 6, at its limit already"),
        ("DECREASE", 3.0, 1.0),
        ("DECREASE", 2.0, 1.0),
        ("DECREASE", 1.0, "SPEED is 1, at its limit already"),
        ("INCREASE", 1.0, 3.0),
        ("DECREASE", 6.0, 4.0),
        ("INCREASE", 6.5, "SPEED is 6.5, outside of 1 to 6"),
        ("DECREASE", 0.5, "SPEED is 0.5, outside of 1 to 6"),
        ("DEFAULT", 5.0, 3.0),
        ("DEFAULT", 9.0, 3.0),
        ("HALVE", 3.0, "HALVE is no change of a parameter"),
    ],
)
def test_a_parameter_changes_by_its_step_within_its_limits(change, value, expected):
    assert changed(TABLE, change, value) == expected


def parameter_run(instruction, answer, value=None):
    run, own = ParameterRun(instruction("CONTD PARAM 1 INCREASE GO"), TABLE), Bench(answer, value=value)
    run.begin(own, START_S)
    return run, own


def test_a_parameter_is_read_then_written(instruction):
    run, own = parameter_run(instruction, "accepted", 3.0)
    assert own.orders == [ReadParameter(name="SPEED")]
    assert run.tick(own, START_S) == "pending"
    assert own.orders[1:] == [WriteParameter(name="SPEED", value=5.0)]
    assert run.tick(own, START_S) == "done"
    assert run.detail == "SPEED 3 to 5"


@pytest.mark.parametrize(
    ("answer", "value", "outcome", "reason"),
    [
        ("pending", None, "pending", ""),
        ("refused", None, "refused", "SPEED: as it says"),
        ("accepted", 6.0, "refused", "SPEED is 6, at its limit already"),
    ],
)
def test_nothing_is_written_before_a_parameter_is_known(instruction, answer, value, outcome, reason):
    run, own = parameter_run(instruction, answer, value)
    assert (run.tick(own, START_S), run.reason) == (outcome, reason)
    assert len(own.orders) == 1


def test_a_parameter_of_the_executor_is_changed_here(instruction):
    table = ParameterTable(number=2, name="cap", own=True, step=0.25, minimum=0.05, maximum=1.0, default=0.5)
    run, own = ParameterRun(instruction("CONTD PARAM 2 INCREASE GO"), table), Bench()
    run.begin(own, START_S)
    assert run.tick(own, START_S) == "done"
    assert (own.cap, own.orders, run.detail) == (0.65, [], "cap 0.4 to 0.65")
    pictures = table.model_copy(update={"name": "interval_s"})
    run = ParameterRun(instruction("CONTD PARAM 2 DECREASE GO"), pictures)
    run.begin(own, START_S)
    assert run.tick(own, START_S) == "done"
    assert own.interval_s == 0.25  # from its default
