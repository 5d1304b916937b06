"""An FMU in C for model exchange alone that misbehaves: it does what a test puts into its calls."""

from pathlib import Path

import fmpy

from fmutesting.foreign.compiled import foreign_fmu

SOURCES = {fmi: Path(__file__).with_name(name) for fmi, name in {2: "oscillator.c", 3: "oscillator3.c"}.items()}

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

DESCRIPTION_3 = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="oscillator" instantiationToken="oscillator">
<ModelExchange modelIdentifier="oscillator"/>
<DefaultExperiment stopTime="1" stepSize="0.01"/>
<ModelVariables>
<Float64 name="time" valueReference="9" causality="independent" variability="continuous"/>
<Float64 name="s" valueReference="0" causality="local" initial="exact" start="1"/>
<Float64 name="v" valueReference="1" causality="local" initial="exact" start="0"/>
<Float64 name="der(s)" valueReference="2" causality="local" derivative="0"/>
<Float64 name="der(v)" valueReference="3" causality="local" derivative="1"/>
</ModelVariables>
<ModelStructure>
<ContinuousStateDerivative valueReference="2"/><ContinuousStateDerivative valueReference="3"/>
<InitialUnknown valueReference="2"/><InitialUnknown valueReference="3"/>
</ModelStructure>
</fmiModelDescription>"""

WORDS_OF_FMI3 = {
    "fmi2GetDerivatives": "fmi3GetContinuousStateDerivatives",
    "fmi2NewDiscreteStates": "fmi3UpdateDiscreteStates",
    "fmi2": "fmi3",
}
"""What messages about an oscillator of FMI 2.0 say of one of FMI 3.0."""


def build_oscillator(folder: Path, description: str | None = None, fmi: int = 2, **does: str) -> Path:
    """Builds oscillator.fmu; `does` is C by the macro of oscillator.c whose place it takes."""
    described, platform = {2: (DESCRIPTION, fmpy.platform), 3: (DESCRIPTION_3, fmpy.platform_tuple)}[fmi]
    path = folder / "oscillator.fmu"
    return foreign_fmu(path, "oscillator", description or described, SOURCES[fmi], does, platform=platform)
