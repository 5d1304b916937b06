"""Plants in C that misbehave: they stand still, and do what a test puts into their calls."""

import subprocess
from collections.abc import Sequence
from pathlib import Path
from zipfile import ZipFile

import fmpy
import pytest

from driveline.fmus.native.compiler import CompilerError, host_compiler
from tests.foreign import UNITS

SOURCE = Path(__file__).with_name("stranger.c")

INPUTS = ("T_mot", "T_brake", "slope")
PARAMETERS = {"v_0": 0.0, "T_0": 0.0, "i": 9.0, "r": 0.3, "m": 1500.0, "g": 9.81, "c_rr": 0.01, "c_wa": 0.4}
OUTPUTS = ("omega_1", "omega_2", "omega_wheel_L", "omega_wheel_R", "T_gear", "v", "a_body")


def build_stranger(folder: Path, name: str = "stranger", libraries: Sequence[str] = ("-lm",), **does: str) -> Path:
    """Builds NAME.fmu with these libraries; `does` is C by the macro of stranger.c whose place it takes."""
    try:
        compiler = host_compiler()
    except CompilerError as reason:
        pytest.skip(str(reason))
    library = folder / f"{name}{fmpy.sharedLibraryExtension}"
    macros = [f"-D{macro}={code}" for macro, code in does.items()]
    subprocess.run([compiler, "-w", "-shared", "-fPIC", *macros, SOURCE, "-o", library, *libraries], check=True)
    path = folder / f"{name}.fmu"
    with ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", description())
        archive.write(library, f"binaries/{fmpy.platform}/stranger{fmpy.sharedLibraryExtension}")
    return path


def description() -> str:
    """The model description of the plant."""
    variables = [
        *(_variable(name, 'causality="input"', ' start="0"') for name in INPUTS),
        *(
            _variable(name, 'causality="parameter" variability="fixed"', f' start="{value}"')
            for name, value in PARAMETERS.items()
        ),
        *(_variable(name, 'causality="output"') for name in OUTPUTS),
    ]
    numbered = "".join(text.format(k) for k, text in enumerate(variables))
    first = len(INPUTS) + len(PARAMETERS) + 1
    outputs = "".join(f'<Unknown index="{first + k}"/>' for k in range(len(OUTPUTS)))
    units = "".join(f'<Unit name="{unit}"/>' for unit in sorted({*UNITS.values(), "1"}))
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="stranger" guid="stranger">
<CoSimulation modelIdentifier="stranger" canHandleVariableCommunicationStepSize="true"/>
<UnitDefinitions>{units}</UnitDefinitions>
<DefaultExperiment stopTime="0.2" stepSize="0.001"/>
<ModelVariables>{numbered}</ModelVariables>
<ModelStructure><Outputs>{outputs}</Outputs><InitialUnknowns>{outputs}</InitialUnknowns></ModelStructure>
</fmiModelDescription>"""


def _variable(name: str, causality: str, start: str = "") -> str:
    return (
        f'<ScalarVariable name="{name}" valueReference="{{}}" description="of a stranger" {causality}>'
        f'<Real unit="{UNITS.get(name, "1")}"{start}/></ScalarVariable>'
    )
