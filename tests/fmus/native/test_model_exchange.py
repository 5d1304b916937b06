"""Model exchange: the host integrates, with what the FMU tells it of states, derivatives and events."""

import ctypes
import math
import random
import re
from contextlib import contextmanager
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.fmi2 import FMU2Model, fmi2Discard
from fmpy.validation import validate_fmu
from fmutesting.host import opened
from fmutesting.together import together

from benchmarks.model_exchange import integrated, recorded, stepped
from driveline.fmus.catalogue import FMUS
from driveline.harness.loop.places import NATIVE, PLANTS
from fmublocks.block.types import ContinuousBlock
from fmublocks.description.units import base_exponents, rate_unit
from fmublocks.description.variables import interface
from fmuloop.description import document_root
from fmuloop.limits import USUAL_LIMITS
from tests.fmus.native.test_places import ROOM, call

DISCARD, ERROR = 2, 3
CONTINUOUS = [name for name, fmu in FMUS.items() if isinstance(fmu.block, ContinuousBlock)]
every_continuous = together("name", CONTINUOUS)


@pytest.fixture(params=["native", "fmi3"])
def folder(request):
    """Of the FMUs of FMI 2.0, and of those of FMI 3.0."""
    return request.getfixturevalue(request.param)


@contextmanager
def exchanged(folder, tmp_path, name, **start):
    """An instance for model exchange in event mode, at the start of a run."""
    with opened(folder / f"{name}.fmu", tmp_path, kind=FMU2Model) as host:
        host.initialize(**start)
        yield host


@pytest.fixture
def driveline(folder, tmp_path):
    with exchanged(folder, tmp_path, "TwoMassDriveline") as host:
        yield host


@pytest.fixture
def integrating(driveline):
    """In continuous-time mode."""
    driveline.fmu.enterContinuousTimeMode()
    return driveline


def given_out(host, function, count):
    """The numbers that a function gives out; None where it discards."""
    room = (ctypes.c_double * count)()
    function(room, count)
    return list(room)


def states(host):
    return given_out(host, host.fmu.getContinuousStates, host.description.numberOfContinuousStates)


def rates(host):
    return given_out(host, host.fmu.getDerivatives, host.description.numberOfContinuousStates)


def indicators(host):
    return given_out(host, host.fmu.getEventIndicators, host.description.numberOfEventIndicators)


def set_states(host, values):
    host.fmu.setContinuousStates((ctypes.c_double * len(values))(*values), len(values))


def at_random(block, draw):
    """A state of a plant or motor somewhere along the road."""
    x = block.start(block.Input(), block.Parameters())
    return [value + draw.choice((0.0, 0.01, 1.0)) * draw.gauss(0.0, 1.0) for value in x]


# what the description says


@every_continuous
def test_one_fmu_is_for_both_and_the_validator_finds_nothing(folder, name):
    path = folder / f"{name}.fmu"
    description = fmpy.read_model_description(str(path))
    assert validate_fmu(str(path)) == []
    assert description.coSimulation
    assert description.modelExchange
    (claims,) = (each.attrib for each in document_root(path, USUAL_LIMITS).iterfind("ModelExchange"))
    assert {value for name, value in claims.items() if name.startswith("providesDirectional")} == {"true"}
    assert not description.modelExchange.needsCompletedIntegratorStep


@together("name", [name for name in FMUS if name not in CONTINUOUS])
def test_a_sampled_block_has_no_model_exchange(folder, name):
    description = fmpy.read_model_description(str(folder / f"{name}.fmu"))
    assert description.modelExchange is None
    assert [v for v in description.modelVariables if v.causality == "local"] == []


