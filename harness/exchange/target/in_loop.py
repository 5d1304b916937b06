"""The controller on the target in the loop, beside the loop with the model and beside off-line."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from ...cosimulation.system import System
from ...loop.settings import Settings
from ...manoeuvres.catalogue import USUAL_MANOEUVRES
from ...metrics.evaluate import at_samples
from ...simulation.simulate import simulate
from .comparison import responses
from .offline_cases import fed
from .programs import Programs
from .target_build import built_on_target


class InLoop(NamedTuple):
    """A manoeuvre with the controller on the target.

    Attributes:
        differing: samples in which T_ref is not, bit by bit, what the C makes of the same inputs off-line.
        T_ref, T_gear: in N.m, largest distance from the loop with the model in double precision.
        rms: of that of T_ref.
    """

    manoeuvre: str
    differing: int
    T_ref: float
    T_gear: float
    rms: float


def in_loop(
    programs: Programs, controller: str, system: System, names: Sequence[str], settings: Settings
) -> Iterator[InLoop]:
    """Drives every manoeuvre.

    Args:
        controller: its name.
        names: of its inputs.
        settings: of the loop.

    Raises:
        SimulationError: the target was lost, hung or crashed.
    """
    with TemporaryDirectory(prefix="driveline-") as temporary:
        path = built_on_target(controller, Path(temporary))
        for manoeuvre in USUAL_MANOEUVRES:
            there = at_samples(simulate(manoeuvre, settings, controller=path))
            here = at_samples(simulate(manoeuvre, settings))
            off_line = responses(programs.single(), fed(manoeuvre, there, system, names))
            T_ref = np.array([answer.outputs[0] for answer in off_line])
            distance, twist = (np.abs(there[name] - here[name]) for name in ("controller.T_ref", "plant.T_gear"))
            yield InLoop(
                manoeuvre.name,
                differing=int(np.count_nonzero(T_ref != there["controller.T_ref"])),
                T_ref=float(np.max(distance)),
                T_gear=float(np.max(twist)),
                rms=float(np.sqrt(np.mean(distance**2))),
            )
