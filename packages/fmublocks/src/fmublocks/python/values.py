"""The values of an FMU's variables, checked when they are set and computed when they are asked for."""

import math
from typing import Any

from .. import protocol
from ..block.types import ContinuousBlock
from ..description.variables import Variable, interface
from .refusal import Refused


class Values:
    """All values of one instance, numbered by value reference: inputs, outputs, parameters.

    Attributes:
        u, p: inputs and parameters as the records of the block.
        up_to_date: whether the outputs are those of the state; inputs do not change them in a sampled block.
    """

    def __init__(self, block: Any) -> None:
        self.block = block
        self.variables = interface(block)
        self.first_output = len(block.Input._fields)
        self.first_parameter = self.first_output + len(block.Output._fields)
        self.of_type = {
            fmi_type: frozenset(v.reference for v in self.variables if v.fmi_type == fmi_type)
            for fmi_type in ("Real", "Integer", "Boolean", "String")
        }
        self._all: list[Any] = [v.start for v in self.variables]
        self.up_to_date = False
        self.allow("input", "parameter")
        self._renew()

    def allow(self, *kinds: str) -> None:
        """Says which variables can be set from now on, by their causality or variability."""
        self._starting = "parameter" in kinds
        settable = (v for v in self.variables if v.causality in kinds or v.variability in kinds)
        self._bounds = {v.reference: v.bounds() for v in settable}

    def _renew(self, parameters: bool = True) -> None:
        self.u = self.block.Input._make(self._all[: self.first_output])
        if parameters:
            self.p = self.block.Parameters._make(self._all[self.first_parameter :])
        if parameters or self._starting or isinstance(self.block, ContinuousBlock):
            self.up_to_date = False

    def get(self, fmi_type: str, references: list[int], x: Any) -> list[Any]:
        """Values of variables of one type, the outputs being those of state x (None: of the start).

        Raises:
            Refused: a variable is of another type.
        """
        if not self.of_type[fmi_type].issuperset(references):
            self._refuse_type(fmi_type, references)
        if not self.up_to_date:
            self._compute(x)
        values = self._all
        return [values[reference] for reference in references]

    def _compute(self, x: Any) -> None:
        """The outputs of state x (None: of the start)."""
        x = self.block.start(self.u, self.p) if x is None else x
        self._all[self.first_output : self.first_parameter] = self.block.output(x, self.u, self.p)
        self.up_to_date = True

    def check_outputs(self, x: Any, step_size: float) -> None:
        """Computes the outputs of state x, at which a step of that size (s) ends.

        Raises:
            Refused: one is not finite.
        """
        if self.up_to_date:
            return
        self._compute(x)
        for reference in range(self.first_output, self.first_parameter):
            value = self._all[reference]
            if not -math.inf < value < math.inf:
                name = self.variables[reference].name
                raise Refused(protocol.NOT_FINITE, size=step_size, name=name, value=value)

    def set(self, fmi_type: str, references: list[int], new: list[Any]) -> None:
        """Sets variables of one type; all of them or, when one is refused, none.

        Raises:
            Refused: a variable is of another type or cannot be set, or its value is not allowed.
        """
        if not self.of_type[fmi_type].issuperset(references):
            self._refuse_type(fmi_type, references)
        bounds, taken = self._bounds, list(new)
        for k, (reference, value) in enumerate(zip(references, new, strict=True)):
            low, high = bounds.get(reference, (1, 0))
            if not low <= value <= high:
                taken[k] = self._judged(self.variables[reference], value)
        for reference, value in zip(references, taken, strict=True):
            self._all[reference] = value
        self._renew(max(references, default=0) >= self.first_parameter)

    def restore(self, u: list[Any], p: list[Any]) -> None:
        """Puts back inputs and parameters as they were in `u` and `p`."""
        self._all[: self.first_output], self._all[self.first_parameter :] = u, p
        self.allow("input", "parameter")
        self._renew()

    def _refuse_type(self, fmi_type: str, references: list[int]) -> None:
        """Raises Refused for the first reference that is of another type."""
        wrong = next(r for r in references if r not in self.of_type[fmi_type])
        last = len(self.variables) - 1
        if not 0 <= wrong <= last:
            unsigned = wrong % 2**32  # as the host gave it; the binary makes it signed
            raise Refused(protocol.UNKNOWN_REFERENCE, reference=unsigned, model=self.block.name, last=last)
        variable = self.variables[wrong]
        raise Refused(protocol.WRONG_TYPE, name=variable.name, type=variable.fmi_type, asked=fmi_type)

    def _judged(self, variable: Variable, value: Any) -> Any:
        """The value that is taken for one out of bounds: of an input of a block that copes with any value that, of
        others the end of the range, if it is a little outside.

        Raises:
            Refused: it is not taken.
        """
        name = variable.name
        if variable.causality == "output":
            raise Refused(protocol.OUTPUT_SET, name=name)
        if variable.reference not in self._bounds:
            raise Refused(protocol.SET_TOO_LATE, name=name, value=value)
        if variable.causality == "input" and self.block.tolerates_bad_input:
            return value
        low, high = variable.bounds()
        slack = protocol.INPUT_TOLERANCE * (high - low)
        real = variable.causality == "input" and variable.fmi_type == "Real" and math.isfinite(value)
        if real and low - slack <= value <= high + slack:
            return min(max(value, low), high)
        unit = f" {variable.unit}" if variable.unit else ""
        raise Refused(protocol.BAD_VALUE, name=name, value=value, unit=unit, allowed=variable.allowed())
