"""Other tools open the package and get what our master gets, which is given neither the package nor its source."""

from typing import Any

import numpy as np
import pytest
from fmutesting.foreign import build_car

from benchmarks.ssp_hosts import PRESENT, run_in
from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmuloop.system import Scheme

STEPS = 1200
TOLERANCE = 1e-9
"""Of the largest value of a signal; what is smaller than 1 in its unit counts as 1."""

FED_ALREADY = {"ecos": {"motor.omega_1_meas"}}
"""What a tool shows as it follows from inputs that it has just handed on; what it hands on itself is as everywhere."""


def host(name: str) -> Any:
    return pytest.param(name, marks=pytest.mark.skipif(not PRESENT[name], reason=f"{name} is not installed"))


def compare(theirs: dict[str, np.ndarray], ours: np.ndarray, expected: set[str], steps: int = STEPS) -> None:
    """Fails unless all signals agree at the ends of the first steps; NaN is a row that is not there."""
    common = theirs.keys() & set(ours.dtype.names or ())
    assert expected <= common
    for name in common:
        values, right = theirs[name][:steps].astype(float), ours[name][1 : steps + 1].astype(float)
        there = ~np.isnan(values)
        assert np.mean(there) > 0.99, name
        error = np.abs(values - right)[there].max()
        assert error <= TOLERANCE * max(1.0, np.abs(right).max()), f"{name}: {error:g}"


OUTPUTS = {"plant.T_gear", "plant.omega_1", "motor.T_mot", "controller.T_ref", "controller.T_gear_hat"}


@pytest.mark.parametrize("plant", PLANTS)
@pytest.mark.parametrize("name", [host("libcosim"), host("ecos"), host("MasterSim")])
def test_tools_that_hand_on_after_the_step_get_what_our_master_gets_under_jacobi(packaged, fmus, name, plant) -> None:
    ours = simulate(MANOEUVRES["tipin15"], plant=plant, scheme=Scheme.JACOBI, folder=fmus, build="native")
    theirs = run_in(name, packaged(), plant, STEPS)
    compare({column: theirs[column] for column in theirs.keys() - FED_ALREADY.get(name, set())}, ours, OUTPUTS)


@pytest.mark.parametrize("name", ["creep", "prbs15"])
@pytest.mark.parametrize("host", [host("libcosim"), host("ecos"), host("MasterSim")])
def test_a_sine_and_a_binary_torque_are_driven_there_too(packaged, fmus, host, name) -> None:
    ours = simulate(MANOEUVRES[name], scheme=Scheme.JACOBI, folder=fmus, build="native")
    theirs = run_in(host, packaged("--manoeuvre", name), PLANTS[0], 200)
    compare({column: theirs[column] for column in theirs.keys() - FED_ALREADY.get(host, set())}, ours, OUTPUTS, 200)


@pytest.mark.parametrize("host", [host("libcosim"), host("ecos")])
@pytest.mark.slow
def test_signals_in_other_units_are_converted(packaged, fmus, host, tmp_path) -> None:
    car = build_car(tmp_path / "car", omega_1=("n", "rev/min", 2.0 * np.pi / 60.0), T_mot=("T", "kN.m", 1e3))
    mapping = {"plant.omega_1": "n", "plant.T_mot": "T"}
    given = (f"--map={name}={theirs}" for name, theirs in mapping.items())
    ssp = packaged("--plant", str(car), "--manoeuvre", "launch", *given)
    ours = simulate(MANOEUVRES["launch"], car, scheme=Scheme.JACOBI, folder=fmus, build="native", mapping=mapping)
    theirs = run_in(host, ssp, "Theirs", STEPS)["plant.T_gear"]
    assert max(theirs) > 50.0
    np.testing.assert_allclose(theirs, ours["plant.T_gear"][1 : STEPS + 1], atol=1e-6)


def test_the_command_line_of_omsimulator_runs_it(packaged, fmus) -> None:
    """It hands on motor.omega_1_meas within the instant: a step less of delay."""
    if not PRESENT["OMSimulator"]:
        pytest.skip("OMSimulator is not installed")
    ours = simulate(MANOEUVRES["tipin15"], scheme=Scheme.JACOBI, folder=fmus, build="native")["plant.T_gear"]
    theirs = run_in("OMSimulator", packaged(), PLANTS[0], 6000)["plant.T_gear"]
    assert theirs[-1] == pytest.approx(ours[-1], abs=0.05)
