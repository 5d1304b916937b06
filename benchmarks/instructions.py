"""Instructions of a communication step, counted by valgrind: they do not depend on what else the machine does.

The plain C loop of the benchmark of hosts runs under callgrind, once for SHORT and once for LONG steps; the difference
is that of the steps between. What an FMU takes includes the functions of the C library that it calls. The counts that
were kept stand in instructions.toml; a step that needs MORE of them fails. `--keep` writes those of now.
"""

import argparse
import re
import subprocess
import sys
import tomllib
from collections import Counter
from pathlib import Path
from shutil import which

from rich.console import Console
from rich.table import Table

from benchmarks import plain_loop
from benchmarks.hosts import START, STEP_SIZE, T_DRIVER
from driveline.harness.loop.built_fmus import warn_of_stale
from driveline.harness.loop.places import NATIVE, PLANTS
from driveline.harness.loop.settings import loop
from toolground.interruption import script

SHORT, LONG = 500, 2500
"""Steps."""

MORE = 1.05
"""What a step may need over what was kept."""

KEPT = Path(__file__).with_name("instructions.toml")

OBJECT = re.compile(r"^(c?ob)=\((\d+)\)(?: (.*))?$")


def counted(program: Path, steps: int) -> Counter[str]:
    """Instructions in all, and those in each FMU, by the name of its instance."""
    output = program.with_name(f"callgrind.{steps}")
    tool = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={output}", "--quiet"]
    subprocess.run([*tool, str(program), str(steps), repr(STEP_SIZE)], check=True, stdout=subprocess.DEVNULL)
    return instructions(output.read_text(encoding="utf-8"), str(program))


def instructions(callgrind: str, program: str) -> Counter[str]:
    """Those of the whole run, and of the calls from the program into each FMU."""
    names: dict[str, str] = {}
    caller = called = ""
    is_call, found = False, Counter[str]()
    for line in callgrind.splitlines():
        if match := OBJECT.match(line):
            kind, number, name = match.groups()
            names.setdefault(number, name or "")
            caller, called = (names[number], called) if kind == "ob" else (caller, names[number])
        elif line.startswith("fn="):
            called = caller
        elif line.startswith("calls="):
            is_call = True
        elif is_call:
            if caller == program and "/binaries/" in called:
                found[Path(called).relative_to(Path(program).parent).parts[0]] += int(line.split()[1])
            is_call, called = False, caller
        elif line.startswith("summary:"):
            found["loop"] = int(line.split()[1])
    return found


def steps_of(plant: str) -> dict[str, int]:
    """Instructions of a step: of the loop and of each FMU in it."""
    warn_of_stale(system := loop(plant, build=NATIVE))
    with plain_loop.program(system, {**START, "controller.T_driver": T_DRIVER}, "plant.T_gear") as program:
        short, long = counted(program, SHORT), counted(program, LONG)
    return {name: round((long[name] - short[name]) / (LONG - SHORT)) for name in ("loop", *system.instances)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keep", action="store_true", help="write the counts of now into instructions.toml")
    args = parser.parse_args()
    if which("valgrind") is None:
        sys.exit("there is no valgrind, which counts the instructions: apt-get install valgrind")
    kept = tomllib.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}
    counts = {plant: steps_of(plant) for plant in PLANTS}
    table = Table("", "", "kept", "now", title="instructions of a step of 1 ms")
    for plant, parts in counts.items():
        for name, count in parts.items():
            table.add_row(plant, name, str(kept.get(plant, {}).get(name, "")), str(count))
    Console().print(table)
    if args.keep:
        parts = ("\n".join((f"[{p}]", *(f"{name} = {n}" for name, n in c.items()))) for p, c in counts.items())
        KEPT.write_text("\n\n".join(parts) + "\n", encoding="utf-8")
    elif worse := [p for p, c in counts.items() if c["loop"] > MORE * kept.get(p, {}).get("loop", float("inf"))]:
        sys.exit(
            f"a step needs {MORE - 1.0:.0%} more instructions than was kept: {', '.join(worse)}; "
            "if that is meant, `python -m benchmarks.instructions --keep`"
        )


if __name__ == "__main__":
    script(main)
