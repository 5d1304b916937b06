"""The calibration: each parameter of the law both ways, cars that are told or not."""

import re

import pytest

from docs.studies.calibration import Found, cases, changes_table
from docs.studies.calibration_cases import (
    DEVIATIONS,
    LAW,
    SUSPECTS,
    Answer,
    Case,
    another_car,
    changed_law,
    deviation_name,
)
from driveline.harness.design.design_weights import MOTOR, PARAMETERS
from driveline.harness.design.uncertainty_box import Deviation
from driveline.harness.loop.places import PLANTS
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics
from driveline.models.controller import damping_law


def answer(value: float) -> Answer:
    return Answer(Metrics(**{metric.name: value for metric in declared(Metrics)}), fallback=0.25)  # type: ignore[arg-type]


def test_every_parameter_of_the_law_that_is_not_the_car_is_changed_within_its_bounds() -> None:
    assert set(LAW) == set(damping_law.Parameters._fields) - {"J_1", "C"}
    for name in LAW:
        low, high = PARAMETERS[name].bounds()
        for ((parameter, value),) in changed_law(name):
            assert parameter == f"controller.{name}"
            assert low <= value <= high


@pytest.mark.parametrize("deviation", DEVIATIONS, ids=deviation_name)
@pytest.mark.parametrize("plant", PLANTS)
def test_the_controller_is_told_of_another_car_or_not_and_the_car_is_the_same(plant: str, deviation: Deviation) -> None:
    unaware, assumed = map(dict, another_car(plant, deviation))
    assert unaware
    assert not [name for name in unaware if name.startswith("controller.")]
    assert {name: value for name, value in assumed.items() if not name.startswith("controller.")} == unaware


def test_a_stiffer_car_is_told_with_its_stiffness_and_gets_more_damping() -> None:
    assumed = dict(another_car("ValidationVehicle", Deviation(C=2.0))[1])
    assert assumed["controller.C"] == pytest.approx(2.0 * damping_law.Parameters().C)
    assert assumed["controller.k_d"] > damping_law.Parameters().k_d


def test_what_changes_nothing_has_no_row() -> None:
    plant, law = PLANTS[0], [("k_d", "tipin15"), ("omega_w", "tipin15")]
    found = Found()
    found.answers = dict.fromkeys(cases(law, [], [], []), answer(1.0))
    assert not changes_table(found, plant, law).rows
    found.answers[Case(plant, "tipin15", changed_law("k_d")[1])] = answer(1.2)
    rows = changes_table(found, plant, law).rows
    assert list(rows) == ["k_d / 1.5, tipin15", "k_d x 1.5, tipin15"]
    assert rows["k_d x 1.5, tipin15"][0] == pytest.approx(200.0)  # ms of the settling time


def test_a_suspect_is_as_wrong_as_its_name_says() -> None:
    usual = {"motor.tau": MOTOR.tau, "motor.g_T": 1.0, "can.g_w2": 1.0}
    named = [(suspect, re.search(r" x([\d.]+)$", suspect.what)) for suspect in SUSPECTS]
    assert sum(factor is not None for _, factor in named) >= 4
    for suspect, factor in named:
        if factor:
            name, value = suspect.parameters[0]
            assert value == pytest.approx(float(factor[1]) * usual[name])
