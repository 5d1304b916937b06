"""What an FMU says of itself is complete and true."""

import math
import sys
import zipfile
from dataclasses import replace
from importlib.metadata import version
from itertools import product
from typing import Annotated, NamedTuple

import fmpy
import pytest
from fmpy.validation import validate_fmu
from fmutesting.together import together

from driveline.fmus.catalogue import EVERY, FMUS
from fmublocks.block.declaration import Boolean, Real
from fmublocks.block.operators import where
from fmublocks.block.types import ContinuousBlock
from fmublocks.description.build_kind import BuildKind
from fmublocks.description.dependencies import Dependent, initial_dependencies, output_dependencies
from fmublocks.description.documentation import ARROW, WIDTH, page, picture, tables, timing
from fmublocks.description.model_description import model_description
from fmublocks.description.units import base_exponents
from fmublocks.description.variables import interface
from fmublocks.errors import BuildError
from fmublocks.fmu import Fmu
from fmublocks.release import DATE, date

every_fmu = together("name", FMUS)


@pytest.fixture
def descriptions(built):
    return {name: fmpy.read_model_description(str(built / f"{name}.fmu")) for name in FMUS}


@every_fmu
def test_the_validator_finds_nothing(built, name):
    assert validate_fmu(str(built / f"{name}.fmu")) == []


@every_fmu
def test_value_references_count_inputs_outputs_and_parameters(descriptions, name):
    description = descriptions[name]
    assert [v.valueReference for v in description.modelVariables] == list(range(len(description.modelVariables)))
    assert [v.causality for v in description.modelVariables] == sorted(
        (v.causality for v in description.modelVariables), key=["input", "output", "parameter", "local"].index
    )


@every_fmu
def test_every_quantity_has_unit_and_meaning_and_every_parameter_bounds(descriptions, name):
    description = descriptions[name]
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
            if v.causality in ("input", "output")
        ]
        for plant in plants
    ]
    assert shared[0] == shared[1]


@together(
    "unit, exponents",
    [
        ("N.m", {"kg": 1, "m": 2, "s": -2}),
        ("N.m/rad", {"kg": 1, "m": 2, "s": -2, "rad": -1}),
        ("N.s2/m2", {"kg": 1, "m": -1}),
        ("J/(kg.K)", {"m": 2, "s": -2, "K": -1}),
        ("W", {"kg": 1, "m": 2, "s": -3}),
        ("Pa", {"kg": 1, "m": -1, "s": -2}),
        ("V/Hz", {"kg": 1, "m": 2, "s": -2, "A": -1}),
        ("1/s", {"s": -1}),
        ("1", {}),
    ],
)
def test_units_are_products_of_base_units(unit, exponents):
    assert base_exponents(unit) == exponents


def test_an_unknown_unit_is_named():
    with pytest.raises(ValueError, match="'lbf' is not among the known ones"):
        base_exponents("lbf.ft")


class Chosen(NamedTuple):
    on: Annotated[bool, Boolean("choose")] = False


class Two(NamedTuple):
    a: Annotated[float, Real("1", "one")] = 0.0
    b: Annotated[float, Real("1", "another")] = 0.0


CHOICE = ContinuousBlock(
    name="Choice",
    description="",
    module=__name__,
    Parameters=Chosen,
    Input=Two,
    State=Two,
    Output=Two,
    start=lambda u, p: Two(),
    output=lambda x, u, p: Two(where(p.on, where(p.on, 0.0, u.a), u.b), where(p.on, u.a, u.b)),
    derivative=lambda x, u, p: Two(),
    step_size=0.001,
)


def test_what_a_boolean_parameter_chooses_and_bars_is_no_dependency_but_the_parameter_is_one():
    assert output_dependencies(CHOICE) == {"a": {"b"}, "b": {"a", "b"}}
    assert initial_dependencies(CHOICE) == {"a": {"on", "b"}, "b": {"on", "a", "b"}}


def test_the_tables_have_a_row_for_each_variable_also_for_one_alone():
    assert {title: len(rows) - 1 for title, rows in tables(CHOICE)} == {"Inputs": 2, "Outputs": 2, "Parameters": 1}


@every_fmu
def test_every_output_that_is_said_to_follow_an_input_does(name):
    """At one of some states at least, for one value of each Boolean parameter."""
    block = FMUS[name].block
    unseen = {(y, u) for y, on in output_dependencies(block).items() for u in on}
    for values in product((False, True), (0.0, 10.0)):
        p = block.Parameters()
        given = dict(zip(("recorded_load", "v_0"), values, strict=True))
        p = p._replace(**{n: value for n, value in given.items() if n in p._fields})
        u = block.Input()
        x = block.start(u, p)
        before = block.output(x, u, p)._asdict()
        for y, changed in sorted(unseen):
            after = block.output(x, u._replace(**{changed: getattr(u, changed) + 0.3}), p)._asdict()
            if after[y] != before[y]:
                unseen.remove((y, changed))
    assert unseen == set()


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


