"""Runs in the lanes of the processor are those that are made alone, but for the rounding of single operations."""

from contextlib import contextmanager
from ctypes import CDLL
from dataclasses import replace

import numpy as np
import pytest
from fmutesting.slow import slow

from driveline.fmus.catalogue import EVERY
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import signals, start
from fmublocks.native.lanes import build_lanes
from fmuloop import row_file
from fmuloop.errors import SimulationError, WiringError
from fmuloop.experiment import Experiment
from fmuloop.lanes import LaneLoop
from fmuloop.loading import loaded
from fmuloop.master import Loop
from fmuloop.system import Scheme
from toolground.lanes_here import FEATURES, lanes_here

pytestmark = pytest.mark.skipif(not lanes_here(), reason="this processor has no lanes")

WIDTHS = [lanes for lanes in FEATURES if lanes <= lanes_here()]

TOLERANCE = 1e-6
"""N.m: of torques."""


@pytest.fixture(scope="module")
def libraries(tmp_path_factory):
    """Gives the libraries of a loop for so many lanes."""
    folder = tmp_path_factory.mktemp("lanes")

    def made(system, lanes):
        found = {}
        for name, path in system.instances.items():
            library = folder / f"{path.stem}-{lanes}.so"
            if not library.exists():
                build_lanes(EVERY[path.stem], lanes, library)
            found[name] = CDLL(str(library))
        return found

    return made


@contextmanager
def running(system):
    """Its loop in this process."""
    with loaded(system) as found:
        assert isinstance(found, Loop)
        yield found


@pytest.fixture
def lanes(both_built, libraries):
    """The loop with the design model alone, and in lanes."""
    system = loop("TwoMassDriveline", folder=both_built, build="native")
    with running(system) as alone:
        yield alone, LaneLoop(alone.fitted, libraries(system, WIDTHS[0]))


def car(number, manoeuvre="tipin15", duration=0.4, scheme=Scheme.PROPAGATED, **parameters):
    """An experiment with a car of its own, without control if its number is 2."""
    of = replace(MANOEUVRES[manoeuvre], duration=duration)
    given = start(of, seed=number + 1) | {"controller.k_d": 1.0 + 0.2 * number}
    return Experiment(
        duration,
        inputs=signals(of, number != 2, 1e-3),
        parameters=given | {name.replace("__", "."): value for name, value in parameters.items()},
        scheme=scheme,
    )


def torques_apart(one, other):
    """The largest difference of a torque in N.m, and of the counters."""
    assert one.dtype == other.dtype
    assert len(one) == len(other)
    torques = [name for name in one.dtype.names if ".T_" in name]
    assert all((one[name] == other[name]).all() for name in ("time", "can.counter", "can.valid", "controller.status"))
    return max(np.abs(one[name] - other[name]).max() for name in torques)


@pytest.mark.parametrize(
    ("width", "plant", "manoeuvre"),
    [
        *((width, "TwoMassDriveline", "tipin15") for width in WIDTHS[:1]),
        *((width, "ValidationVehicle", "launch_brake") for width in WIDTHS),
    ],
)
@pytest.mark.slow
def test_they_are_those_of_single_runs(both_built, libraries, width, plant, manoeuvre):
    system = loop(plant, folder=both_built, build="native")
    cars = [car(number, manoeuvre, 1.2) for number in range(width)]
    with running(system) as alone:
        in_lanes = LaneLoop(alone.fitted, libraries(system, width))
        for made, each in zip(in_lanes.run(alone, cars), cars, strict=True):
            assert torques_apart(made, alone.run(each)) < TOLERANCE
        assert 0 < in_lanes.alone < 0.05 * width * 1200


@pytest.mark.parametrize("scheme", slow(Scheme, but=[Scheme.JACOBI]))
def test_every_scheme_and_controller_has_lanes(both_built, native_builder, libraries, scheme, tmp_path):
    native_builder(EVERY["PaperObserver"], both_built)
    system = loop("TwoMassDriveline", controller="PaperObserver", folder=both_built, build="native")
    of = replace(MANOEUVRES["tipout"], duration=0.4)
    cars = [
        Experiment(0.4, inputs=signals(of), parameters=start(of, seed), scheme=scheme)
        for seed in range(1, 1 + WIDTHS[0])
    ]
    with running(system) as alone:
        for made, each in zip(LaneLoop(alone.fitted, libraries(system, WIDTHS[0])).run(alone, cars), cars, strict=True):
            assert torques_apart(made, alone.run(each)) < TOLERANCE


def test_any_number_of_cars_of_any_length(lanes):
    alone, in_lanes = lanes
    cars = [car(0, duration=0.05), car(1, duration=0.3), car(2, duration=0.2)]
    for count in (1, 3, 2):
        for made, each in zip(in_lanes.run(alone, cars[:count]), cars[:count], strict=True):
            assert torques_apart(made, alone.run(each)) < TOLERANCE


def test_a_car_that_is_refused_something_is_given_up_and_the_others_go_on(lanes):
    alone, in_lanes = lanes
    absurd = replace(car(1), inputs=dict(car(1).inputs) | {"plant.T_brake": lambda t: np.where(t < 0.1, 0.0, -1.0)})
    cars = [car(0), absurd, car(2, controller__k_d=-1.0), car(3)]
    first, given_up, refused, last = in_lanes.run(alone, cars)
    assert given_up is None
    with pytest.raises(SimulationError, match=r"T_brake = -1\.0 N\.m"):
        alone.run(absurd)
    assert isinstance(refused, SimulationError)
    assert "k_d" in str(refused)
    assert torques_apart(first, alone.run(cars[0])) < TOLERANCE
    assert torques_apart(last, alone.run(cars[3])) < TOLERANCE
    assert in_lanes.run(alone, [absurd, absurd]) == [None, None]
    (again,) = in_lanes.run(alone, cars[:1])
    assert torques_apart(again, first) == 0.0


def test_a_run_that_changes_a_parameter_or_whose_rows_are_in_a_file_goes_alone(lanes, monkeypatch):
    alone, in_lanes = lanes
    constant = car(1)
    changed, never = (
        replace(constant, parameters=dict(constant.parameters) | {f"controller.k_d@{at:g}": 0.0}) for at in (0.1, 7.0)
    )
    first, given_up, refused = in_lanes.run(alone, [constant, changed, never])
    assert given_up is None
    assert isinstance(refused, WiringError)
    assert torques_apart(first, alone.run(constant)) < TOLERANCE
    assert in_lanes.run(alone, [changed, changed]) == [None, None]
    alone, in_lanes = lanes
    size = alone.run(car(0)).nbytes
    for most, alike in ((size - 1, False), (size, True)):
        monkeypatch.setattr(row_file, "MOST_IN_MEMORY", most)
        (made,) = in_lanes.run(alone, [car(0)])
        assert (made is not None) == alike
