"""What the controller's model needs of an identified car.

Its model is that of the paper: J_1, C, the gap, and a load torque that changes slowly. Neither result of the
identification is that as it stands. With load torque J_2 is the wheels alone, next to nothing in the vehicle, and C
does not have the tyre in it; without, J_2 is wheels and vehicle. What both have in common is how the car answers on its
own, about the resonance: the two masses that answer so give C. J_2 is left as the vehicle file has it; the gains depend
on J_2 + m r^2/i^2, and with J_2 as identified the estimate of the wheels is lost.
"""

import numpy as np
from scipy.optimize import least_squares

from .drive_train import Parameters
from .drive_train_response import Tyre, response

ABOUT = np.linspace(0.5, 1.5, 41)
"""Frequencies over that of the resonance at which the answers are compared."""


def equivalent(p: Parameters, behind: Tyre | None, peak: float) -> Parameters:
    """The two masses that answer as the car does.

    Args:
        p, behind: the car as identified.
        peak: its resonance in Hz.
    """
    if behind is None:
        return p
    f = peak * ABOUT
    car = response(p, f, behind)

    def missed(x: np.ndarray) -> np.ndarray:
        J_2, C, d = np.exp(x)
        off = response(p._replace(J_2=J_2, C=C, d=d), f) / car - 1.0
        return np.concatenate([off.real, off.imag])

    C = p.J_1 * (2.0 * np.pi * peak) ** 2
    with np.errstate(over="ignore", invalid="ignore"):  # a step into infinity is taken back and made smaller
        found = least_squares(missed, np.log([behind.J_v, C, 0.1 * C / (2.0 * np.pi * peak)]))
    J_2, C, d = map(float, np.exp(found.x))
    return p._replace(J_2=J_2, C=C, d=d)
