"""What the vehicle file needs of an identified car: J_2 and C of the design model.

Where the model explains the recording, they are what was found. Where it does not, J_2 is what predicts best, of the
validation vehicle, whose wheels hang on mounts and bushings, a tenth of the design's; with that the controller's
estimate of the wheels is lost. J_2 then stays as it was, and C follows from the frequency at which the car answers:
a detailed car of that file swings there (`fmus/building/one_car.py`).
"""

from functools import cache
from math import pi

from scipy.optimize import brentq

from ...fmus.building.one_car import DESIGN, DETAILED
from ...fmus.building.oscillation import oscillation
from .diagnostics import lacking
from .drive_train import Parameters
from .drive_train_response import PEAK, resonance, rolling_tyre
from .identify import Identified


@cache
def detailed_over_design() -> float:
    """Frequency of the validation vehicle over that of the design model, of any car."""
    detailed, design = (oscillation(plant, plant.Parameters()).frequency for plant in (DETAILED, DESIGN))
    return detailed / design


def equivalent(identified: Identified, p: Parameters) -> Parameters:
    """The car of the vehicle file in the design model.

    Args:
        p: as identified, or near.
    """
    if identified.explained:
        return p
    file = identified.found.centre._replace(J_1=p.J_1, phi_B=p.phi_B, d=0.0)
    tyre = rolling_tyre(file, identified.predictor.behind, identified.speed)
    peak = resonance(p, identified.tyre_of(p))
    peak = peak / detailed_over_design() if lacking(identified.found) else peak

    def off(C: float) -> float:
        return resonance(file._replace(C=C), tyre) - peak

    softest, stiffest = (p.J_1 * (2.0 * pi * f) ** 2 for f in (0.8 * PEAK[0], 1.2 * PEAK[1]))
    C = brentq(off, softest, stiffest)
    return file._replace(C=float(C))  # pyright: ignore[reportArgumentType]
