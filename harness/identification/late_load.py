"""What a load torque that may be recorded late leaves unknown.

Where a tyre is mostly a damper, a change of the load torque follows the acceleration of the wheels, as the torque on
their inertia does. A late load torque then looks like another J_2, or like damping d, and the recording hardly tells
them apart.
"""

from math import exp, pi, sqrt

import numpy as np

from .drive_train import DELAYS
from .maximum_likelihood import Found
from .model_inputs import Drive
from .prediction import Noise, Predictor
from .quality import Z_95

RANGE = 0.008
"""Length in s of the range in which a delay of the load torque is, all equally likely: -3 to 5 ms."""

SELDOM = 0.05
"""Odds that the load torque is late where nothing else is; where another channel is late, it is as likely as not."""

COLLINEAR = 0.99
"""Correlation of J_2 with what is free beside it from which on they cannot be told apart."""


def covariance_with_late_load(drive: Drive, best: Found, noise: Noise) -> np.ndarray:
    """Covariance of the free parameters about the answer, allowing for a late load torque if that is not free.

    The data do not ask for its delay then, but may not exclude it either. The answer that it leads to counts by its
    posterior probability (Laplace; R. E. Kass, A. E. Raftery, J. Am. Stat. Assoc. 90, 1995), after one scoring step.
    """
    if "late_L" in best.free:
        return best.covariance
    free = (*best.free, "late_L")
    wider = Found(best.p, free, Predictor(free).innovations(drive, best.p, noise), passes=1)
    step = -wider.inverse_information @ wider.innovations.gradient
    covariance = wider.covariance
    deviation = sqrt(covariance[-1, -1])
    odds = (1.0 if {*DELAYS} & {*best.free} else SELDOM) * sqrt(2.0 * pi) * deviation / RANGE
    share = odds / (odds + exp(-0.5 * (step[-1] / deviation) ** 2))
    late = covariance[:-1, :-1] + np.outer(step[:-1], step[:-1])
    return (1.0 - share) * best.covariance + share * late


def diagnose_late_load(found: Found, deviation: float) -> list[str]:
    """Whether J_2 and what is free beside it cannot be told apart.

    Args:
        deviation: of J_2 in kg.m2, with all doubt.
    """
    alone = [k for k, name in enumerate(found.free) if name not in ("d", "late_L")]
    information = np.linalg.inv(found.covariance)
    J_2 = alone.index(found.free.index("J_2"))
    if_known = sqrt(np.linalg.inv(information[np.ix_(alone, alone)])[J_2, J_2])
    if if_known > sqrt(1.0 - COLLINEAR**2) * deviation:
        return []
    together = "J_2, d and late_L" if "d" in found.free else "J_2 and late_L"
    return [
        f"{together} cannot be told apart (late_L: time by which the load torque is recorded late), which the interval "
        f"of J_2 allows for; were the rest known, it would be +- {100.0 * Z_95 * if_known / found.p.J_2:.2g} %"
    ]
