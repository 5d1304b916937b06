"""Where each signal of a run lies in memory: one row of bytes an instant, the same for every instant.

A row begins with what is known in advance (time and the inputs from outside), then come the outputs
of each instance, type by type, so that one FMI call reads all of a type straight into their place.
"""

import sys
from collections.abc import Collection, Mapping
from ctypes import c_double, c_int, sizeof
from typing import Any, Literal, NamedTuple

import numpy as np
from fmpy.model_description import ModelVariable
from numpy.typing import NDArray

from toolground.plain_text import plain

from .errors import WiringError
from .interface import Interface, type_of, unit_of
from .results import Results
from .row_file import zeros


def require_fit(name: str, kind: str, samples: NDArray[np.generic]) -> None:
    """Refuses samples of an input that a variable of that FMI type cannot take.

    Raises:
        WiringError: one is no number, no whole number, or neither true nor false.
    """
    if samples.dtype.kind not in "biuf":
        raise WiringError(f"{name} = {plain(samples.flat[0], 40)}: an input is a number")
    if kind == "Real":
        return
    values = samples.astype(np.float64)
    fits = np.isin(values, (0, 1)) if kind == "Boolean" else (abs(values) < 2.0**31) & (values == np.floor(values))
    if not fits.all():
        allowed = "true (1) or false (0)" if kind == "Boolean" else "a whole number of less than 2^31"
        raise WiringError(f"{name} = {values[~fits].flat[0]:g}: it must be {allowed}")


class Kind(NamedTuple):
    """How values of an FMI type travel.

    Attributes:
        ctype: in the calls.
        code: of the ctype, as in `struct` and numpy.
    """

    ctype: Any
    code: Literal["d", "i"]


KINDS = {"Real": Kind(c_double, "d"), "Integer": Kind(c_int, "i"), "Boolean": Kind(c_int, "i")}

TRUTH_BYTE = 0 if sys.byteorder == "little" else sizeof(c_int) - 1
"""Which byte of a Boolean, a whole number that is 0 or 1, is the truth value."""


class Layout:
    """The columns of a run.

    Attributes:
        dtype: of a row, all Booleans as whole numbers.
        known: number of bytes at the beginning of a row that are known in advance.
        recorded: dtype of a row of the results, Booleans as such.
        units: of the columns that have one.
    """

    def __init__(self, interfaces: Mapping[str, Interface], inputs: Collection[str]) -> None:
        input_types = {name: type_of(_variable(name, interfaces)) for name in inputs}
        types = {"time": "Real"} | dict(sorted(input_types.items(), key=lambda item: list(KINDS).index(item[1])))
        first_output = len(types)
        for instance, interface in interfaces.items():
            for kind in KINDS:
                for variable in interface.of_causality("output"):
                    if type_of(variable) == kind:
                        types[f"{instance}.{variable.name}"] = kind
        names = list(types)
        formats = [KINDS[kind].code for kind in types.values()]
        self.dtype = np.dtype({"names": names, "formats": formats}, align=True)
        offsets = [int(field[1]) for field in (self.dtype.fields or {}).values()]
        self._offsets = dict(zip(names, offsets, strict=True))
        self.units = units(interfaces, inputs)
        self.known = offsets[first_output] if names[first_output:] else self.dtype.itemsize
        self._types = types
        self._truths = [name for name, kind in types.items() if kind == "Boolean"]
        for place in (place for place, kind in enumerate(types.values()) if kind == "Boolean"):
            formats[place], offsets[place] = "?", offsets[place] + TRUTH_BYTE
        self.recorded = np.dtype(
            {"names": names, "formats": formats, "offsets": offsets, "itemsize": self.dtype.itemsize}
        )

    def offset(self, name: str) -> int:
        """First byte of a column in a row."""
        return self._offsets[name]

    def table(self, time: NDArray[np.float64], inputs: Mapping[str, NDArray[np.generic]]) -> Results:
        """A row for each instant, with what is known in advance; zeros for the rest.

        Raises:
            WiringError: an input does not take its samples.
            MemoryError: there is no room for so many rows.
        """
        for name, samples in inputs.items():
            require_fit(name, self._types[name], samples)
        rows, file = zeros(len(time), self.dtype)
        table = Results(rows, self.units, file)
        for piece in table.pieces():
            for name, samples in {"time": time, **inputs}.items():
                rows[name][piece] = samples[piece] if samples.shape else samples
        return table

    def table_like(self, other: Results) -> Results:
        """Another one with what is known of one in memory."""
        known = (len(other), -1)
        rows = np.empty_like(np.asarray(other))
        rows.view(np.uint8).reshape(known)[:, : self.known] = other.view(np.uint8).reshape(known)[:, : self.known]
        return Results(rows, self.units)

    def results(self, table: Results, are_truths: bool = False) -> Results:
        """The same memory with the Booleans as such.

        Args:
            are_truths: whether all that stand there are 0 or 1.
        """
        rows = np.asarray(table)
        for piece in table.pieces():
            for name in () if are_truths else self._truths:
                rows[name][piece] = rows[name][piece] != 0
        return Results(table.view(self.recorded), self.units, table.file)


def units(interfaces: Mapping[str, Interface], inputs: Collection[str]) -> dict[str, str]:
    """The unit of every column of the results that has one."""
    return {"time": "s"} | {
        f"{instance}.{name}": unit
        for instance, interface in interfaces.items()
        for name, variable in interface.variables.items()
        if (variable.causality == "output" or f"{instance}.{name}" in inputs) and (unit := unit_of(variable))
    }


def _variable(name: str, interfaces: Mapping[str, Interface]) -> ModelVariable:
    instance, _, variable = name.partition(".")
    return interfaces[instance].variables[variable]
