"""docs/mutation.md: the score, and why some faults are not found."""

import json
import tomllib
from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

from mutants import ROOT, Mutant, digest, mutants_of
from sample import Name, kept

PATH = ROOT / "docs" / "mutation.md"
KNOWN = ROOT / "tests" / "mutation" / "survivors.toml"
SCORE = ROOT / "tests" / "mutation" / "score.json"

HEAD = """\
# Mutation run

Small faults were put into the code one at a time: numbers changed by a fifth, `<` made `<=` or `>=`, `+` made `-`,
`min` made `max`, `and` made `or`, both sides of a choice swapped, limits, checks and statements left out, a field of
the next state left as it was. A fault is found when a test fails, the compiler refuses it, or the tests never end.

## A sample of all rooms

Drawn with the seed SEED, in proportion to the lines of the rooms, a few in each. Tests that touch the line or name its
module were run, until one failed. What is explained is not tried.
"""

WHOLE = """
## The C core and the controller, file by file

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


def record(faults: Mapping[str, int], mutants: Iterable[Mutant], found: Iterable[Mutant]) -> None:
    """Adds what a run of some files has shown to the score.

    Args:
        faults: how many each file could have.
        mutants: those that were tried.
        found: those of them that no test found.
    """
    made, alive = (Counter(mutant.file for mutant in some) for some in (mutants, found))
    score = scores() | {
        file: {"digest": digest(file), "faults": number, "tried": made[file], "not_found": alive[file]}
        for file, number in faults.items()
    }
    SCORE.write_text(json.dumps(score, indent=2, sort_keys=True) + "\n", encoding="utf-8")


def scores() -> dict[str, dict[str, str | int]]:
    """Of the files that were run as a whole."""
    return json.loads(SCORE.read_text(encoding="utf-8")) if SCORE.exists() else {}


def dependencies() -> dict[str, set[str]]:
    """The files that the page speaks of, and their digests when their faults were tried."""
    found = {file: {str(each["digest"])} for file, each in scores().items()}
    for (file, _, _), (known, _) in kept()[2].items():
        found.setdefault(file, set()).add(known)
    return found


def changed() -> list[str]:
    """Files of which the page speaks as they were."""
    return [file for file, known in sorted(dependencies().items()) if {_now(file)} != known]


def _now(file: str) -> str:
    return digest(file) if (ROOT / file).exists() else "gone"


def write_page() -> None:
    PATH.write_text(page(), encoding="utf-8")


def page() -> str:
    """The numbers are those of files that are as they were run; the others are named."""
    old, explained = changed(), reasons()
    for name in gone({file for file, _, _ in explained}):
        del explained[name]
    seed, drawn, tried = kept()
    found = {name for name, (known, by) in tried.items() if by is not None and known == _now(name[0])}
    alive = {name for name, (known, by) in tried.items() if by is None and known == _now(name[0])}
    lines = [HEAD.replace("SEED", str(seed))]
    lines += [
        "| room | faults | found | explained | survive | not tried |",
        "| --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    rooms: dict[str, list[Name]] = {}
    for name in drawn:
        rooms.setdefault(f"`{Path(name[0]).parent}`", []).append(name)
    for room, names in (rooms | {"all": drawn}).items():
        sets = found, explained.keys() - found, alive - explained.keys()
        its = [sum(name in some for name in names) for some in sets]
        lines.append(f"| {room} | {len(names)} | {' | '.join(map(str, its))} | {len(names) - sum(its)} |")
    score = {file: each for file, each in scores().items() if file not in old}
    rows = {f"`{file}`": [int(each[key]) for key in ("faults", "tried", "not_found")] for file, each in score.items()}
    if rows:
        rows["all"] = [sum(column) for column in zip(*rows.values(), strict=True)]
        lines += [WHOLE, "| file | faults | tried | not found | found |", "| --- | ---: | ---: | ---: | ---: |"]
    lines += [f"| {file} | {n} | {count} | {k} | {1.0 - k / count:.1%} |" for file, (n, count, k) in rows.items()]
    if old:
        names = ", ".join(f"`{file}`" for file in old)
        lines += ["", f"Changed since they were run, so that what was found in them does not count: {names}."]
    lines += ["", "## Why some are not found"]
    for (file, line, fault), why in explained.items():
        lines += ["", f"`{file}`: `{line}`", "", f"`{fault}`", "", f"- {why}"]
    lines += ["", "Made by `make mutation`; do not edit."]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    write_page()
