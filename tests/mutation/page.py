"""docs/mutation.md: the score, and why some faults are not found."""

import tomllib
from collections import Counter

from mutants import ROOT, Mutant

PATH = ROOT / "docs" / "mutation.md"
KNOWN = ROOT / "tests" / "mutation" / "survivors.toml"

HEAD = """\
# Mutation run

Made by `make mutation` (tests/mutation), do not edit. Small faults were put into the code one at a time: numbers
changed by a fifth, `<` made `<=` or `>=`, `+` made `-`, `min` made `max`, `and` made `or`, both sides of a choice
swapped, limits and statements left out, a field of the next state left as it was. A fault is found when a test fails,
the compiler refuses it, or the tests never end.

The files of the C core are not in this score yet; `python tests/mutation fmus/native/c/run.c` runs one of them.
"""


def reasons() -> dict[tuple[str, str, str], str]:
    """Why a mutant survives, by what it is known as."""
    known = tomllib.loads(KNOWN.read_text(encoding="utf-8"))
    return {
        (file, each["line"], fault): each["why"]
        for file, survivors in known.items()
        for each in survivors
        for fault in each["faults"]
    }


def page(mutants: list[Mutant], found: list[Mutant]) -> str:
    made, alive = (Counter(mutant.file for mutant in some) for some in (mutants, found))
    rows = [(f"`{file}`", made[file], alive[file]) for file in made] + [("all", len(mutants), len(found))]
    lines = [HEAD, "| file | faults | not found | found |", "| --- | ---: | ---: | ---: |"]
    lines += [f"| {file} | {n} | {k} | {1.0 - k / n:.1%} |" for file, n, k in rows]
    lines += ["", "## Why some are not found"]
    known = reasons()
    for mutant in found:
        lines += ["", f"`{mutant.file}`, line {mutant.line}: `{mutant.fault}`", "", f"- {known[mutant.known_as]}"]
    return "\n".join(lines) + "\n"