@every_continuous
def test_event_indicators_are_variables_of_fmi_3(fmi3, tmp_path, name):
    with exchanged(fmi3, tmp_path, name, **({"v_0": 8.0} if name in PLANTS else {})) as host:
        shown = [host.variables[f"event_indicator[{k + 1}]"] for k in range(host.description.numberOfEventIndicators)]
        assert [unknown.variable for unknown in host.description.eventIndicators] == shown
        references = [v.valueReference for v in shown]
        assert references[0] == host.variables[names_of(FMUS[name].block)[-1][1]].valueReference + 1
        for change in (lambda: None, host.fmu.newDiscreteStates):
            change()
            assert host.fmu.getFloat64(references) == indicators(host)
        told = host.refuses(host.fmu.getDirectionalDerivative, references[:1], [0], [1.0])
        assert told.startswith("event_indicator[1] cannot be the unknown of a directional derivative")
        told = host.refuses(host.fmu.setFloat64, references[:1], [1.0])
        assert told == "event_indicator[1] belongs to the state and cannot be set as a variable"


def test_fmi_3_sets_states_as_variables_while_the_host_integrates(fmi3, tmp_path):
    with exchanged(fmi3, tmp_path, "TwoMassDriveline") as host:
        host.set(**{"x.omega_1": 1.0})
        host.fmu.enterContinuousTimeMode()
        references = [host.variables[n].valueReference for n in ("x.phi", "x.v", "T_mot")]
        host.fmu.setFloat64(references, [0.125, 3.0, 11.0])
        assert states(host)[:3] == [1.0, 0.0, 0.125]
        assert host.fmu.getFloat64(references) == [0.125, 3.0, 11.0]
        message = host.refuses(host.fmu.setFloat64, references, [0.25, math.nan, 12.0])
        assert message == "x.v = nan m/s is refused; allowed is any finite number"
        assert host.status == DISCARD
        assert host.fmu.getFloat64(references) == [0.125, 3.0, 11.0]
        host.fmu.terminate()
        message = host.refuses(host.set, **{"x.phi": 0.0})
        assert message == "x.phi belongs to the state and cannot be set as a variable"


@every_continuous
def test_states_and_derivatives_have_the_references_behind_the_interface(folder, name):
    block: Any = FMUS[name].block
    variables = fmpy.read_model_description(str(folder / f"{name}.fmu")).modelVariables
    assert [v.valueReference for v in variables] == list(range(len(variables)))
    names = [f"x.{field}" for field in block.State._fields]
    first = len(interface(block))
    shown = variables[first : first + 2 * len(names)]
    assert {v.causality for v in shown} == {"local"}
    assert [v.name for v in shown] == names + [f"der({state})" for state in names]
    for v in shown[len(names) :]:
        assert v.derivative is not None
        assert v.name == f"der({v.derivative.name})"
        state = base_exponents(v.derivative.unit or "")
        assert base_exponents(v.unit or "") == {k: n for k, n in (state | {"s": state.get("s", 0) - 1}).items() if n}


@together(
    "unit, rate",
    [
        ("1", "1/s"),
        ("rad", "rad/s"),
        ("rad/s", "rad/s2"),
        ("m/s2", "m/s3"),
        ("N.m/rad", "N.m/(rad.s)"),
        ("J/(kg.s)", "J/(kg.s2)"),
        ("N.m", "N.m/s"),
        ("J/(kg.K)", "J/(kg.K.s)"),
    ],
)
def test_a_rate_has_the_unit_of_its_quantity_over_seconds(unit, rate):
    assert rate_unit(unit) == rate


@every_continuous
def test_nominal_values_are_those_of_the_description(folder, tmp_path, name):
    with opened(folder / f"{name}.fmu", tmp_path, kind=FMU2Model) as host:
        declared = [unknown.variable.derivative for unknown in host.description.derivatives]
        nominals = given_out(host, host.fmu.getNominalsOfContinuousStates, len(declared))
        assert nominals == [float(v.nominal or 1.0) for v in declared]


