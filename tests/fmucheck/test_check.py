"""The compliance checks: nothing to find in our FMUs, every planted fault found."""

import os
import re
import subprocess
import sys
import tempfile
from xml.etree import ElementTree
from zipfile import ZipFile

import pytest
from fmutesting.foreign import RELAY, build_relay, tampered
from fmutesting.foreign.archives import HOSTILE
from fmutesting.foreign.stranger import build_stranger, in_words_of
from fmutesting.skipping import skipped_if_impossible
from fmutesting.slow import slow

from driveline.fmus.catalogue import FMUS
from driveline.harness.loop.places import PLANTS
from fmublocks.builds import sender_builder
from fmublocks.native.compiler import host_compiler
from fmucheck.behaviour_rules import BEHAVIOUR_RULES
from fmucheck.checking import check
from fmucheck.claim_rules import CLAIM_RULES, EXCHANGE_CLAIM_RULES, STEPPING_CLAIM_RULES
from fmucheck.exchange_rules import EXCHANGE_RULES
from fmucheck.junit import junit
from fmucheck.probe import initialized
from fmucheck.rule import Rule, Severity
from fmuloop.description import KINDS
from fmuloop.interface import Interface
from fmuloop.limits import Limits
from fmuloop.unpacked_fmu import unpacked as opened
from toolground.errors import UserError

PLANT = f"{PLANTS[0]}.fmu"

STEPPED = {rule.name for rule in (*BEHAVIOUR_RULES, *CLAIM_RULES, *STEPPING_CLAIM_RULES)}
"""Rules for which an FMU for co-simulation is run."""


def findings(path):
    return [problem for verdict in check(path) for problem in verdict.problems]


def file_findings(path):
    """Those that need no run of the FMU."""
    verdicts = check(path, ignored=STEPPED | {rule.name for rule in (*EXCHANGE_RULES, *EXCHANGE_CLAIM_RULES)})
    return "\n".join(problem for verdict in verdicts for problem in verdict.problems)


def broken(path, **options):
    """Rule, severity and what was found, of each rule that is broken."""
    return {v.rule: (v.severity, "\n".join(v.problems)) for v in check(path, **options) if v.problems}


def replaced(path, folder, pattern, replacement):
    """An FMU whose description has something else in the place of the first match."""
    return tampered(
        path, folder / "faulty.fmu", lambda xml: re.sub(pattern, replacement, xml, count=1, flags=re.DOTALL)
    )


OURS = [PLANT, "ValidationVehicle.fmu", "MotorTorqueLoop.fmu", "WheelSpeedCan.fmu", "DampingController.fmu"]


@pytest.mark.parametrize("build", ["native", "fmi3"])
@pytest.mark.parametrize("name", OURS)
def test_our_native_fmus_have_no_findings(request, name, build):
    assert findings(request.getfixturevalue(build) / name) == []


@pytest.fixture(scope="module")
def sender(tmp_path_factory):
    """The FMU that sends frames, with clocks."""
    with skipped_if_impossible():
        build = sender_builder(b'VERSION ""\n')
    return build(FMUS["WheelSpeedCan"], tmp_path_factory.mktemp("sender"))


def test_an_fmu_with_clocks_is_run_in_event_mode_or_it_is_said_that_it_was_not(sender, tmp_path):
    verdicts = list(check(sender))
    assert [v for v in verdicts if v.problems] == []
    assert {v.rule for v in verdicts if v.tried} >= {rule.name for rule in BEHAVIOUR_RULES}
    with opened(Interface(sender, kinds=list(KINDS))) as fmu, initialized(fmu) as instance:
        instance.call("exitInitializationMode")
        instance.call("updateDiscreteStates")  # which is refused where event mode is not used
    path = tampered(sender, tmp_path / "no.fmu", lambda xml: xml.replace('hasEventMode="true"', 'hasEventMode="false"'))
    verdicts = {v.rule: v for v in check(path)}
    assert verdicts["kind"].problems == ["it has clocks, but no event mode, so it was not run in co-simulation"]
    assert "runs" not in verdicts


