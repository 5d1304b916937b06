"""An FMU in C for model exchange alone that misbehaves: it does what a test puts into its calls."""

import subprocess
from pathlib import Path
from zipfile import ZipFile

import fmpy
import pytest

from driveline.fmus.native.compiler import CompilerError, host_compiler

SOURCE = Path(__file__).with_name("oscillator.c")

DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="oscillator" guid="oscillator" numberOfEventIndicators="0">
<ModelExchange modelIdentifier="oscillator"/>
<DefaultExperiment stopTime="1" stepSize="0.01"/>
<ModelVariables>
<ScalarVariable name="s" valueReference="0" causality="local" initial="exact"><Real start="1"/></ScalarVariable>
<ScalarVariable name="v" valueReference="1" causality="local" initial="exact"><Real start="0"/></ScalarVariable>
<ScalarVariable name="der(s)" valueReference="2" causality="local"><Real derivative="1"/></ScalarVariable>
<ScalarVariable name="der(v)" valueReference="3" causality="local"><Real derivative="2"/></ScalarVariable>
</ModelVariables>
<ModelStructure>
<Derivatives><Unknown index="3"/><Unknown index="4"/></Derivatives>
<InitialUnknowns><Unknown index="3"/><Unknown index="4"/></InitialUnknowns>
</ModelStructure>
</fmiModelDescription>"""


def build_oscillator(folder: Path, description: str = DESCRIPTION, **does: str) -> Path:
    """Builds oscillator.fmu; `does` is C by the macro of oscillator.c whose place it takes."""
    try:
        compiler = host_compiler()
    except CompilerError as reason:
        pytest.skip(str(reason))
    library = folder / f"oscillator{fmpy.sharedLibraryExtension}"
    macros = [f"-D{macro}={code}" for macro, code in does.items()]
    subprocess.run([compiler, "-w", "-shared", "-fPIC", *macros, SOURCE, "-o", library, "-lm"], check=True)
    path = folder / "oscillator.fmu"
    with ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", description)
        archive.write(library, f"binaries/{fmpy.platform}/{library.name}")
    return path
