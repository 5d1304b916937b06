"""FMUs of others: C that does what a test puts into its calls, and a model description."""

import re
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from zipfile import ZipFile

import fmpy

from fmublocks.native.compiler import host_compiler
from fmutesting.skipping import skipped_if_impossible


def foreign_fmu(
    path: Path,
    identifier: str,
    description: str,
    source: Path,
    does: Mapping[str, str],
    libraries: Sequence[str] = ("-lm",),
    platform: str = fmpy.platform,
) -> Path:
    """Builds the FMU at the path, with that model identifier; `does` is C by the macro IN_... of the source
    whose place it takes; others do nothing."""
    with skipped_if_impossible():
        compiler = host_compiler()
    library = path.with_suffix(fmpy.sharedLibraryExtension)
    nothing = dict.fromkeys(
        re.findall(r"\bIN_\w+", "".join(path.read_text() for path in source.parent.glob("*.[ch]"))), ""
    )
    macros = [f"-D{macro}={code}" for macro, code in {**nothing, **does}.items()]
    subprocess.run([compiler, "-w", "-shared", "-fPIC", *macros, source, "-o", library, *libraries], check=True)
    with ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", description)
        archive.write(library, f"binaries/{platform}/{identifier}{library.suffix}")
    return path
