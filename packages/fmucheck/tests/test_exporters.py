"""No false alarm on FMUs as other exporters write them: the oscillator, described by us in the manner of each."""

import pytest
from fmutesting.foreign.oscillator import DESCRIPTION, build_oscillator

from .test_faults import found, judged

STRUCTURE = DESCRIPTION[DESCRIPTION.index("<ModelStructure>") : DESCRIPTION.index("</fmiModelDescription>")]

DYMOLA = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" fmiVersion="2.0" modelName="oscillator"
  guid="oscillator" generationTool="as Dymola" generationDateAndTime="2024-05-16T10:47:02Z"
  variableNamingConvention="structured" numberOfEventIndicators="0">
<ModelExchange modelIdentifier="oscillator" canNotUseMemoryManagementFunctions="true"
  providesDirectionalDerivative="true"/>
<UnitDefinitions><Unit name="m"><BaseUnit m="1"/></Unit><Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
<Unit name="m/s2"><BaseUnit m="1" s="-2"/></Unit></UnitDefinitions>
<TypeDefinitions>
<SimpleType name="Modelica.Units.SI.Position"><Real quantity="Length" unit="m"/></SimpleType>
<SimpleType name="Modelica.Units.SI.Velocity"><Real quantity="Velocity" unit="m/s"/></SimpleType>
<SimpleType name="Modelica.Units.SI.Acceleration"><Real quantity="Acceleration" unit="m/s2"/></SimpleType>
</TypeDefinitions>
<DefaultExperiment startTime="0.0" stopTime="1.0" tolerance="0.0001"/>
<ModelVariables>
<!-- Index for next variable = 1 -->
<ScalarVariable name="mass.s" valueReference="0" initial="exact">
  <Real declaredType="Modelica.Units.SI.Position" unit="m" start="1" reinit="true"/></ScalarVariable>
<ScalarVariable name="mass.v" valueReference="1" initial="exact">
  <Real declaredType="Modelica.Units.SI.Velocity" unit="m/s" start="0"/></ScalarVariable>
<ScalarVariable name="der(mass.s)" valueReference="2">
  <Real declaredType="Modelica.Units.SI.Velocity" unit="m/s" derivative="1"/></ScalarVariable>
<ScalarVariable name="der(mass.v)" valueReference="3">
  <Real declaredType="Modelica.Units.SI.Acceleration" unit="m/s2" derivative="2"/></ScalarVariable>
<ScalarVariable name="mass.a" valueReference="3"><Real declaredType="Modelica.Units.SI.Acceleration"/></ScalarVariable>
</ModelVariables>
<ModelStructure><Derivatives>
<Unknown index="3" dependencies="2" dependenciesKind="constant"/>
<Unknown index="4" dependencies="1" dependenciesKind="fixed"/>
</Derivatives><InitialUnknowns>
<Unknown index="3" dependencies="2" dependenciesKind="dependent"/>
<Unknown index="4" dependencies="1" dependenciesKind="dependent"/>
</InitialUnknowns></ModelStructure>
</fmiModelDescription>"""

OPENMODELICA = f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="Oscillator" guid="oscillator" description=""
  numberOfEventIndicators="0" generationTool="as OpenModelica" generationDateAndTime="2017-11-21T06:51:19Z"
  variableNamingConvention="structured">
<ModelExchange modelIdentifier="oscillator">
</ModelExchange>
<LogCategories><Category name="logEvents" /><Category name="logFmi2Call" /></LogCategories>
<DefaultExperiment startTime="0.0" stopTime="1.0" tolerance="1e-06"/>
<ModelVariables>
<!-- Index of variable = "1" -->
<ScalarVariable name="s" valueReference="0" variability="continuous" causality="local" initial="exact">
  <Real start="1.0"/></ScalarVariable>
<ScalarVariable name="v" valueReference="1" variability="continuous" causality="local" initial="exact">
  <Real start="0.0"/></ScalarVariable>
<ScalarVariable name="der(s)" valueReference="2" variability="continuous" causality="local" initial="calculated">
  <Real derivative="1"/></ScalarVariable>
<ScalarVariable name="der(v)" valueReference="3" variability="continuous" causality="local" initial="calculated">
  <Real derivative="2"/></ScalarVariable>
</ModelVariables>
{STRUCTURE}
</fmiModelDescription>"""

