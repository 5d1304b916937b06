"""What is known of the parameters before a recording is seen, and how they are searched: positive ones by their
logarithm, the others in a unit of their own."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from .drive_train import DELAYS, Parameters
from .model_inputs import LATEST


class Prior(NamedTuple):
    """What is known of a parameter before a recording is seen.

    Attributes:
        meaning: in words of the car.
        unit: of the parameter, as in Modelica.
        deviation: standard deviation, in that unit; of a positive parameter that of its logarithm.
        source: of that number.
        positive: whether it is; else it is searched as it is.
        centre: the most likely value; None: that of the start.
    """

    meaning: str
    unit: str
    deviation: float
    source: str
    positive: bool = True
    centre: float | None = None


_TORQUES = "torque estimates are right to 5 %", "measurement wheels are right to some per cent"
_SKEW = "tasks and buses of loggers are some ms apart"
_LACK = "from the rounding of the filter to a wrong model"

PRIORS: Mapping[str, Prior] = {
    "J_1": Prior("inertia of the motor", "kg.m2", 0.5, "data sheet of the motor"),
    "J_2": Prior("inertia of the wheels", "kg.m2", 2.0, "from bare wheels to a vehicle that does not slip"),
    "C": Prior("stiffness", "N.m/rad", 1.0, "cars shuffle at 2 to 12 Hz"),
    "d": Prior("damping", "N.m.s/rad", 1.0, "damping ratios of drive trains are below .3", positive=False),
    "phi_B": Prior("half the gap", "rad", 2.0, "from a new gear to a worn one"),
    "g_T": Prior("gain of the motor torque", "1", 0.05, _TORQUES[0], centre=1.0),
    "g_L": Prior("gain of the load torque", "1", 0.05, _TORQUES[1], centre=1.0),
    "late_T": Prior("delay of the motor torque", "s", 2e-3, _SKEW, positive=False, centre=0.0),
    "late_L": Prior("delay of the load torque", "s", 2e-3, _SKEW, positive=False, centre=0.0),
    "c_t": Prior("stiffness of the tyre", "N.m/rad", 1.5, "tyres of cars"),
    "sigma_t": Prior("relaxation length of the tyre", "rad", 1.5, "tyres of cars"),
    "lack_1": Prior("what the equation of the motor speed lacks", "rad/s", 4.0, _LACK),
    "lack_phi": Prior("what that of the twist lacks", "rad", 4.0, _LACK),
    "lack_L": Prior("what that of the tyre lacks", "N.m", 4.0, _LACK),
}

OF_CAR = tuple(name for name in PRIORS if not name.startswith("lack_"))
"""Of car and logger, and not of the model."""

LEAST = {"d": 0.0, "lack_1": 1e-3, "lack_phi": 1e-5, "lack_L": 0.01}
"""Least values, in their units: no damper drives, and below a hundredth of its noise nothing of a channel is told."""

UNIT = {"d": 0.1, **dict.fromkeys(DELAYS, 1e-3)}
"""Of what is searched as it is."""


def scales(p: Parameters, free: Sequence[str]) -> np.ndarray:
    """Derivative of each free parameter by what is searched."""
    return np.array([UNIT.get(name) or getattr(p, name) for name in free])


def before(free: Sequence[str]) -> np.ndarray:
    """Information about what is searched before a recording is seen."""
    return np.array([(UNIT.get(name, 1.0) / PRIORS[name].deviation) ** 2 for name in free])


def surprise(p: Parameters, free: Sequence[str], centre: Parameters) -> np.ndarray:
    """How far what is searched is from what was expected."""
    off = []
    for name in free:
        value, prior = getattr(p, name), PRIORS[name]
        expected = getattr(centre, name) if prior.centre is None else prior.centre
        off.append(np.log(value / expected) if prior.positive else (value - expected) / UNIT[name])
    return np.array(off)


def moved(p: Parameters, free: Sequence[str], by: np.ndarray) -> Parameters:
    """A step, within bounds."""
    values = {
        name: getattr(p, name) * float(np.exp(step)) if PRIORS[name].positive else getattr(p, name) + UNIT[name] * step
        for name, step in zip(free, by, strict=True)
    }
    values |= {name: float(np.clip(values[name], -LATEST, LATEST)) for name in DELAYS if name in values}
    values |= {name: max(values[name], least) for name, least in LEAST.items() if name in values}
    return p._replace(**values)
