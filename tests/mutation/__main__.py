"""Mutation run: small faults are put into the code one at a time; for each a test must fail.

    python tests/mutation [--faults N] [--seed N]  # a sample of all rooms
    python tests/mutation [--every N] FILE ...     # C core and controller, file by file

A fault that no test finds must be explained in survivors.toml. The score is written to docs/mutation.md. For each fault
of the sample the tests run that touch its line, the cheapest first, until one fails; a run of the fast tests under
coverage tells which these are (tests/mutation/touched.py). The sample is kept fault by fault: a run that was stopped
goes on, and what was found in files that have not changed since is not tried again.
"""

import argparse
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from mutants import Mutant, mutants_of
from page import gone, reasons, record, write_page
from sample import Sample
from touched import KEPT, Test, Touched, is_in_function, own_tests
from workers import finders

LEAST_SCORE = 0.95

CALLS_IN_C = "calls", "same_words", "as_python", "rates", "no_step_to_nowhere", "content"
CALLS = (
    *(f"tests/fmus/native/test_{name}.py" for name in CALLS_IN_C),
    "tests/test_fuzz.py::test_odd_input_is_answered_as_promised[calls]",
)

INTEGRATOR = (
    "tests/fmus/native/test_integrator.py",
    "tests/fmus/native/test_no_step_to_nowhere.py",
    "tests/fmus/test_stiff_plants.py",
)

IN_C = {
    "sampled.c": ("tests/fmus/native/test_runner.py", *CALLS),
    "integrator.c": (*INTEGRATOR, "tests/fmus/native/test_rates.py"),
    "explicit.c": (*INTEGRATOR, "tests/fmus/native/test_rates.py"),
    "implicit.c": INTEGRATOR,
    "operators.h": ("tests/fmus/native/test_functions.py", "tests/fmus/native/test_rates.py"),
    "continuous.c": ("tests/fmus/native/test_rates.py", *CALLS),
    "content.c": ("tests/fmus/native/test_same_words.py", "tests/fmus/test_state.py", *CALLS),
    **{f"{name}.c": CALLS for name in ("run", "values", "state", "messages", "calls", "fmi2")},
    "fmi3.c": ("tests/fmus/native/test_fmi3.py", "tests/fmus/native/test_same_words.py"),
}
"""The files of the C core, and the tests that find faults in them, in the order in which they are run."""

OF_NUMBERS = "models/block/integrator.py", "fmus/protocol.py"
"""Of these only the numbers that C takes from them are changed."""

FEW = 12
"""Tests of the first round: most faults are found by it, and pytest has only their files to collect."""

SHARE = 30.0
"""Time in s that the tests may take that are run for a fault of the sample."""


def main() -> None:
    parser = argparse.ArgumentParser(prog="python tests/mutation", description="Do the tests find small faults?")
    parser.add_argument("files", nargs="*", metavar="FILE", help="of the faults (default: a sample of all rooms)")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="tries one of N faults (default: all)")
    parser.add_argument("--faults", type=int, default=200, metavar="N", help="in the sample (default: 200)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of the sample (default: 1)")
    parser.add_argument("--workers", type=int, metavar="N", default=os.cpu_count(), help="(default: one on each core)")
    args = parser.parse_args()
    if not KEPT.exists():
        watched(args.workers)
    is_good = (
        whole(args.files, args.every, args.workers) if args.files else sampled(args.faults, args.seed, args.workers)
    )
    write_page()
    sys.exit(not is_good)


def watched(shards: int) -> None:
    """Runs the fast tests under coverage, in so many processes."""
    command = [sys.executable, Path(__file__).with_name("touched.py")]
    for running in [subprocess.Popen([*command, str(shard), str(shards)]) for shard in range(shards)]:
        running.wait()


def whole(files: Sequence[str], step: int, workers: int) -> bool:
    """Tries all faults of files, or one of so many; whether enough is found and the rest explained."""
    every = {file: [mutant for mutant in mutants_of(file) if counts(mutant)] for file in files}
    mutants = [mutant for of_file in every.values() for mutant in of_file[::step]]
    known = {mutant.known_as for mutant in mutants} & reasons().keys()
    touched, found = Touched(), []
    for mutant, by in finders(mutants, lambda mutant: tests_of(mutant, touched), touched.sound, workers):
        if by is None:
            print(f"{mutant.file}:{mutant.line}: {mutant.fault}", flush=True)
            found.append(mutant)
    score = 1.0 - len(found) / len(mutants)
    print(f"{len(mutants)} faults, {len(found)} not found: {score:.1%} found")
    alive = {mutant.known_as for mutant in found}
    sentences = {
        "is not explained": alive - known,
        "is explained, but found": known - alive,
        "is explained, but there is no such fault": gone(files),
    }
    for what, some in sentences.items():
        for name in sorted(some):
            print(f"{' | '.join(name)}: {what}")
    if alive != known or score < LEAST_SCORE:
        return False
    record({file: len(of_file) for file, of_file in every.items()}, mutants, found)
    return True


def counts(mutant: Mutant) -> bool:
    return mutant.file not in OF_NUMBERS or bool(re.match(r"[A-Z_]+ = [\d.e-]+$", mutant.code))


def sampled(size: int, seed: int, workers: int) -> bool:
    """Tries what of the sample is not known to be found or explained; whether enough of it is then."""
    sample, touched = Sample.drawn(size, seed), Touched()
    left = [mutant for mutant in sample.mutants if not sample.is_found(mutant) and mutant.known_as not in reasons()]
    left.sort(key=lambda mutant: mutant.known_as in sample.tried)  # what no test has found comes last
    for mutant, by in finders(left, lambda mutant: tests_of(mutant, touched), touched.sound, workers):
        sample.keep(mutant, by)
        print(f"{mutant.file}:{mutant.line}: {mutant.fault}: {'NOT FOUND' if by is None else by}", flush=True)
    good = sum(sample.is_found(mutant) or mutant.known_as in reasons() for mutant in sample.mutants)
    print(f"{len(sample.mutants)} faults, {good} found or explained, {len(left)} of them tried now")
    return good >= LEAST_SCORE * len(sample.mutants)


def tests_of(mutant: Mutant, touched: Touched) -> tuple[Sequence[Sequence[str]], Sequence[str]]:
    """What may find a fault, in rounds in the order in which they are run; and the tests whose slow ones may too.

    The last round is for what no test is seen to touch: what runs in another process, or while a module is imported.
    """
    name = Path(mutant.file).name
    if name in IN_C:
        return [IN_C[name]], IN_C[name]
    own, naming, touching = own_tests(mutant.file), touched.naming(mutant.file), chosen(touched.by(mutant))
    unseen, others = ([test for test in naming if (test in own) is is_own] for is_own in (True, False))
    first, then = [*unseen, *by_file(touching[:FEW])], [*by_file(touching[FEW:]), *others]
    return [first, then, own if touching and is_in_function(mutant) else touched.naming_files(mutant.file)], own


def chosen(tests: Sequence[Test]) -> list[str]:
    """The names of those that can be run within SHARE."""
    total, names = 0.0, []
    for test in tests:
        total += test.time
        if total > SHARE:
            break
        names.append(test.name)
    return names


def by_file(names: Sequence[str]) -> list[str]:
    """The tests of a file one after the other."""
    files = list(dict.fromkeys(name.partition("::")[0] for name in names))
    return sorted(names, key=lambda name: files.index(name.partition("::")[0]))


if __name__ == "__main__":
    main()
