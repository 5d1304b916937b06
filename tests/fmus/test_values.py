"""Setting and getting: what is allowed takes effect, what is not is refused and changes nothing."""

import math

import pytest
from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks.description.variables import LARGEST, interface
from fmublocks.protocol import INPUT_TOLERANCE

SETTABLE = [
    (name, variable)
    for name, fmu in FMUS.items()
    for variable in interface(fmu.block)
    if variable.causality != "output" and variable.fmi_type != "Boolean"
]
STRICT = [(name, v) for name, v in SETTABLE if v.causality == "parameter" or not FMUS[name].block.tolerates_bad_input]


@pytest.fixture(scope="module")
def hosts(built, tmp_path_factory):
    """One instance of every FMU, before initialization mode."""
    opening = [opened(built / f"{name}.fmu", tmp_path_factory.mktemp(name)) for name in FMUS]
    yield dict(zip(FMUS, [each.__enter__() for each in opening], strict=True))
    for each in opening:
        each.__exit__(None, None, None)


def outside(variable):
    """Values that are not allowed."""
    low, high = variable.bounds()
    if variable.fmi_type == "Integer":
        return [value for value in (low - 1, high + 1) if -(2**31) <= value < 2**31]
    if variable.causality == "input":  # those of strict blocks have ranges
        slack = 1.01 * INPUT_TOLERANCE * (high - low)
        return [low - slack, high + slack, math.nan, math.inf, -math.inf]
    ends = [math.nextafter(low, -math.inf)] if low > -LARGEST else []
    ends += [math.nextafter(high, math.inf)] if high < LARGEST else []
    return [*ends, math.nan, math.inf, -math.inf]


@together("name, variable", STRICT)
def test_a_value_that_is_not_allowed_is_refused_by_name_and_changes_nothing(hosts, name, variable):
    host = hosts[name]
    before = host.outputs(), host.get(variable.name)
    for value in outside(variable):
        message = host.refuses(host.set, **{variable.name: value})
        assert f"{variable.name} = {value!r}" in message
        assert f"allowed is {variable.allowed()}" in message
        assert (host.outputs(), host.get(variable.name)) == before


@together("name, variable", SETTABLE)
def test_both_ends_of_the_range_are_allowed(hosts, name, variable):
    host = hosts[name]
    for value in (*variable.bounds(), variable.start):
        host.set(**{variable.name: value})
        assert host.get(variable.name) == value


@pytest.mark.parametrize("build", ["built", "native", "fmi3"])
def test_an_input_a_little_outside_of_its_range_is_at_its_end(request, tmp_path, build):
    """As hosts give it that perturb it for a Jacobian."""
    with opened(request.getfixturevalue(build) / "TwoMassDriveline.fmu", tmp_path) as host:
        low, high = next(v.bounds() for v in interface(FMUS["TwoMassDriveline"].block) if v.name == "T_brake")
        for value in (-1e-12, -0.99e-6 * (high - low)):
            host.set(T_brake=value)
            assert host.get("T_brake") == low == 0.0
        host.set(T_brake=high + 0.99e-6 * (high - low))
        assert host.get("T_brake") == high
        host.initialize()
        host.step(0.0, 0.01)


def test_one_bad_value_among_good_ones_keeps_them_all_out(hosts):
    host = hosts["MotorTorqueLoop"]
    references = [host.variables[name].valueReference for name in ("T_ref", "omega_1")]
    host.refuses(host.fmu.setReal, references, [50.0, math.nan])
    assert host.fmu.getReal(references) == [0.0, 0.0]


def test_the_controller_takes_any_measurement_and_stays_finite(controller):
    controller.initialize()
    for k, value in enumerate((math.nan, math.inf, -math.inf, 1e300, -1e300) * 20):
        controller.set(T_driver=value, omega_1_meas=value, T_mot_est=value, omega_2_can=value, counter=-k)
        controller.step(k * 0.002, 0.002)
        assert abs(controller.get("T_ref")) <= controller.get("T_max")


def test_a_parameter_is_fixed_after_initialization_and_free_after_reset(motor):
    motor.initialize(tau=0.01)
    message = motor.refuses(motor.set, tau=0.02)
    assert "tau = 0.02 is refused; a fixed parameter can be set until initialization mode is left" in message
    assert motor.get("tau") == 0.01
    motor.fmu.reset()
    assert motor.get("tau") == FMUS["MotorTorqueLoop"].block.Parameters().tau
    motor.initialize(tau=0.02)
    assert motor.get("tau") == 0.02


def test_an_enumeration_is_read_as_its_number(controller):
    controller.initialize(enable=False)
    assert controller.get("status") == 1
    assert not controller.get("enable")


def test_instances_do_not_see_each_other(built, tmp_path):
    with (
        opened(built / "MotorTorqueLoop.fmu", tmp_path, "first") as first,
        opened(built / "MotorTorqueLoop.fmu", tmp_path, "second") as second,
    ):
        first.initialize(T_ref=50.0)
        second.initialize(T_ref=-20.0, tau=0.01)
        first.step(0.0, 0.01)
        assert (first.get("T_mot"), second.get("T_mot")) == (50.0, -20.0)
        assert first.get("tau") != second.get("tau")
