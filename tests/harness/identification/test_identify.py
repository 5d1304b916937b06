"""From a recording to the drive train: what it is, and what a recording does not tell."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from driveline.harness.identification.car_file import identified_car
from driveline.harness.identification.identify import WITHOUT_LOAD, Identified, nrmse
from driveline.harness.identification.prior_knowledge import identify
from driveline.harness.manoeuvres.prbs import binary_torque
from driveline.harness.simulation.excitation_drive import MeasurementWheels, sensed
from driveline.harness.simulation.simulate import simulate
from driverecords.measurement import Measurement, read_measurement
from toolground.csv_file import write_csv

RECORDED = Path(__file__).parents[4] / "shared/data/prbs"
"""Of a loop that nobody here has made."""

TRUE = {
    "a": {"J_2": 0.37, "C": 99.0, "phi_B": 0.110, "late_T": 0.0, "late_L": 0.0},
    "b": {"J_2": 0.22, "C": 160.0, "phi_B": 0.210, "late_T": -0.001, "late_L": -0.001},
    "c": {"J_2": 0.55, "C": 75.0, "phi_B": 0.060, "late_T": 0.0, "late_L": -0.0005},
}

WITHIN = {"J_2": 0.02, "C": 0.003, "phi_B": 0.01}
"""Relative errors that are allowed; of a skew .2 ms."""


@pytest.mark.parametrize("name", TRUE)
@pytest.mark.skipif(not RECORDED.exists(), reason=f"{RECORDED} is not there")
@pytest.mark.slow
def test_cars_of_a_loop_of_others_are_found_with_their_skews(name: str) -> None:
    one = identify(read_measurement(RECORDED / f"{name}.csv", 9.0, 0.29))
    p, true = one.p, TRUE[name]
    for parameter, within in WITHIN.items():
        assert getattr(p, parameter) == pytest.approx(true[parameter], rel=within), parameter
    assert (p.late_T, p.late_L) == pytest.approx((true["late_T"], true["late_L"]), abs=2e-4)
    assert identified_car(one)["C"] == pytest.approx(true["C"], rel=WITHIN["C"])
    named = {"a": [], "b": ["motor speed comes 1.0 ms late"], "c": ["load torque comes 0.5 ms early"]}[name]
    assert [text.partition(" (")[0].partition(",")[0] for text in one.warnings] == named


Driven = Callable[..., Measurement]


@pytest.fixture(scope="module")
def driven(both_built: Path, tmp_path_factory: pytest.TempPathFactory) -> Driven:
    """A test drive of the validation vehicle, as `driveline record` writes it."""

    @cache
    def recording(amplitude: float = 30.0, mean: float = 10.0, duration: float = 10.0) -> Measurement:
        manoeuvre = binary_torque("drive", mean, amplitude, 0.04, 9, duration, 15.0 / 3.6)
        results = simulate(manoeuvre, "ValidationVehicle", control=False, seed=104, folder=both_built)
        path = tmp_path_factory.mktemp("recorded") / "drive.csv"
        write_csv(sensed(results, 9.0, MeasurementWheels(), 104), path)
        return read_measurement(path, 9.0, 0.29)

    return recording


@pytest.fixture(scope="module")
def vehicle(driven: Driven) -> Identified:
    return identify(driven())


@pytest.mark.slow
def test_of_the_detailed_vehicle_gap_and_frequency_are_found_and_what_the_model_lacks_is_said(
    vehicle: Identified,
) -> None:
    """True are .157 rad and 8.00 Hz; C of the design is 117.4, and the wheels alone are no J_2 for it."""
    assert vehicle.plant_fit
    assert vehicle.plant_fit.plant == "ValidationVehicle"
    assert vehicle.plant_fit.values["phi_B"] == pytest.approx(0.157, rel=0.01)
    assert vehicle.resonance == pytest.approx(8.00, rel=0.01)
    entries = identified_car(vehicle)
    assert entries["C"] == pytest.approx(117.4, rel=0.03)
    assert "J_2" not in entries
    assert [text.partition(":")[0].partition(" finds ")[0] for text in vehicle.warnings] == [
        "two masses and a tyre do not explain all of this car",
        "the gap of two masses is not that of this car",
    ]
    assert entries["phi_B"] == pytest.approx(vehicle.plant_fit.values["phi_B"], rel=1e-5)


@pytest.mark.slow
def test_without_load_torque_the_inertia_carries_the_vehicle(driven: Driven) -> None:
    """True is 8.00 Hz. A model that lacks so much has a likelihood with many minima: a part in 1e13 of the torque, or
    another processor, takes the answer from 7.67 to 7.83 Hz, and J_2 from 1.2 to 1.6 kg.m2."""
    one = identify(replace(driven(), T_load=None))
    assert one.name == WITHOUT_LOAD
    assert 0.8 < one.p.J_2 < 2.5
    assert one.resonance == pytest.approx(8.00, rel=0.05)
    assert one.found.p.c_t == 0.0
    assert one.p.phi_B < 0.9 * 0.157, "tyres and mounts unwind within the gap"
    assert identified_car(one)["phi_B"] == pytest.approx(0.157, rel=0.01)
    assert one.warnings[-1].startswith("without load torque: phi_B = 0.1")


@pytest.mark.slow
def test_of_a_weak_drive_what_it_does_not_tell_is_named_and_no_cause(driven: Driven) -> None:
    warnings = identify(driven(10.0, mean=25.0)).warnings
    assert any("the gap is not crossed and phi_B is not told" in text for text in warnings)
    causes = ("looks", "early", "late")
    assert [text for text in warnings if any(cause in text for cause in causes)] == []


def test_an_offset_of_the_load_torque_is_no_error_of_the_prediction() -> None:
    signal = np.sin(np.arange(100.0))
    assert nrmse(signal * 0.0 + 3.0, signal, centred=True) == 100.0
    assert nrmse(signal * 0.1, signal, centred=True) == pytest.approx(90.0, abs=0.1)
    assert nrmse(signal * 0.0 + 3.0, signal) < 0.0
