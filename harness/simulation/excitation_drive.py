"""The test drive: the car is excited by a pseudo-random binary torque, and recorded as its sensors see it."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import asin
from typing import Any, NamedTuple

import numpy as np

from driverecords.quantities import QUANTITIES, aliases
from fmuloop.errors import WiringError
from fmuloop.experiment import require_steps
from fmuloop.interface import Interface
from fmuloop.wiring import out_of_bounds, require
from toolground.collected_warnings import warn_once

from ..loop import roles
from ..loop.places import T_S
from ..loop.resolved import ResolvedLoop
from ..manoeuvres.manoeuvre import Manoeuvre
from ..manoeuvres.prbs import binary_torque
from ..manoeuvres.road_load import RoadLoad
from ..manoeuvres.speed_following import SIN_MAX
from ..metrics.evaluate import at_samples
from .simulate import start

MEASURED_WHEELS = roles.RIM_TORQUE
"""What measurement wheels show; a drive of a plant that has no such output is recorded without."""

RECORDED = {
    "omega_1": roles.MEASURED_MOTOR_SPEED,
    "T_mot": roles.MOTOR_TORQUE_ESTIMATE,
    "T_ref": roles.REFERENCE_TORQUE,
    "omega_wheel": roles.BUS_WHEEL_SPEED,
    "valid": roles.BUS_VALID,
    "counter": roles.BUS_COUNTER,
    "T_wheel": MEASURED_WHEELS,
}
"""The quantities of a test drive beside the time, and the output `instance.variable` from which each is recorded."""

DECIMALS = 6
"""Of the values in the file, far below what any sensor resolves."""


@dataclass(frozen=True)
class MeasurementWheels:
    """What the torque of the measurement wheels is off by, both wheels together, wheel side.

    Attributes:
        noise: standard deviation in N.m of each sample, T_S apart.
        offset: in N.m.
        gain_error: share of the torque.
    """

    noise: float = 10.0
    offset: float = 8.0
    gain_error: float = 0.01

    def measured(self, T_rim: np.ndarray, seed: int) -> np.ndarray:
        """The torque in N.m that they show of the true one between rim and hub, positive when it drives."""
        noise = np.random.default_rng(seed).standard_normal(len(T_rim))
        return (1.0 + self.gain_error) * T_rim + self.offset + self.noise * noise


def require_demand(mean: float, amplitude: float, clock: float, T_max: float) -> None:
    """Refuses a demand that the car would not follow.

    Args:
        mean, amplitude: in N.m.
        clock: in s.
        T_max: largest torque of the motor in N.m.

    Raises:
        WiringError: the motor would cut it off, or the controller would miss pulses between its samples.
    """
    if abs(mean) + amplitude > T_max:
        raise WiringError(
            f"a demand of {mean:g} +- {amplitude:g} N.m is beyond the {T_max:g} N.m of the motor (motor.T_max)"
        )
    if clock < T_S:
        raise WiringError(f"a clock of {clock:g} s is shorter than the {T_S:g} s between samples of the controller")


def require_sensors(interfaces: Mapping[str, Interface]) -> None:
    """
    Raises:
        WiringError: an FMU lacks an output that is recorded.
    """
    recorded: dict[str, list[str]] = {}
    for output in RECORDED.values():
        instance, _, name = output.partition(".")
        recorded.setdefault(instance, []).append(name)
    for instance, outputs in recorded.items():
        lacking = [name for name in outputs if name not in interfaces[instance].variables]
        if [f"{instance}.{name}" for name in lacking] == [MEASURED_WHEELS]:
            warn_once(f"{interfaces[instance].path.name} has no T_rim: recorded without measurement wheels")
        elif lacking:
            raise WiringError(
                f"{interfaces[instance].path} has no {', '.join(lacking)}; a test drive records {', '.join(outputs)}"
            )


class PlannedDrive(NamedTuple):
    """A test drive before it is driven, the road load of the plant, and the slope in rad on which it keeps speed."""

    manoeuvre: Manoeuvre
    load: RoadLoad
    slope: float


def planned(resolved: ResolvedLoop, demand: Mapping[str, Any], v_0: float) -> PlannedDrive:
    """A test drive of a loop under a pseudo-random binary torque.

    Args:
        demand: arguments of `harness.manoeuvres.prbs.binary_torque`: mean, amplitude, clock, order and duration.
        v_0: speed in m/s.

    Raises:
        WiringError: the FMUs do not have what is recorded, or nobody can drive so.
    """
    settings = resolved.settings
    require_sensors(resolved.fit.interfaces)
    require_steps(demand["duration"], settings.step_size)
    require_demand(demand["mean"], demand["amplitude"], demand["clock"], resolved.T_max)
    load = RoadLoad.of(resolved)
    slope = holding_slope(load, demand["mean"], v_0)
    manoeuvre = binary_torque("prbs", **demand, v_0=v_0, slope=slope)
    require(out_of_bounds(resolved.fit, {**start(manoeuvre), **settings.parameters}))
    return PlannedDrive(manoeuvre, load, slope)


def holding_slope(load: RoadLoad, mean: float, v_0: float) -> float:
    """Slope in rad of the road on which a mean torque (N.m) holds a speed (m/s), but for the friction that the balance
    of forces along the road does not know.

    Raises:
        WiringError: it would be steeper than any road.
    """
    surplus = load.motor_force(np.array(mean)) - load.motion(np.full(2, v_0), T_S)[0]
    sine = float(surplus) / (load.m * load.g)
    if abs(sine) > SIN_MAX:
        raise WiringError(
            f"a mean torque of {mean:g} N.m holds {3.6 * v_0:g} km/h on a slope of {100.0 * sine:.0f} % only; "
            f"at most {100.0 * SIN_MAX:.0f} % can be"
        )
    return asin(sine)


def sensed(results: np.ndarray, i: float, wheels: MeasurementWheels, seed: int) -> np.ndarray:
    """What the sensors of the car have recorded, every T_S: a field for each column of the file, with its unit in
    brackets, as `driverecords` reads it.

    The speed of the wheels is that of the last message, its validity and counter as received. The torque demand is what
    motor control receives at the sample and holds until the next.

    Args:
        results: of a run of the loop.
        i: gear ratio.
        seed: of the noise of the measurement wheels.
    """
    sampled = at_samples(results)
    there = {quantity: output for quantity, output in RECORDED.items() if output in (sampled.dtype.names or ())}
    columns = {"time": sampled["time"]} | {quantity: sampled[output] for quantity, output in there.items()}
    columns["omega_wheel"] = columns["omega_wheel"] / i
    if "T_wheel" in columns:
        columns["T_wheel"] = wheels.measured(columns["T_wheel"], seed)
    names = aliases()
    headings = [f"{names[quantity][0]} [{QUANTITIES[quantity].unit}]" for quantity in columns]
    whole = ("valid", "counter")
    kinds = [(heading, int if q in whole else float) for heading, q in zip(headings, columns, strict=True)]
    recording = np.empty(len(sampled), dtype=kinds)
    for heading, values in zip(headings, columns.values(), strict=True):
        recording[heading] = np.round(values.astype(float), DECIMALS)
    return recording
