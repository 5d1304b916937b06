"""A controller and its plant, two FMUs, are wired, run and recorded; what does not fit is refused by name."""

from ctypes import CDLL
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmutesting.blocks import FOLDER, build

from fmublocks.native.lanes import build_lanes
from fmublocks.own_file import fmu_in
from fmuloop import Connection, Experiment, Port, SimulationError, System, WiringError, loaded, run, run_many
from fmuloop.campaign import RunRequest
from toolground.lanes_here import lanes_here


@pytest.fixture(scope="module")
def system(tmp_path_factory: pytest.TempPathFactory, native_builder: object) -> System:
    fmus = build(tmp_path_factory.mktemp("fmus"), "pi_controller", "lag")
    return System(
        instances={"controller": fmus["PiController"], "plant": fmus["Lag"]},
        connections=(Connection("controller.u", "plant.u"), Connection("plant.y", "controller.y")),
        inputs=(Port("controller.r", "1"),),
        parameters=(Port("controller.k_i", "1/s"),),
    )


def step(**changes: object) -> Experiment:
    """A step of the reference."""
    values: dict = {"inputs": {"controller.r": 1.0}, "parameters": {"controller.k_i": 5.0}, **changes}
    return Experiment(duration=3.0, step_size=0.01, **values)


def test_the_plant_settles_at_the_reference(system: System) -> None:
    results = run(system, step())
    assert results["plant.y"][0] == 0.0
    assert results["plant.y"][-1] == pytest.approx(1.0, abs=1e-3)
    assert len(results) == 301
    assert set(results.dtype.names or ()) >= {"time", "controller.u", "plant.y", "controller.r"}


def test_it_is_the_loop_that_its_equations_give(system: System) -> None:
    """The lag is solved exactly for a control that is held over each step."""
    results = run(system, step())
    decay, y, integral, u = np.exp(-0.01 / 0.5), 0.0, 0.0, 0.0
    for measured, control in zip(results["plant.y"], results["controller.u"], strict=True):
        assert (measured, control) == pytest.approx((y, u), abs=1e-7)
        error = 1.0 - y
        y, u = u + (y - u) * decay, min(max(2.0 * error + integral, -3.0), 3.0)
        integral += 0.01 * 5.0 * error * (abs(2.0 * error + integral) <= 3.0)


def test_a_loaded_loop_runs_again_and_again_as_the_first_time(system: System) -> None:
    with loaded(system, ["controller.r"], ["controller.k_i"]) as loop:
        first = loop.run(step()).copy()
        other = loop.run(step(parameters={"controller.k_i": 0.0}))["plant.y"][-1]
        np.testing.assert_array_equal(first, loop.run(step()))
    assert other == pytest.approx(2.0 / 3.0, abs=1e-3)  # k_p/(1 + k_p) without an integral


def settled(k_i: float, system: System) -> float:
    return float(run(system, step(parameters={"controller.k_i": k_i}))["plant.y"][-1])


def test_many_runs_are_the_runs_one_by_one(system: System) -> None:
    gains = [0.0, 1.0, 5.0]
    answers = run_many(lambda k_i: settled(k_i, system), gains, workers=1)
    assert answers == [settled(k_i, system) for k_i in gains]


def test_runs_in_the_lanes_of_the_processor_are_the_runs_one_by_one(system: System, tmp_path: Path) -> None:
    """The libraries are made of the blocks, several of whose instances make a step at a time."""
    names = {"controller": "pi_controller", "plant": "lag"}
    for instance, name in names.items():
        build_lanes(fmu_in(FOLDER / f"{name}.py"), lanes_here(), tmp_path / f"{instance}.so")
    libraries = {instance: CDLL(str(tmp_path / f"{instance}.so")) for instance in names}
    asked: list[System] = []

    def lane_libraries(system: System) -> dict[str, CDLL]:
        asked.append(system)
        return libraries

    with_lanes = replace(system, own=frozenset(names), lane_libraries=lane_libraries)
    gains = [0.25 * k for k in range(40)]
    answers = run_many(
        lambda _, results: float(results[0]["plant.y"][-1]),
        gains,
        workers=1,
        runs=lambda k_i: [RunRequest(with_lanes, step(parameters={"controller.k_i": k_i}))],
    )
    assert asked
    assert answers == pytest.approx([settled(k_i, system) for k_i in gains], rel=1e-12)


@pytest.mark.parametrize(
    ("connection", "error"),
    [
        (Connection("controller.v", "plant.u"), "controller.v"),
        (Connection("controller.u", "plant.T"), "plant.T"),
        (Connection("controller.u", "plant.u", "N.m"), "N.m"),
    ],
)
def test_wiring_that_does_not_fit_is_refused_by_name(system: System, connection: Connection, error: str) -> None:
    with pytest.raises(WiringError, match=error):
        run(replace(system, connections=(connection, system.connections[1])), step())


def test_a_parameter_out_of_bounds_is_refused_by_the_fmu(system: System) -> None:
    with pytest.raises((SimulationError, WiringError), match=r"k_i"):
        run(system, step(parameters={"controller.k_i": -1.0}))
