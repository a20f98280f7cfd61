"""Mutation testing of what decides: is there a test that fails where the code is altered?

    python -m tests.mutation --list
    python -m tests.mutation rules                                   # all mutants of a group
    python -m tests.mutation rules --only beam,search                # of some of its modules
    python -m tests.mutation executor --sample 300 --seed 7          # a random sample
    python -m tests.mutation rules --survivors                       # once more what survived, after tests were written
    python -m tests.mutation --table                                 # what was tried so far

What became of each mutant stands in a file a group in the folder `--work`; a mutant that is there is not tried again
while its module is the same.
"""

import argparse
import os
import random
import sys
import tempfile
from collections import Counter
from pathlib import Path

from .mutants import Mutant, mutants_of, source_of
from .targets import GROUPS, ROOT

WORK = Path(tempfile.gettempdir()) / "lightgesture-mutation"


def main() -> int:
    """0: what was asked for was tried."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__.splitlines()[0])
    parser.add_argument("groups", nargs="*", metavar="GROUP", help="all without any")
    parser.add_argument("--only", default="", metavar="MODULES", help="last names of modules, with commas")
    parser.add_argument("--sample", type=int, metavar="N", help="so many of a group, drawn at random")
    parser.add_argument("--seed", type=int, default=20180521, help="of the sample (default: 20180521)")
    parser.add_argument("--survivors", action="store_true", help="only those that survived so far")
    parser.add_argument(
        "--within", type=float, default=float("inf"), metavar="S", help="seconds of tests a mutant"
    )
    parser.add_argument("--work", type=Path, default=WORK, help=f"folder (default: {WORK})")
    parser.add_argument("--list", action="store_true", help="name the groups and how many mutants each has")
    parser.add_argument(
        "--table", action="store_true", help="print what was tried, by module, and what survived"
    )
    args = parser.parse_args()
    unknown = [name for name in args.groups if name not in GROUPS]
    if unknown:
        parser.error(f"{unknown[0]}: no group; --list names them")
    args.work.mkdir(parents=True, exist_ok=True)
    only = set(filter(None, args.only.split(",")))
    for name in args.groups or GROUPS:
        mutants = [
            mutant
            for module in GROUPS[name].modules
            if not only or module.rsplit(".", 1)[-1] in only
            for mutant in mutants_of(module, source_of(module))
        ]
        file = args.work / f"{name}.jsonl"
        if args.list:
            print(f"{name:10} {len(mutants):5} mutants, tests: {' '.join(GROUPS[name].tests)}")
        elif args.table:
            _table(mutants, file)
        else:
            if args.sample is not None:
                mutants = random.Random(args.seed).sample(mutants, min(args.sample, len(mutants)))
            _try(name, mutants, file, args.survivors, args.within)
    return 0


def _try(name: str, mutants: list[Mutant], file: Path, is_of_survivors: bool, within_s: float) -> None:
    """Try the mutants of a group that a file of results does not have yet, or that survived so far."""
    # Before NumPy is loaded: a process with threads is not to be forked.
    os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    os.chdir(ROOT)
    import pytest

    from .running import Trial, note_in, noted

    known = noted(file)
    outcomes = {mutant.key: known.get(mutant.key, {}).get("outcome", "") for mutant in mutants}
    sought = "survived" if is_of_survivors else ""
    waiting = [mutant for mutant in mutants if outcomes[mutant.key] == sought]
    print(f"{name}: {len(waiting)} of {len(mutants)} mutants are tried", flush=True)
    if not waiting:
        return

    def note(mutant: Mutant, outcome: str, killer: str, seconds: float) -> None:
        note_in(file, mutant, outcome, killer, seconds)
        if outcome == "survived":
            print(_line(mutant), flush=True)

    functions = {
        (mutant.module, mutant.function)
        for module in GROUPS[name].modules
        for mutant in mutants_of(module, source_of(module))
    }
    sources = {mutant.module: source_of(mutant.module) for mutant in waiting}
    history = [(line["module"], line["function"], line["by"]) for line in known.values() if line["by"]]
    trial = Trial(waiting, sources, functions, file.with_suffix(".calls"), within_s, history, note)
    with tempfile.TemporaryDirectory() as folder:
        os.environ["HYPOTHESIS_STORAGE_DIRECTORY"] = folder
        options = ["-q", "-s", "-p", "no:cacheprovider"]
        if GROUPS[name].unfit:
            options += ["-k", f"not ({GROUPS[name].unfit})"]
        status = pytest.main([*options, *GROUPS[name].tests], plugins=[trial])
    if status:
        sys.exit(f"{name}: the tests do not pass, or cannot be collected ({status!r})")


def _line(mutant: Mutant) -> str:
    place = f"{mutant.module.removeprefix('lightgesture.')}:{mutant.line}"
    return f"{place} {mutant.function}: {mutant.before} -> {mutant.after}"


def _table(mutants: list[Mutant], file: Path) -> None:
    """Mutants, tried and killed, by module, as Markdown; then what survived."""
    from .running import noted

    known = noted(file)
    print("| module | mutants | tried | killed | share |\n|---|---:|---:|---:|---:|")
    of_module = Counter(mutant.module for mutant in mutants)
    outcomes = {(mutant.module, mutant.key): known.get(mutant.key, {}).get("outcome") for mutant in mutants}
    for module, count in [*of_module.items(), ("all", len(mutants))]:
        own = [outcome for (name, _), outcome in outcomes.items() if module in (name, "all")]
        tried, killed = len(own) - own.count(None), own.count("killed")
        share = f"{killed / tried:.2f}" if tried else ""
        print(f"| `{module.removeprefix('lightgesture.')}` | {count} | {tried} | {killed} | {share} |")
    for mutant in mutants:
        if outcomes[mutant.module, mutant.key] == "survived":
            print(_line(mutant))


if __name__ == "__main__":
    sys.exit(main())