@every_continuous
def test_no_dependency_of_an_output_or_derivative_is_missing(folder, tmp_path, name):
    """Directional derivatives are zero along whatever is not among the dependencies."""
    block: Any = FMUS[name].block
    draw = random.Random(name)
    with exchanged(folder, tmp_path, name) as host:
        host.fmu.enterContinuousTimeMode()
        variables = host.variables.values()
        knowns = [v for v in variables if v.causality == "input" or v.name.startswith("x.")]
        for _ in range(20):
            set_states(host, at_random(block, draw))
            for unknown in [*host.description.outputs, *host.description.derivatives]:
                for known in knowns:
                    if known in unknown.dependencies:
                        continue
                    references = [unknown.variable.valueReference], [known.valueReference]
                    assert host.fmu.getDirectionalDerivative(*references, [1.0]) == [0.0]


# what the functions compute


@every_continuous
def test_derivatives_and_indicators_are_those_of_the_block(folder, tmp_path, name):
    block: Any = FMUS[name].block
    draw = random.Random(name)
    u, p = block.Input(), block.Parameters()
    with exchanged(folder, tmp_path, name) as host:
        assert states(host) == list(block.start(u, p))
        host.fmu.enterContinuousTimeMode()
        for _ in range(20):
            x = block.State(*at_random(block, draw))
            set_states(host, x)
            assert states(host) == list(x)
            assert rates(host) == pytest.approx(list(block.derivative(x, u, p)), rel=1e-12)
            assert indicators(host) == pytest.approx(list(block.event_indicators(x, u, p)), rel=1e-12, abs=1.001e-6)
            assert host.outputs() == pytest.approx(block.output(x, u, p)._asdict(), rel=1e-12)


@every_continuous
def test_states_are_variables_too_in_co_simulation_as_well(folder, tmp_path, name):
    block: Any = FMUS[name].block
    with opened(folder / f"{name}.fmu", tmp_path) as host:
        host.initialize()
        host.step(0.0, 0.01)
        x = block.State(*(host.get(f"x.{field}") for field in block.State._fields))
        expected = block.derivative(x, block.Input(), block.Parameters())
        assert [host.get(f"der(x.{field})") for field in x._fields] == pytest.approx(list(expected), rel=1e-12)
        message = host.refuses(host.set, **{f"x.{x._fields[0]}": 0.0})
        assert message == f"x.{x._fields[0]} belongs to the state and cannot be set as a variable"


@every_continuous
def test_directional_derivatives_along_states_are_differences(folder, tmp_path, name):
    block: Any = FMUS[name].block
    start = {"v_0": 8.0, "T_0": 20.0} if name in PLANTS else {"T_ref": 50.0, "q_omega": 0.0}
    with exchanged(folder, tmp_path, name, **start) as host:
        host.fmu.enterContinuousTimeMode()
        x, outputs = states(host), host.names("output")
        unknowns = [host.variables[n].valueReference for n in (*outputs, *(f"der(x.{f})" for f in block.State._fields))]

        def values(moved):
            set_states(host, moved)
            return [host.get(n) for n in outputs] + rates(host)

        for k, field in enumerate(block.State._fields):
            h = 1e-6 * max(1.0, abs(x[k]))
            ahead, behind = (values([*x[:k], x[k] + way * h, *x[k + 1 :]]) for way in (1.0, -1.0))
            set_states(host, x)
            along = host.fmu.getDirectionalDerivative(unknowns, [host.variables[f"x.{field}"].valueReference], [1.0])
            if field == "sample":
                continue  # the noise jumps with it
            scale = [1e-8 * (abs(a) + abs(b)) / h + 1e-5 * abs(c) for a, b, c in zip(ahead, behind, along, strict=True)]
            for a, b, c, error in zip(ahead, behind, along, scale, strict=True):
                assert (a - b) / (2.0 * h) == pytest.approx(c, abs=1e-6 + error)


