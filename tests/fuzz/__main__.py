"""Long fuzz runs.

    python -m tests.fuzz [TARGET ...] [--seed SEED] [--tries N]

Runs the targets that are named, or all, and writes what they answered to docs/reliability.md.
"""

import argparse
import sys
from collections import Counter
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from driveline.harness.base.interruption import script
from driveline.harness.base.progress import progress
from tests.fuzz import page
from tests.fuzz.target import Target, Unclean
from tests.fuzz.targets import TARGETS


def run(name: str, target: Target, seed: int, tries: int) -> Counter[str]:
    """How often each answer was given; tells every fault with its try."""
    answers: Counter[str] = Counter()
    with TemporaryDirectory() as folder, target.open(Path(folder)) as attempt, progress(tries, name) as done:
        for k in range(tries):
            try:
                answers[attempt(Random(f"{seed} {k}"))] += 1
            except Unclean as fault:
                answers[page.FAULT] += 1
                print(f"{name}, seed {seed}, try {k}: {fault}", file=sys.stderr)
            done(k + 1)
    return answers


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description="Long fuzz runs.")
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=f"of {', '.join(TARGETS)} (default: all)")
    parser.add_argument("--seed", type=int, default=1, help="of all that is drawn (default: %(default)s)")
    parser.add_argument("--tries", type=int, help="of each target (default: what each target says)")
    args = parser.parse_args()
    if unknown := set(args.targets) - TARGETS.keys():
        parser.error(f"there is no target {', '.join(sorted(unknown))}; there are {', '.join(TARGETS)}")
    faults = 0
    for name in args.targets or TARGETS:
        answers = run(name, TARGETS[name], args.seed, args.tries or TARGETS[name].long)
        faults += answers[page.FAULT]
        print(f"{name}: {', '.join(f'{n} {answer}' for answer, n in sorted(answers.items()))}")
        page.record(name, args.seed, answers)
    return 1 if faults else 0


if __name__ == "__main__":
    script(main)
