"""A plant with other names and other units: it drives the loop like ours, or is told why not."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from fmutesting.foreign import build_car, tampered

from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import signals, simulate, start
from fmuloop.compiled_steps import LIBRARY, CompiledSteps
from fmuloop.errors import WiringError
from fmuloop.experiment import Experiment
from fmuloop.loading import loaded
from fmuloop.mapping import parsed
from fmuloop.steps import interpreted
from fmuloop.wiring import fit
from toolground.collected_warnings import warn_once

TIPIN = replace(MANOEUVRES["tipin15"], duration=1.2)

THEIRS = {
    "T_mot": ("Rotor.torque", "kN.m", 1e3),
    "slope": ("Road.angle", "deg", pi / 180.0),
    "v_0": ("Car.v_start", "km/h", 1.0 / 3.6),
    "m": ("Car.mass", "t", 1e3),
    "omega_1": ("Rotor.n", "rpm", pi / 30.0),
    "T_gear": ("Shaft.tau", "N.mm", 1e-3),
    "v": ("Car.v", "", 1.0),
}
"""Of some variables in the loop: their name, their unit (v has none), and its factor."""

EXACT = {"motor.q_omega": 0.0, "can.q_v": 0.0}
"""Sensors that do not round: what a conversion changes in the last digit stays there."""

MAPPING = {f"plant.{ours}": name for ours, (name, _, _) in THEIRS.items()}


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """The car with the names and units of the loop."""
    return build_car(tmp_path_factory.mktemp("plain"))


@pytest.fixture(scope="module")
def theirs(tmp_path_factory):
    """The same car with names and units of its own."""
    return build_car(tmp_path_factory.mktemp("theirs"), **THEIRS)


def test_other_names_and_units_drive_the_loop_with_the_same_results(both_built, plain, theirs):
    uphill = replace(TIPIN, slope=lambda t: np.full(np.shape(t), 0.02))
    heavy = EXACT | {"plant.m": 1600.0}
    expected = simulate(uphill, plain, folder=both_built, parameters=heavy)
    results = simulate(uphill, theirs, folder=both_built, parameters=heavy, mapping=MAPPING)
    assert set(results.dtype.names or ()) == set(expected.dtype.names or ())
    for name in expected.dtype.names or ():
        np.testing.assert_allclose(results[name], expected[name], rtol=1e-9, atol=1e-9, err_msg=name)


@pytest.mark.skipif(LIBRARY is None, reason="the project was installed without a C compiler")
def test_compiled_steps_and_those_in_python_convert_alike(both_built, theirs):
    results = []
    for make in (CompiledSteps, interpreted):
        with loaded(loop(theirs, folder=both_built, mapping=MAPPING), make_steps=make) as running:
            results.append(running.run(Experiment(TIPIN.duration, 1e-3, signals(TIPIN), start(TIPIN))).tobytes())
    assert results[0] == results[1]


def test_a_mapped_variable_without_a_unit_is_said(both_built, theirs, caplog):
    warn_once.cache_clear()
    fit(loop(theirs, folder=both_built, mapping=MAPPING))
    text = f"{theirs.name}: variables without a unit are taken to be in that of the loop: v in m/s"
    assert caplog.messages == [text]


def test_names_may_be_the_same_or_swapped_and_one_output_two_things(both_built, plain, tmp_path):
    ours = both_built / f"{PLANTS[0]}.fmu"
    mapping = {f"plant.{name}": name for name in ("T_mot", "T_gear", "omega_1", "v_0")}
    np.testing.assert_array_equal(
        simulate(TIPIN, ours, folder=both_built, mapping=mapping), simulate(TIPIN, ours, folder=both_built)
    )
    swapped = {"plant.omega_1": "omega_2", "plant.omega_2": "omega_1"}
    row = simulate(TIPIN, plain, folder=both_built, mapping=swapped)[-1]
    assert row["plant.omega_wheel_L"] * 9.0 == pytest.approx(row["plant.omega_1"], rel=1e-12)
    assert row["plant.omega_2"] != row["plant.omega_1"]
    # A car with one wheel speed.
    one = {"omega_wheel_L": ("wheel", "rad/s", 1.0), "omega_wheel_R": ("other", "rad/s", 1.0)}
    plant = build_car(tmp_path / "car", **one)
    mapping = {"plant.omega_wheel_L": "wheel", "plant.omega_wheel_R": "wheel"}
    results = simulate(TIPIN, plant, folder=both_built, mapping=mapping)
    np.testing.assert_array_equal(results["plant.omega_wheel_R"], results["plant.omega_wheel_L"])
    assert results["plant.omega_wheel_R"][-1] > 1.0
    assert "plant.wheel" not in (results.dtype.names or ())


@pytest.mark.parametrize(
    ("mapping", "complaint"),
    [
        ({"plant.T_gear": "Shaft.ta"}, r"plant\.T_gear=Shaft\.ta: in .* does not exist; did you mean Shaft\.tau"),
        (
            {"plnt.T_gear": "Shaft.tau"},
            "^plnt is no place of the loop, nor the name of an FMU in it; did you mean plant",
        ),
        ({"plant.T_gear": "Rotor.n"}, r"plant\.T_gear=Rotor\.n: .* is in rpm, which does not convert into N\.m"),
        ({"plant.T_gear": "T_brake"}, r"plant\.T_gear: .* T_gear is of causality input; it must be output"),
        ({"plant.T_mot": "T_brake", "plant.T_brake": "T_brake"}, "T_brake is mapped to T_brake too; only an output"),
    ],
)
def test_a_mapping_that_does_not_fit_is_refused(both_built, theirs, mapping, complaint):
    with pytest.raises(WiringError, match=complaint):
        simulate(TIPIN, theirs, folder=both_built, mapping=MAPPING | mapping)


def test_all_that_does_not_fit_is_named_at_once_and_each_once(both_built, theirs):
    mapping = MAPPING | {"plant.T_gear": "Shaft.ta", "plant.omega_1": "Shaft.tau", "plant.v_0": "v0"}
    del mapping["plant.T_mot"]
    with pytest.raises(WiringError) as error:
        simulate(TIPIN, theirs, folder=both_built, mapping=mapping, parameters={"plant.J_1": 0.06})
    named = [line.partition("=")[0].partition(":")[0] for line in str(error.value).splitlines()]
    assert sorted(named) == ["plant.J_1", "plant.T_gear", "plant.T_mot", "plant.omega_1", "plant.v_0"]


@pytest.mark.parametrize("unit", ["rpm", "1/min", "U/min", "deg/s"])
def test_a_unit_that_differs_is_converted(both_built, plain, tmp_path, unit):
    def change(xml):
        return xml.replace('unit="rad/s"', f'unit="{unit}"', 1)

    plant, one = tampered(plain, tmp_path / "other.fmu", change), pi / (180.0 if unit == "deg/s" else 30.0)
    for mapping in ({}, {"plant.omega_1": "omega_1"}):
        first = simulate(TIPIN, plant, folder=both_built, mapping=mapping)[0]
        assert first["plant.omega_1"] == pytest.approx(first["plant.omega_2"] * one, rel=1e-12)


def test_an_unknown_unit_is_named(both_built, tmp_path):
    plant = build_car(tmp_path / "car", T_gear=("Shaft.tau", "blub", 1.0))
    with pytest.raises(WiringError, match=r"plant\.T_gear=Shaft\.tau: .* is in 'blub', which is not a known unit"):
        simulate(TIPIN, plant, folder=both_built, mapping={"plant.T_gear": "Shaft.tau"})


def test_a_mapping_is_read_from_text_one_variable_a_name():
    assert parsed(["plant.T_gear=Shaft.tau", " plant.v_0 = Car.v.start "]) == {
        "plant.T_gear": "Shaft.tau",
        "plant.v_0": "Car.v.start",
    }
    assert parsed(["plant.T_gear=a=b"]) == {"plant.T_gear": "a=b"}
    assert parsed([]) == {}
    assert parsed(["plant.v=a", "plant.v=a"]) == {"plant.v": "a"}
    with pytest.raises(WiringError, match=r"plant\.v cannot be both a and b"):
        parsed(["plant.v=a", "plant.v=b"])


@pytest.mark.parametrize(
    ("text", "said"),
    [("ctl.tml", r"and there is no file ctl\.tml$"), ("ctl.toml", r"^ctl\.toml: there is no such file$")],
)
def test_a_file_that_is_not_there_is_named(text, said):
    with pytest.raises(WiringError, match=said):
        parsed([text])


@pytest.mark.parametrize("text", ["plant.T_gear", "T_gear=Shaft.tau", "plant.=x", ".T_gear=x", "plant.T_gear=", "=x"])
def test_another_form_of_mapping_is_refused(text):
    with pytest.raises(WiringError, match=r"is not of the form plant\.T_gear=Shaft\.tau"):
        parsed([text])
