"""The smallest faults that can be put into a good FMU, one of each rule: found, and nothing else is."""

import re
from zipfile import ZipFile

import pytest
from fmutesting.foreign.oscillator import DESCRIPTION, DESCRIPTION_3, build_oscillator
from fmutesting.foreign.stranger import build_stranger

from fmucheck.checking import check

TERMINALS = "terminalsAndIcons/terminalsAndIcons.xml"

TERMINAL = """<fmiTerminalsAndIcons fmiVersion="3.0"><Terminals><Terminal name="t" matchingRule="plug">
<TerminalMemberVariable variableName="s" memberName="a" variableKind="signal"/></Terminal></Terminals>
</fmiTerminalsAndIcons>"""

MANIFESTS = {name: f"extra/org.fmi-standard.{name}/fmi-ls-manifest.xml" for name in ("fmi-ls-xcp", "fmi-ls-bus")}

MANIFEST = """<x xmlns:l="http://fmi-standard.org/fmi-ls-manifest" l:fmi-ls-name="org.fmi-standard.{}"
l:fmi-ls-version="1" isBusSimulationFMU="false"><Interface definition="a.a2l"/></x>"""

BUS_TERMINAL = TERMINAL.replace('"plug"', '"plug" terminalKind="org.fmi-ls-bus.network-terminal"')

END = "</ModelVariables>"

CLOCK = '<Clock name="c" valueReference="20" causality="input" intervalVariability="constant" intervalDecimal="0.1"/>'

VECTOR = """<UInt64 name="n" valueReference="21" causality="structuralParameter" variability="fixed" start="3"/>
<Float64 name="p" valueReference="22" causality="parameter" variability="fixed" start="1 2 3">
<Dimension valueReference="21"/></Float64>"""

OPTION = """<TypeDefinitions><EnumerationType name="E"><Item name="a" value="1"/><Item name="b" value="2"/>
</EnumerationType></TypeDefinitions><DefaultExperiment"""

CHOICE = (
    '<Enumeration name="e" valueReference="23" causality="parameter" variability="fixed" declaredType="E" start="1"/>'
)

EVENTS = ("<DefaultExp", '<CoSimulation modelIdentifier="oscillator" hasEventMode="true"/>\n<DefaultExp')


def found(folder, description, files, fmi):
    """Errors and warnings of an FMU without a binary, by rule."""
    path = folder / f"{fmi}.fmu"
    with ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", description)
        archive.writestr("binaries/none/oscillator.so", "")
        for name, content in files.items():
            archive.writestr(name, content)
    return {v.rule: "\n".join(v.problems) for v in check(path) if v.problems and v.severity != "note"}


def case(fmi, fault, rule, finding, made=(), files=None):
    """What makes a good FMU of the oscillator, files beside it, the fault, the rule and what it says."""
    return fmi, made, files or {}, fault, rule, finding


DESCRIBED = [
    case(
        2,
        ('name="s"', 'name="s s"'),
        "variable-names",
        "not a legal variable name",
        made=[("guid=", 'variableNamingConvention="structured" guid=')],
    ),
    case(2, ('<InitialUnknowns><Unknown index="3"/>', "<InitialUnknowns>"), "structure", r"lacks der\(s\)"),
    case(
        2,
        ('<Unknown index="3"/><Unknown index="4"/></I', '<Unknown index="4"/><Unknown index="3"/></I'),
        "structure",
        r"der\(s\) stands behind der\(v\) in InitialUnknowns",
    ),
    case(3, ("<InitialUnknown ", '<InitialUnknown valueReference="0"/><InitialUnknown '), "structure", "not have s"),
    case(2, ('stopTime="1"', 'startTime="2" stopTime="1"'), "experiment-numbers", "not after startTime = 2"),
    case(3, ('stopTime="1"', 'stopTime="1" tolerance="0"'), "experiment-numbers", "tolerance = 0 is not above 0"),
    case(2, ('<Real derivative="1"', '<Real reinit="true" derivative="1"'), "reinit", r"der\(s\) has reinit, and is"),
    case(2, ('oscillator"/>', 'oscillator" canSerializeFMUstate="true"/>'), "capabilities", "but not canGetAndSet"),
    case(
        2,
        ('oscillator"/>', 'oscillator"><SourceFiles><File name="x.c"/></SourceFiles></ModelExchange>'),
        "sources",
        "sources/x.c is named, and is not there",
    ),
    case(2, ('<Real start="1"', '<Real nominal="0" start="1"'), "nominal", "nominal value of s is 0"),
    case(3, (' intervalDecimal="0.1"', ""), "clocks", "without intervalDecimal", made=[(END, CLOCK + END), EVENTS]),
    case(
        3, ('Decimal="0.1"', 'Decimal="0"'), "clocks", "is 0, which is not above 0", made=[(END, CLOCK + END), EVENTS]
    ),
    case(3, (' hasEventMode="true"', ""), "clocks", "no event mode", made=[(END, CLOCK + END), EVENTS]),
    case(3, (END, '<Int32 name="k" valueReference="7" clocks="0"/>' + END), "clocks", "names 0, which is no clock"),
    case(
        3, ('start="1 2 3"', 'start="1 2"'), "dimensions", "2 start values for 3 elements", made=[(END, VECTOR + END)]
    ),
    case(
        3,
        ('start="1"/></M', 'start="7"/></M'),
        "enumerations",
        "starts at 7, which is no item of E",
        made=[("<DefaultExperiment", OPTION), (END, CHOICE + END)],
    ),
    case(
        3, (TERMINALS, TERMINAL.replace('"s"', '"u"')), "terminals", "names u, which is no", files={TERMINALS: TERMINAL}
    ),
    case(
        3,
        ("extra/org.fmi-standard.fmi-ls-xcp/a.a2l", ""),
        "layered-standards",
        "has no PROJECT",
        files={
            MANIFESTS["fmi-ls-xcp"]: MANIFEST.format("fmi-ls-xcp"),
            "extra/org.fmi-standard.fmi-ls-xcp/a.a2l": "/begin PROJECT",
        },
    ),
    case(
        3,
        (TERMINALS, TERMINAL),
        "layered-standards",
        "has no network terminal",
        files={MANIFESTS["fmi-ls-bus"]: MANIFEST.format("fmi-ls-bus"), TERMINALS: BUS_TERMINAL},
    ),
]


