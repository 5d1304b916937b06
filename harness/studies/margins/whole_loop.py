"""The whole analysis of a loop, as a program asks for it."""

from collections.abc import Mapping, Sequence
from typing import Any, Unpack

from fmuloop.argument_kinds import require_each

from ...design.loop_parameters import loop_parameters
from ...loop.own_controller import with_equations
from ...loop.places import PLACES, PLANTS
from ...loop.resolved import as_given
from ...loop.settings import RunChanges, Settings
from .loop_analysis import Analysis
from .loop_analysis import analyse as analysis


def analyse(
    plants: Sequence[str] = PLANTS,
    controller: str = PLACES["controller"][0],
    car: Mapping[str, Any] | None = None,
    **changes: Unpack[RunChanges],
) -> Analysis:
    """How stable the loop is, what it depends on, and how good the estimate is, on all cores; see also
    `driveline analyse`. It takes minutes.

        found = driveline.analyse(["TwoMassDriveline"])
        for at in found.at:
            print(at.speed, at.margins.phase_margin)  # in km/h and rad

    Args:
        plants: names of plants of the project.
        controller: one of the project, or a Python file that declares one, as `driveline build` takes it.
        car: entries of a vehicle file and of gains, in SI units, as `read_files` gives them; what they do not name is
            that of the default car.
        changes: fields of the settings that are to be others, as of `simulate`, for all runs.

    Raises:
        UserError: the controller is not linear in contact, or the loop with it is not stable.
        BuildError: a Python file declares no FMU, or it cannot be built.
        TypeError: a single plant is given.
    """
    if "plant" in changes:  # for scripts that no type checker reads
        raise TypeError("analyse takes plants, and no single plant")
    require_each("plants", plants, str, "names of plants of the project")
    controller = with_equations(controller)
    common = Settings(controller=controller).replace(**changes)
    return analysis(
        {
            plant: as_given(common, plant=plant).with_parameters(loop_parameters(car or {}, plant, controller))
            for plant in plants
        }
    )
