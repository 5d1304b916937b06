"""Mutation run: small faults are put into the code one at a time; for each a test must fail.

    python tests/mutation [--every N] [FILE ...]

A fault that no test finds must be explained in survivors.toml. The files that are named, or all, are run, and their
score is written to docs/mutation.md; of every N faults one is tried.
"""

import argparse
import sys
from collections.abc import Sequence

from mutants import mutants_of
from page import gone, reasons, record
from workers import survivors

LEAST_SCORE = 0.95

CONTROLLER = (
    "damping_law",
    "departure",
    "fading",
    "rest",
    "signal_monitor",
    "supervised",
    "supervision",
    "swings",
    "torque_estimator",
    "torque_loop",
    "trust",
    "wheel_monitor",
)
WHOLE_CONTROLLER = "tests/models/controller", "tests/models/test_damping_controller.py", "-k", "not ValidationVehicle"
"""On the design model alone, in half the time."""

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

TESTS = {
    **{
        f"models/controller/{name}.py": (f"tests/models/controller/test_{name}.py", *WHOLE_CONTROLLER)
        for name in CONTROLLER
    },
    "models/controller/supervision_interface.py": ("tests/models/controller/test_supervision.py", *WHOLE_CONTROLLER),
    "models/block/runner.py": ("tests/models/block/test_runner.py",),
    "models/block/integrator.py": ("tests/models/block/test_integrator.py", "tests/fmus/native/test_integrator.py"),
    "fmus/protocol.py": ("tests/fmus/test_time.py", "tests/fmus/native/test_same_words.py"),
    "fmus/native/c/sampled.c": ("tests/fmus/native/test_runner.py", *CALLS),
    "fmus/native/c/integrator.c": (*INTEGRATOR, "tests/fmus/native/test_rates.py"),
    "fmus/native/c/explicit.c": (*INTEGRATOR, "tests/fmus/native/test_rates.py"),
    "fmus/native/c/implicit.c": INTEGRATOR,
    "fmus/native/c/operators.h": ("tests/fmus/native/test_functions.py", "tests/fmus/native/test_rates.py"),
    "fmus/native/c/continuous.c": ("tests/fmus/native/test_rates.py", *CALLS),
    "fmus/native/c/content.c": ("tests/fmus/native/test_same_words.py", "tests/fmus/test_state.py", *CALLS),
    **{f"fmus/native/c/{name}.c": CALLS for name in ("run", "values", "state", "messages", "fmi2")},
}
"""The files, and the tests that find faults in them, in the order in which they are run."""


def main() -> None:
    parser = argparse.ArgumentParser(prog="python tests/mutation", description="Do the tests find small faults?")
    parser.add_argument("files", nargs="*", metavar="FILE", help="of the faults (default: all)")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="tries one of N faults (default: all)")
    args = parser.parse_args()
    files: Sequence[str] = args.files or list(TESTS)
    every = {file: mutants_of(file) for file in files}
    mutants = [mutant for of_file in every.values() for mutant in of_file[:: args.every]]
    known = {mutant.known_as for mutant in mutants} & reasons().keys()
    found = list(survivors(mutants, TESTS))
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
        sys.exit(1)
    record({file: len(of_file) for file, of_file in every.items()}, mutants, found)


if __name__ == "__main__":
    main()