@every_continuous
def test_co_simulation_gives_the_same_linear_model(folder, tmp_path, name):
    block: Any = FMUS[name].block
    with exchanged(folder, tmp_path, name) as host, opened(folder / f"{name}.fmu", tmp_path) as stepped:
        references = [host.variables[name].valueReference for name in (*host.names("input"), *host.names("output"))]
        inputs = len(host.names("input"))
        x, dx = ([host.variables[f"{n}"].valueReference for n in each] for each in zip(*names_of(block), strict=True))
        stepped.initialize()
        stepped.step(0.0, 0.01)
        host.fmu.enterContinuousTimeMode()
        set_states(host, stepped.fmu.getReal(x))
        for known in (*x, *references[:inputs]):
            columns = [
                each.fmu.getDirectionalDerivative([*references[inputs:], *dx], [known], [1.0])
                for each in (host, stepped)
            ]
            assert columns[0] == columns[1]


def names_of(block):
    """What an FMU calls its states and their derivatives."""
    return [(f"x.{field}", f"der(x.{field})") for field in block.State._fields]


@every_continuous
def test_the_start_can_be_linearised_too(folder, tmp_path, name):
    """States and their derivatives along parameters and inputs, in initialization mode."""
    start = {"v_0": 8.0, "T_0": 20.0} if name in PLANTS else {"T_ref": 50.0}
    along = "T_0" if name in PLANTS else "T_ref"
    with opened(folder / f"{name}.fmu", tmp_path, kind=FMU2Model) as host:
        host.set(**start)
        host.fmu.setupExperiment()
        host.fmu.enterInitializationMode()
        unknowns = [host.variables[name].valueReference for pair in names_of(FMUS[name].block) for name in pair]

        def values(way):
            host.set(**{along: start[along] + way})
            return host.fmu.getReal(unknowns)

        h = 1e-4
        differences = [(a - b) / (2.0 * h) for a, b in zip(values(h), values(-h), strict=True)]
        host.set(**start)
        exact = host.fmu.getDirectionalDerivative(unknowns, [host.variables[along].valueReference], [1.0])
        assert differences == pytest.approx(exact, rel=1e-5, abs=1e-5)
        assert any(exact)


# events


def test_an_indicator_on_its_zero_is_not_zero_and_changes_sign_a_little_beyond(folder, tmp_path):
    with exchanged(folder, tmp_path, "TwoMassDriveline", phi_B=0.25) as host:
        flank = states(host)
        assert flank[2] == 0.0
        host.fmu.newDiscreteStates()
        assert all(z != 0.0 for z in indicators(host)), "at rest all but the flanks are on their zeros"
        host.fmu.enterContinuousTimeMode()

        def upper_flank(phi):
            set_states(host, [*flank[:2], phi, *flank[3:]])
            return indicators(host)[0]

        eps = 1e-6
        assert upper_flank(0.25) == -eps
        assert upper_flank(0.25 + 0.9 * eps) < 0.0 < upper_flank(0.25 + 1.1 * eps)
        host.fmu.enterEventMode()
        host.fmu.newDiscreteStates()
        host.fmu.enterContinuousTimeMode()
        assert upper_flank(0.25 + 1.1 * eps) > 2.0 * eps
        assert upper_flank(0.25 - 1.1 * eps) < 0.0 < upper_flank(0.25 - 0.9 * eps)


@together("name", PLANTS)
def test_a_plant_has_no_time_events_and_states_do_not_jump(folder, tmp_path, name):
    with exchanged(folder, tmp_path, name, v_0=8.0, T_0=20.0) as host:
        before = states(host)
        assert host.fmu.newDiscreteStates() == (False, False, False, False, False, 0.0)
        assert states(host) == before
        host.fmu.enterContinuousTimeMode()
        assert host.fmu.completedIntegratorStep() == (False, False)


