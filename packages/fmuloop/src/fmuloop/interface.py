"""What an FMU shows to the outside, and what the loop calls it.

Types are called as in FMI 2.0, also those of FMI 3.0: a Float64 is a Real, an Int32 an Integer.
"""

from collections.abc import Sequence
from ctypes import c_bool, c_double, c_int, c_int32, c_int64
from pathlib import Path
from typing import Any, NamedTuple

from fmpy.model_description import ModelDescription, ModelVariable

from . import description
from .limits import USUAL_LIMITS, Limits


class Access(NamedTuple):
    """How values of a type travel in calls.

    Attributes:
        name: of the type in the names of functions.
        ctype: of a value.
    """

    name: str
    ctype: Any


INTEGERS = Access("Integer", c_int)

ACCESSES = {
    2: {
        "Real": Access("Real", c_double),
        "Integer": INTEGERS,
        "Enumeration": INTEGERS,
        "Boolean": Access("Boolean", c_int),
    },
    3: {
        "Real": Access("Float64", c_double),
        "Integer": Access("Int32", c_int32),
        "Enumeration": Access("Int64", c_int64),
        "Boolean": Access("Boolean", c_bool),
    },
}
"""By FMI and type."""


class Interface:
    """What an FMU shows to the outside.

    Attributes:
        path: of the FMU.
        limits: within which it is read.
        fmi: 2 or 3, for FMI 2.0 or 3.0.
        description: as fmpy read it, with our names of types; others share it.
        identifier: of the binary.
        variables: by name, in the order of the description; where they are mapped, as the loop sees them.
        factors: what values of mapped variables are multiplied by on their way into the loop.
        refused: names of the loop whose mapping does not fit.
        any_value: NaN among the outputs is meant to be there.
        rates: of FMI 3.0, value reference of an input -> that of the input which is its rate of change.
    """

    def __init__(self, path: Path, limits: Limits = USUAL_LIMITS, kinds: Sequence[str] = description.STEPPING) -> None:
        """Reads the model description.

        Args:
            kinds: of FMUs that are taken; of one that is of several the first counts.

        Raises:
            WiringError: the file is no FMU of these kinds, of FMI 2.0 or 3.0, or is not one that can be used.
        """
        self.path = path
        self.limits = limits
        self.description = description.read(path, limits, kinds)
        model = self.description
        offered = model.coSimulation or model.modelExchange or model.scheduledExecution
        assert offered is not None
        self.identifier = str(offered.modelIdentifier)
        self.fmi = self.description.fmiMajorVersion
        self.rates = _rates(self.description) if self.fmi == 3 else {}
        self.variables: dict[str, ModelVariable] = {v.name: v for v in self.description.modelVariables}
        self.factors: dict[str, float] = {}
        self.refused: set[str] = set()
        self.any_value = False

    def of_causality(self, causality: str) -> list[ModelVariable]:
        return [v for v in self.variables.values() if v.causality == causality]

    def can_move(self, name: str) -> bool:
        """Whether an input can move during a step."""
        assert self.description.coSimulation is not None
        if self.fmi == 3:
            return self.variables[name].valueReference in self.rates
        return bool(self.description.coSimulation.canInterpolateInputs)

    def access(self, variable: ModelVariable) -> Access | None:
        """How the values of a variable travel in calls; None: the loop does not know its type."""
        return ACCESSES[self.fmi].get(str(variable.type))

    def by_access(self, variables: Sequence[ModelVariable]) -> dict[Access, list[ModelVariable]]:
        """Those that are set or got by the same function; others are left out."""
        alike = {access: [v for v in variables if self.access(v) == access] for access in ACCESSES[self.fmi].values()}
        return {access: alike_there for access, alike_there in alike.items() if alike_there}


def _rates(description: ModelDescription) -> dict[int, int]:
    inputs = [v for v in description.modelVariables if v.causality == "input" and v.type == "Real"]
    return {
        v.derivative.valueReference: v.valueReference
        for v in inputs
        if v.derivative is not None and v.derivative.causality == "input"
    }


def unit_of(variable: ModelVariable) -> str | None:
    """Unit of a variable, its own or that of its declared type."""
    if variable.unit is None and variable.declaredType is not None:
        return variable.declaredType.unit
    return variable.unit


def type_of(variable: ModelVariable) -> str:
    """FMI type of a variable; an enumeration travels as an Integer."""
    return "Integer" if variable.type == "Enumeration" else str(variable.type)
