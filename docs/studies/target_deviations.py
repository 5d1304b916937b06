"""What MISRA C:2012 and further warnings of the compiler find in the C of the target, and why it stays.

`python -m docs.studies.target_deviations` says what is missing to look, and to run the controller on the target.
"""

import re
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from fmublocks.native.compiler import CompilerError
from fmublocks.target.image import BOARD, COMPILER, FLAGS, LINK, PROCESSOR, SCHEDULER, require_packages, written
from toolground.child_process import run

CHECKER = "cppcheck"

LARGEST_STACK = 256
"""Bytes that a function may take."""

WITHOUT_VALUES = {"DISABLE_VALUEFLOW": "1"}
"""Has cppcheck not follow the values of variables, which takes it minutes in the code of a controller."""

WARNING = re.compile(r"^(\S+?):(\d+):\d+: warning: .* \[(-W[a-z-]+)=?\]$", re.MULTILINE)

GENERATED = "generated"
"""Stands for all files of the controller."""


class Deviation(NamedTuple):
    """A rule or warning that is not kept in some files, and why."""

    rule: str
    files: tuple[str, ...]
    reason: str


DEVIATIONS = (
    Deviation("2.3", (GENERATED,), "the types of `controller.h` are for the program that includes it"),
    Deviation("2.4", (GENERATED,), "the words of the status are for the program that reads it"),
    Deviation("2.4", ("link.c",), "its constants have no tag, which the checker takes for one that is not used"),
    Deviation("2.5", (GENERATED,), "name and sample time are for the program that includes the header"),
    Deviation(
        "8.6", ("board_mps2.c", SCHEDULER), "the interrupt of the board is weak, so that a program can have its own"
    ),
    Deviation(
        "8.9",
        ("board_mps2.c", LINK, SCHEDULER),
        "what the hardware, the link and the program are set to stands in one place, at the top",
    ),
    Deviation("11.4", ("board_mps2.c", SCHEDULER), "registers have addresses; semihosting takes addresses as numbers"),
    Deviation("11.5", ("board_mps2.c",), "the link carries bytes, whatever they are of"),
    Deviation("11.6", ("board_mps2.c",), "semihosting takes addresses as numbers"),
    Deviation(
        "-Wfloat-equal",
        (GENERATED,),
        "truth values are exactly 0 or 1, the counter is whole, and a motor speed that is frozen has the same bits",
    ),
)


class Finding(NamedTuple):
    """A rule or warning at a line.

    Attributes:
        file: GENERATED, or the name of one written by hand.
        place: file and line.
    """

    rule: str
    file: str
    place: str


def findings(sources: Mapping[str, str]) -> list[Finding]:
    """What is found in the programs with a controller, behind a link and under a timer.

    Args:
        sources: those of `fmus.target.sources`, in single precision.

    Raises:
        CompilerError: the compiler or the checker is missing.
    """
    require_packages(CHECKER)
    with TemporaryDirectory(prefix="driveline-") as temporary:
        folder = Path(temporary)
        places = [
            (rule, *place)
            for program in (LINK, SCHEDULER)
            for names in [written(sources, (program, *BOARD), folder)]
            for rule, *place in (*_misra(names, folder), *_warned(names, folder))
        ]
    return [
        Finding(rule, GENERATED if file in sources else file, f"{file}:{line}")
        for rule, file, line in dict.fromkeys(places)
    ]


def reason(finding: Finding) -> str | None:
    """Why it stays, if that is written."""
    reasons = (kept.reason for kept in DEVIATIONS if kept.rule == finding.rule and finding.file in kept.files)
    return next(reasons, None)


def _misra(names: Iterable[str], folder: Path) -> list[tuple[str, str, str]]:
    """Rule, file and line; what cppcheck finds beside MISRA has its name for a rule."""
    template = "--template={id} {file} {line}"
    command = [CHECKER, "--quiet", "--addon=misra", "--std=c99", template, "--template-location=", *names]
    rows = [line.split() for line in _complaints(command, folder, WITHOUT_VALUES).splitlines() if line.strip()]
    return [(rule.removeprefix("misra-c2012-"), file, line) for rule, file, line in rows]


def _warned(names: Iterable[str], folder: Path) -> list[tuple[str, str, str]]:
    warnings = ("-Wno-error", "-Wfloat-equal", f"-Wstack-usage={LARGEST_STACK}", "-fno-diagnostics-color")
    command = [COMPILER, *PROCESSOR, *FLAGS, *warnings, "-c", *names]
    return [(rule, file, line) for file, line, rule in WARNING.findall(_complaints(command, folder, {"LC_ALL": "C"}))]


def _complaints(command: list[str], folder: Path, environment: Mapping[str, str]) -> str:
    done = run(command, folder, environment)
    done.check_returncode()
    return done.stderr


if __name__ == "__main__":
    try:
        require_packages(CHECKER)
    except CompilerError as lacking:
        sys.exit(str(lacking))
