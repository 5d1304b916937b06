"""docs/reliability.md: what the long runs answered."""

import json
from collections.abc import Mapping
from pathlib import Path

from tests.fuzz.targets import TARGETS

ROOT = Path(__file__).parents[2]
PATH = ROOT / "docs" / "reliability.md"
RECORD = ROOT / "tests" / "fuzz" / "record.json"

FAULT = "not as promised"

HEAD = """\
# Reliability

Odd input by the thousand, drawn from a seed: every try has to be answered as promised.
`python -m tests.fuzz calls --tries 1000 --seed 7` makes more of one kind; some of each are in `make test`.

| input | what is promised | tries | answers | not as promised |
| --- | --- | ---: | --- | ---: |
"""

END = """
Made by `make fuzz`; do not edit.
"""


def record(name: str, seed: int, answers: Mapping[str, int]) -> None:
    """Puts what a target answered in the place of its last run, and writes the page."""
    runs = json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.exists() else {}
    runs[name] = {"seed": seed, "answers": dict(sorted(answers.items()))}
    RECORD.write_text(json.dumps(runs, indent=2, sort_keys=True) + "\n", encoding="utf-8")
    rows = "".join(_row(name, runs[name]["answers"]) for name in TARGETS if name in runs)
    PATH.write_text(HEAD + rows + END, "utf-8")


def _row(name: str, answers: Mapping[str, int]) -> str:
    total, faults = sum(answers.values()), answers.get(FAULT, 0)
    shares = ", ".join(f"{n / total:.1%} {answer}" for answer, n in answers.items() if answer != FAULT)
    return f"| {TARGETS[name].what} | {TARGETS[name].promise} | {total} | {shares} | {faults} |\n"
