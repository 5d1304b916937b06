"""One manoeuvre with one plant: the function that everything else runs the loop with."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from .cosimulation.master import Scheme, Source, run
from .cosimulation.system import BUILD, PLANTS, loop
from .manoeuvres.manoeuvre import Manoeuvre


def simulate(
    manoeuvre: Manoeuvre,
    plant: str | Path = PLANTS[0],
    control: bool = True,
    parameters: Mapping[str, float] | None = None,
    step_size: float = 1e-3,
    scheme: Scheme = Scheme.GAUSS_SEIDEL,
    seed: int = 1,
    folder: Path = BUILD,
    build: str | None = None,
) -> np.ndarray:
    """Drives the closed loop through a manoeuvre.

    Args:
        plant: name of a plant of the project, or path of an FMU with the same interface.
        control: whether the damping control is enabled.
        parameters: `instance.variable` -> value, beside the start and the seeds that this sets.
        step_size: communication step in s.
        seed: of all noise and jitter.
        folder: of the built FMUs.
        build: "native" or "python"; None: see `harness.cosimulation.system.chosen_build`.

    Returns:
        Structured array, see `harness.cosimulation.master.run`.

    Raises:
        WiringError: the plant or a parameter does not fit.
        SimulationError: an FMU refused a call.
    """
    return run(
        loop(plant, folder, build),
        duration=manoeuvre.duration,
        step_size=step_size,
        inputs=signals(manoeuvre, control),
        parameters=start(manoeuvre, seed) | dict(parameters or {}),
        scheme=scheme,
        label=manoeuvre.name,
    )


def signals(manoeuvre: Manoeuvre, control: bool = True) -> dict[str, Source]:
    """What the loop is given from outside during a manoeuvre."""
    return {
        "controller.T_driver": manoeuvre.T_driver,
        "controller.enable": control,
        "plant.T_brake": manoeuvre.T_brake,
        "plant.slope": manoeuvre.slope,
    }


def start(manoeuvre: Manoeuvre, seed: int = 1) -> dict[str, float]:
    """Parameters with which the loop starts a manoeuvre."""
    return {"plant.v_0": manoeuvre.v_0, "plant.T_0": manoeuvre.T_0, "motor.seed": seed, "can.seed": seed}
