"""Mutants are what they say, only the process that tries one has it, and a test that fails tells."""

import importlib
import json
import subprocess
import sys
from pathlib import Path

import pytest

from .mutants import mutants_of, put_in, source_of
from .targets import GROUPS

ROOT = Path(__file__).parents[2]

TOY = '''
"""A module."""

LIMIT = 3


class Gate:
    """Lets some through."""

    def __init__(self) -> None:
        self.count = 0

    @property
    def is_full(self) -> bool:
        return self.count >= LIMIT

    def take(self, size: int = 1, sure: bool = True) -> bool:
        if self.is_full or not sure:
            return False
        self.count += size
        print(self.count)
        return 0 < size <= 2
'''


def shown(source):
    return [(mutant.function, mutant.before, mutant.after) for mutant in mutants_of("toy", source)]


def test_the_mutants_of_a_module_are_those_of_the_bodies_of_its_functions():
    assert shown(TOY) == [
        ("Gate.__init__", "0", "1"),
        ("Gate.is_full", "self.count >= LIMIT", "self.count > LIMIT"),
        ("Gate.is_full", "self.count >= LIMIT", "self.count <= LIMIT"),
        ("Gate.take", "self.is_full or not sure", "not (self.is_full or not sure)"),
        ("Gate.take", "self.is_full or not sure", "self.is_full and (not sure)"),
        ("Gate.take", "not sure", "not not sure"),
        ("Gate.take", "False", "True"),
        ("Gate.take", "self.count += size", "self.count -= size"),
        ("Gate.take", "print(self.count)", "pass"),
        ("Gate.take", "0 < size <= 2", "0 <= size <= 2"),
        ("Gate.take", "0 < size <= 2", "0 > size <= 2"),
        ("Gate.take", "0 < size <= 2", "0 < size < 2"),
        ("Gate.take", "0 < size <= 2", "0 < size >= 2"),
        ("Gate.take", "0", "1"),
        ("Gate.take", "2", "3"),
    ]


def test_a_mutant_keeps_its_name_where_the_text_around_it_changes():
    keys = [mutant.key for mutant in mutants_of("toy", TOY)]
    assert len(set(keys)) == len(keys)
    assert [mutant.key for mutant in mutants_of("toy", "import math\n" + TOY)] == keys


@pytest.fixture
def toy(tmp_path, monkeypatch):
    """The module, imported from a file."""
    (tmp_path / "toy.py").write_text(TOY)
    monkeypatch.syspath_prepend(tmp_path)
    yield importlib.import_module("toy")
    del sys.modules["toy"]


def test_the_code_of_one_function_is_exchanged_and_no_file(toy, tmp_path):
    gate, before = toy.Gate(), (tmp_path / "toy.py").read_text()
    gate.count = 3
    assert gate.is_full
    mutants = list(mutants_of("toy", TOY))
    assert put_in(mutants[1], TOY) == 1
    assert not gate.is_full
    assert put_in(mutants[6], TOY) == 1
    assert gate.take(sure=False)
    assert (tmp_path / "toy.py").read_text() == before


TRIAL = """
import json, pathlib, sys
sys.path[:0] = [{root!r}, {folder!r}]
import pytest
from tests.mutation.mutants import mutants_of
from tests.mutation.running import Trial
source = pathlib.Path("toy.py").read_text()
mutants = [one for one in mutants_of("toy", source) if one.after in {afters}]
outcomes = []
def note(mutant, outcome, killer, seconds):
    outcomes.append((mutant.function, mutant.before, mutant.after, outcome, killer))
functions = {{(mutant.module, mutant.function) for mutant in mutants}}
for _ in range(2):
    trial = Trial(mutants, {{"toy": source}}, functions, pathlib.Path("calls"), 9.0, [], note)
    status = pytest.main(["-q", "-s", "-p", "no:cacheprovider", "test_toy.py"], plugins=[trial])
    del sys.modules["test_toy"]
print(json.dumps([int(status), outcomes]))
"""

TESTS = """
import pytest, toy

@pytest.fixture(scope="module")
def counted():
    return toy.Gate().count

def test_counts(counted):
    assert counted == 0

def test_ends():
    gate = toy.Gate()
    while not gate.is_full:
        gate.take()
    assert gate.count == 3

def test_nothing():
    pass
"""


def test_a_mutant_is_killed_by_a_failure_or_an_endless_loop_and_else_survives(tmp_path):
    (tmp_path / "toy.py").write_text(TOY.replace("return 0 < size <= 2", "return True"))
    (tmp_path / "test_toy.py").write_text(TESTS)
    afters = ["1", "self.count > LIMIT", "self.count -= size", "pass", "False"]
    script = TRIAL.format(root=str(ROOT), folder=str(tmp_path), afters=afters)
    done = subprocess.run(
        [sys.executable, "-c", "import tests.mutation.running as r; r.SPARE_S = 0.2\n" + script],
        cwd=tmp_path,
        env={"PYTHONPATH": str(ROOT), "PATH": ""},
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
    )
    status, outcomes = json.loads(done.stdout.splitlines()[-1])
    assert status == 0
    half = len(outcomes) // 2
    assert outcomes[:half] == outcomes[half:]
    told = {(before, after): (outcome, killer) for _, before, after, outcome, killer in outcomes}
    assert told["0", "1"] == ("killed", "test_toy.py::test_counts")
    outcome, killer = told["self.count += size", "self.count -= size"]
    assert outcome == "killed"
    assert killer.startswith("ended with")
    assert told["print(self.count)", "pass"] == ("survived", "")
    assert told["self.count >= LIMIT", "self.count > LIMIT"] == ("killed", "test_toy.py::test_ends")
    assert told["True", "False"] == ("survived", "")


def test_every_group_has_modules_and_tests_that_are_there():
    for name, group in GROUPS.items():
        assert group.modules, name
        for module in group.modules:
            assert source_of(module)
        for test in group.tests:
            assert (ROOT / test).exists(), test