@pytest.mark.parametrize("name", slow(OURS, but=["WheelSpeedCan.fmu", "DampingController.fmu"]))
def test_our_python_fmus_have_no_findings_on_linux(built, name):
    assert broken(built / name).keys() <= ({"symbols", "token"} if sys.platform != "linux" else set())


IN_BOTH = (
    (r' description="speed of the motor"', "", "omega_1 has no description"),
    (r'min="-2000.0" ', 'min="1.0" ', r"T_mot starts at .* out of \[1\.0"),
    (r'name="T_brake"', 'name="T_mot"', "not unique"),
    (r"<DefaultExperiment[^>]*>", "", "DefaultExperiment"),
)
"""Faults that descriptions of FMI 2.0 and 3.0 can have."""


@pytest.mark.parametrize(
    ("pattern", "replacement", "finding"),
    [
        (r' unit="m/s2"', "", "a_body has no unit"),
        (r'<Unknown index="\d+" dependencies="[^"]*"', lambda m: m[0].split(" dep")[0], "its dependencies"),
        (r"<InitialUnknowns>.*?</InitialUnknowns>", "", "InitialUnknowns"),
        *IN_BOTH,
        (r'stopTime="[^"]*"', 'stopTime="0"', "stopTime = 0.* is not after startTime = 0"),
        (r'causality="input"', 'causality="input" initial="exact"', 'T_mot is input and has initial="exact"'),
        (r'max="2000.0"', 'max="-3000.0"', "T_mot has min -2000.0 above max -3000.0"),
        (r'(valueReference=)"1"', r'\1"0"', "T_mot and T_brake have one value reference and a start value each"),
        (r'(name="omega_2" valueReference=)"\d+"', r'\1"0"', "one value reference, but not one unit"),
        (r'(<Unit name="m/s2">.*?</Unit>)', r"\1\1", "2 units are called m/s2"),
        (r'(DateAndTime="[^"]*)Z"', r'\1+00:00"', r"generationDateAndTime is .*\+00:00"),
        (r"<Real ", '<Real reinit="false" ', "1 variables have reinit"),
        (r' fmiVersion="2.0"', ' fmiVersion="1.5"', "cannot be read|FMI 1.5"),
    ],
)
def test_a_fault_in_the_description_is_found(built, tmp_path, pattern, replacement, finding):
    assert re.search(finding, file_findings(replaced(built / PLANT, tmp_path, pattern, replacement)))


@pytest.mark.parametrize(
    ("pattern", "replacement", "finding"),
    [
        (r'(name="a_body"[^>]*) unit="m/s2"', r"\1", "a_body has no unit"),
        (r'<Output valueReference="\d+" dependencies="[^"]*"', lambda m: m[0].split(" dep")[0], "its dependencies"),
        (r"<InitialUnknown [^>]*>", "", "InitialUnknowns"),
        *IN_BOTH,
        (r'<Float64 name="time"[^>]*>', "", "independent variable"),
        (r' fmiVersion="3.0"', ' fmiVersion="3.1"', "is of FMI 3.1; known are FMI 2.0 and FMI 3.0"),
        (r' instantiationToken="[^"]*"', "", "fmiModelDescription has no instantiationToken"),
        (r' valueReference="0"', "", "T_mot has no valueReference"),
        (r' valueReference="0"', ' valueReference="-1"', "valueReference of T_mot is '-1'"),
        (r'min="-2000.0"', 'min="low"', "min of T_mot is 'low'"),
        (r'(<Output valueReference=)"\d+"', r'\1"999"', "valueReference of Output in ModelStructure is '999'"),
        (r'(<InitialUnknown .*? dependencies=)"[^"]*"', r'\1"1 x"', "dependencies of InitialUnknown .* is 'x'"),
        (r"<Output valueReference", "<Output reference", "Output in ModelStructure has no valueReference"),
    ],
)
def test_a_fault_in_the_description_of_fmi_3_is_found(fmi3, tmp_path, pattern, replacement, finding):
    assert re.search(finding, file_findings(replaced(fmi3 / PLANT, tmp_path, pattern, replacement)))


