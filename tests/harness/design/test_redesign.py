"""Gains for a car that has become known are softened until they are no worse than those before."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from driveline.harness.design import redesign
from driveline.harness.design.design import design
from driveline.harness.design.design_weights import WEIGHTS
from driveline.harness.design.redesign import MARGIN, REDESIGN_MANOEUVRES, SOFTER, SOFTEST, softened, worth
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.simulation.simulate import simulate

CAR = {"C": 90.0}


@pytest.fixture
def overshoot(monkeypatch: pytest.MonkeyPatch) -> dict[str, float]:
    """Before, and by plant for each rad/s of the washout; twice that in one manoeuvre."""
    of = {"before": 0.1, **dict.fromkeys(PLANTS, 0.0)}

    def pretended(
        plant: str, manoeuvre: str, car: Mapping[str, Any], assumed: Mapping[str, Any], settings: Settings | None
    ) -> tuple[float, float]:
        assert car == CAR
        return 0.1, (of["before"] if "omega_w" not in assumed else of[plant] * assumed["omega_w"]) * (
            2.0 if manoeuvre == REDESIGN_MANOEUVRES[0] else 1.0
        )

    monkeypatch.setattr(redesign, "worth", pretended)
    return of


OMEGA_W = design(CAR)["omega_w"]


@pytest.mark.parametrize("plant", PLANTS)
@pytest.mark.parametrize(("times", "steps"), [(0.999, 0), (1.001, 1), (0.999 / SOFTER, 1), (1.001 / SOFTER, 2)])
def test_the_washout_is_lowered_until_the_overshoot_is_less_on_both_plants(
    overshoot: dict[str, float], plant: str, times: float, steps: int
) -> None:
    overshoot[plant] = times * MARGIN * overshoot["before"] / OMEGA_W
    weights = softened(CAR, {})
    assert weights.washout == pytest.approx(SOFTER**steps * WEIGHTS.washout)
    assert {**vars(weights), "washout": 0.0} == {**vars(WEIGHTS), "washout": 0.0}


def test_it_is_not_lowered_without_end(overshoot: dict[str, float]) -> None:
    overshoot[PLANTS[0]] = 100.0
    least = softened(CAR, {}).washout / WEIGHTS.washout
    assert SOFTEST <= least < SOFTEST / SOFTER


def test_what_a_controller_is_worth_depends_on_the_car_and_on_what_it_is_told(
    both_built: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = []

    def noted(manoeuvre: Manoeuvre, settings: Settings) -> Any:
        given.append(settings)
        return simulate(manoeuvre, settings)

    monkeypatch.setattr("driveline.harness.design.design_trials.simulate", noted)
    car, gains, settings = {"C": 90.0}, design({"C": 90.0}), Settings(folder=both_built)
    settling, overshoot = worth("TwoMassDriveline", "tipin15", car, {}, settings)
    assert worth("TwoMassDriveline", "tipin15", car, {**car, **gains}, settings) != (settling, overshoot)
    assert [made.folder for made in given] == [both_built, both_built]
    first, second = (made.parameters for made in given)
    assert first["plant.C"] == second["plant.C"] == second["controller.C"] == 90.0
    assert second["controller.k_d"] == gains["k_d"]
    assert first.get("controller.C") != 90.0
    assert 0.02 < settling < 0.5
    assert 0.0 <= overshoot < 0.5
