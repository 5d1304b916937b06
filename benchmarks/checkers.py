"""What `driveline check` finds in FMUs of others, beside the checkers that are there.

`fmpy validate` always is; FMUChecker (`fmuCheck.linux64` or `fmuCheck`, FMI 2.0 only) and VDMCheck (`VDMCheck2.sh` and
`VDMCheck3.sh`) where they are on the path. A row for each FMU: of ours the rules that are broken, as errors or
warnings, of the others the number of findings. `!` marks an FMU in which one of them finds something and ours does not.
"""

import argparse
import re
import subprocess
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from shutil import which
from typing import NamedTuple

from fmpy.validation import validate_fmu
from rich.console import Console
from rich.table import Table

from fmucheck.checking import check
from fmuloop.limits import Limits
from toolground.interruption import script

LONGEST = 60.0
"""How long in s a checker may take for an FMU."""

SEVERE = ("error", "warning")

EXAMPLES = """\
examples:
  python -m benchmarks.checkers FOLDER
  PATH=$PATH:/opt/vdmcheck python -m benchmarks.checkers --quick FOLDER
"""


class Row(NamedTuple):
    """What was found in an FMU: rules of ours that it breaks; by checker a number, None if it does not take the FMU."""

    ours: list[str]
    others: dict[str, int | None]

    @property
    def missed(self) -> bool:
        return not self.ours and any(self.others.values())


def of_fmpy(path: Path, _fmi: int) -> int:
    try:
        return len(validate_fmu(str(path)))
    except Exception:  # fmpy raises bare exceptions
        return 1


def of_fmu_check(path: Path, fmi: int) -> int | None:
    program = which("fmuCheck.linux64") or which("fmuCheck")
    if program is None or fmi != 2:
        return None
    said = _said(program, "-l", "3", "-s", "1", "-o", "/dev/null", path)
    return None if said is None else len(re.findall(r"^\[(?:ERROR|FATAL|WARNING)\]\[FM", said, re.MULTILINE))


def of_vdm_check(path: Path, fmi: int) -> int | None:
    program = which(f"VDMCheck{fmi}.sh")
    said = _said(program, path) if program else None
    if said is None:
        return None
    return len(re.findall(r"^(?:\d+ )?(?:valid|Internal)\w*:? ", said, re.MULTILINE))


def _said(*command: str | Path) -> str | None:
    try:
        done = subprocess.run(command, capture_output=True, timeout=LONGEST, check=False)
    except subprocess.TimeoutExpired:
        return None
    return (done.stdout + done.stderr).decode(errors="replace")


CHECKERS: dict[str, Callable[[Path, int], int | None]] = {
    "fmpy validate": of_fmpy,
    "FMUChecker": of_fmu_check,
    "VDMCheck": of_vdm_check,
}


def compared(path: Path, fmi: int, quick: bool) -> Row:
    verdicts = check(path, Limits(call=LONGEST), quick)
    ours = [verdict.rule for verdict in verdicts if verdict.problems and verdict.severity in SEVERE]
    return Row(ours, {name: checker(path, fmi) for name, checker in CHECKERS.items()})


def rows(folder: Path, quick: bool) -> Iterator[tuple[Path, Row]]:
    """Those of FMI 2.0 and 3.0."""
    from fmpy import read_model_description

    for path in sorted(folder.rglob("*.fmu")):
        try:
            fmi = int(read_model_description(str(path), validate=False).fmiMajorVersion)
        except Exception:  # whatever is wrong with it
            fmi = 2
        if fmi in (2, 3):
            yield path, compared(path, fmi, quick)


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="in which, and below which, the FMUs are")
    parser.add_argument("--quick", action="store_true", help="of the behaviours only the first steps of a run")
    args = parser.parse_args(arguments)
    table = Table("FMU", "driveline check", *CHECKERS, title=f"Findings in the FMUs of {args.folder}")
    rules: Counter[str] = Counter()
    found: Counter[str] = Counter()
    count = 0
    for path, row in rows(args.folder, args.quick):
        count += 1
        rules.update(row.ours)
        found.update(name for name, findings in row.others.items() if findings)
        found["driveline check"] += bool(row.ours)
        found["driveline check alone"] += bool(row.ours) and not any(row.others.values())
        found["others alone"] += row.missed
        others = ("" if findings is None else str(findings) for findings in row.others.values())
        table.add_row(f"{'! ' if row.missed else ''}{path.relative_to(args.folder)}", " ".join(row.ours), *others)
    console = Console()
    console.print(table)
    console.print(f"{count} FMUs; with findings of: {', '.join(f'{name} {n}' for name, n in found.items())}")
    console.print(f"rules: {', '.join(f'{rule} {n}' for rule, n in rules.most_common())}")


if __name__ == "__main__":
    script(main)
