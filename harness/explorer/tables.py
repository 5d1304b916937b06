"""The calls of loops as C: what `compiled_steps.py` binds in memory, written down for a module that has the FMUs."""

from collections.abc import Iterator, Mapping, Sequence
from ctypes import addressof, c_char, c_double, c_int, sizeof
from typing import Any, NamedTuple

from fmuloop.bound_calls import wired
from fmuloop.calls import Call
from fmuloop.compiled_steps import TYPES
from fmuloop.input_lines import Line
from fmuloop.interface import Interface
from fmuloop.row_layout import Layout
from fmuloop.system import Scheme
from fmuloop.wiring import Fit

ROWS = 1025
"""Of the table in the module, which a long run fills again and again."""

C_TYPES = {c_double: "double", c_int: "int32_t"}


class Named(NamedTuple):
    """An FMU in the place of an instance: what calls are named by, without a binary."""

    name: str
    number: int
    interface: Interface
    component: None = None

    def function(self, name: str) -> Any:
        """Is called by nobody."""
        return name.__len__


class Loop(NamedTuple):
    """A loop in the module.

    Attributes:
        text: its tables.
        size: bytes of a row, with output derivatives.
        layout: of the row.
        inputs: `instance.variable` that are given from outside.
    """

    text: str
    size: int
    layout: Layout
    inputs: Sequence[str]


def loop(number: int, fitted: Fit, inputs: Sequence[str], fmus: Sequence[str]) -> Loop:
    """The tables of a loop under the propagated scheme.

    Args:
        inputs: `instance.variable` of those that are given from outside.
        fmus: names of the FMUs of the module.

    Raises:
        WiringError: the scheme does not suit the system.
    """
    instances = [Named(name, k, interface) for k, (name, interface) in enumerate(fitted.interfaces.items())]
    bound: list[Any] = []

    def written(*arguments: Any) -> Any:
        bound.extend(arguments)

    wires = wired(fitted, instances, inputs, Scheme.PROPAGATED, c_double(), written)  # type: ignore[arg-type]
    begin, end, row, known = bound
    tables = _Tables(number, row)
    steps, hand_over = tables.calls([*begin, *end]), tables.calls(wires.hand_over)
    places = ", ".join(str(fmus.index(instance.interface.identifier)) for instance in instances)
    text = [
        f"static unsigned char row_{number}[{len(row)}] __attribute__((aligned(8)));",
        f"static const uint32_t fmus_{number}[] = {{{places}}};",
        *tables.lines,
        f"static Call calls_{number}[] = {{\n{steps}\n}};",
        f"static Call handed_{number}[] = {{\n{hand_over}\n}};",
        f"#define LOOP_{number} {{fmus_{number}, {len(instances)}, "
        f"calls_{number}, {len(begin)}, {len(begin) + len(end)}, "
        f"handed_{number}, {len(wires.hand_over)}, row_{number}, {known}, {wires.layout.dtype.itemsize}, {len(row)}}}",
    ]
    return Loop("\n".join(text), len(row), wires.layout, inputs)


def tables(loops: Sequence[Loop], guids: Mapping[str, str], exchanging: frozenset[str]) -> str:
    """tables.h.

    Args:
        guids: of the FMUs, by their names.
        exchanging: those that are for model exchange too.
    """
    return "\n\n".join(
        [
            *(_declared(name, name in exchanging) for name in guids),
            "static const Fmu fmus[] = {\n"
            + "\n".join(_fmu(*item, item[0] in exchanging) for item in guids.items())
            + "\n};",
            *(loop.text for loop in loops),
            f"static const Loop loops[] = {{{', '.join(f'LOOP_{k}' for k in range(len(loops)))}}};\n",
        ]
    )


FUNCTIONS = (
    *("Instantiate", "SetupExperiment", "EnterInitializationMode", "ExitInitializationMode", "Reset", "FreeInstance"),
    *("SetReal", "SetInteger", "SetBoolean"),
)
EXCHANGING = (
    *("SetContinuousStates", "GetContinuousStates", "GetDerivatives", "NewDiscreteStates", "EnterContinuousTimeMode"),
)
STEPPING = ("DoStep", "GetReal", "GetInteger", "GetBoolean", "SetRealInputDerivatives", "GetRealOutputDerivatives")


