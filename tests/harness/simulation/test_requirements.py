"""What the damping must reach on both plants, by the metrics of the specification, in the loop of FMUs.

The figures are those of a reference study of the same specification (its best controller); the
requirement is to come within a quarter of them. Where a run is quiet beyond that, so much the better.
"""

from pathlib import Path

import pytest

from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import simulate

QUARTER = 1.25

STUDIED = (
    "settling_time", "overshoot", "response_delay", "withheld_time", "gear_torque_rms", "jerk_rms_to_50_Hz"
)  # fmt: skip

STEPS = {
    ("TwoMassDriveline", "tipin15"): (0.114, 0.19, 0.058, 0.012, 4.2, 5.3),
    ("TwoMassDriveline", "tipout"): (0.070, 0.08, 0.064, 0.008, 3.8, 3.7),
    ("TwoMassDriveline", "launch"): (0.136, 0.11, 0.113, 0.008, 2.7, 4.6),
    ("ValidationVehicle", "tipin15"): (0.101, 0.17, 0.062, 0.013, 3.8, 12.2),
    ("ValidationVehicle", "tipin50"): (0.115, 0.06, 0.072, 0.013, 3.0, 10.8),
    ("ValidationVehicle", "tipout"): (0.111, 0.09, 0.079, 0.009, 2.8, 12.4),
    ("ValidationVehicle", "launch"): (0.121, 0.06, 0.116, 0.008, 2.2, 5.4),
}

PRICE = {("ValidationVehicle", "tipout", "response_delay"): 1.4}
"""Of the shaped demand: the first swing just misses 90 % (docs/control.md, "What stands against what")."""

# gear_torque_rms, jerk_rms_to_50_Hz
RECORDS = {
    ("TwoMassDriveline", "drive"): (2.1, 4.0),
    ("ValidationVehicle", "drive"): (1.8, 9.2),
    ("TwoMassDriveline", "creep"): (1.6, 2.1),
    ("ValidationVehicle", "creep"): (1.6, 6.9),
    ("TwoMassDriveline", "prbs"): (5.9, 7.8),
    ("ValidationVehicle", "prbs"): (5.7, 23.6),
}


def run(plant: str, name: str, native: Path, control: bool = True) -> Metrics:
    manoeuvre = MANOEUVRES[name]
    return evaluate(simulate(manoeuvre, plant=plant, folder=native.parent, control=control), manoeuvre)


@pytest.mark.parametrize(("plant", "name"), STEPS)
def test_steps_settle_as_in_the_study_and_leave_the_stationary_torque_alone(
    plant: str, name: str, native: Path
) -> None:
    m = run(plant, name, native)
    for metric, reference in zip(STUDIED, STEPS[plant, name], strict=True):
        assert getattr(m, metric) <= PRICE.get((plant, name, metric), QUARTER) * reference, metric
    assert abs(m.stationary_torque_change) <= QUARTER * 0.03, "stationary torque unchanged; the study: at most 0.03 N.m"
    assert m.end_swing < 0.5, "quiet at the end"


@pytest.mark.parametrize(("plant", "name"), RECORDS)
def test_uneven_driving_is_damped_as_in_the_reference_study(plant: str, name: str, native: Path) -> None:
    m = run(plant, name, native)
    gear_torque_rms, jerk_rms_to_50_Hz = RECORDS[plant, name]
    assert m.gear_torque_rms <= QUARTER * gear_torque_rms
    assert m.jerk_rms_to_50_Hz <= QUARTER * jerk_rms_to_50_Hz
    if name == "drive":
        assert m.plateau_swing <= QUARTER * {"TwoMassDriveline": 0.17, "ValidationVehicle": 0.20}[plant]


def test_without_control_the_design_model_swings_for_seconds(native: Path) -> None:
    m = run("TwoMassDriveline", "tipin15", native, control=False)
    assert m.settling_time == pytest.approx(1.758, rel=0.05), "the study: 1758 ms"
    assert m.overshoot == pytest.approx(1.16, rel=0.05)
