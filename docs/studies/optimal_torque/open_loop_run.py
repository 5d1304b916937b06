"""Open-loop runs of the design model under a given torque reference, which verify every optimal trajectory.

The loop of the FMUs runs with the control switched off, and the reference takes the place of the driver's demand.
"""

from dataclasses import replace

import numpy as np

from driveline.harness.loop.places import T_S
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.signals import Held
from driveline.harness.simulation.simulate import simulate


def open_loop_run(manoeuvre: Manoeuvre, T_ref: np.ndarray, settings: Settings) -> np.ndarray:
    """The results of a manoeuvre in which the motor gets a torque reference, whatever the driver demands.

    Args:
        T_ref: (samples,), in N.m, each held for T_S; the first two are the same.
        settings: of the loop with the design model.
    """
    # the demand passes the controller in a sample, except at the start
    ahead = replace(manoeuvre, T_driver=Held(T_S, [T_ref[0], *T_ref[2:]]))
    results = simulate(ahead, settings, control=False).copy()
    results["controller.T_driver"] = manoeuvre.T_driver(results["time"])
    return results