def _declared(name: str, exchanging: bool) -> str:
    functions = (*FUNCTIONS, *STEPPING, *(EXCHANGING if exchanging else ()))
    return "\n".join(f"extern fmi2{function}TYPE {name}_fmi2{function};" for function in functions)


def _fmu(name: str, guid: str, exchanging: bool) -> str:
    known = [f"{name}_fmi2{function}" for function in FUNCTIONS]
    known += [f"{name}_fmi2{function}" if exchanging else "0" for function in EXCHANGING]
    return f'    {{"{guid}", {", ".join(known)}}},'


class _Tables:
    """Writes calls; what they point to goes before them.

    Attributes:
        lines: definitions of arrays.
    """

    def __init__(self, number: int, row: bytearray) -> None:
        self.lines: list[str] = []
        self._number = number
        self._row = addressof((c_char * len(row)).from_buffer(row)), len(row)
        self._values: dict[int, tuple[str, Any]] = {}
        self._names = 0

    def calls(self, calls: Sequence[Call]) -> str:
        for call in calls:
            if call.values is not None and self._place(addressof(call.values)) is None:
                kind = C_TYPES[call.values._type_]
                name = self._array(kind, f"[{len(call.values)}]", "")
                self._values[addressof(call.values)] = name, call.values
        return "\n".join(f"    {{{', '.join(self._fields(call))}}}," for call in calls)

    def _fields(self, call: Call) -> Iterator[str]:
        function = f"(void (*)(void)){call.instance.interface.identifier}_{call.function}"
        yield ".fmi = 2"
        yield f".instance = {call.instance.number}"
        if call.step_size is not None:
            yield ".step_size = &step_size"
        if call.values is None:
            yield f".do_step = {function}"
            return
        yield f".access = {function}" if call.orders is None else f".rates = {function}"
        yield f".references = {self._array('const uint32_t', '[]', ', '.join(map(str, call.references)))}"
        yield f".count = {len(call.values)}, .values = {self._pointer(addressof(call.values))}"
        yield f".type = {TYPES.index(call.values._type_)}, .is_number = {int(call.is_number)}"
        if call.orders is not None:
            yield f".orders = {self._array('const int32_t', '[]', ', '.join(map(str, call.orders)))}"
        if call.sources:
            yield f".sources = {self._array('const uint32_t', '[]', ', '.join(map(str, call.sources)))}"
        if call.factors:
            yield f".factors = {self._array('const double', '[]', ', '.join(map(repr, call.factors)))}"
        if call.lines:
            lines = self._array("Line", "[]", ", ".join(map(self._line, call.lines)))
            yield f".lines = {lines}, .slopes = {int(call.slopes)}"

    def _line(self, line: Line) -> str:
        numbers = (line.sent, line.end, line.before, line.after)
        sent, end, before, after = ("0" if n is None else f"(double *){self._pointer(addressof(n))}" for n in numbers)
        return f"{{{sent}, {line.factor!r}, {end}, {before}, {after}}}"

    def _array(self, kind: str, size: str, content: str) -> str:
        self._names += 1
        name = f"a_{self._number}_{self._names}"
        self.lines.append(f"static {kind} {name}{size}" + (f" = {{{content}}};" if content else ";"))
        return name

    def _pointer(self, address: int) -> str:
        pointer = self._place(address)
        assert pointer is not None
        return pointer

    def _place(self, address: int) -> str | None:
        """What is at an address that a call has: a byte of the row, or a value that is set."""
        row, size = self._row
        if row <= address < row + size:
            return f"(void *)(row_{self._number} + {address - row})"
        for begin, (name, values) in self._values.items():
            if begin <= address < begin + sizeof(values):
                return f"({name} + {(address - begin) // sizeof(values._type_)})"
        return None
