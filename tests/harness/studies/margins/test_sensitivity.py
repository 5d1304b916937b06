"""Sensitivities are relative changes, of every parameter that can be changed."""

from math import isnan

import pytest

from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.studies.margins.sensitivity import SHOWN, sensitivity, varied


def metrics(value: float) -> Metrics:
    return Metrics(**{metric.name: value for metric in declared(Metrics)})  # type: ignore[arg-type]


def test_a_metric_that_grows_like_the_square_changes_by_two_percent_for_one() -> None:
    found = sensitivity("plant", "tipin15", "plant.C", [metrics(0.9**2), metrics(1.0), metrics(1.1**2)])
    assert found.changes == pytest.approx(dict.fromkeys(SHOWN, 2.0))
    assert found.largest == pytest.approx(2.0)


def test_a_metric_without_a_value_has_no_sensitivity() -> None:
    found = sensitivity("plant", "tipin15", "plant.C", [metrics(1.0), metrics(0.0), metrics(1.0)])
    assert all(isnan(change) for change in found.changes.values())
    assert found.largest == 0.0


def test_car_and_controller_are_changed_apart_and_within_their_bounds() -> None:
    found = varied("TwoMassDriveline", "DampingController", {"plant.C": 100.0, "controller.k_gap": 1.9})
    assert found["plant.C"] == 100.0
    assert found["controller.C"] == 117.4
    assert "controller.k_gap" not in found, "1.1 times 1.9 is beyond 2"
    assert "plant.v_0" not in found, "the manoeuvre sets it"
    assert "motor.o_T" not in found, "10 % of nothing is nothing"
