"""Where the search begins: the likelihood has other valleys, so that several are looked into."""

from collections.abc import Sequence
from itertools import product
from math import pi

from .drive_train import Parameters
from .estimator import search
from .prediction import Predictor

INERTIAS = (0.5, 2.0, 8.0, 30.0)
"""J_2 over J_1: from bare wheels to a vehicle that does not slip."""

FREQUENCIES = (4.0, 5.5, 7.5, 10.0, 14.0)
"""In Hz, of the motor against the shaft: cars shuffle between them."""

HALF_GAPS = (0.02, 0.1, 0.3)
"""phi_B in rad."""

STRETCH = 3.0
"""Time in s of the longest piece by which they are compared."""

PASSES = 10
"""Into each valley."""


def best_start(predictor: Predictor, known: Parameters, free: Sequence[str]) -> Parameters:
    """The end of a short search, the likeliest of those from what is given and from the best with each inertia.

    Args:
        given: of which J_1 is taken as known; the filter must be wide enough to follow what it does not model.
        free: of the parameters that are searched, J_2, C and phi_B among them.
    """
    drive = predictor.drive
    first, end = drive.longest.start, drive.longest.stop
    piece = predictor.of(drive.between(first, min(first + round(STRETCH / drive.T_s), end - 1)))

    def likeliest(ratio: float) -> Parameters:
        others = (
            known._replace(J_2=ratio * known.J_1, C=known.J_1 * (2.0 * pi * frequency) ** 2, phi_B=phi_B)
            for frequency, phi_B in product(FREQUENCIES, HALF_GAPS)
        )
        return min(others, key=lambda p: piece.predicted(p).cost)

    starts = [known, *map(likeliest, INERTIAS)]
    ends = [search(piece, start, free, known, most=PASSES) for start in starts]
    return min(ends, key=lambda end: end.predicted.cost).p
