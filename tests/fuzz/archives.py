"""FMUs whose archive or model description is damaged."""

import re
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path
from random import Random
from zipfile import ZipFile, ZipInfo

from driveline.fmus.building.builds import build_fmus
from driveline.harness.loop.places import NATIVE, PLANTS
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmucheck.checking import check
from fmuloop.wiring import fit
from tests.fuzz.damage import ODD, spoiled_bytes, spoiled_text
from tests.fuzz.target import Attempt, Unclean, target
from toolground.errors import UserError

DESCRIPTION = "modelDescription.xml"
ATTRIBUTE = re.compile(r' (\w+)="([^"]*)"')
LONGEST = 1000
"""Characters of a refusal, for every name of a file in it."""
LONG_NUMBER = "9" * 5000
"""More digits than Python makes a number of."""
CHECKS = 0.05
"""Share of the FMUs that are checked, in a process of their own."""
RUNS = 0.05
"""Share of the FMUs that are still taken which are run."""


def other_attribute(xml: str, random: Random) -> str:
    """An attribute is left out, doubled or given another value."""
    place = random.choice(list(ATTRIBUTE.finditer(xml)))
    odd = random.choice((*ODD, LONG_NUMBER)).replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
    new = random.choice(("", 2 * place[0], *3 * (f' {place[1]}="{odd}"',)))
    return xml[: place.start()] + new + xml[place.end() :]


def other_entry(entry: ZipInfo, random: Random) -> ZipInfo:
    """An entry under another name, as a link, or of another kind."""
    other = ZipInfo(
        random.choice((f"../{entry.filename}", f"/{entry.filename}", entry.filename.upper(), "a/../b", "x:y"))
    )
    if random.random() < 0.3:
        other = ZipInfo(entry.filename)
        other.external_attr = (stat.S_IFLNK | 0o777) << 16
    return other


def damaged(sound: Path, path: Path, random: Random) -> None:
    """Writes a damaged copy of an FMU."""
    kind = random.choice(("description", "description", "entry", "bytes"))
    if kind == "bytes":
        path.write_bytes(spoiled_bytes(sound.read_bytes(), random))
        return
    with ZipFile(sound) as source, ZipFile(path, "w") as target:
        chosen = random.choice(source.infolist()).filename if kind == "entry" else DESCRIPTION
        for entry in source.infolist():
            content = source.read(entry)
            if entry.filename == chosen and kind == "entry":
                entry = other_entry(entry, random)
            elif entry.filename == chosen:
                spoil = random.choice((other_attribute, other_attribute, spoiled_text))
                content = spoil(content.decode(), random).encode("utf-8", "surrogatepass")
            target.writestr(entry, content)


@target(
    "damaged archives and model descriptions of FMUs",
    "a run, or lines that refuse it; nothing left behind",
    short=60,
    long=20_000,
)
def attempts(folder: Path) -> Iterator[Attempt]:
    list(build_fmus((), folder, "native"))
    sound, path, temporary = folder / NATIVE / f"{PLANTS[0]}.fmu", folder / "theirs.fmu", folder / "temporary"
    temporary.mkdir()

    def attempt(random: Random) -> str:
        damaged(sound, path, random)
        try:
            if random.random() < CHECKS:
                list(check(path, quick=True))
            fit(loop(str(path), folder=folder, build=NATIVE))
            if random.random() > RUNS:
                return "fits"
            simulate(MANOEUVRES["tipin0"], plant=str(path), folder=folder, build=NATIVE)
        except UserError as refusal:
            lines = str(refusal).splitlines()
            if not all(line.isprintable() and len(line) <= LONGEST for line in lines):
                raise Unclean(f"{lines}") from refusal
            return "refused"
        finally:
            if left := list(temporary.iterdir()):
                raise Unclean(f"left behind: {left}")
        return "runs"

    usual, tempfile.tempdir = tempfile.tempdir, str(temporary)
    try:
        yield attempt
    finally:
        tempfile.tempdir = usual