@pytest.mark.parametrize(
    ("path", "finding"),
    [
        ("resources\\model.txt", "has a backslash in its path"),
        ("resources/__pycache__/model.pyc", "leftover"),
        ("../escape.txt", "leaves the folder"),
        ("resources/für.txt", "resources/für.txt is not plain ASCII"),
        ("resources/a\tb.txt", "is not plain ASCII"),
        ("LICENSE.txt", "documentation/index.html is missing"),
        ("LICENSE.txt", "model.png or documentation/diagram.png is missing"),
    ],
)
def test_faults_in_the_archive_and_missing_pages_are_found(built, tmp_path, path, finding):
    with ZipFile(built / PLANT) as source, ZipFile(tmp_path / "faulty.fmu", "w") as target:
        for name in source.namelist():
            if not name.startswith("documentation/") and name != "model.png":
                target.writestr(name, source.read(name))
        target.writestr(path, b"x")
    assert finding in file_findings(tmp_path / "faulty.fmu")


FAULTS = {
    "not_finite": ("t = current_time + step_size", "t = float('nan')", "t is nan"),
    "shared": (
        "self.t = current_time + step_size",
        "self.t = Relay.total = getattr(Relay, 'total', 0.0) + step_size",
        "beside another instance",
    ),
    "crash": ("self._pass_on()\n        self.t", "import os; os._exit(3)\n        self.t", "exit code 3"),
    "refusal": ("step_size):", "step_size):\n        assert step_size < 5e-3", "answered fmi2DoStep"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_in_the_behaviour_is_found_and_leaves_nothing_behind(tmp_path, fault, monkeypatch):
    old, new, finding = FAULTS[fault]
    script = tmp_path / "relay.py"
    text = RELAY.read_text()
    assert old in text
    script.write_text(text.replace(old, new))
    relay = build_relay(tmp_path, script)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    assert finding in "\n".join(findings(relay))
    assert list(temporary.iterdir()) == []


def test_a_folder_that_the_fmu_cannot_take_is_no_error_of_it(tmp_path, monkeypatch):
    """PythonFMU's binary crashes there; one that crashes in a step does so anywhere."""
    relay, stranger = build_relay(tmp_path, RELAY), build_stranger(tmp_path, IN_DO_STEP="exit(0)")
    temporary = tmp_path / "für"
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    severity, problem = broken(relay)["runs"]
    assert severity == "note"
    assert f"it was unpacked to {temporary}, whose name is not plain ASCII" in problem
    assert broken(stranger)["runs"][0] == "error"


@pytest.mark.parametrize("build", ["native", "fmi3"])
@pytest.mark.slow
def test_a_parameter_that_is_called_tunable_and_is_fixed_is_found(request, tmp_path, build):
    motor = request.getfixturevalue(build) / "MotorTorqueLoop.fmu"
    (found,) = findings(replaced(motor, tmp_path, r'(name="tau"[^\n]*?variability=)"fixed"', r'\1"tunable"'))
    assert re.search(r"tau is called tunable, and is not: .*tau = 0.003 is refused; a fixed parameter can be", found)


def test_a_binary_that_is_not_there_is_found(tmp_path):
    verdicts = list(
        check(replaced(build_relay(tmp_path), tmp_path, 'modelIdentifier="Relay"', 'modelIdentifier="Other"'))
    )
    (found,) = [verdict for verdict in verdicts if "cannot be instantiated" in "".join(verdict.problems)]
    assert (found.rule, found.tried) == ("runs", True)
    assert {verdict.rule for verdict in verdicts if not verdict.tried} == STEPPED - {"runs"}


@pytest.mark.parametrize("stop", ["1e300", "-1"])
def test_any_default_experiment_is_tried(tmp_path, stop):
    old, new = 'stopTime="0.2" stepSize="0.001"', f'stopTime="{stop}" stepSize="1e-20"'
    assert "runs" not in broken(replaced(build_stranger(tmp_path), tmp_path, old, new), quick=True)


def test_what_cannot_be_read_or_tried_is_a_finding(tmp_path, monkeypatch):
    path = tmp_path / "text.fmu"
    path.write_text("no archive")
    assert len(findings(path)) == 1
    with pytest.raises(UserError, match="there is no FMU"):
        findings(tmp_path / "none.fmu")
    rule = Rule("odd", Severity.ERROR, "an error that nobody foresees", problems=os.listdir)
    monkeypatch.setattr("fmucheck.checking.QUICK_RULES", (rule,))
    severity, text = broken(build_stranger(tmp_path), quick=True)["odd"]
    assert (severity, text.partition(",")[0]) == ("error", "cannot be tried: TypeError: listdir: path should be string")


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_archive_is_an_error_of_its_own_rule(tmp_path, unpacked, kind):
    spoil, rule, message = HOSTILE[kind]
    path = build_stranger(tmp_path)
    spoil(path)
    severity, text = broken(path, quick=True)[rule]
    assert severity == "error"
    assert re.search(message, text)
    assert list(unpacked.iterdir()) == []


@pytest.mark.parametrize(
    ("does", "rules", "finding"),
    [
        ({"IN_DO_STEP": "exit(0)"}, {"runs"}, "exit code 0, in fmi2DoStep at 0 s"),
        ({"IN_INSTANTIATE": "exit(0)"}, {"runs"}, "exit code 0, in fmi2Instantiate"),
        ({"IN_DO_STEP": "raise(SIGSEGV)"}, {"runs"}, r"crashed \(SIGSEGV\) in fmi2DoStep"),
        ({"IN_DO_STEP": "for (;;) usleep(1000)"}, {"runs"}, r"did not return from fmi2DoStep at 0 s within 0\.5 s"),
        ({"IN_RESET": "raise(SIGSEGV)"}, {"reset"}, r"crashed \(SIGSEGV\) in fmi2Reset"),
        (
            {"IN_DO_STEP": "return -1"},
            {"runs", "steps", "reset", "instances", "memory"},
            "answered fmi2DoStep with the status -1",
        ),
        ({"IN_GET_REAL": "values[0] = NAN"}, {"runs", "steps"}, "is nan"),
    ],
)
@pytest.mark.parametrize("fmi", [2, 3])
def test_a_stranger_that_misbehaves_is_an_error_that_names_the_call(tmp_path, unpacked, does, rules, finding, fmi):
    path = build_stranger(tmp_path, fmi=fmi, **does)
    finding = in_words_of(fmi, finding)
    found = broken(path, limits=Limits(call=0.5), ignored=[rule.name for rule in (*CLAIM_RULES, *STEPPING_CLAIM_RULES)])
    errors = {name: text for name, (severity, text) in found.items() if severity == "error"}
    assert errors.keys() == rules
    assert all(re.search(finding, text) for text in errors.values())
    assert list(unpacked.iterdir()) == []


@pytest.mark.skipif(sys.platform != "linux", reason="the rule is for binaries of Linux")
@pytest.mark.parametrize("fmi", [2, 3])
def test_a_symbol_of_a_library_that_is_not_named_is_found(tmp_path, fmi):
    """Python has loaded libm: the FMU runs here, and in no host in C."""
    wants = {"fmi": fmi, "IN_INSTANTIATE": "now = 0.0 * acos(now)"}
    assert "symbols" not in broken(build_stranger(tmp_path, "linked", **wants))
    found = broken(build_stranger(tmp_path, libraries=[], **wants))
    assert found["symbols"] == ("warning", "stranger.so needs acos, which no library has that it names")
    assert "runs" not in found


@pytest.mark.skipif(sys.platform != "linux", reason="the rule is for binaries of Linux")
def test_a_library_that_is_not_here_is_named_without_the_symbols_that_it_may_have(tmp_path):
    command = [host_compiler(), "-shared", "-o", tmp_path / "libfar.so", "-x", "c", "-"]
    subprocess.run(command, input=b"int far(void) { return 0; }", check=True)
    path = build_stranger(tmp_path, libraries=["-lm", f"-L{tmp_path}", "-lfar"], IN_RESET="far()")
    (tmp_path / "libfar.so").unlink()
    assert broken(path)["symbols"] == ("warning", "stranger.so needs libfar.so, which is not here, nor in the FMU")


ENDS = {"IN_DO_STEP": "if (time > 0.0105) return 2"}


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_end_that_the_fmu_wants_is_no_error(tmp_path, fmi):
    """It discards a step and says that it has terminated; without that it is a refusal."""
    ending = build_stranger(
        tmp_path, "ending", fmi=fmi, IN_GET_BOOLEAN_STATUS="if (kind == 3) { *value = 1; return 0; }", **ENDS
    )
    assert not {"runs", "steps", "reset", "instances"} & broken(ending).keys()
    assert f"answered fmi{fmi}DoStep with discard" in broken(build_stranger(tmp_path, fmi=fmi, **ENDS))["runs"][1]


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_step_that_is_too_long_may_be_discarded(tmp_path, fmi):
    assert "steps" not in broken(build_stranger(tmp_path, fmi=fmi, IN_DO_STEP="if (step > 0.005) return 2"))


def test_memory_that_is_kept_or_shared_is_found(tmp_path):
    keeps = "((void *(*)(size_t, size_t))((void **)callbacks)[1])(1, 8)"
    found = broken(build_stranger(tmp_path, IN_INSTANTIATE=keeps))["memory"]
    assert found == ("error", "1 blocks of memory are not given back by fmi2FreeInstance")
    assert "memory" not in broken(build_stranger(tmp_path, "clean"))
    # They come from one file: an FMU is unpacked once for all that is tried.
    path = build_stranger(tmp_path, IN_GET_REAL="values[5] = now")
    assert "beside another instance, but was 0.0, at step 0" in broken(path)["instances"][1]


@pytest.mark.slow
def test_many_short_calls_are_not_one_that_hangs(tmp_path):
    stranger = build_stranger(tmp_path, IN_GET_REAL="usleep(30000)")
    path = replaced(stranger, tmp_path, 'stopTime="0.2"', 'stopTime="0.02"')
    assert "runs" not in broken(path, quick=True, limits=Limits(call=0.3))


@pytest.mark.parametrize("exchanged", ["", 'intermediateUpdate="true"'])
def test_intermediate_updates_are_asked_for_if_there_is_something_to_exchange(tmp_path, exchanged):
    path = build_stranger(tmp_path, fmi=3)
    claimed = {
        '"stranger" can': '"stranger" providesIntermediateUpdate="true" can',
        'name="v"': f'name="v" {exchanged}',
    }
    for old, new in claimed.items():
        path = replaced(path, tmp_path, old, new).rename(tmp_path / "claims.fmu")
    assert bool(exchanged) == ("it has called no intermediate update" in "".join(findings(path)))


def test_derivatives_at_a_communication_point_are_compared_where_values_are_computed_anew(tmp_path):
    """FMI forbids to read before the next step what was set: an FMU may give out what it has computed in the last."""
    for name, follows, found in (("kept", "", False), ("anew", "if (r[0] >= KEPT) values[0] = 3.0 * kept[0]", True)):
        path = build_stranger(tmp_path, name, IN_GET_REAL=follows, IN_DIRECTIONAL="du[0] = 1.0; return 0")
        claim = r'\1 providesDirectionalDerivative="true"'
        path = replaced(path, tmp_path, r'(modelIdentifier="stranger")', claim)
        assert ("directional-derivatives" in broken(path)) is found


def test_what_is_not_tried_after_a_crash_is_said(tmp_path):
    path = build_stranger(tmp_path, IN_DO_STEP="exit(0)")
    names = STEPPED - {"runs", "reset"}
    verdicts = list(check(path, ignored=["reset"]))
    severities = {verdict.rule: verdict.severity for verdict in verdicts if verdict.problems}
    assert severities == {"archive-pages": "note", "dependencies": "note", "origin": "note", "runs": "error"}
    assert {verdict.rule for verdict in verdicts if not verdict.tried} == names
    (suite,) = ElementTree.fromstring(junit({"stranger.fmu": verdicts}, ["error"]))
    assert (suite.get("skipped"), suite.get("failures")) == (str(len(names)), "1")
    assert len(suite.findall("testcase/skipped")) == len(names)


def test_what_cannot_run_here_is_a_note_and_not_tried(tmp_path):
    path, other = build_stranger(tmp_path), tmp_path / "other.fmu"
    elsewhere = "win64/stranger.dll" if sys.platform == "darwin" else "darwin64/stranger.dylib"
    with ZipFile(path) as source, ZipFile(other, "w") as target:
        for name in source.namelist():
            target.writestr(re.sub("binaries/.*", f"binaries/{elsewhere}", name), source.read(name))
    verdicts = {verdict.rule: verdict for verdict in check(other)}
    assert "so it was not run; there are: " in verdicts["platform"].problems[0]
    assert not any(verdicts[rule.name].tried for rule in BEHAVIOUR_RULES)
    assert [v for v in verdicts.values() if v.severity != "note" and v.problems] == []


@pytest.mark.parametrize(
    ("places", "missing"),
    [
        (["binaries/win64/stranger.dll", "binaries/win64/other.dll", "resources/0/binaries/win64/inner.dll"], []),
        (["binaries/win64/Stranger.dll"], []),
        (["binaries/win64/other.dll", "binaries/linux32/stranger.so"], ["binaries/win64 has no stranger.dll"]),
        (["binaries/darwin64/Stranger.dylib"], ["binaries/darwin64 has no stranger.dylib"]),
    ],
)
def test_a_folder_of_binaries_has_one_of_the_name_of_the_fmu(tmp_path, places, missing):
    path = build_stranger(tmp_path)
    with ZipFile(path, "a") as archive:
        for place in places:
            archive.writestr(place, "")
    found = {verdict.rule: verdict.problems for verdict in check(path, quick=True)}
    assert found["binary-folder"] == missing


def test_an_fmu_of_sources_alone_is_legal_and_one_of_nothing_is_not(tmp_path):
    path = build_stranger(tmp_path)
    for name, finds in {"sources/all.c": False, "resources/all.c": True}.items():
        bare = tmp_path / "bare.fmu"
        with ZipFile(path) as source, ZipFile(bare, "w") as target:
            target.writestr("modelDescription.xml", source.read("modelDescription.xml"))
            target.writestr(name, "")
        assert ("archive-binary" in broken(bare)) is finds


def test_quick_makes_the_first_steps_alone_and_verdicts_name_the_clause_of_the_standard(tmp_path):
    later = build_stranger(tmp_path, IN_DO_STEP="if (time > 0.15) exit(0)", IN_RESET="exit(0)")
    verdicts = {verdict.rule: verdict for verdict in check(later, quick=True)}
    assert not {"runs", "reset"} & {rule for rule, verdict in verdicts.items() if verdict.problems}
    assert "runs" in broken(later)
    assert verdicts["runs"].clause == "FMI 2.0.4, 4.2.2; FMI 3.0.2, 4.2.1"
    assert (verdicts["aliases"].clause, verdicts["archive-leftover"].clause) == ("FMI 2.0.4, 2.2.7", "")
