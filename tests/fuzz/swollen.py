"""Files that are small and take much: units, keys and numbers without end, lines and columns without number, and packed
recordings that unpack to gigabytes, descriptions and archives of FMUs with one thing again and again."""

import resource
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from struct import pack
from time import process_time
from zipfile import ZIP_DEFLATED, ZipFile

import asammdf
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.manoeuvres.manoeuvre_file import read_manoeuvre
from driverecords.drive import read_drive
from driverecords.quantities import aliases
from fmublocks.errors import BuildError
from fmuloop.system import System
from fmuloop.wiring import fit
from packages.driverecords.tests.test_bus_log import drive as frames
from packages.driverecords.tests.test_bus_log import write as write_log
from tests.fuzz.target import Attempt, Unclean, target
from toolground.errors import UserError
from toolground.file_limits import SECONDS
from toolground.unit_conversion import SI, factor

MEMORY, BESIDE = 2_000_000_000, 2.0
"""Bytes that the process may have that reads a file, and seconds that it may compute beside reading."""

SYMBOLS = ("m", "s", "h", "min", "N", "km", "rad", "deg", "Ym", "ym", "g", "x")

NAMES = ["Time [s]", "Velocity [km/h]", "Motor Torque [Nm]"]


def scale(random: Random, most: float) -> int:
    """A number up to so many, small and large alike."""
    return int(10.0 ** random.uniform(0.0, np.log10(most)))


def unit(random: Random) -> str:
    """A product of powers."""
    powers = ("", str(scale(random, 1e9)), f"-{scale(random, 1e9)}", f"^{scale(random, 9)}")
    count = scale(random, 5000)
    return random.choice((".", "*", "/")).join(random.choice(SYMBOLS) + random.choice(powers) for _ in range(count))


def in_heading(random: Random, folder: Path) -> None:
    name = random.choice(NAMES)
    heading = ",".join([*(each for each in NAMES if each != name), f"{name.partition('[')[0]}[{unit(random)}]"])
    read_drive(written(folder / "drive.csv", f"{heading}\n0,1,2\n1,1,2\n"))


def in_manoeuvre(random: Random, folder: Path) -> None:
    read_manoeuvre(written(folder / "mine.toml", f'duration = 2\nv_0 = "15 {unit(random)}"\n'))


def in_fmu(random: Random, folder: Path) -> None:
    try:
        factor(unit(random), random.choice((SI, "N.m", unit(random))))
    except ValueError as reason:
        raise UserError(str(reason)) from reason


def entry(random: Random) -> str:
    """A line of TOML with a key of many parts, a number of many digits, or brackets in brackets."""
    name, count = random.choice(("duration", "J_1", "omega_1", "x")), scale(random, 200_000)
    part = random.choice(("a", "'a'", '"\\""', "1", '"="'))
    dots = random.choice((".", " . ")).join([part] * count)
    digits = random.choice(("9", "1_", "0")) * count + "1"
    value = random.choice((digits, f"0x{'F' * count}", f"0.{digits}", f"1e{digits}", "[" * count, "{a=" * count))
    return random.choice((f"{name}.{dots} = 1", f"[{dots}]", f"{name} = {{{dots} = 1}}", *3 * (f"{name} = {value}",)))


def toml(random: Random, folder: Path) -> None:
    text = "\n".join(entry(random) for _ in range(random.choice((1, 1, 3, 100))))[: scale(random, 2e6) + 1000]
    path = written(folder / "file.toml", text)
    random.choice((read_manoeuvre, read_vehicle, aliases))(path)


def text(random: Random, folder: Path) -> None:
    """One line, one column or one cell again and again."""
    again = random.choice(("x", ",", "\n", " ", "1,2,3\n", "1,", '"', "1\u00a0,2,3\n", "true,1,2\n", ";", "\r", "\t"))
    count = scale(random, 3e7) // len(again) + 1
    read_drive(written(folder / "drive.csv", random.choice(("", ",".join(NAMES) + "\n0,1,2\n1,1,2\n")) + again * count))


