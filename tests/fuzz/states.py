"""Saved states that no instance wrote, in every mode of the native FMUs, under the sanitizers."""

import subprocess
from collections.abc import Iterator
from pathlib import Path
from random import Random

from driveline.fmus.catalogue import FMUS
from fmublocks.builds import builders
from tests.fuzz.calls import HOST, program
from tests.fuzz.target import Attempt, Unclean, target

STATES = 50
"""Of a try."""


@target(
    "50 forged saved states of a native FMU, from before, in and after initialization mode, under sanitizers",
    "refused, or followed without a fault and without hanging",
    short=20,
    long=20_000,
)
def attempts(folder: Path) -> Iterator[Attempt]:
    (build,) = builders("native")
    host = HOST.with_name("forged_states.c")
    programs = [program(build(fmu, folder), folder / fmu.name, host) for fmu in FMUS.values()]

    def attempt(random: Random) -> str:
        command = [*random.choice(programs), str(random.getrandbits(31)), str(STATES)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise Unclean(f"{' '.join(command)}: exit code {done.returncode} {done.stderr[:1000]}")
        return "some are taken" if int(done.stdout) else "all are refused"

    yield attempt
