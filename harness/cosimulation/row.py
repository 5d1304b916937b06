"""Where each signal of a run lies in memory: one row of bytes an instant, the same for every instant.

A row begins with what is known in advance (time and the inputs from outside), then come the outputs
of each instance, type by type, so that one FMI call reads all of a type straight into their place.
"""

from collections.abc import Mapping, Sequence
from ctypes import c_double, c_int
from typing import Any, Literal, NamedTuple

import numpy as np
from fmpy.model_description import ModelVariable

from .wiring import Interface, type_of


class Kind(NamedTuple):
    """How values of an FMI type travel.

    Attributes:
        ctype: in the calls.
        code: of the ctype, as in `struct` and numpy.
        column: dtype of the results.
    """

    ctype: Any
    code: Literal["d", "i"]
    column: type


KINDS = {
    "Real": Kind(c_double, "d", np.float64),
    "Integer": Kind(c_int, "i", np.int32),
    "Boolean": Kind(c_int, "i", np.bool_),
}


class Layout:
    """The columns of a run.

    Attributes:
        dtype: of a row, all booleans as whole numbers.
        results: dtype of the results.
        known: number of bytes at the beginning of a row that are known in advance.
    """

    def __init__(self, interfaces: Mapping[str, Interface], inputs: Sequence[str]) -> None:
        given = {name: type_of(_variable(name, interfaces)) for name in inputs}
        types = {"time": "Real"} | dict(sorted(given.items(), key=lambda item: list(KINDS).index(item[1])))
        first_output = len(types)
        for instance, interface in interfaces.items():
            for kind in KINDS:
                for variable in interface.of_causality("output"):
                    if type_of(variable) == kind:
                        types[f"{instance}.{variable.name}"] = kind
        names = list(types)
        formats = [KINDS[kind].code for kind in types.values()]
        self.dtype = np.dtype({"names": names, "formats": formats}, align=True)
        fields = self.dtype.fields or {}
        self._offsets = {str(name): int(field[1]) for name, field in fields.items()}
        self.results = np.dtype([(name, KINDS[kind].column) for name, kind in types.items()])
        self.known = self.offset(names[first_output]) if names[first_output:] else self.dtype.itemsize

    def offset(self, name: str) -> int:
        """First byte of a column in a row."""
        return self._offsets[name]


def _variable(name: str, interfaces: Mapping[str, Interface]) -> ModelVariable:
    instance, _, variable = name.partition(".")
    return interfaces[instance].variables[variable]