def parquet(random: Random, folder: Path) -> None:
    """Zeros, at most 2.4 GB of them."""
    rows = scale(random, 1e8)
    some = pa.table({name: np.zeros(min(rows, 10_000_000)) for name in NAMES})
    with pq.ParquetWriter(folder / "drive.parquet", some.schema, compression=random.choice(("zstd", "gzip"))) as file:
        for _ in range(rows // len(some)):
            file.write_table(some, row_group_size=len(some))
    read_drive(folder / "drive.parquet")


def mdf(random: Random, folder: Path) -> None:
    """Zeros, at most 1.2 GB of them."""
    time = 0.001 * np.arange(scale(random, 5e7))
    with asammdf.MDF() as file:
        for name, of in (("Velocity", "km/h"), ("Motor Torque", "Nm")):
            file.append([asammdf.Signal(np.zeros(len(time)), time, name=name, unit=of)])
        file.save(folder / "drive.mf4", overwrite=True, compression=2)
    read_drive(folder / "drive.mf4")


def log(random: Random, folder: Path) -> None:
    """A container of zeros, at most 2 GB of them, behind sound frames."""
    path, databases = write_log(folder, frames())
    packer = zlib.compressobj(1)
    content = b"".join(packer.compress(bytes(1_000_000)) for _ in range(scale(random, 2000))) + packer.flush()
    head = pack("<4sHHLL", b"LOBJ", 16, 1, 32 + len(content), 10) + pack("<H6xL4x", 2, 0)
    path.write_bytes(path.read_bytes() + head + content)
    read_drive(path, databases=databases)


DESCRIPTION = {
    2: """<fmiModelDescription fmiVersion="2.0" modelName="m" guid="g" {in_root}><CoSimulation modelIdentifier="m"/>
<UnitDefinitions>{units}</UnitDefinitions><VendorAnnotations>{notes}</VendorAnnotations><ModelVariables>
<ScalarVariable name="x" valueReference="0" causality="output"><Real/></ScalarVariable>{variables}</ModelVariables>
<ModelStructure><Outputs><Unknown index="1"/>{unknowns}</Outputs></ModelStructure></fmiModelDescription>""",
    3: """<fmiModelDescription fmiVersion="3.0" modelName="m" instantiationToken="g" {in_root}>
<CoSimulation modelIdentifier="m"/><UnitDefinitions>{units}</UnitDefinitions><Annotations>{notes}</Annotations>
<ModelVariables><Float64 name="x" valueReference="0" causality="output"/>{variables}</ModelVariables>
<ModelStructure><Output valueReference="0"/>{unknowns}</ModelStructure></fmiModelDescription>""",
}

SWOLLEN = {
    2: {
        "in_root": ('a{k}="" ',),
        "units": ('<Unit name="u{k}"/>',),
        "notes": ("<a/>", "<a>", "<a {again}/>"),
        "variables": (
            '<ScalarVariable name="v{k}" valueReference="{k}" causality="output"><Real/></ScalarVariable>',
            '<ScalarVariable name="{again}" valueReference="1"><Real start="1"/></ScalarVariable>',
        ),
        "unknowns": ('<Unknown index="1"/>', '<Unknown index="1" dependencies="{again}"/>'),
    },
    3: {
        "in_root": ('a{k}="" ',),
        "units": ('<Unit name="u{k}"/>',),
        "notes": ("<a/>", "<a>", "<a {again}/>"),
        "variables": (
            '<Float64 name="v{k}" valueReference="{k}" causality="output"/>',
            '<Boolean name="v{k}" valueReference="{k}" causality="output"/>',
            '<Float64 name="v" valueReference="1" clocks="{again}"/>',
            '<Float64 name="v" valueReference="1">{again}</Float64>',
        ),
        "unknowns": ('<Output valueReference="0"/>', '<Output valueReference="0" dependencies="{again}"/>'),
    },
}
"""What is there again and again, by the place in the description; `again` stands for one of AGAIN."""

AGAIN = ("1 ", "0 ", "x", 'a{k}="" ', '<Alias name="a{k}"/>', '<Dimension start="1"/>', "&#9;1")


def repeated(pattern: str, count: int) -> str:
    return "".join(pattern.replace("{k}", str(k)) for k in range(1, count + 1))


def fmu(random: Random, folder: Path) -> None:
    """A description or an archive with one thing again and again."""
    fmi = random.choice((2, 3))
    parts = dict.fromkeys(SWOLLEN[fmi], "")
    place = random.choice([*parts, "entries"])
    count, entries = scale(random, 5e6), 0
    if place == "entries":
        entries = scale(random, 2e5)
    elif "{again}" in (pattern := random.choice(SWOLLEN[fmi][place])):
        parts[place] = pattern.replace("{again}", repeated(random.choice(AGAIN), count).strip())
    else:
        parts[place] = repeated(pattern, count)
    name = random.choice(("modelDescription.xml", "modelDescription.xml", "sources/buildDescription.xml"))
    written = {"modelDescription.xml": DESCRIPTION[fmi].format_map(dict.fromkeys(parts, ""))}
    written[name] = DESCRIPTION[fmi].format_map(parts)
    with ZipFile(folder / "theirs.fmu", "w", ZIP_DEFLATED, compresslevel=1) as archive:
        for path, content in written.items():
            archive.writestr(path, content)
        for k in range(entries):
            archive.writestr(f"resources/{k}", "")
    fit(System({"theirs": folder / "theirs.fmu"}))


QUICK = (in_heading, in_manoeuvre, in_fmu, fmu, toml, text)
PACKED = (parquet, mdf, log)
SHARE = 0.1
"""Of the tries that are packed files."""


def written(path: Path, content: str) -> Path:
    path.write_text(content, encoding="utf-8")
    return path


@target(
    "small files that take much: units, keys, numbers, lines, columns, variables, references and entries without end, "
    "Parquet, MDF and BLF that unpack to gigabytes",
    "read or refused in a line, with at most 30 s of computing and 2 GB",
    short=15,
    long=1000,
)
def attempts(folder: Path) -> Iterator[Attempt]:
    def attempt(random: Random) -> str:
        kind: Callable[[Random, Path], None] = random.choice(PACKED if random.random() < SHARE else QUICK)
        before, began = _children_time(), process_time()
        try:
            kind(random, folder)
            answer = "read"
        except (UserError, BuildError) as refusal:
            answer = "refused in one line"
            if not all(line.isprintable() for line in str(refusal).splitlines()[: None if kind is toml else 1]):
                raise Unclean(f"{kind.__name__}: {refusal}") from refusal
        except Exception as fault:
            raise Unclean(f"{kind.__name__}: {type(fault).__name__}: {str(fault)[:300]}") from fault
        seconds = max(process_time() - began if kind in QUICK else 0.0, _children_time() - before)
        memory = 1024 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        for path in folder.iterdir():
            path.unlink()
        if seconds > SECONDS + BESIDE or memory > MEMORY:
            raise Unclean(f"{kind.__name__}: {seconds:.1f} s of computing, {memory / 1e6:.0f} MB")
        return answer

    yield attempt


def _children_time() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
