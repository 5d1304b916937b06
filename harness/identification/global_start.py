"""Where the search begins: the likelihood has other valleys, so that several are looked into."""

from itertools import product
from math import pi

from .drive_train import Parameters
from .maximum_likelihood import maximise
from .model_inputs import Drive
from .prediction import Noise, Predictor, filtered

INERTIAS = (0.5, 2.0, 8.0, 30.0)
"""J_2 over J_1: from bare wheels to a vehicle that does not slip."""

FREQUENCIES = (4.0, 5.5, 7.5, 10.0, 14.0)
"""In Hz, of the motor against the shaft: cars shuffle between them."""

HALF_GAPS = (0.02, 0.1, 0.3)
"""phi_B in rad."""

STRETCH = 3.0
"""Time in s of the recording by which they are compared."""

PASSES = 6
"""Into each valley."""


def best_start(predictor: Predictor, drive: Drive, given: Parameters, noise: Noise) -> Parameters:
    """The end of a short search, the likeliest of those from what is given and from the best with each inertia.

    Args:
        predictor: of the parameters that are searched, J_2, C and phi_B among them.
        given: of which J_1 is taken as known.
        noise: wide enough for the filter to follow what it does not model.
    """
    piece = drive.between(0, min(round(STRETCH / drive.T_s), len(drive)))

    def likeliest(ratio: float) -> Parameters:
        others = (
            given._replace(J_2=ratio * given.J_1, C=given.J_1 * (2.0 * pi * frequency) ** 2, phi_B=phi_B)
            for frequency, phi_B in product(FREQUENCIES, HALF_GAPS)
        )
        return min(others, key=lambda p: filtered(piece, p, noise).cost)

    starts = [given, *map(likeliest, INERTIAS)]
    ends = [maximise(predictor, piece, start, noise, most=PASSES) for start in starts]
    return min(ends, key=lambda end: end.innovations.cost).p