@pytest.mark.parametrize(("fmi", "made", "files", "fault", "rule", "finding"), DESCRIBED)
def test_a_fault_of_the_description_or_the_files_is_found(tmp_path, fmi, made, files, fault, rule, finding):
    description = {2: DESCRIPTION, 3: DESCRIPTION_3}[fmi]
    for old, new in made:
        description = description.replace(old, new, 1)
    assert found(tmp_path, description, files, fmi) == {}
    old, new = fault
    if old in files:
        broken = found(tmp_path, description, files | {old: new}, fmi)
    else:
        assert old in description
        broken = found(tmp_path, description.replace(old, new, 1), files, fmi)
    assert broken.keys() <= {rule, "schema"}
    assert re.search(finding, broken[rule])


DIRECTIONAL = ('oscillator"/>', 'oscillator" providesDirectionalDerivative{}="true"/>')

KEPT = [
    (
        2,
        {"IN_DIRECTIONAL": "du[0] += 1"},
        DIRECTIONAL,
        "directional-derivatives",
        r"of der\(s\) by s is 0\.5, by differ",
    ),
    (
        3,
        {"IN_DIRECTIONAL": "return 3"},
        DIRECTIONAL,
        "directional-derivatives",
        "answered fmi3GetDirectionalDerivative",
    ),
    (2, {}, ('start="1"', 'start="1.5"'), "starts", r"s starts at 1\.0, in the description at 1\.5"),
    (2, {"INDICATORS": "2"}, None, "exchange-indicators", "refuses 0 event indicators, .* and takes 2"),
    (3, {"INDICATORS": "2"}, None, "exchange-indicators", "has 2 event indicators, and ModelStructure lists 0"),
    (2, {"VERSION": '"1.0"'}, None, "version", "fmi2GetVersion answers '1.0', and the description is of 2.0"),
    (2, {"TYPES_PLATFORM": '"mine"'}, None, "version", "'mine'; it must be \"default\""),
    (
        2,
        {},
        ('<Unknown index="3"/><Unknown index="4"/></D', '<Unknown index="4"/><Unknown index="3"/></D'),
        "exchange-order",
        "state v is",
    ),
    (
        2,
        {},
        ('<Unknown index="4"/></D', '<Unknown index="4" dependencies="2" dependenciesKind="dependent"/></D'),
        "independent",
        r"der\(v\) depends on s, and does not say so",
    ),
    (2, {}, ('guid="oscillator"', 'guid="other"'), "exchange-runs", "cannot be instantiated"),
]


def judged(path):
    return {v.rule: "\n".join(v.problems) for v in check(path) if v.problems and v.severity != "note"}


@pytest.mark.parametrize(("fmi", "does", "fault", "rule", "finding"), KEPT)
def test_a_claim_that_the_binary_does_not_keep_is_found(tmp_path, fmi, does, fault, rule, finding):
    description = {2: DESCRIPTION, 3: DESCRIPTION_3}[fmi]
    old, new = (text.format("s" * (fmi == 3)) for text in fault or ("", ""))
    assert old in description
    broken = judged(build_oscillator(tmp_path, description.replace(old, new, 1), fmi=fmi, **does))
    assert broken.keys() == {rule}
    assert re.search(finding, broken[rule])


@pytest.mark.parametrize(("fmi", "last", "ended"), [(2, 0.1, True), (3, 0.1, True), (2, 0.2, False)])
def test_an_fmu_that_ends_its_default_experiment_of_200_ms_is_noted(tmp_path, fmi, last, ended):
    asks = {"IN_GET_BOOLEAN_STATUS": "if (kind == 3) { *value = 1; return 0; }"}
    path = build_stranger(tmp_path, fmi=fmi, IN_DO_STEP=f"if (time > {last - 5e-4}) return 2", **asks)
    (verdict,) = (each for each in check(path) if each.rule == "end")
    assert verdict.problems == ["it ends the default experiment at 0.1 of 0.2 s"] * ended
    assert verdict.severity == "note"


def test_a_value_that_is_not_kept_and_a_function_that_is_missing_are_found(tmp_path):
    broken = judged(build_stranger(tmp_path, IN_SET_REAL="start()", fmi2CancelStep="anotherName"))
    assert broken["sets"].startswith("T_mot is 0.0 after it was set to 0.01")
    assert broken["functions"] == "it has no fmi2CancelStep"
    assert broken.keys() == {"sets", "functions"}