def test_the_noise_of_the_motor_changes_at_events_that_are_announced(folder, tmp_path):
    with exchanged(folder, tmp_path, "MotorTorqueLoop", start_time=3.0, T_s=0.004) as host:
        (sample,) = [k for k, v in enumerate(host.description.derivatives) if "sample" in v.variable.name]
        x, time, seen = states(host), 3.0, [host.get("T_mot_est")]
        for k in range(1, 5):
            *_, defined, announced = host.fmu.newDiscreteStates()
            assert defined
            assert announced == pytest.approx(3.0 + 0.004 * k)
            host.fmu.enterContinuousTimeMode()
            for part in (0.5, 0.999):
                host.fmu.setTime(time + part * (announced - time))
                x[sample] = k - 1 + part
                set_states(host, x)
                assert host.get("T_mot_est") == seen[-1]
            host.fmu.setTime(announced)
            x[sample] = float(k)
            set_states(host, x)
            host.fmu.enterEventMode()
            time = announced
            seen.append(host.get("T_mot_est"))
        assert len(set(seen)) == len(seen)


# calls that make no sense


def test_a_wrong_number_of_states_is_refused(integrating):
    before = states(integrating)
    for function, right, what in (
        ("fmi2SetContinuousStates", 6, "states"),
        ("fmi2GetContinuousStates", 6, "states"),
        ("fmi2GetDerivatives", 6, "derivatives"),
        ("fmi2GetNominalsOfContinuousStates", 6, "nominal values"),
        ("fmi2GetEventIndicators", 5, "event indicators"),
    ):
        for count in (right - 1, right + 1):
            assert call(integrating, function, ROOM, ctypes.c_size_t(count)) == ERROR
            assert integrating.message == f"{count} {what} are refused; TwoMassDriveline has {right}"
        assert call(integrating, function, None, ctypes.c_size_t(right)) == ERROR
        assert integrating.message == f"{function}: an argument is NULL"
    assert states(integrating) == before


@together("value", [math.nan, math.inf, -math.inf])
def test_a_state_that_is_no_number_is_discarded_so_that_the_solver_may_try_another(integrating, value):
    before = states(integrating)
    message = integrating.refuses(set_states, integrating, [*before[:2], value, *before[3:]])
    assert message == f"x.phi = {value!r} rad is refused; allowed is any finite number"
    assert integrating.status == DISCARD
    assert states(integrating) == before


def test_derivatives_that_are_no_numbers_are_discarded(integrating):
    set_states(integrating, [1e308, -1e308, 1e308, 0.0, 0.0, 0.0])
    message = integrating.refuses(rates, integrating)
    assert message == "der(x.omega_1) = -inf rad/s2 is refused; allowed is any finite number"
    assert integrating.status == DISCARD


@together("time", [math.nan, math.inf])
def test_a_time_that_is_no_number_is_refused(driveline, time):
    message = driveline.refuses(driveline.fmu.setTime, time)
    assert message == f"time = {time!r} s is refused; allowed is any finite number"


def test_a_parameter_is_refused_while_the_host_integrates_and_an_input_is_not(driveline):
    for change in (lambda: None, driveline.fmu.enterContinuousTimeMode):
        change()
        assert "C = 100.0 is refused; a fixed parameter can be set until" in driveline.refuses(driveline.set, C=100.0)
        driveline.set(T_mot=11.0)
        assert rates(driveline)[0] == pytest.approx(11.0 / 0.055)


def test_a_saved_state_holds_mode_time_states_and_sides(folder, tmp_path):
    with exchanged(folder, tmp_path, "TwoMassDriveline", v_0=8.0, T_0=20.0) as host:
        host.fmu.newDiscreteStates()
        host.fmu.enterContinuousTimeMode()
        x, z = states(host), indicators(host)
        saved = bytes(host.fmu.serializeFMUstate(host.fmu.getFMUstate()))
        set_states(host, [0.0] * len(x))
        host.fmu.enterEventMode()
        host.fmu.newDiscreteStates()
        assert indicators(host) != z
        host.fmu.setFMUstate(host.fmu.deSerializeFMUstate(saved))
        assert (states(host), indicators(host)) == (x, z)
        host.fmu.completedIntegratorStep()