FMUSDK = f"""<?xml version="1.0" encoding="ISO-8859-1"?>
<fmiModelDescription fmiVersion="2.0" modelName="oscillator" guid="oscillator" numberOfEventIndicators="0">
<ModelExchange modelIdentifier="oscillator"/>
<LogCategories><Category name="logAll"/><Category name="logError"/></LogCategories>
<ModelVariables>
<ScalarVariable name="h" valueReference="0" description="height, used as state" causality="local"
  variability="continuous" initial="exact"><Real start="1"/></ScalarVariable>
<ScalarVariable name="v" valueReference="1" causality="local" initial="exact"><Real start="0" reinit="true"/>
</ScalarVariable>
<ScalarVariable name="der(h)" valueReference="2" causality="local"><Real derivative="1"/></ScalarVariable>
<ScalarVariable name="der(v)" valueReference="3" causality="local"><Real derivative="2"/></ScalarVariable>
<ScalarVariable name="sliding" valueReference="3" causality="local" variability="discrete" initial="exact">
  <Real start="0.5"/></ScalarVariable>
</ModelVariables>
{STRUCTURE}
</fmiModelDescription>"""

STEPPED = {
    "20-sim": """<?xml version="1.0" encoding="ISO-8859-1"?>
<fmiModelDescription fmiVersion="2.0" modelName="TorsionBar" guid="{1}" generationTool="as 20-sim" copyright="-"
  numberOfEventIndicators="0" license="-">
<CoSimulation modelIdentifier="oscillator" needsExecutionTool="false" canInterpolateInputs="false"
  maxOutputDerivativeOrder="0" canRunAsynchronuously="false" canNotUseMemoryManagementFunctions="true">
<SourceFiles><File name="xxmodel.c" /></SourceFiles></CoSimulation>
<DefaultExperiment startTime="0.0" stopTime="12.56" stepSize="1.0e-5" />
<ModelVariables>
<ScalarVariable name="Amplifier.DA.bits" valueReference="5" variability="tunable" causality="parameter">
<Real start="12.0" /></ScalarVariable>
<ScalarVariable name="Motor\\i" valueReference="6" variability="continuous" causality="local"><Real /></ScalarVariable>
<ScalarVariable name="LoadDiskRev" valueReference="7" variability="continuous" causality="output"><Real />
</ScalarVariable></ModelVariables>
<ModelStructure><Outputs><Unknown index="3" /></Outputs>
<InitialUnknowns><Unknown index="3" /></InitialUnknowns></ModelStructure></fmiModelDescription>""",
    "Simulink": """<?xml version="1.0" encoding="utf-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="winch" guid="{8468d5d0}" description="" version="1.15"
  generationTool="as Simulink" variableNamingConvention="structured" generationDateAndTime="2020-06-10T10:05:46Z">
<CoSimulation modelIdentifier="oscillator" canBeInstantiatedOnlyOncePerProcess="true"/>
<DefaultExperiment startTime="0" stopTime="1000" stepSize="0.1"/>
<VendorAnnotations><Tool name="Simulink"><Simulink><ImportCompatibility requireRelease="all"/></Simulink></Tool>
</VendorAnnotations>
<ModelVariables>
<ScalarVariable name="vessel_position.north" valueReference="1" causality="input" variability="continuous">
<Real start="0"  /></ScalarVariable> <!-- index="1" -->
<ScalarVariable name="connected" valueReference="0" causality="output" variability="discrete"><Boolean />
</ScalarVariable> <!-- index="2" -->
<ScalarVariable name="mode[1]" valueReference="0" causality="parameter" variability="tunable"><Integer start="2" />
</ScalarVariable> <!-- index="3" -->
</ModelVariables>
<ModelStructure><Outputs><Unknown index="2" dependencies="1" dependenciesKind="dependent"/></Outputs>
<InitialUnknowns><Unknown index="2"/></InitialUnknowns></ModelStructure></fmiModelDescription>""",
    "SimulationX": """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="oscillator" guid="{2}" generationTool="as SimulationX"
  generationDateAndTime="2024-09-25T17:36:52Z" variableNamingConvention="structured" numberOfEventIndicators="4">
<CoSimulation modelIdentifier="oscillator" canHandleVariableCommunicationStepSize="true" canGetAndSetFMUstate="true"
  canSerializeFMUstate="true" canInterpolateInputs="true"/>
<UnitDefinitions><Unit name="m"><DisplayUnit name="\u00b5m" factor="9.9999999999999995e-07" offset="0."/>
</Unit></UnitDefinitions>
<TypeDefinitions><SimpleType name="Switch"><Enumeration quantity="Switch"><Item name="'off'" value="0"/>
<Item name="'on'" value="1"/></Enumeration></SimpleType></TypeDefinitions>
<DefaultExperiment startTime="0." stopTime="1." stepSize="0.001"/>
<ModelVariables>
<ScalarVariable name="_iti_state0" valueReference="2147483648" variability="continuous" causality="local"
  initial="approx"><Real start="0."/></ScalarVariable>
<ScalarVariable name="_iti_derstate0" valueReference="2415919104" variability="continuous" causality="local">
<Real derivative="1"/></ScalarVariable>
<ScalarVariable name="kind" valueReference="3" causality="parameter" variability="fixed">
<Enumeration declaredType="Switch" start="1"/></ScalarVariable>
<ScalarVariable name="x" valueReference="4" causality="output"><Real unit="m" displayUnit="\u00b5m"/></ScalarVariable>
</ModelVariables>
<ModelStructure><Outputs><Unknown index="4"/></Outputs><Derivatives><Unknown index="2"/></Derivatives>
<InitialUnknowns><Unknown index="1"/><Unknown index="4"/></InitialUnknowns></ModelStructure>
</fmiModelDescription>""",
    "Amesim": """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="rail" guid="1405882510" generationTool="as Amesim"
  variableNamingConvention="flat">
<CoSimulation modelIdentifier="oscillator" needsExecutionTool="true" canNotUseMemoryManagementFunctions="true"/>
<UnitDefinitions><Unit name="bar"/><Unit name="s"/></UnitDefinitions>
<ModelVariables>
<ScalarVariable name="p1@hydraulic chamber" valueReference="2" causality="local" variability="continuous">
<Real unit="bar" min="-1e+30" max="1e+30" nominal="1."/>
<Annotations><Tool name="Amesim"><VarAnnot index="1"/></Tool></Annotations></ScalarVariable>
<ScalarVariable name="maxTimeStep" valueReference="536870912" causality="parameter" variability="fixed"
  initial="exact"><Real unit="s" min="0." max="1e+30" nominal="1." start="1e+30"/></ScalarVariable>
<ScalarVariable name="errCtrl" valueReference="536870912" causality="parameter" variability="fixed" initial="exact">
<Integer min="0" max="2" start="0"/></ScalarVariable>
<ScalarVariable name="expseu_.q" valueReference="9" causality="output" variability="continuous" initial="exact">
<Real start="0"/></ScalarVariable>
</ModelVariables><ModelStructure><Outputs><Unknown index="4"/></Outputs></ModelStructure></fmiModelDescription>""",
    "Activate, FMI 3.0": """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription  fmiVersion="3.0"  modelName="sine" generationTool="as Activate" copyright="-"
  version="2023.0" variableNamingConvention="flat" instantiationToken="{Activate-inline-CG-2023  6  22  15  12  13}">
<CoSimulation modelIdentifier="oscillator" providesIntermediateUpdate="true" hasEventMode="true"
  canReturnEarlyAfterIntermediateUpdate="true"></CoSimulation>
<LogCategories><Category name="logInfo"/></LogCategories>
<DefaultExperiment startTime="0" stopTime="5" tolerance="1e-06" stepSize="0.01"/>
<ModelVariables>
<Float64 name="InternalTime"  valueReference="1"   causality="independent"   description="Time variable" ></Float64>
<Clock name="SampleClock"  valueReference="2"   variability="discrete"   intervalVariability="constant"
  intervalDecimal="0.2"   shiftDecimal="0"   causality="input"/>
<Float64 name="Output"  valueReference="3"   causality="output"><Dimension start="3"/><Dimension start="2"/></Float64>
<Float64 name="Phase"  valueReference="4"   initial="exact"   variability="fixed"   causality="parameter"
  start="1 2 3 4 5 6"><Dimension start="3"/><Dimension start="2"/></Float64>
<String name="file" valueReference="5" causality="parameter" variability="fixed"><Start value=""/></String>
</ModelVariables>
<ModelStructure><Output valueReference="3" dependencies=""/><InitialUnknown valueReference="3" dependencies="" />
</ModelStructure></fmiModelDescription>""",
}


@pytest.mark.parametrize("description", [DYMOLA, OPENMODELICA, FMUSDK], ids=["Dymola", "OpenModelica", "FMU SDK"])
def test_nothing_is_found_in_model_exchange(tmp_path, description):
    assert judged(build_oscillator(tmp_path, description)) == {}


@pytest.mark.parametrize("exporter", STEPPED)
def test_nothing_is_found_in_a_description_for_co_simulation(tmp_path, exporter):
    description = STEPPED[exporter]
    fmi = 3 if 'fmiVersion="3.0"' in description else 2
    assert found(tmp_path, description, {"sources/xxmodel.c": ""}, fmi) == {}
