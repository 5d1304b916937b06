"""Mutation run: small faults are put into the code one at a time; for each a test must fail.

    python -m tests.mutation [--faults N] [--seed N] [--workers N] [FILE ...]

Draws faults of all rooms, or of the files that are named, runs the tests that cover their files, and prints for each
which test has found it, at the end the rate of those that were found. What no test can find is explained in
survivors.toml and not tried. Exits with 1 if less than LEAST_SCORE of the others is found.
"""

import argparse
import os
import sys
import tomllib
from collections import Counter
from pathlib import Path

from tests.mutation.covering import rounds, slow
from tests.mutation.mutants import drawn, mutants_of, rooms
from tests.mutation.workers import finders

LEAST_SCORE = 0.95


def explained() -> set[tuple[str, str, str]]:
    """What no test can find, as `Mutant.known_as`."""
    known = tomllib.loads(Path(__file__).with_name("survivors.toml").read_text(encoding="utf-8"))
    return {(file, each["line"], fault) for file, some in known.items() for each in some for fault in each["faults"]}


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description="Do the tests find small faults?")
    parser.add_argument("files", nargs="*", metavar="FILE", help="of all faults (default: a sample of all rooms)")
    parser.add_argument("--faults", type=int, default=200, metavar="N", help="in the sample (default: 200)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of the sample (default: 1)")
    parser.add_argument("--workers", type=int, metavar="N", default=os.cpu_count(), help="(default: one on each core)")
    args = parser.parse_args()
    code = {file for files in rooms().values() for file in files}
    if unknown := sorted({*args.files} - code):
        parser.error(f"{unknown[0]} is no file of the code, such as {min(code)}")
    if min(args.faults, args.workers) < 1:
        parser.error("--faults and --workers take a whole number from 1 on")
    known = explained()
    sample = [m for file in args.files for m in mutants_of(file)] if args.files else drawn(args.faults, args.seed)
    tried = [mutant for mutant in sample if mutant.known_as not in known]
    if not tried:
        sys.exit("there is no fault to try")
    missed = []
    for mutant, by in finders([(mutant, rounds(mutant.file), slow(mutant.file)) for mutant in tried], args.workers):
        says = "MISSED" if by is None else by or "cannot be imported"
        print(f"{mutant.file}:{mutant.line}: {mutant.fault}: {says}", flush=True)
        missed += [mutant] if by is None else []
    for room, count in Counter(Path(mutant.file).parent.as_posix() for mutant in tried).items():
        print(f"{room}: {count} tried, {sum(Path(mutant.file).parent.as_posix() == room for mutant in missed)} missed")
    rate = 1.0 - len(missed) / len(tried)
    print(f"{len(sample)} faults, {len(sample) - len(tried)} explained, {len(missed)} missed: {rate:.1%} found")
    sys.exit(rate < LEAST_SCORE)


if __name__ == "__main__":
    main()
