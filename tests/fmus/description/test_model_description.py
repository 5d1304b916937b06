"""What an FMU says of itself is complete and true."""

import math
import zipfile

import fmpy
import pytest
from fmpy.validation import validate_fmu

from fmus.catalogue import FMUS
from fmus.description.dependencies import Dependent, initial_dependencies, output_dependencies
from fmus.description.units import base_exponents
from fmus.description.variables import interface

every_fmu = pytest.mark.parametrize("name", FMUS)


@pytest.fixture
def description(built, name):
    return fmpy.read_model_description(str(built / f"{name}.fmu"))


@every_fmu
def test_the_validator_finds_nothing(built, name):
    assert validate_fmu(str(built / f"{name}.fmu")) == []


@every_fmu
def test_value_references_count_inputs_outputs_and_parameters(description):
    assert [v.valueReference for v in description.modelVariables] == list(range(len(description.modelVariables)))
    assert [v.causality for v in description.modelVariables] == sorted(
        (v.causality for v in description.modelVariables), key=["input", "output", "parameter"].index
    )


@every_fmu
def test_every_quantity_has_unit_and_meaning_and_every_parameter_bounds(description):
    units = {unit.name for unit in description.unitDefinitions}
    for v in description.modelVariables:
        assert v.description
        assert v.type != "Real" or v.unit in units
        if v.causality == "parameter" and v.type in ("Real", "Integer"):
            assert float(v.min) <= float(v.start) <= float(v.max), v.name


def test_the_plants_have_the_same_inputs_and_outputs(built):
    plants = ("TwoMassDriveline", "ValidationVehicle")
    shared = [
        [
            (v.name, v.type, v.unit, v.causality, v.variability, v.valueReference)
            for v in fmpy.read_model_description(str(built / f"{plant}.fmu")).modelVariables
            if v.causality != "parameter"
        ]
        for plant in plants
    ]
    assert shared[0] == shared[1]


@pytest.mark.parametrize(
    ("unit", "exponents"),
    [
        ("N.m", {"kg": 1, "m": 2, "s": -2}),
        ("N.m/rad", {"kg": 1, "m": 2, "s": -2, "rad": -1}),
        ("N.s2/m2", {"kg": 1, "m": -1}),
        ("J/(kg.K)", {"m": 2, "s": -2, "K": -1}),
        ("1/s", {"s": -1}),
        ("1", {}),
    ],
)
def test_units_are_products_of_base_units(unit, exponents):
    assert base_exponents(unit) == exponents


def test_an_unknown_unit_is_named():
    with pytest.raises(ValueError, match="'lbf' is not among the known ones"):
        base_exponents("lbf.ft")


def test_the_measured_speed_is_all_that_the_motor_feeds_through():
    assert output_dependencies(FMUS["MotorTorqueLoop"].block) == {
        "T_mot": frozenset(),
        "T_mot_est": frozenset(),
        "omega_1_meas": {"omega_1"},
    }


def test_no_output_of_a_sampled_block_depends_on_its_inputs_at_once():
    for name in ("WheelSpeedCan", "DampingController"):
        assert not any(output_dependencies(FMUS[name].block).values())


def other_value(variable):
    """A value near the start value that is allowed and not the same."""
    low, high = variable.bounds()
    if not isinstance(variable.start, float):
        return low if variable.start != low else high
    step = 0.01 * min(high - low, abs(variable.start) + 1.0)
    return variable.start + (step if variable.start + step <= high else -step)


@every_fmu
def test_an_output_changes_only_with_what_it_is_said_to_depend_on(name):
    block = FMUS[name].block
    at_once, at_start = output_dependencies(block), initial_dependencies(block)
    p = block.Parameters()
    p = p._replace(v_0=10.0, T_0=40.0) if "v_0" in p._fields else p
    u = block.Input()
    x = block.start(u, p)
    before = block.output(x, u, p)._asdict()
    for variable in interface(block):
        if variable.causality == "output":
            continue
        change = {variable.name: other_value(variable)}
        new_u, new_p = (u._replace(**change), p) if variable.causality == "input" else (u, p._replace(**change))
        started = block.output(block.start(new_u, new_p), new_u, new_p)._asdict()
        assert all(variable.name in at_start[y] for y in before if started[y] != before[y])
        if variable.causality == "input":
            now = block.output(x, new_u, p)._asdict()
            assert all(variable.name in at_once[y] for y in before if now[y] != before[y])


def test_a_model_that_branches_on_data_is_caught():
    with pytest.raises(TypeError, match="must call `where`"):
        max(Dependent(), Dependent())


@every_fmu
def test_the_documentation_page_tells_of_every_variable(built, name):
    with zipfile.ZipFile(built / f"{name}.fmu") as archive:
        text = archive.read("documentation/index.html").decode()
        assert archive.read("model.png").startswith(b"\x89PNG")
    for variable in interface(FMUS[name].block):
        assert f"<td>{variable.name}</td>" in text
        assert variable.causality == "output" or math.isfinite(variable.start)
