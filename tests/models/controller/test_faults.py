"""Wrong motor speeds in the loop, on both plants: found, kept out, and forgotten when they are over."""

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from fmutesting.slow import slow

from docs.studies import monolithic
from driveline.harness.metrics.spectrum import band_rms
from driveline.models import two_mass_driveline, validation_vehicle
from driveline.models.controller.causes import WRONG_LAUNCH
from driveline.models.controller.supervision import FALLBACK
from fmublocks.block.types import ContinuousBlock

V_0 = 15.0
ONSET, END, DURATION = 0.3, 0.9, 1.5
FOUND, BACK = 0.05, 0.5
"""Times in s within which a fault is found, and forgotten after its end."""

FAULTS: dict[str, Callable[[float], float]] = {
    "stuck at 0": lambda omega_1: 0.0,
    "200 rad/s more": lambda omega_1: omega_1 + 200.0,
    "100 rad/s less": lambda omega_1: omega_1 - 100.0,
    "halved": lambda omega_1: 0.5 * omega_1,
    "wrong sign": lambda omega_1: -omega_1,
    "no number": lambda omega_1: math.nan,
}

both_plants = pytest.mark.parametrize(
    "plant",
    slow([two_mass_driveline.BLOCK, validation_vehicle.BLOCK], but=(two_mass_driveline.BLOCK,)),
    ids=lambda block: block.name,
)


@cache
def simulated(plant: ContinuousBlock, T_driver: float, enable: bool = True, fault: str | None = None) -> np.ndarray:
    def received(t: float, sent: Any) -> Any:
        faulty = fault is not None and ONSET <= t < END
        return sent._replace(omega_1_meas=FAULTS[fault or ""](sent.omega_1_meas)) if faulty else sent

    parameters = {"plant": {"v_0": V_0, "T_0": T_driver}}
    return monolithic.run(plant, lambda k: (T_driver, 0.0, 0.0), DURATION, parameters, enable, received)


@both_plants
@pytest.mark.parametrize("fault", FAULTS)
def test_a_wrong_speed_of_a_coasting_car_leads_to_fallback_for_as_long_as_it_lasts(
    plant: ContinuousBlock, fault: str
) -> None:
    """And half a second later all is as if it had never been."""
    y, healthy = simulated(plant, 0.0, fault=fault), simulated(plant, 0.0)
    t, fallback = y["time"], y["controller.status"] == FALLBACK
    assert all(fallback[(t >= ONSET + FOUND) & (t < END)])
    assert not any(fallback[(t < ONSET) | (t >= END + BACK)])
    kick = abs(y["controller.T_damp"] - healthy["controller.T_damp"])
    assert kick[t >= END].max() < 2.0


@both_plants
@pytest.mark.parametrize("fault", ["wrong sign", "halved"])
def test_a_wrong_speed_under_torque_does_not_shake_the_gear(plant: ContinuousBlock, fault: str) -> None:
    """By more than 1.2 times what it does without control, or than the noise of the sensors makes it with control."""
    y, alone, healthy = (
        simulated(plant, 40.0, fault=fault),
        simulated(plant, 40.0, enable=False),
        simulated(plant, 40.0),
    )
    shaken, *others = (band_rms(run["plant.T_gear"], monolithic.INTERVAL) for run in (y, alone, healthy))
    assert shaken < 1.2 * max(others) + 0.1
    assert max(others) < 0.2


def launched(plant: ContinuousBlock, rise: float, enable: bool = True, wrong: bool = False) -> np.ndarray:
    """From rest to 120 N.m within so many seconds, with the wrong sign of the motor speed from the first on."""

    def signals(k: int) -> tuple[float, float, float]:
        return 120.0 * min(max(k * monolithic.INTERVAL - 0.1, 0.0) / rise, 1.0), 0.0, 0.0

    def received(t: float, sent: Any) -> Any:
        return sent._replace(omega_1_meas=-sent.omega_1_meas) if wrong else sent

    return monolithic.run(plant, signals, 1.0, {"plant": {"v_0": 0.0}}, enable, received)


@both_plants
@pytest.mark.parametrize(("rise", "most"), [(0.1, 1.2), (1.0, 1.4)])
def test_a_launch_with_a_motor_speed_of_the_wrong_sign_does_not_shake_the_gear(
    plant: ContinuousBlock, rise: float, most: float
) -> None:
    """Below the least wheel speed no message contradicts; but the motor sets off against its torque. A slow one shakes
    the gear little without control, and the landing has begun when it is found."""
    y, alone = launched(plant, rise, wrong=True), launched(plant, rise, enable=False)
    fallback = y["controller.status"] == FALLBACK
    assert all(fallback[(y["time"] > 0.2) & (y["time"] < 0.8)])
    assert set(y["controller.cause"][fallback]) == {WRONG_LAUNCH}
    shaken, usual = (band_rms(run["plant.T_gear"], monolithic.INTERVAL) for run in (y, alone))
    assert shaken < most * usual


@both_plants
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_damping_that_is_switched_on_at_speed_acts_as_one_that_was_always_on(
    plant: ContinuousBlock, way: float
) -> None:
    """In a tip-in half a second later, forwards and backwards."""
    demand = ([0.1, 0.2, 1.0, 1.1, 1.5 - 1e-9, 1.5], [0.0, 100.0, 100.0, -12.0, -12.0, 100.0])

    def signals(k: int) -> tuple[float, float, float]:
        return way * float(np.interp(k * monolithic.INTERVAL, *demand)), 0.0, 0.0

    def swing(enabled_from: float) -> float:
        def received(t: float, sent: Any) -> Any:
            return sent._replace(enable=t >= enabled_from)

        y = monolithic.run(plant, signals, 2.2, {"plant": {"v_0": 0.0}}, received=received)
        return band_rms(y["plant.T_gear"][y["time"] >= 1.5], monolithic.INTERVAL)

    late, always, never = map(swing, (1.0, 0.0, 9.0))
    assert late == pytest.approx(always, rel=0.05)
    assert late < 0.7 * never
