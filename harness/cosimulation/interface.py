"""What an FMU shows to the outside, and what the loop calls it."""

from pathlib import Path
from zipfile import BadZipFile

from fmpy import read_model_description
from fmpy.model_description import ModelDescription, ModelVariable

from ..errors import WiringError


class Interface:
    """What an FMU shows to the outside.

    Attributes:
        path: of the FMU.
        description: as fmpy read it.
        identifier: of the binary.
        variables: by name, in the order of the description; where they are mapped, as the loop sees them.
        factors: what values of mapped variables are multiplied by on their way into the loop.
        refused: names of the loop whose mapping does not fit.
    """

    def __init__(self, path: Path) -> None:
        """Reads the model description.

        Raises:
            WiringError: the file is not an FMI 2.0 Co-Simulation FMU.
        """
        self.path = path
        self.description = _read(path)
        assert self.description.coSimulation is not None
        self.identifier = str(self.description.coSimulation.modelIdentifier)
        self.variables: dict[str, ModelVariable] = {v.name: v for v in self.description.modelVariables}
        self.factors: dict[str, float] = {}
        self.refused: set[str] = set()

    def of_causality(self, causality: str) -> list[ModelVariable]:
        return [v for v in self.variables.values() if v.causality == causality]


def _read(path: Path) -> ModelDescription:
    if not path.is_file():
        raise WiringError(f"there is no FMU {path} (`driveline build` makes those of the project)")
    try:
        description = read_model_description(str(path), validate=False)
    except (BadZipFile, KeyError) as error:
        raise WiringError(f"{path} is not an FMU: {error}") from error
    except Exception as error:  # fmpy raises bare exceptions
        raise WiringError(f"the model description of {path} cannot be read: {error}") from error
    if description.fmiVersion != "2.0" or description.coSimulation is None:
        raise WiringError(f"{path} is of FMI {description.fmiVersion}; only FMI 2.0 Co-Simulation runs here")
    return description


def unit_of(variable: ModelVariable) -> str | None:
    """Unit of a variable, its own or that of its declared type."""
    if variable.unit is None and variable.declaredType is not None:
        return variable.declaredType.unit
    return variable.unit


def type_of(variable: ModelVariable) -> str:
    """FMI type of a variable; an enumeration travels as an Integer."""
    return "Integer" if variable.type == "Enumeration" else str(variable.type)