@together("kind", ["model exchange", "co-simulation"])
def test_a_saved_state_of_the_other_kind_is_refused(folder, tmp_path, kind):
    kinds = {"model exchange": {"kind": FMU2Model}, "co-simulation": {}}
    (other,) = [each for each in kinds if each != kind]
    with opened(folder / "TwoMassDriveline.fmu", tmp_path, **kinds[kind]) as host:
        host.initialize()
        state = host.fmu.getFMUstate()
        saved = bytes(host.fmu.serializeFMUstate(state))
        with opened(folder / "TwoMassDriveline.fmu", tmp_path, **kinds[other]) as taker:
            for function, given in ((taker.fmu.deSerializeFMUstate, saved), (taker.fmu.setFMUstate, state)):
                message = taker.refuses(function, given)
                assert message == f"the FMU state is refused: its instance was made for {kind}"
            taker.initialize()
        host.fmu.freeFMUstate(state)


def test_an_output_that_is_no_number_is_discarded(integrating):
    """No step has looked at it, and a solver may try any state."""
    x = states(integrating)
    set_states(integrating, [1e308] * len(x))
    assert re.fullmatch(r"T_gear is refused; it would be -?(inf|nan)", integrating.refuses(integrating.get, "T_gear"))
    assert integrating.status == fmi2Discard
    assert integrating.get("T_mot") == 0.0
    set_states(integrating, x)
    assert abs(integrating.get("T_gear")) < 1e3


# a host that integrates


@together("tolerance", [1e-4, 1e-8])
@together("name", PLANTS)
def test_a_car_at_rest_stays_at_rest_and_meets_few_events(folder, name, tolerance):
    """All wheels are on the zeros of their indicators."""
    results = fmpy.simulate_fmu(
        str(folder / f"{name}.fmu"),
        fmi_type="ModelExchange",
        start_values={"T_brake": 500.0},
        relative_tolerance=tolerance,
        stop_time=2.0,
        output_interval=0.01,
        output=["v", "T_gear"],
    )
    assert len(results) < 201 + 20
    assert np.max(np.abs(results["v"])) < 1e-6


@together("name", PLANTS)
def test_a_jump_of_the_torque_is_an_event_of_the_host(folder, name):
    """FMPy as it is: the inputs are constant before and after the jump."""
    jump = np.array([(0.0, -12.0), (0.1, -12.0), (0.1, 100.0), (0.4, 100.0)], dtype=[("time", float), ("T_mot", float)])
    common = {
        "start_values": {"v_0": 4.0, "T_0": -12.0},
        "stop_time": 0.4,
        "output_interval": 1e-3,
        "output": ["T_gear"],
    }
    path = str(folder / f"{name}.fmu")
    me = fmpy.simulate_fmu(
        path, fmi_type="ModelExchange", input=jump, relative_tolerance=1e-10, record_events=False, **common
    )
    cs = fmpy.simulate_fmu(path, fmi_type="CoSimulation", input=jump, **common)
    assert np.max(np.abs(me["T_gear"])) > 70.0
    assert me["T_gear"] == pytest.approx(cs["T_gear"], abs=1e-3)


WITHIN = 1e-5
"""Of the largest torque; `python -m benchmarks.model_exchange` shows what is reached in all manoeuvres."""


@together("manoeuvre, plant", [("tipin15", PLANTS[0]), ("launch", PLANTS[1])])
@pytest.mark.slow
def test_plant_and_motor_give_the_torque_of_co_simulation(both_built, manoeuvre, plant):
    of_plant, of_motor = recorded(manoeuvre, plant, both_built)
    for run in (of_plant, of_motor) if manoeuvre == "tipin15" else (of_plant,):
        path = both_built / NATIVE / f"{run.name}.fmu"
        expected, taken = stepped(run, path), integrated(run, path, 1e-8)
        assert np.max(np.abs(taken.output - expected)) < WITHIN * np.max(np.abs(expected))
