"""The steps in compiled code and in Python: the same to the last bit, and the same words about a refusal."""

from ctypes import c_double
from dataclasses import replace

import numpy as np
import pytest

from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import signals, start
from fmuloop.calls import _change
from fmuloop.compiled_steps import LIBRARY, CompiledSteps
from fmuloop.errors import SimulationError
from fmuloop.experiment import Experiment
from fmuloop.loading import loaded
from fmuloop.steps import interpreted
from fmuloop.system import Connection, Scheme, System

pytestmark = pytest.mark.skipif(LIBRARY is None, reason="the project was installed without a C compiler")

TIPIN = replace(MANOEUVRES["tipin15"], duration=1.0)
"""Longer than what is done between two updates of the progress display."""


def tipin(scheme):
    return Experiment(TIPIN.duration, inputs=signals(TIPIN), parameters=start(TIPIN), scheme=scheme)


def both(system, experiment):
    """The results of the two kinds of steps, as bytes."""
    results = []
    for make in (CompiledSteps, interpreted):
        with loaded(system, make_steps=make) as running:
            results.append(running.run(experiment).tobytes())
    return results


@pytest.mark.parametrize("scheme", Scheme)
@pytest.mark.parametrize("plant", PLANTS)
def test_native_fmus_of_fmi_2_and_3_make_the_same_steps(native, fmi3_as_native, plant, scheme):
    """Each alone, and those of one kind with the others."""
    of_fmi2, of_fmi3 = (loop(plant, folder=folder, build="native") for folder in (native.parent, fmi3_as_native))
    kinds = of_fmi2.instances, of_fmi3.instances
    mixed = replace(of_fmi2, instances={name: kinds[k % 2][name] for k, name in enumerate(of_fmi2.instances)})
    expected = both(of_fmi2, tipin(scheme))
    assert expected[0] == expected[1]
    assert both(of_fmi3, tipin(scheme)) == expected
    assert both(mixed, tipin(scheme)) == expected


@pytest.mark.parametrize("scheme", Scheme)
def test_fmus_that_run_python_make_the_same_steps(built, scheme):
    compiled, in_python = both(loop(PLANTS[0], folder=built, build="python"), tipin(scheme))
    assert compiled == in_python


@pytest.mark.parametrize("scheme", Scheme)
def test_all_types_and_strange_values_make_the_same_steps(relay, scheme):
    wires = [("a.y", "b.u"), ("a.n_out", "b.n"), ("a.b_out", "b.b")]
    system = System({"a": relay, "b": relay}, tuple(Connection(*wire) for wire in wires))
    u = np.resize([0.0, -0.0, 1.0, 1.0, 1e308, -1e308, 5e-324], 501)
    inputs = {"a.u": u, "a.n": np.arange(501) // 3 - 50, "a.b": np.arange(501) % 5 == 0}
    limits = {"b.limit": 1e308, "a.limit": 1e308}
    compiled, in_python = both(system, Experiment(0.5, inputs=inputs, parameters=limits, scheme=scheme))
    assert compiled == in_python


@pytest.mark.parametrize("make", [CompiledSteps, interpreted])
def test_a_refusal_names_instance_function_time_and_reason(relay, make):
    """In the middle of the steps that are made at once, and of the calls of a step; each relay takes one."""
    system = System({"a": relay, "b": relay}, (Connection("a.y", "b.u"),))
    message = r"^b \(Relay\.fmu\) answered fmi2DoStep at 0\.304 s with fatal: .*u = 303.0 is beyond the limit of 302.5"
    with loaded(system, make_steps=make) as running, pytest.raises(SimulationError, match=message):
        running.run(Experiment(0.5, inputs={"a.u": lambda t: 1e3 * t}, parameters={"b.limit": 302.5}))


@pytest.mark.parametrize(("build", "function"), [("native", "fmi2SetReal"), ("fmi3", "fmi3SetFloat64")])
@pytest.mark.parametrize("make", [CompiledSteps, interpreted])
def test_a_native_fmu_says_why_it_refuses(request, make, build, function):
    system = System({"motor": request.getfixturevalue(build) / "MotorTorqueLoop.fmu"})
    T_ref = np.where(np.arange(501) < 250, 10.0, np.nan)
    message = rf"^motor \(MotorTorqueLoop\.fmu\) answered {function} at 0\.25 s .*T_ref"
    with loaded(system, make_steps=make) as running, pytest.raises(SimulationError, match=message):
        running.run(Experiment(0.5, inputs={"motor.T_ref": T_ref}))


@pytest.mark.parametrize("factors", [(), (1.0, 1e3)])
def test_inputs_are_handed_on_if_one_of_them_has_changed_and_only_then(factors):
    row, buffer = (c_double * 3)(4.0, 0.0, 7.0), (c_double * 2)()
    changed, (first, second) = _change(memoryview(row).cast("B").cast("d"), (0, 16), buffer, factors), factors or (1, 1)
    for k, value, has_changed in ((0, 4.0, True), (0, 4.0, False), (1, 9.0, False), (2, 8.0, True)):
        row[k] = value  # that between them is not among them
        assert changed() is has_changed
    assert tuple(buffer) == (4.0 / first, 8.0 / second)
