"""The steps of the master as compiled code, steps.c: what is left beside the FMUs is next to nothing.

The shared library is made when the package is installed, where there is a C compiler. Without it, or if
its source is another one now, the loop runs in Python, with the same results.
"""

from collections.abc import Sequence
from ctypes import (
    CDLL,
    CFUNCTYPE,
    Structure,
    addressof,
    byref,
    c_bool,
    c_char,
    c_double,
    c_int32,
    c_int64,
    c_size_t,
    c_uint32,
    c_void_p,
    cast,
)
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from .call_trace import NUMBERS, current
from .calls import Call
from .input_lines import Line
from .instance import Instance
from .steps import Refusal

SOURCE = Path(__file__).with_name("steps.c")

SPEC = find_spec(f"{__package__}._steps")
"""Of the library; None if there is none."""


def library(path: str, source: Path) -> CDLL | None:
    """The library, if it was made of the source that is there: by another one records are laid out otherwise."""
    library = CDLL(path)
    made_of = sha256(source.read_bytes()).hexdigest()
    try:
        return library if (c_char * len(made_of)).in_dll(library, "digest").raw == made_of.encode() else None
    except ValueError:  # it does not tell
        return None


LIBRARY = library(SPEC.origin, SOURCE) if SPEC and SPEC.origin else None


def why_not() -> str | None:
    """Why a library that was made does not run; None if it does or there is none."""
    if LIBRARY or SPEC is None:
        return None
    return f"{SPEC.origin} was made of another {SOURCE.name}; the steps run in Python until the next installation"


TYPES = [c_double, c_int32, c_int64, c_bool]
"""Of values, numbered as in steps.c."""


class CompiledLine(Structure):
    """`Line` in steps.c."""

    _fields_ = (
        ("sent", c_void_p),
        ("factor", c_double),
        ("end", c_void_p),
        ("before", c_void_p),
        ("after", c_void_p),
    )


class CompiledCall(Structure):
    """`Call` in steps.c."""

    _fields_ = (
        ("fmi", c_int32),
        ("access", c_void_p),
        ("do_step", c_void_p),
        ("component", c_void_p),
        ("references", c_void_p),
        ("count", c_size_t),
        ("values", c_void_p),
        ("sources", c_void_p),
        ("factors", c_void_p),
        ("type", c_int32),
        ("is_number", c_int32),
        ("place", c_void_p),
        ("step_size", c_void_p),
        ("instance", c_int32),
        ("function", c_int32),
        ("rates", c_void_p),
        ("orders", c_void_p),
        ("lines", c_void_p),
        ("slopes", c_int32),
        ("every", c_int32),
        ("lead", c_int32),
    )


DO_STEP = CFUNCTYPE(c_int32, c_void_p, c_double, c_double, c_bool, *[c_void_p] * 4)
"""`DoStep3` in steps.c."""


def _watched(instance: Instance) -> Any:
    """The step of an FMU of FMI 3.0 that may ask for the end of the run."""
    do_step = DO_STEP(cast(instance.slave.dll["fmi3DoStep"], c_void_p).value or 0)

    def step(*arguments: Any) -> int:
        status = do_step(*arguments)
        instance.slave.ended = c_bool.from_address(arguments[5]).value  # type: ignore[union-attr]
        return status

    return DO_STEP(step)


class CompiledSteps:
    """The same as `fmuloop.steps.interpreted`; only where there is a LIBRARY."""

    def __init__(self, begin: Sequence[Call], end: Sequence[Call], row: bytearray, known: int) -> None:
        assert LIBRARY is not None
        self._make_steps = LIBRARY.make_steps
        self._make_steps.restype = c_size_t
        self._turn = len(begin)
        calls = self._calls = [*begin, *end]
        c_void_p.in_dll(LIBRARY, "call_record").value = addressof(current())
        # the records hold bare addresses: of these, and of what the calls keep
        self._sources = [(c_uint32 * len(call.sources))(*call.sources) for call in calls]
        self._factors = [(c_double * len(call.factors))(*call.factors) for call in calls]
        self._lines = [(CompiledLine * len(call.lines))(*map(_line, call.lines)) for call in calls]
        records = [*map(_record, calls, self._sources, self._factors, self._lines)]
        self._watched = []
        for call, record in zip(calls, records, strict=True):
            if record.do_step and record.fmi == 3 and not call.instance.own:
                self._watched.append(_watched(call.instance))
                record.do_step = cast(self._watched[-1], c_void_p)
        self._loop = (
            (CompiledCall * len(calls))(*records),
            c_size_t(self._turn),
            c_size_t(len(calls)),
            (c_char * len(row)).from_buffer(row),
            c_size_t(known),
        )

    def __call__(self, table: np.ndarray, numbers: range) -> Refusal | None:
        refused, status = c_size_t(), c_int32()
        rows, size = c_void_p(table.ctypes.data), c_size_t(table.itemsize)
        first, last = c_size_t(numbers.start), c_size_t(numbers.stop)
        step = self._make_steps(*self._loop, rows, size, first, last, byref(refused), byref(status))
        if step == numbers.stop:
            return None
        return Refusal(self._calls[refused.value], status.value, step, step + (refused.value >= self._turn))


def _line(line: Line) -> CompiledLine:
    return CompiledLine(_address(line.sent), line.factor, *map(_address, (line.end, line.before, line.after)))


def _address(number: c_double | None) -> int | None:
    return None if number is None else addressof(number)


def _record(call: Call, sources: Any, factors: Any, lines: Any) -> CompiledCall:
    record = CompiledCall(fmi=call.instance.interface.fmi, component=call.instance.component)
    record.instance, record.function = call.instance.number, NUMBERS[call.function]
    record.every, record.lead = call.every, call.lead
    function = cast(call.instance.slave.dll[call.function], c_void_p)
    record.step_size = _address(call.step_size)
    if call.values is None:
        record.do_step = function
        return record
    if call.orders is None:
        record.access = function
    else:
        record.rates, record.orders = function, addressof(call.orders)
    record.count, record.references = len(call.values), addressof(call.references)
    record.values = addressof(call.values)
    record.sources = addressof(sources) if call.sources else None
    record.type, record.is_number = TYPES.index(call.values._type_), call.is_number
    record.place = None if call.place is None else addressof(call.place)
    record.factors = addressof(factors) if call.factors else None
    record.lines, record.slopes = addressof(lines) if call.lines else None, call.slopes
    return record