@every_fmu
def test_every_real_input_and_output_tells_how_large_it_is(descriptions, name):
    description = descriptions[name]
    for v in description.modelVariables:
        if v.causality != "parameter" and v.type == "Real":
            assert float(v.nominal) > 0.0, v.name


def test_names_that_differ_in_case_only_are_refused():
    block = FMUS["WheelSpeedCan"].block

    class Twice(NamedTuple):
        T_land: Annotated[float, Real("N.m", "a torque")] = 0.0
        t_land: Annotated[float, Real("s", "a time")] = 0.0
        V: Annotated[float, Real("m/s", "a speed")] = 0.0
        v: Annotated[float, Real("V", "a voltage")] = 0.0

    fmu = Fmu(replace(block, Input=Twice), stop_time=1.0)
    all_at_once = "the variables T_land and t_land differ in case only; the variables V and v differ in case only"
    with pytest.raises(ValueError, match=all_at_once):
        model_description(fmu, BuildKind({}, {}, ""), "")


@together("name", EVERY)
def test_the_experiment_that_it_proposes_takes_ten_seconds_and_that_of_the_motor_two(name):
    text = model_description(EVERY[name], BuildKind({}, {}, ""), "").decode()
    stop_time = 2 if name == "MotorTorqueLoop" else 10
    assert f'<DefaultExperiment startTime="0" stopTime="{stop_time}.0" stepSize="0.001" />' in text


@every_fmu
def test_it_says_whose_it_is_and_of_which_release(descriptions, name):
    description = descriptions[name]
    assert description.generationTool.startswith(f"fmublocks {version('fmublocks')}")
    assert (description.version, description.author) == (version("driveline-damping"), "the driveline-damping authors")
    assert "driveline-damping" in description.copyright
    assert description.license.startswith("BSD-3-Clause")
    assert description.generationDateAndTime == f"{DATE}T00:00:00Z"


def test_of_a_block_of_the_users_own_nothing_is_said_that_only_the_user_knows():
    fmu = Fmu(replace(FMUS["WheelSpeedCan"].block, module="my_can"), stop_time=1.0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "my_can", sys.modules[__name__])
        text = model_description(fmu, BuildKind({}, {}, ""), "").decode()
    assert "author" not in text
    assert "license" not in text


def test_the_date_can_be_given_as_for_every_reproducible_build(monkeypatch):
    for seconds, expected in ((315532800, "1980-01-01 00:00:00"), (4354819199, "2107-12-31 23:59:59")):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", str(seconds))
        assert f"{date():%Y-%m-%d %H:%M:%S}" == expected
    for seconds in ("315532799", "4354819200", "-1", "", "today", "1e9"):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", seconds)
        with pytest.raises(BuildError, match=f"SOURCE_DATE_EPOCH = {seconds} is refused"):
            date()


def test_a_model_that_branches_on_data_is_caught():
    with pytest.raises(TypeError, match="takes such a condition"):
        max(Dependent(), Dependent())


@every_fmu
def test_the_documentation_page_tells_of_every_variable(built, name):
    with zipfile.ZipFile(built / f"{name}.fmu") as archive:
        text = archive.read("documentation/index.html").decode()
        assert archive.read("model.png").startswith(b"\x89PNG")
    for variable in interface(FMUS[name].block):
        assert f"<td>{variable.name}</td>" in text
        assert variable.causality == "output" or math.isfinite(variable.start)


@every_fmu
def test_the_page_says_how_often_it_computes(name):
    says = timing(FMUS[name].block)
    assert f" {2 if name == 'DampingController' else 1} ms" in says
    assert says in page(FMUS[name], BuildKind({}, {}, ""))


def test_the_picture_has_an_arrow_for_each_input_to_the_box_and_for_each_output_from_it(monkeypatch):
    """None of which leaves the picture."""
    tails = []
    monkeypatch.setattr("fmublocks.description.documentation._arrow", lambda _, x, y: tails.append(x))
    block = FMUS["WheelSpeedCan"].block
    picture.__wrapped__(block)
    inputs, outputs = tails[: len(block.Input._fields)], tails[len(block.Input._fields) :]
    assert len(outputs) == len(block.Output._fields)
    assert all(0.0 < tail < tail + ARROW < 0.5 * WIDTH for tail in inputs)
    assert all(0.5 * WIDTH < tail < tail + ARROW < WIDTH for tail in outputs)
