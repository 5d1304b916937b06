"""Plants in C that misbehave: they stand still, and do what a test puts into their calls."""

from collections.abc import Sequence
from pathlib import Path

import fmpy

from fmutesting.foreign import UNITS
from fmutesting.foreign.compiled import foreign_fmu

SOURCES = {fmi: Path(__file__).with_name(name) for fmi, name in {2: "stranger.c", 3: "stranger3.c"}.items()}

INPUTS = ("T_mot", "T_brake", "slope")
PARAMETERS = {"v_0": 0.0, "T_0": 0.0, "i": 9.0, "r": 0.3, "m": 1500.0, "g": 9.81, "c_rr": 0.01, "c_wa": 0.4}
OUTPUTS = ("omega_1", "omega_2", "omega_wheel_L", "omega_wheel_R", "T_gear", "v", "a_body")


WORDS_OF_FMI3 = {
    "fmi2Instantiate": "fmi3InstantiateCoSimulation",
    "Failed to instantiate model": "Failed to instantiate FMU",
    "fmi2GetReal": "fmi3GetFloat64",
    "fmi2": "fmi3",
}
"""What messages about a stranger of FMI 2.0 say of one of FMI 3.0."""


def in_words_of(fmi: int, message: str) -> str:
    """A message about a stranger of FMI 2.0, or a pattern of it, for the same one of that FMI."""
    for two, three in WORDS_OF_FMI3.items() if fmi == 3 else ():
        message = message.replace(two, three)
    return message


def build_stranger(
    folder: Path, name: str = "stranger", libraries: Sequence[str] = ("-lm",), fmi: int = 2, **does: str
) -> Path:
    """Builds NAME.fmu with these libraries; `does` is C by the macro of stranger.c whose place it takes."""
    described, platform = {2: (description, fmpy.platform), 3: (description_3, fmpy.platform_tuple)}[fmi]
    return foreign_fmu(folder / f"{name}.fmu", "stranger", described(), SOURCES[fmi], does, libraries, platform)


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


def description_3() -> str:
    """The same of the plant as an FMU of FMI 3.0."""
    kinds = [
        *((name, 'causality="input" start="0"') for name in INPUTS),
        *((name, f'causality="parameter" variability="fixed" start="{value}"') for name, value in PARAMETERS.items()),
        *((name, 'causality="output"') for name in OUTPUTS),
        ("time", 'causality="independent"'),
    ]
    units = {**UNITS, "time": "s"}
    variables = "".join(
        f'<Float64 name="{name}" valueReference="{k}" unit="{units.get(name, "1")}" description="strange" {kind}/>'
        for k, (name, kind) in enumerate(kinds)
    )
    references = [k for k, (name, _) in enumerate(kinds) if name in OUTPUTS]
    structure = "".join(f'<{tag} valueReference="{k}"/>' for tag in ("Output", "InitialUnknown") for k in references)
    defined = "".join(f'<Unit name="{unit}"/>' for unit in sorted({*units.values(), "1"}))
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="stranger" instantiationToken="stranger">
<CoSimulation modelIdentifier="stranger" canHandleVariableCommunicationStepSize="true"/>
<UnitDefinitions>{defined}</UnitDefinitions>
<DefaultExperiment stopTime="0.2" stepSize="0.001"/>
<ModelVariables>{variables}</ModelVariables>
<ModelStructure>{structure}</ModelStructure>
</fmiModelDescription>"""
