"""The calibration page: each parameter of the law both ways, cars that are told or not, and the same each time."""

import re
from math import nan
from pathlib import Path

import pytest

from docs.studies.calibration import (
    DEVIATIONS,
    LAW,
    SUSPECTS,
    Answer,
    Case,
    another_car,
    answered,
    cases,
    changed_law,
    deviation_name,
)
from docs.studies.calibration_figure import plot_calibration
from docs.studies.calibration_page import page
from docs.studies.calibration_tables import COLUMNS, matters, signed
from driveline.harness.design.design_weights import MOTOR, PARAMETERS
from driveline.harness.design.uncertainty_box import Deviation
from driveline.harness.loop.places import NATIVE, PLANTS
from driveline.harness.loop.settings import Settings
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics
from driveline.models.controller import damping_law


def answer(value: float) -> Answer:
    return Answer(Metrics(**{metric.name: value for metric in declared(Metrics)}), fallback=0.25)  # type: ignore[arg-type]


def test_every_parameter_of_the_law_that_is_not_the_car_is_changed_within_its_bounds() -> None:
    assert set(LAW) == set(damping_law.Parameters._fields) - {"J_1", "C", "phi_B"}
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


@pytest.mark.slow
def test_less_damping_overshoots_more_and_pulls_away_sooner(both_built: Path) -> None:
    less = changed_law("k_d")[0]
    settings = Settings(folder=both_built, build=NATIVE)
    found = [answered(Case("TwoMassDriveline", "launch", given), (1,), settings) for given in ((), less)]
    default, soft = (each.metrics for each in found)
    assert soft.overshoot > 1.5 * default.overshoot
    assert soft.response_delay < default.response_delay
    assert [each.fallback for each in found] == [0.0, 0.0]


def test_the_page_tells_all_cases_and_is_the_same_each_time() -> None:
    found = {case: answer(1.0 + 0.01 * k) for k, case in enumerate(cases())}
    text = page(found)
    assert text == page(found)
    assert all(f"| `{name}` | tipin15 |" in text for name in LAW)
    assert all(f"| {deviation_name(deviation)} | launch |" in text for deviation in DEVIATIONS)
    assert "25.0 %" in text


def test_what_changes_nothing_has_no_row() -> None:
    found = dict.fromkeys(cases(), answer(1.0))
    assert not any(matters(found, "TwoMassDriveline", "tipin15", name) for name in LAW)
    found[Case("TwoMassDriveline", "tipin15", changed_law("k_d")[1])] = answer(1.2)
    assert matters(found, "TwoMassDriveline", "tipin15", "k_d")


def test_a_change_has_its_sign_unless_it_is_nothing() -> None:
    settling = COLUMNS["settling_time"]
    assert [signed(change, settling) for change in (0.012, -0.012, 0.0001, -0.0001, nan)] == [
        "+12",
        "-12",
        "0",
        "0",
        "-",
    ]


@pytest.mark.slow
def test_the_figure_is_the_same_each_time(tmp_path: Path) -> None:
    found = {case: answer(1.0 + 0.01 * k) for k, case in enumerate(cases())}
    first, second = (plot_calibration(found, "TwoMassDriveline", tmp_path / name)[0] for name in ("a", "b"))
    assert first.read_bytes() == second.read_bytes()


def test_a_suspect_is_as_wrong_as_its_name_says() -> None:
    usual = {"motor.tau": MOTOR.tau, "motor.g_T": 1.0, "can.g_w2": 1.0}
    named = [(suspect, re.search(r" x([\d.]+)$", suspect.what)) for suspect in SUSPECTS]
    assert sum(factor is not None for _, factor in named) >= 4
    for suspect, factor in named:
        if factor:
            name, value = suspect.given[0]
            assert value == pytest.approx(float(factor[1]) * usual[name])
