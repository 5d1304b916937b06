"""The days of an electric car, driven with the detailed vehicle: each does what its description says."""

from pathlib import Path

import numpy as np
import pytest

from driveline.harness.commands.cli import main
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate, start
from fmuloop.errors import SimulationError
from fmuloop.results import Results

VEHICLE = "ValidationVehicle"


@pytest.fixture(scope="module")
def runs(native: Path) -> dict[str, Results]:
    """Without damping."""
    names = ("one_pedal_hard", "blending", "hill_start", "park_back", "abs", "launch", "launch_ice", "launch_split")
    return {name: simulate(MANOEUVRES[name], VEHICLE, control=False, folder=native.parent) for name in names}


def at(results: Results, name: str, t: float) -> float:
    return float(np.interp(t, results["time"], results[name]))


@pytest.mark.parametrize("name", ["one_pedal_hard", "blending", "hill_start", "park_back"])
def test_the_car_stands_at_the_end(runs: dict[str, Results], name: str) -> None:
    last = runs[name]["time"] > runs[name]["time"][-1] - 0.2
    assert np.abs(runs[name]["plant.v"][last]).max() < 0.1


def test_the_motor_alone_brings_the_car_almost_to_rest_before_the_brakes_hold_it(runs: dict[str, Results]) -> None:
    run = runs["one_pedal_hard"]
    assert (run["plant.T_brake"][run["time"] < 4.15] == 0.0).all()
    assert abs(at(run, "plant.v", 4.2)) < 0.45 < at(run, "plant.v", 3.6)


def test_the_brakes_take_over_while_the_car_still_rolls(runs: dict[str, Results]) -> None:
    assert at(runs["blending"], "plant.v", 4.3) > 0.5
    assert abs(at(runs["blending"], "controller.T_driver", 4.3)) < 1e-6


def test_the_car_rolls_back_before_it_pulls_away_uphill(runs: dict[str, Results]) -> None:
    v = runs["hill_start"]["plant.v"]
    assert -1.0 < v.min() < -0.05
    assert v.max() > 1.0


def test_parking_back_only_goes_backwards(runs: dict[str, Results]) -> None:
    assert runs["park_back"]["plant.v"].min() < -0.3
    assert runs["park_back"]["plant.v"].max() < 0.15


def test_the_wheels_slip_to_half_the_speed_of_the_car_in_the_pulses_and_catch_up_between(
    runs: dict[str, Results],
) -> None:
    run = runs["abs"]
    speed = run["plant.omega_2"] * 0.29 / 9.0 / np.maximum(run["plant.v"], 1.0)
    braked = (run["time"] > 1.0) & (run["time"] < 3.3)
    assert 0.4 < speed[braked].min() < 0.6
    assert speed[(run["time"] > 1.15) & (run["time"] < 1.2)].max() > 0.95


def test_the_wheels_spin_on_ice_alone(runs: dict[str, Results]) -> None:
    """omega_2 is the mean of both: on split grip one wheel spins."""

    def slip(name: str) -> float:
        return at(runs[name], "plant.omega_2", 1.6) * 0.29 / 9.0 - at(runs[name], "plant.v", 1.6)

    assert slip("launch") < 0.1
    assert min(slip("launch_ice"), slip("launch_split")) > 1.0


def test_what_a_user_sets_comes_before_the_road_of_a_manoeuvre(native: Path, runs: dict[str, Results]) -> None:
    assert start(MANOEUVRES["launch_ice"])["plant.mu"] == 0.12
    dry = simulate(MANOEUVRES["launch_ice"], VEHICLE, control=False, folder=native.parent, parameters={"plant.mu": 1.0})
    pushing = dry["time"] < 1.6
    assert (dry["plant.T_gear"][pushing] == runs["launch"]["plant.T_gear"][pushing]).all()


@pytest.mark.parametrize("command", ["simulate", "compare"])
def test_a_plant_without_grip_is_refused_before_anything_runs(native, tmp_path, capsys, command):
    given = ["--manoeuvre", "launch_ice", "--fmus", str(native.parent), "--output", str(tmp_path / "out")]
    assert main([command, "--plant", "TwoMassDriveline", *given]) == 2
    message = capsys.readouterr().err
    assert "launch_ice is for plants with a parameter mu (0.12 there); TwoMassDriveline.fmu has none" in message
    assert not (tmp_path / "out").exists()


def test_wheels_that_spin_beyond_the_bus_are_named_and_what_eases_off(native: Path) -> None:
    spins = (
        r"omega_wheel_L = 500\..*; the wheels spin, as launch demands .*; launch_ice, launch_split, ice_hill ease off"
    )
    with pytest.raises(SimulationError, match=spins):
        simulate(MANOEUVRES["launch"], VEHICLE, folder=native.parent, parameters={"plant.mu": 0.1})


def test_a_parameter_of_the_other_plant_names_that_plant(native, capsys):
    given = ["--fmus", str(native.parent), "--set", "plant.mu=0.1"]
    assert main(["simulate", *given]) == 2
    named = "plant.mu: TwoMassDriveline has no parameter mu; --plant ValidationVehicle has it"
    assert named in capsys.readouterr().err
    assert main(["simulate", "--fmus", str(native.parent), "--set", "plant.J_3=0.1"]) == 2
    assert "TwoMassDriveline.fmu has no parameter J_3; did you mean" in capsys.readouterr().err
