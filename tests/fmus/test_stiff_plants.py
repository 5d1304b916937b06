"""Stops with hard brakes and bristles, in both builds: finite, within the capacity of the brake, at any step."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from fmutesting.host import Host, opened
from fmutesting.together import together

from driveline.models.physics.plant import Output

DURATION, STEP = 0.2, 1e-3


class Stop(NamedTuple):
    """A plant, its parameters and how it is braked."""

    plant: str
    parameters: Mapping[str, float]
    T_brake: float
    slope: float = 0.0


DESIGN, VEHICLE = "TwoMassDriveline", "ValidationVehicle"
SHORT_BRISTLES = {"z_br": 1e-4, "J_2": 0.001, "i": 1.0, "t_br": 0.1}

STOPS = [
    Stop(DESIGN, SHORT_BRISTLES, 1500.0),
    Stop(DESIGN, SHORT_BRISTLES, 20000.0),
    *(Stop(DESIGN, {"z_br": z_br}, 1500.0) for z_br in (1.5e-3, 1e-4)),
    *(Stop(VEHICLE, {"z_br": z_br}, 1500.0) for z_br in (5e-4, 1e-4)),
    *(Stop(plant, {}, T_brake) for plant in (DESIGN, VEHICLE) for T_brake in (12_400.0, 20_000.0)),
    Stop(DESIGN, {"i": 1.5}, 8000.0, slope=0.2),
]

every_stop = together("stop", STOPS)


def simulated(host: Host, stop: Stop, step_size: float) -> np.ndarray:
    """The outputs every millisecond, a row each: rolling at 1 m/s, then braked."""
    references = [host.variables[name].valueReference for name in Output._fields]
    host.initialize(v_0=1.0, **stop.parameters)
    host.set(T_brake=stop.T_brake, slope=stop.slope)
    each, rows = round(STEP / step_size), []
    for k in range(round(DURATION / step_size)):
        host.step(k * step_size, step_size)
        if (k + 1) % each == 0:
            rows.append(host.fmu.getReal(references))
    host.fmu.reset()
    return np.array(rows)


@pytest.fixture(scope="module")
def unpacked_once(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("unpacked")


def run(folder: Path, unpacked: Path, stop: Stop, step_size: float = STEP) -> np.ndarray:
    with opened(folder / f"{stop.plant}.fmu", unpacked / f"{folder.name}-{stop.plant}") as host:
        return simulated(host, stop, step_size)


@every_stop
def test_a_stop_is_finite_and_no_brake_has_more_than_its_capacity(
    native: Path, unpacked_once: Path, stop: Stop
) -> None:
    rows = run(native, unpacked_once, stop)
    assert np.isfinite(rows).all()
    T_load, T_rim = rows[:, Output._fields.index("T_load")], rows[:, Output._fields.index("T_rim")]
    braking = -stop.parameters.get("i", 9.0) * T_load - T_rim
    assert np.abs(braking).max() <= stop.T_brake * (1.0 + 1e-9)
    assert braking.max() > 1000.0, "it does brake"


@every_stop
def test_a_stop_does_not_depend_on_the_communication_step(native: Path, unpacked_once: Path, stop: Stop) -> None:
    """Twist and slip of what is stiff are as exact as all states are; the torque of it is less so."""
    coarse, fine = (run(native, unpacked_once, stop, step_size) for step_size in (STEP, 0.1 * STEP))
    share = np.array([1e-2 if name.startswith("T_") else 1e-3 for name in Output._fields])
    assert (np.abs(coarse - fine) <= share * np.ptp(fine, axis=0) + 1e-6).all()


@pytest.mark.slow
@every_stop
def test_both_builds_stop_alike_bit_by_bit(built: Path, native: Path, unpacked_once: Path, stop: Stop) -> None:
    assert (run(built, unpacked_once, stop) == run(native, unpacked_once, stop)).all()
