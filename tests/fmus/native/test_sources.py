"""The sources in a native FMU are those of a source FMU: listed, and fit to be linked with those of others."""

import subprocess
from pathlib import Path

import fmpy
import pytest
from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks.native.compiler import FLAGS, host_compiler
from fmublocks.native.shared_header import definition

PROGRAM = Path(__file__).parent / "linked.c"
STEPS = 100


def listed(path: Path) -> list[str]:
    """The files that the description of an FMU tells to compile."""
    configuration = fmpy.read_model_description(str(path)).buildConfigurations[0]
    return configuration.sourceFileSets[0].sourceFiles


@pytest.fixture(scope="module")
def objects(native, tmp_path_factory) -> dict[str, Path]:
    """The sources of every FMU compiled with the prefix of the standard, and what fmpy unpacked beside them."""
    made = {}
    for name in FMUS:
        folder = tmp_path_factory.mktemp(name)
        fmpy.extract(str(native / f"{name}.fmu"), str(folder))
        prefix = f"-DFMI2_FUNCTION_PREFIX={name}_"
        made[name] = folder / "fmu.o"
        (file,) = listed(native / f"{name}.fmu")
        command = [host_compiler(), *FLAGS, prefix, "-c", file, "-o", made[name]]
        subprocess.run(command, cwd=folder / "sources", check=True)
    return made


def first_output(path: Path, folder: Path) -> tuple[int, float]:
    """Value reference of the first Real output, and its value after what linked.c does."""
    with opened(path, folder) as host:
        name = next(n for n in host.names("output") if host.variables[n].type == "Real")
        host.initialize()
        host.fmu.setReal([0], [40.0])
        for k in range(STEPS):
            host.step(k * 1e-3, 1e-3)
        return host.variables[name].valueReference, host.get(name)


def test_all_fmus_are_linked_into_one_program_and_run_side_by_side(native, objects, tmp_path):
    expected = {name: first_output(native / f"{name}.fmu", objects[name].parent) for name in FMUS}
    each = " ".join(f"X({name}, {reference})" for name, (reference, _) in expected.items())
    headers = objects["MotorTorqueLoop"].parent / "sources"
    command = [host_compiler(), *FLAGS, f"-DEACH(X)={each}", f"-I{headers}", PROGRAM, *objects.values()]
    subprocess.run([*command, "-o", tmp_path / "linked", "-lm"], check=True)
    guids = [str(fmpy.read_model_description(str(native / f"{name}.fmu")).guid) for name in FMUS]
    done = subprocess.run([tmp_path / "linked", *guids], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    printed = dict(line.split() for line in done.stdout.splitlines())
    assert {name: float(value) for name, value in printed.items()} == {
        name: value for name, (_, value) in expected.items()
    }


@together("name", FMUS)
def test_nothing_has_a_name_outside_its_fmu_but_the_functions_of_the_standard_with_the_prefix(objects, name):
    done = subprocess.run(["nm", "--defined-only", "-g", objects[name]], capture_output=True, text=True, check=True)
    symbols = [line.split()[-1].lstrip("_") for line in done.stdout.splitlines()]
    assert f"{name}_fmi2DoStep" in symbols
    assert [symbol for symbol in symbols if not symbol.startswith(f"{name}_fmi2")] == [f"{name}_instance"]


@together(
    "value, text",
    [
        (1e-13, "#define X 1e-13"),
        (16, "#define X 16"),
        (("in one", 'in "two"'), r'#define X {"in one", "in \"two\""}'),
        ("nothing to fill in", '#define X "nothing to fill in"'),
        ("{b!r} of {a} is 5 % of {a}", '#define X(b, a) "%s of %s is 5 %% of %s", b, a, a'),
        ("{k:d} is above {most:g}", '#define X(k, most) "%u is above %g", k, most'),
        ({"not": "for C"}, ""),
    ],
)
def test_a_value_becomes_a_macro_and_its_fields_the_parameters(value, text):
    assert definition("X", value) == text
