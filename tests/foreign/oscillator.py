"""An FMU in C for model exchange alone that misbehaves: it does what a test puts into its calls."""

from pathlib import Path

from tests.foreign.compiled import foreign_fmu

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
    return foreign_fmu(folder / "oscillator.fmu", "oscillator", description, SOURCE, does)
