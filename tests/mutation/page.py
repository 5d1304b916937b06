"""docs/mutation.md: the score, and why some faults are not found."""

import json
import tomllib
from collections import Counter
from collections.abc import Collection, Iterable, Mapping

from mutants import ROOT, Mutant, mutants_of

from docs.studies import digests

PATH = ROOT / "docs" / "mutation.md"
KNOWN = ROOT / "tests" / "mutation" / "survivors.toml"
SCORE = ROOT / "tests" / "mutation" / "score.json"

HEAD = """\
# Mutation run

Small faults were put into the code one at a time: numbers changed by a fifth, `<` made `<=` or `>=`, `+` made `-`,
`min` made `max`, `and` made `or`, both sides of a choice swapped, limits and statements left out, a field of the next
state left as it was. A fault is found when a test fails, the compiler refuses it, or the tests never end.
`python tests/mutation fmus/native/c/run.c` runs one file anew, `--every 5` tries one of five faults.
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


def gone(files: Collection[str]) -> set[tuple[str, str, str]]:
    """What is explained of these files, but can no longer be: the line has changed."""
    possible = {mutant.known_as for file in files for mutant in mutants_of(file)}
    return {name for name in reasons() if name[0] in files} - possible


def digest(file: str) -> str:
    return digests.digest(ROOT / file) if (ROOT / file).exists() else "gone"


def record(faults: Mapping[str, int], mutants: Iterable[Mutant], found: Iterable[Mutant]) -> None:
    """Adds what a run of some files has shown to the score, and writes the page.

    Args:
        faults: how many each file could have.
        mutants: those that were tried.
        found: those of them that no test found.
    """
    score = json.loads(SCORE.read_text(encoding="utf-8")) if SCORE.exists() else {}
    made, alive = (Counter(mutant.file for mutant in some) for some in (mutants, found))
    score |= {
        file: {"digest": digest(file), "faults": number, "tried": made[file], "not_found": alive[file]}
        for file, number in faults.items()
    }
    SCORE.write_text(json.dumps(score, indent=2, sort_keys=True) + "\n", encoding="utf-8")
    PATH.write_text(page(score), encoding="utf-8")


def page(score: dict[str, dict[str, str | int]]) -> str:
    rows = {f"`{file}`": [int(each[key]) for key in ("faults", "tried", "not_found")] for file, each in score.items()}
    rows["all"] = [sum(column) for column in zip(*rows.values(), strict=True)]
    lines = [HEAD, "| file | faults | tried | not found | found |", "| --- | ---: | ---: | ---: | ---: |"]
    lines += [f"| {file} | {n} | {tried} | {k} | {1.0 - k / tried:.1%} |" for file, (n, tried, k) in rows.items()]
    if changed := [f"`{file}`" for file, each in score.items() if each["digest"] != digest(file)]:
        lines += ["", f"Changed since they were run: {', '.join(changed)}."]
    lines += ["", "## Why some are not found"]
    explained = reasons()
    for name in gone({file for file, _, _ in explained}):
        del explained[name]
    for (file, line, fault), why in explained.items():
        lines += ["", f"`{file}`: `{line}`", "", f"`{fault}`", "", f"- {why}"]
    lines += ["", "Made by `make mutation`; do not edit."]
    return "\n".join(lines) + "\n"
