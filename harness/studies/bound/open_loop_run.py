"""Open-loop runs of the design model under a given torque reference, which verify every optimal trajectory.

The loop of the FMUs runs with the control switched off, and the reference takes the place of the driver's demand.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ...loop.places import PLANTS
from ...manoeuvres.manoeuvre import Manoeuvre
from ...manoeuvres.signals import Held
from ...metrics.evaluate import T_S
from ...simulation.simulate import simulate


def open_loop_run(manoeuvre: Manoeuvre, T_ref: np.ndarray, settings: Mapping[str, Any]) -> np.ndarray:
    """The results of a manoeuvre in which the motor gets a torque reference, whatever the driver demands.

    Args:
        T_ref: (samples,), in N.m, each held for T_S; the first two are the same.
        settings: further arguments of `driveline.simulate`.
    """
    # the demand passes the controller in a sample, except at the start
    ahead = replace(manoeuvre, T_driver=Held(T_S, [T_ref[0], *T_ref[2:]]))
    results = simulate(ahead, PLANTS[0], control=False, **settings).copy()
    results["controller.T_driver"] = manoeuvre.T_driver(results["time"])
    return results
