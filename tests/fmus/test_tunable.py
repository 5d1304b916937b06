"""Parameters that a run may change: every build takes them over, as the functions of the block do."""

import math
from collections.abc import Iterator
from random import Random
from typing import Any

import pytest
from fmpy.fmi2 import FMU2Model
from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.catalogue import EVERY, FMUS
from fmublocks.block.runner import runner
from fmublocks.description.variables import Variable, interface
from tests.back_to_back import random_inputs
from tests.fmus.test_values import outside

STEP = 0.001

BUILDS = together("build", ["built", "native", "fmi3"])


def tunable(name: str) -> list[Variable]:
    return [v for v in interface(EVERY[name].block) if v.variability == "tunable"]


WITH_TUNABLE = [name for name in FMUS if tunable(name)]


def turned(name: str, draw: Random) -> dict[str, float]:
    """Each tunable parameter with a value of its own, not far from the declared one and within its bounds."""
    found = {}
    for variable in tunable(name):
        low, high = variable.bounds()
        value = variable.start * draw.uniform(0.7, 1.3) + draw.uniform(0.0, 1e-3)
        found[variable.name] = min(max(value, low), high)
    return found


def test_what_a_calibration_engineer_turns_is_tunable_and_what_belongs_to_the_car_is_not() -> None:
    names = {v.name for v in tunable("DampingController")}
    assert {"k_d", "omega_w", "k_gap", "T_pred", "T_gap", "shape_1", "landing_share", "L_phi_B", "T_take_max"} <= names
    assert {"L_phi", "L_omega_1", "Ls_T_l", "L_can_phi", "T_age"} <= names
    assert not names & {"J_1", "J_2", "C", "phi_B", "tau", "phi_B_0", "lambda_v", "t_land", "T_max", "t_bad", "t_stale"}
    assert {v.name for v in tunable("TwoMassDriveline")} == {"m", "c_rr", "c_wa"}
    assert {v.name for v in tunable("ValidationVehicle")} == {"m", "mu", "c_rr", "c_wa", "g_muL", "g_muR"}
    assert "tau" not in {v.name for v in tunable("MotorTorqueLoop")}


@BUILDS
@together("name", WITH_TUNABLE)
def test_turned_in_a_run_they_act_as_in_the_functions(request: Any, tmp_path: Any, name: str, build: str) -> None:
    block: Any = FMUS[name].block
    draw, steps = Random(name), 60
    columns = random_inputs(block, steps).inputs
    inputs = [block.Input(*row) for row in zip(*(columns[n].tolist() for n in block.Input._fields), strict=True)]
    start = {"v_0": 15.0 / 3.6} if "v_0" in block.Parameters._fields else {}
    running: Any = runner(block, inputs[0], block.Parameters(**start))
    with opened(request.getfixturevalue(build) / f"{name}.fmu", tmp_path) as host:
        host.initialize(**start, **inputs[0]._asdict())
        for k, u in enumerate(inputs[:-1]):
            host.set(**u._asdict())
            if k % 20 == 13:
                values = turned(name, draw)
                host.set(**values)
                running.p = running.p._replace(**values)
            assert host.outputs() == running.output(u)._asdict()
            host.step(k * STEP, STEP)
            running.advance(u, STEP)
        assert {n: host.get(n) for n in values} == values
        assert host.outputs() == running.output(u)._asdict()


@BUILDS
def test_a_sampled_block_takes_them_over_at_the_next_sample(request: Any, tmp_path: Any, build: str) -> None:
    rolling = {"omega_1_meas": 150.0, "T_mot_est": 50.0, "T_driver": 50.0}
    with opened(request.getfixturevalue(build) / "DampingController.fmu", tmp_path) as host:
        host.initialize(**rolling)
        host.set(omega_1_meas=152.0)
        host.step(0.0, 0.002)
        before = host.outputs()
        host.set(k_d=0.0)
        assert host.outputs() == before
        host.step(0.002, 0.001)
        assert host.outputs() == before
        host.step(0.003, 0.001)
        assert host.get("T_ref") != before["T_ref"]


@BUILDS
@together("name", WITH_TUNABLE)
def test_in_a_run_both_ends_are_allowed_and_what_is_beyond_is_refused(
    request: Any, tmp_path: Any, name: str, build: str
) -> None:
    with opened(request.getfixturevalue(build) / f"{name}.fmu", tmp_path) as host:
        host.initialize()
        for variable in tunable(name):
            for value in (*variable.bounds(), variable.start):
                host.set(**{variable.name: value})
                assert host.get(variable.name) == value
            for value in outside(variable):
                message = host.refuses(host.set, **{variable.name: value})
                unit = f" {variable.unit}" if variable.unit else ""
                assert message.endswith(
                    f"{variable.name} = {value!r}{unit} is refused; allowed is {variable.allowed()}"
                )
                assert host.get(variable.name) == variable.start


@BUILDS
def test_a_fixed_one_beside_a_tunable_one_keeps_both_out(request: Any, tmp_path: Any, build: str) -> None:
    with opened(request.getfixturevalue(build) / "TwoMassDriveline.fmu", tmp_path) as host:
        host.initialize()
        references = [host.variables[name].valueReference for name in ("m", "C")]
        message = host.refuses(host.fmu.setReal, references, [2000.0, 100.0])
        assert "C = 100.0 is refused; a fixed parameter can be set until initialization mode is left" in message
        assert (host.get("m"), host.get("C")) == (1450.0, 117.4)
        host.fmu.terminate()
        assert "m = 2000.0 is refused" in host.refuses(host.set, m=2000.0)


@BUILDS
def test_a_saved_state_has_them_and_a_reset_forgets_them(request: Any, tmp_path: Any, build: str) -> None:
    with opened(request.getfixturevalue(build) / "TwoMassDriveline.fmu", tmp_path) as host:
        host.initialize(v_0=10.0, T_0=20.0, T_mot=20.0, c_rr=0.0)
        host.set(m=2000.0)
        heavy = host.get("a_body")
        state = host.fmu.getFMUstate()
        host.set(m=1000.0)
        assert host.get("a_body") == pytest.approx(2.0 * heavy)
        host.fmu.setFMUstate(state)
        host.fmu.freeFMUstate(state)
        assert (host.get("m"), host.get("a_body")) == (2000.0, heavy)
        host.fmu.reset()
        assert host.get("m") == 1450.0


@pytest.fixture
def exchanged(native: Any, tmp_path: Any) -> Iterator[Any]:
    with opened(native / "TwoMassDriveline.fmu", tmp_path, kind=FMU2Model) as host:
        host.initialize(v_0=10.0, T_0=20.0, T_mot=20.0, c_rr=0.0)
        yield host


def test_in_model_exchange_their_place_is_event_mode(exchanged: Any) -> None:
    before = exchanged.get("der(x.v)")
    exchanged.set(m=2900.0)
    assert exchanged.get("der(x.v)") == pytest.approx(0.5 * before, rel=1e-6)
    exchanged.fmu.enterContinuousTimeMode()
    message = exchanged.refuses(exchanged.set, m=1450.0)
    assert "m = 1450.0 is refused; a fixed parameter can be set until" in message
    assert "a tunable one between steps (in model exchange: in event mode)" in message
    assert exchanged.get("m") == 2900.0
    exchanged.fmu.enterEventMode()
    exchanged.set(m=1450.0)
    assert math.isclose(exchanged.get("der(x.v)"), before)
