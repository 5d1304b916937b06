"""Long fuzz runs: `python -m tests.fuzz [TARGET ...] [--seed SEED] [--tries N]`, of all targets if none is named."""

import argparse
import json
from pathlib import Path

from tests.fuzz import TARGETS
from tests.fuzz.target import FAULT
from toolground.interruption import script


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description="Long fuzz runs.")
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=f"of {', '.join(TARGETS)} (default: all)")
    parser.add_argument("--seed", type=int, default=1, help="of all that is drawn (default: %(default)s)")
    parser.add_argument("--tries", type=int, default=0, help="of each target (default: what each target says)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="writes how often each answer was given")
    args = parser.parse_args()
    if unknown := set(args.targets) - TARGETS.keys():
        parser.error(f"there is no target {', '.join(sorted(unknown))}; there are {', '.join(TARGETS)}")
    counts = {name: TARGETS[name].counts(args.seed, args.tries) for name in args.targets or TARGETS}
    for name, answers in counts.items():
        print(f"{name}: {', '.join(f'{n} {answer}' for answer, n in sorted(answers.items()))}")
    if args.json:
        args.json.write_text(json.dumps({"seed": args.seed, "counts": counts}, indent=2) + "\n", encoding="utf-8")
    return int(any(answers[FAULT] for answers in counts.values()))


if __name__ == "__main__":
    script(main)
