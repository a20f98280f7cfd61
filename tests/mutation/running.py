"""Tests are collected once; each mutant is then a forked process that runs the tests which call its function.

One run of the unaltered code notes which functions each test calls and how long it takes; it is kept as long as the
test's file stays the same. The quickest tests come first, and the first that fails ends a mutant. Only the processes
are altered, so that nothing is left of a mutant. Seconds are of the processor, for others may use it.
"""

import hashlib
import json
import os
import pickle
import resource
import signal
import sys
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass, field
from itertools import accumulate
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

import pytest

from .mutants import Mutant, put_in

SPARE_S = 5.0
"""Seconds beyond what its tests may take after which a mutant counts as one that hangs."""
SLOWER = 3.0
"""How many times longer than in the first run its tests may take."""
WAITING = 20.0
"""How many times as many seconds of the clock: others use the machine."""
START_S = 0.05
"""Seconds that each test costs besides its own."""
MEMORY = 4 << 30
"""Bytes of address space that a mutant may take beyond what there is."""


@dataclass(slots=True)
class Called:
    """What a test does: its seconds, the functions that it calls, and the digest of its file."""

    seconds: float = 0.0
    functions: set[tuple[str, str]] = field(default_factory=set)
    digest: str = ""


class Trial:
    """A plugin of pytest that tries mutants in place of running the tests.

    functions: of the whole group, as (module, qualified name). known: the file with what was seen of the tests.
    within_s: seconds that the tests of a mutant may take together; others are left out. history: module,
    function and killer of mutants that were tried before. note: told of each mutant, what became of it: "killed" or
    "survived", the test that killed it, and seconds.
    """

    def __init__(
        self,
        mutants: list[Mutant],
        sources: dict[str, str],
        functions: set[tuple[str, str]],
        known: Path,
        within_s: float,
        history: Iterable[tuple[str, str, str]],
        note: Callable[[Mutant, str, str, float], None],
    ) -> None:
        self._mutants, self._sources, self._within_s, self._note = mutants, sources, within_s, note
        self._wanted, self._known = functions, known
        self._by_fixture: defaultdict[str, set[tuple[str, str]]] = defaultdict(set)
        self._sinks: list[set[tuple[str, str]]] = []
        self._failed = ""
        self._kills: Counter[tuple[str, str, str]] = Counter()
        for module, function, killer in history:
            self._count(module, function, killer)

    # What pytest asks

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Try all mutants."""
        items = {item.nodeid: item for item in session.items}
        called = self._look_at(session)
        for mutant in self._mutants:
            start_s = time.monotonic()
            tests = self._tests(mutant, called)
            limit_s = SPARE_S + SLOWER * sum(called[test].seconds for test in tests)

            def attempt(mutant: Mutant = mutant, tests: list[str] = tests) -> str:
                put_in(mutant, self._sources[mutant.module])
                return self._first_failure(session, [items[test] for test in tests])

            try:
                killer = _forked(attempt, limit_s) if tests else ""
            except ProcessLookupError as error:
                killer = str(error)
            self._count(mutant.module, mutant.function, killer)
            self._note(mutant, "killed" if killer else "survived", killer, time.monotonic() - start_s)
        return True

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """The first test that fails."""
        if report.failed and not self._failed:
            self._failed = report.nodeid

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: pytest.FixtureDef[Any]) -> Iterator[None]:
        """What is called for a fixture counts for every test that uses it."""
        self._sinks.append(set())
        try:
            return (yield)
        finally:
            self._by_fixture[fixturedef.argname] |= self._sinks.pop()

    # The parts

    def _count(self, module: str, function: str, killer: str) -> None:
        self._kills[module, function, killer] += 1
        self._kills[module, "", killer] += 1

    def _look_at(self, session: pytest.Session) -> dict[str, Called]:
        """What each test calls: as it is known, or by running it."""
        digests = {item.path: hashlib.sha256(item.path.read_bytes()).hexdigest() for item in session.items}
        known: dict[str, Called] = pickle.loads(self._known.read_bytes()) if self._known.exists() else {}
        new = [
            item
            for item in session.items
            if item.nodeid not in known or known[item.nodeid].digest != digests[item.path]
        ]
        if new:
            found, failed = _forked(lambda: self._observe(session, new), None)
            if failed:
                raise pytest.UsageError(f"{failed}: fails without any mutant")
            for item in new:
                found[item.nodeid].digest = digests[item.path]
            known |= found
            self._known.write_bytes(pickle.dumps(known))
        return {item.nodeid: known[item.nodeid] for item in session.items}

    def _observe(self, session: pytest.Session, items: list[pytest.Item]) -> tuple[dict[str, Called], str]:
        """Run tests once: what each calls, and the first that fails."""
        found = {item.nodeid: Called() for item in items}
        names: dict[CodeType, tuple[str, str] | None] = {}

        def profile(frame: FrameType, event: str, _: object) -> None:
            if event != "call":
                return
            code = frame.f_code
            if code not in names:
                # Functions within functions, and comprehensions, are parts of the outer one.
                outer = code.co_qualname.split(".<locals>")[0]
                name = str(frame.f_globals.get("__name__")), outer
                names[code] = name if name in self._wanted else None
            if (name_of := names[code]) is not None:
                self._sinks[-1].add(name_of)

        for item, after in zip(items, [*items[1:], None], strict=True):
            of_item = found[item.nodeid]
            self._sinks = [of_item.functions]
            start_s = time.process_time()
            threading.setprofile(profile)
            sys.setprofile(profile)
            session.config.hook.pytest_runtest_protocol(item=item, nextitem=after)
            sys.setprofile(None)
            of_item.seconds = time.process_time() - start_s
        for item in items:
            for fixture in getattr(item, "fixturenames", ()):
                found[item.nodeid].functions |= self._by_fixture.get(fixture, set())
        return found, self._failed

    def _tests(self, mutant: Mutant, called: dict[str, Called]) -> list[str]:
        """The tests that call a function: first those that have killed others of it, then those that killed most of
        its module for their time, then the quickest; as many as there is time for."""
        name = mutant.module, mutant.function

        def promise(test: str) -> tuple[float, float, float]:
            seconds = called[test].seconds
            of_module = self._kills[mutant.module, "", test]
            return -self._kills[*name, test], -of_module / (seconds + START_S), seconds

        tests = sorted((test for test, what in called.items() if name in what.functions), key=promise)
        sums = accumulate(called[test].seconds for test in tests)
        return tests[: max(1, sum(seconds <= self._within_s for seconds in sums))]

    def _first_failure(self, session: pytest.Session, items: list[pytest.Item]) -> str:
        self._sinks, self._failed = [set()], ""
        for item, after in zip(items, [*items[1:], None], strict=True):
            session.config.hook.pytest_runtest_protocol(item=item, nextitem=after)
            if self._failed:
                break
        return self._failed


def _forked(work: Callable[[], Any], limit_s: float | None) -> Any:
    """What a function gives that is run in a process forked from this one.

    Raises ProcessLookupError where that ends without giving anything: after `limit_s`, for want of memory, by a crash.
    """
    reading, writing = os.pipe()
    process = os.fork()
    if not process:
        os.close(reading)
        silence = os.open(os.devnull, os.O_WRONLY)
        os.dup2(silence, 1)
        os.dup2(silence, 2)
        if limit_s is not None:
            signal.setitimer(signal.ITIMER_PROF, limit_s)
            signal.setitimer(signal.ITIMER_REAL, limit_s * WAITING)
            used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
            resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, used + MEMORY))
        try:
            with os.fdopen(writing, "wb") as pipe:
                pickle.dump(work(), pipe)
        finally:
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        content = pipe.read()
    _, status = os.waitpid(process, 0)
    if not content:
        raise ProcessLookupError(f"ended with {status}")
    return pickle.loads(content)


def noted(file: Path) -> dict[str, dict[str, Any]]:
    """What a file of results says, by the key of the mutant; the last word counts."""
    if not file.exists():
        return {}
    lines = (json.loads(line) for line in file.read_text(encoding="utf-8").splitlines())
    return {line["key"]: line for line in lines}


def note_in(file: Path, mutant: Mutant, outcome: str, killer: str, seconds: float) -> None:
    """Add a line to a file of results."""
    line = {**asdict(mutant), "outcome": outcome, "by": killer, "seconds": round(seconds, 2)}
    with open(file, "a", encoding="utf-8") as lines:
        lines.write(json.dumps(line) + "\n")
