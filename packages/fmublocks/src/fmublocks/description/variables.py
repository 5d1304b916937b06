"""The variables of a block as an FMU shows them: one numbering for the XML and for the FMU itself."""

from typing import Any, NamedTuple

from ..block.declaration import Boolean, Declaration, Enumeration, Integer, Real, variables
from ..block.operators import LARGEST
from .units import NOMINAL


class Variable(NamedTuple):
    """One variable of an FMU.

    Attributes:
        reference: its FMI value reference, which is also its place in the list of all variables.
        causality: "input", "output" or "parameter"; of a state or its derivative "local"; of the time in FMI 3.0
            "independent".
        start: start value; None for what is computed.
        of: of a derivative, the reference of what it is the derivative of.
    """

    reference: int
    name: str
    causality: str
    declaration: Declaration
    start: Any
    of: int | None = None

    @property
    def fmi_type(self) -> str:
        """The FMI functions that reach it: "Real", "Integer" or "Boolean"."""
        if isinstance(self.declaration, Real):
            return "Real"
        return "Boolean" if isinstance(self.declaration, Boolean) else "Integer"

    @property
    def variability(self) -> str:
        """Of a parameter: "tunable" if it can be set during a run, else "fixed"; of others empty."""
        if self.causality != "parameter":
            return ""
        return "tunable" if isinstance(self.declaration, Real) and self.declaration.tunable else "fixed"

    @property
    def unit(self) -> str:
        """Its unit; empty for what has none."""
        unit = self.declaration.unit if isinstance(self.declaration, Real) else ""
        return "" if unit == "1" else unit

    @property
    def nominal(self) -> float | None:
        """How large it typically is; None for what no unit tells it of."""
        if not isinstance(self.declaration, Real):
            return None
        return self.declaration.nominal or NOMINAL.get(self.declaration.unit)

    def bounds(self) -> tuple[Any, Any]:
        """Smallest and largest value allowed; both finite, so that a comparison refuses inf and NaN."""
        match self.declaration:
            case Real(minimum=minimum, maximum=maximum):
                return max(minimum, -LARGEST), min(maximum, LARGEST)
            case Integer(minimum=minimum, maximum=maximum):
                return minimum, maximum
            case Enumeration(items=items):
                return 1, len(items)
            case _:
                return False, True

    def allowed(self) -> str:
        """What values it may have, in words."""
        low, high = self.bounds()
        if isinstance(self.declaration, Boolean):
            return "true or false"
        if isinstance(self.declaration, Enumeration):
            return " or ".join(f"{k} ({name})" for k, (name, _) in enumerate(self.declaration.items, 1))
        unit = f" {self.unit}" if self.unit else ""
        if isinstance(self.declaration, Integer):
            return f"{low} to {high}"
        if low <= -LARGEST and high >= LARGEST:
            return f"any finite number{unit and ' in'}{unit}"
        if high >= LARGEST:
            return f"{low:g}{unit} and more"
        if low <= -LARGEST:
            return f"{high:g}{unit} and less"
        return f"{low:g} to {high:g}{unit}"


def interface(block: Any) -> tuple[Variable, ...]:
    """All variables of a block: inputs, outputs, parameters, each in the order of declaration."""
    records = (("input", block.Input), ("output", block.Output), ("parameter", block.Parameters))
    declared = [(causality, v) for causality, record in records for v in variables(record)]
    return tuple(
        Variable(reference, v.name, causality, v.declaration, v.start)
        for reference, (causality, v) in enumerate(declared)
    )
