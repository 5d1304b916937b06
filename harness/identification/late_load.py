"""How likely a load torque is recorded late, and what one that may be leaves unknown.

Where a tyre is mostly a damper, a change of the load torque follows the acceleration of the wheels, as the torque on
their inertia does. A late load torque then looks like another J_2, or like damping d, and the recording hardly tells
them apart.
"""

from collections.abc import Sequence
from math import exp, log, pi, sqrt

import numpy as np

from .maximum_likelihood import Found, deviations_if_known
from .model_inputs import Drive
from .prediction import Noise, Predictor
from .quality import Z_95

RANGE = 0.008
"""Length in s of the range in which a delay of the load torque is, all equally likely: -3 to 5 ms."""

SELDOM = 0.05
"""Odds that the load torque is late where nothing else is; where another channel is late, it is as likely as not."""

COLLINEAR = 0.99
"""Correlation of J_2 with what is free beside it from which on they cannot be told apart."""


def odds(deviation: float, free: Sequence[str]) -> float:
    """That the load torque is late, if the data say as much as that it is not: what delay they find is one of the few
    that they cannot tell apart, of all in RANGE (Laplace; R. E. Kass, A. E. Raftery, J. Am. Stat. Assoc. 90, 1995).

    Args:
        deviation: standard deviation in s of its delay.
        free: names of the free parameters.
    """
    before = 1.0 if {"late_1", "late_T"} & {*free} else SELDOM
    return before * sqrt(2.0 * pi) * deviation / RANGE


def price(deviation: float, free: Sequence[str]) -> float:
    """Twice the gain in likelihood from which on it is likelier late than not, and by more than chance."""
    return max(-2.0 * log(odds(deviation, free)), Z_95**2)


def covariance_with_late_load(drive: Drive, best: Found, noise: Noise) -> np.ndarray:
    """Covariance of the free parameters about the answer, allowing for a late load torque if that is not free.

    The data do not ask for its delay then, but may not exclude it either. The answer that it leads to counts by its
    posterior probability, after one scoring step.
    """
    if "late_L" in best.free:
        return best.covariance
    free = (*best.free, "late_L")
    wider = Found(best.p, free, Predictor(free).innovations(drive, best.p, noise), passes=1)
    step = -wider.inverse_information @ wider.innovations.gradient
    covariance = wider.covariance
    deviation = sqrt(covariance[-1, -1])
    late_odds = odds(deviation, free)
    share = late_odds / (late_odds + exp(-0.5 * (step[-1] / deviation) ** 2))
    if_late = covariance[:-1, :-1] + np.outer(step[:-1], step[:-1])
    return (1.0 - share) * best.covariance + share * if_late


def diagnose_late_load(found: Found, deviation: float) -> list[str]:
    """Whether J_2 and what is free beside it cannot be told apart.

    Args:
        deviation: of J_2 in kg.m2, with all doubt.
    """
    if_known = deviations_if_known(found.covariance, found.free, ("d", "late_L"))["J_2"]
    if if_known > sqrt(1.0 - COLLINEAR**2) * deviation:
        return []
    together = "J_2, d and late_L" if "d" in found.free else "J_2 and late_L"
    return [
        f"{together} cannot be told apart (late_L: time by which the load torque is recorded late), which the interval "
        f"of J_2 allows for; were the rest known, it would be +- {100.0 * Z_95 * if_known / found.p.J_2:.2g} %"
    ]
