"""What an FMU shows to the outside, and what the loop calls it."""

from collections.abc import Sequence
from pathlib import Path

from fmpy.model_description import ModelVariable

from . import description
from .limits import USUAL_LIMITS, Limits


class Interface:
    """What an FMU shows to the outside.

    Attributes:
        path: of the FMU.
        description: as fmpy read it.
        identifier: of the binary.
        variables: by name, in the order of the description; where they are mapped, as the loop sees them.
        factors: what values of mapped variables are multiplied by on their way into the loop.
        refused: names of the loop whose mapping does not fit.
        any_value: NaN among the outputs is meant to be there.
    """

    def __init__(self, path: Path, limits: Limits = USUAL_LIMITS, kinds: Sequence[str] = description.STEPPING) -> None:
        """Reads the model description.

        Args:
            kinds: of FMUs that are taken; of one that is of several the first counts.

        Raises:
            WiringError: the file is not an FMI 2.0 FMU of these kinds, or is not one that can be used.
        """
        self.path = path
        self.description = description.read(path, limits, kinds)
        offered = self.description.coSimulation or self.description.modelExchange
        assert offered is not None
        self.identifier = str(offered.modelIdentifier)
        self.variables: dict[str, ModelVariable] = {v.name: v for v in self.description.modelVariables}
        self.factors: dict[str, float] = {}
        self.refused: set[str] = set()
        self.any_value = False

    def of_causality(self, causality: str) -> list[ModelVariable]:
        return [v for v in self.variables.values() if v.causality == causality]


def unit_of(variable: ModelVariable) -> str | None:
    """Unit of a variable, its own or that of its declared type."""
    if variable.unit is None and variable.declaredType is not None:
        return variable.declaredType.unit
    return variable.unit


def type_of(variable: ModelVariable) -> str:
    """FMI type of a variable; an enumeration travels as an Integer."""
    return "Integer" if variable.type == "Enumeration" else str(variable.type)
