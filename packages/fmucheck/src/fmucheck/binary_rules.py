"""Rules for the binary of an FMU. Each function is given it unpacked and yields what a host in C would miss."""

import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import fmpy

from fmuloop.interface import Interface
from fmuloop.unpacked_fmu import Unpacked
from toolground.child_process import run

from .event_host import has_clocks
from .rule import OURS, Clause, Rule, Rules, Severity

MOST_NAMED = 3
"""Symbols that are named of those that are missing."""

LONGEST = 30.0
"""How long in s the linker may look for symbols."""

MISSING = re.compile(r"undefined symbol: ([^\s,]+)|symbol (\S+), version \S+ not defined")

ABSENT = re.compile(r"(\S+) => not found")

BINARIES = Clause("2.3", "2.5.1.4")


def _no_binary_here(interface: Interface) -> Iterator[str]:
    """Whether it can run on this machine; what it does is not tried elsewhere."""
    platforms = fmpy.supported_platforms(str(interface.path))
    if fmpy.platform not in platforms:
        yield f"there is no binary for {fmpy.platform}, so it was not run; there are: {', '.join(platforms) or 'none'}"


PLATFORM = Rule("platform", Severity.NOTE, "there is a binary for this machine", BINARIES, _no_binary_here)


def _not_stepped(interface: Interface) -> Iterator[str]:
    """What it is for that is not run."""
    described = interface.description
    if described.coSimulation and has_clocks(described) and not described.coSimulation.hasEventMode:
        yield "it has clocks, but no event mode, so it was not run in co-simulation"
    elif not described.coSimulation and not described.modelExchange:
        yield "it is for scheduled execution alone, so it was not run"


KIND = Rule("kind", Severity.NOTE, "it is of a kind that is run here", OURS, _not_stepped)

BINARY_RULES = Rules()


@BINARY_RULES.rule("symbols", Severity.WARNING, "its binary has or names all that it needs (Linux)", BINARIES)
def missing_symbols(fmu: Unpacked) -> Iterator[str]:
    """Symbols that no library defines that the binary names as needed.

    A host that happens to have loaded such a library lends it, as Python lends libm and itself; others cannot load the
    binary. The dynamic linker is asked (`ldd -r`), in a process that has neither; what is not Linux is not looked at.
    """
    platform = fmpy.platform_tuple if fmu.interface.fmi == 3 else fmpy.platform
    binary = Path(fmu.folder) / "binaries" / platform / f"{fmu.interface.identifier}.so"
    linker = shutil.which("ldd")
    if not linker or not binary.is_file():
        return
    done = run([linker, "-r", binary], environment={"LC_ALL": "C"}, timeout=LONGEST)
    said = done.stdout + done.stderr
    if absent := list(dict.fromkeys(ABSENT.findall(said))):  # which may have what else is missing
        yield f"{binary.name} needs {', '.join(absent)}, which is not here, nor in the FMU"
        return
    missing = [next(filter(None, match.groups())) for match in MISSING.finditer(said)]
    if missing := list(dict.fromkeys(missing)):
        more = f" and {len(missing) - MOST_NAMED} more" if missing[MOST_NAMED:] else ""
        yield f"{binary.name} needs {', '.join(missing[:MOST_NAMED])}{more}, which no library has that it names"
