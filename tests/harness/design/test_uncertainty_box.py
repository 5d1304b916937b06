"""The box of parameters: its corners, and what a deviation changes of the loop."""

from itertools import combinations

import pytest

from driveline.harness.design.design_trials import loop_parameters
from driveline.harness.design.uncertainty_box import BOX, LOSS, NOMINAL, Deviation, corner, deviating, screening

DESIGN_MODEL, VEHICLE, OURS = "TwoMassDriveline", "ValidationVehicle", "DampingController"


def test_every_factor_is_high_in_half_of_the_runs_and_so_is_each_pair_balanced() -> None:
    runs = screening()
    assert len(set(runs)) == len(runs) == 12
    for first, second in combinations(range(11), 2):
        assert sorted((run[first], run[second]) for run in runs) == sorted(
            [(low, high) for low in (False, True) for high in (False, True)] * 3
        )


def test_a_corner_is_at_the_bounds_of_every_parameter() -> None:
    high = {name: k % 2 == 0 for k, name in enumerate(BOX)}
    found = corner(high)._asdict()
    assert found.pop("loss") == LOSS
    assert found == {name: BOX[name][high[name]] for name in BOX}
    assert found["J_2"] == 2.0
    assert found["C"] == 0.5


def test_without_deviation_the_loop_is_that_of_the_car() -> None:
    van = {"J_1": 0.09, "tau": 0.004, "k_d": 2.0}
    assert deviating(van, VEHICLE, OURS, NOMINAL) == loop_parameters(van, VEHICLE)


@pytest.mark.parametrize(
    ("plant", "expected"),
    [
        (DESIGN_MODEL, {"plant.J_2": 0.6, "plant.C": 58.7, "plant.m": 725.0}),
        (
            VEHICLE,
            {
                "plant.J_w": 3.6, "plant.J_g": 0.2, "plant.k_s": 12900.0, "plant.k_g": 60000.0, "plant.k_p": 35000.0,
                "plant.m": 725.0, "plant.F_z0": 4250.0, "plant.J_y": 800.0,
            },
        ),
    ],
)  # fmt: skip
def test_the_plant_deviates_and_the_controller_is_not_told(plant: str, expected: dict[str, float]) -> None:
    assert deviating({}, plant, OURS, Deviation(J_2=2.0, C=0.5, m=0.5)) == pytest.approx(expected)


def test_a_factor_is_on_what_the_car_has() -> None:
    given = deviating({"tau": 0.004, "phi_B": 0.1}, DESIGN_MODEL, OURS, Deviation(tau=1.5, phi_B=0.0))
    assert given == {
        "motor.tau": pytest.approx(0.006), "controller.tau": 0.004, "plant.phi_B": 0.0, "controller.phi_B": 0.1
    }  # fmt: skip


def test_the_sensors_deviate() -> None:
    found = deviating({}, DESIGN_MODEL, OURS, Deviation(g_T=1.1, o_T=-1.5, g_w2=0.98, loss=0.1))
    assert found == {"motor.g_T": 1.1, "motor.o_T": -1.5, "can.g_w2": 0.98, "can.loss": 0.1}


@pytest.mark.parametrize(
    ("delay", "shortest", "longest"),
    [(0.0, 0.001, 0.001), (0.005, 0.001, 0.01), (0.0105, 0.001, 0.0205), (0.04, 0.03, 0.05)],
)
def test_the_transport_delay_spreads_as_far_as_it_can(delay: float, shortest: float, longest: float) -> None:
    found = {"can.d_min": 0.001, "can.d_max": 0.025} | deviating({}, VEHICLE, OURS, Deviation(delay=delay))
    assert found == pytest.approx({"can.d_min": shortest, "can.d_max": longest})
