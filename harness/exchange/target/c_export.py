"""The C of a controller, for a car or with the parameters of a run."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ....fmus.building.one_car import of_one_car
from ....fmus.building.parameter_files import read_files, require_taken
from ....fmus.errors import ParameterFileError
from ...base.errors import DrivelineError


def values_of(controller: str, vehicle: Path | None, parameters: Path | None) -> dict[str, Any]:
    """What two files say of the parameters of a controller, by name.

    Raises:
        DrivelineError: a file is refused.
    """
    from ....fmus.catalogue import EVERY

    names = EVERY[controller].block.Parameters._fields
    try:
        require_taken(parameters, names, controller)
        return of_one_car(read_files(vehicle, parameters), names)
    except ParameterFileError as refusal:
        raise DrivelineError(str(refusal)) from refusal


def with_values(controller: str, precision: str, values: Mapping[str, Any]) -> dict[str, str]:
    """The files of its C by their names.

    Args:
        controller: a name in `fmus.target.sources.CONTROLLERS`.
        precision: float or double.
        values: of its parameters, by name; others are declared.
    """
    from ....fmus.target.sources import CONTROLLERS, PRECISIONS, target_sources

    return target_sources(CONTROLLERS[controller].started_with(values), PRECISIONS[precision])
