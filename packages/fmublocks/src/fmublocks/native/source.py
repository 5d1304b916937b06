"""The C source of a block: block.h and block.c, and variables.h with what a host sees of it."""

import re
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, NamedTuple

from ..block.declaration import Enumeration
from ..block.explicit import small_sizes
from ..block.frame import layout
from ..block.types import SampledBlock
from ..description.states import event_indicators, shown_by_fmi3, states
from ..description.terminal import BAUD_RATE, OPERATIONS_SIZE, members
from ..description.variables import Variable, interface
from ..fmu import Fmu
from .arithmetic import Graph
from .records import IN_FMU, RECORDS, Names, paths, records_of, structs
from .statements import DOUBLE, Precision, Statements
from .terms import TERMS, Terms
from .trace import Traced, trace

MEANINGS = {
    "start": "The state at the start, with the inputs of that instant.",
    "output": "The outputs.",
    "derivative": "The rate of change of the state.",
    "derivative_held": "The same, with what depends on inputs and parameters alone.",
    "held_terms": "What the rate of change of the state needs that depends on inputs and parameters alone: all of it, "
    "or what depends on inputs that move at the rates du.",
    "event_indicators": "Values that are zero where the equations have a kink.",
    "solution": "Whether the solution in closed form holds for a step of h s, and the state at its end, for inputs "
    "that move at the rates du.",
    "next_event": "The time in s until outputs jump by themselves.",
    "update": "The state at the next sample.",
    "frame": "What the bits of the signals of the frame hold, as whole numbers.",
    "output_rate": "The rate of change of the outputs when state and inputs change at the rates dx and du.",
    "output_tangent": "The change of the outputs with small changes dx, du and dp, to first order.",
    "derivative_tangent": "The change of the derivative then.",
    "start_tangent": "The change of the state at the start with those of inputs and parameters.",
    "compute_terms": "Computes the terms that depend on the other parameters alone, whenever one of these was set.",
}

HEADER = """/* {name}: {description}.

Written by build_fmus.py from {module}, which is its documentation:

{equations}
*/
#ifndef BLOCK_H
#define BLOCK_H

typedef {precision.real} real;

{structs}

{constants}

{prototypes}

#endif
"""

SOURCE = """/* {name}: arithmetic, written by build_fmus.py from {module}. */
#include "block.h"
#include "operators.h"

{functions}
"""


def block_sources(fmu: Fmu, precision: Precision = DOUBLE, others: tuple[Traced, ...] = ()) -> dict[str, str]:
    """block.h and block.c: the functions of the block in plain C99, with no need of anything of FMI.

    Args:
        others: functions beside those of the block.
    """
    block = fmu.block
    records, traced = records_of(block), (*trace(block), *others)
    code = functions(traced, records, precision)
    about = {"name": fmu.name, "description": block.description, "module": fmu.module}
    header = HEADER.format(
        **about,
        equations=fmu.equations.replace("*/", "* /").strip(),
        precision=precision,
        structs="\n\n".join(structs(records, terms=len(code.terms))),
        constants="\n".join(_constants(fmu, traced, code.held)),
        prototypes="\n".join(f"/* {meaning} */\nstatic {head};" for head, meaning in code.heads),
    )
    return {"block.h": header, "block.c": SOURCE.format(**about, functions=code.text)}


def _constants(fmu: Fmu, traced: tuple[Traced, ...], held: int) -> list[str]:
    """What else there is to know of the block."""
    if isinstance(fmu.block, SampledBlock):
        return [f"#define SAMPLE_TIME {fmu.block.sample_time!r} /* s */"]
    sizes = {function.name: len(function.values) for function in traced}
    return [
        f"#define LONGEST_STEP {fmu.block.step_size!r} /* s: of the integration */",
        f"#define ALLOWED_ERROR {fmu.block.allowed_error!r} /* of a step, in units of what is tolerated */",
        f"#define INDICATORS {sizes.get('event_indicators', 0)}",
        f"#define TIME_EVENTS {sizes.get('next_event', 0)}",
        *([f"#define HELD_TERMS {held} /* numbers that held_terms computes */"] if held else []),
        *(["#define HAS_SOLUTION"] if "solution" in sizes else []),
        f"#define SMALL_SIZES {{{', '.join(map(repr, small_sizes(fmu.block)))}}} /* of the states: see explicit.py */",
        f"#define NOMINALS {{{', '.join(repr(v.nominal or 1.0) for v in states(fmu.block) if v.of is None)}}}",
    ]


def _letter(name: str) -> str:
    """The letter of the record that an argument or result is one of; a rate of change is one of what changes."""
    return "x" if name == "next" else name.lstrip("d")


WIDTH = 118
"""Of a line of C."""


class Functions(NamedTuple):
    """The functions of a block in C.

    Attributes:
        heads: of each the head and what it computes.
        text: all of them.
        terms: values of the terms that depend on the declared parameters alone.
        held: how many terms of the derivative depend on inputs and parameters alone.
    """

    heads: list[tuple[str, str]]
    text: str
    terms: list[float]
    held: int


RARE = ("start", "start_tangent", "output_tangent", "derivative_tangent")
"""Functions that are not called in steps; all that they need they compute themselves."""


def functions(
    traced: Iterable[Traced],
    records: dict[str, Any],
    precision: Precision,
    names: Names = IN_FMU,
    computed_once: bool = True,
    statements: type[Statements] = Statements,
) -> Functions:
    """The traced functions, and one that computes what depends on parameters alone.

    Args:
        records: one of each record of the block, by their letters.
        computed_once: else each function computes that by itself, and parameters can be changed without a call.
        statements: writes them.
    """
    terms, held = Terms(f"p->{TERMS}"), Terms("w")
    heads, texts = list[tuple[str, str]](), list[str]()

    def add(name: str, arguments: list[str], lines: list[str], used: Iterable[str]) -> None:
        heads.append((_line(f"{names.function}{name}", arguments), MEANINGS[name]))
        texts.append(_function(heads[-1][0], lines, used))

    for function in traced:
        graph = function.graph([_lvalues(name, records) for name in function.arguments])
        if computed_once and function.name not in RARE:
            terms.take(graph, [function.arguments.index("p")])
        if function.name == "derivative":
            held.take(graph, [function.arguments.index("u"), function.arguments.index("p"), len(graph.inputs) - 1])
        size = len(function.values)
        outputs = [f"z[{k}]" for k in range(size)] if function.result == "z" else _lvalues(function.result, records)
        lines, arguments = statements(graph, outputs, precision).lines, _arguments(function, names)
        if function.name == "derivative" and held.outputs:
            x, u, p, dx = arguments
            add("derivative_held", [x, u, p, f"const {names.real} w[]", dx], lines, function.arguments)
            moving = [u, p, u.replace("*u", "*du"), f"{names.real} w[]"]
            add("held_terms", moving, _held_lines(held, partial(statements, precision=precision)), "up")
            lines = [
                f"    {names.real} w[HELD_TERMS];",
                f"    {names.function}held_terms(u, p, 0, w);",
                f"    {names.function}derivative_held(x, u, p, w, dx);",
            ]
        add(function.name, arguments, lines, function.arguments)
    if computed_once:
        add("compute_terms", [f"{names.struct}Parameters *p"], statements(terms, terms.names(), precision).lines, "p")
    declared = terms.values(list(map(float, records["p"])))
    return Functions(heads, "\n\n".join(texts), declared, len(held.outputs))


def _held_lines(held: Terms, statements: Callable[[Graph, list[str]], Statements]) -> list[str]:
    """Those of held_terms: a block for all terms that depend on the same inputs."""
    lines: list[str] = []
    for inputs, part in held.by_inputs():
        written = statements(part, held.names())
        moves = " || ".join(["!du", *(written.is_not_zero(f"d{name}") for name in inputs)])
        lines += [f"    if ({moves}) {{", *(f"    {line}" for line in written.lines), "    }"]
    return lines


def _arguments(function: Traced, names: Names) -> list[str]:
    """Those of a function in C."""

    def pointer(name: str) -> str:
        return f"{names.struct}{RECORDS[_letter(name)]} *{name}"

    arguments = [f"{names.real} h" if name == "h" else f"const {pointer(name)}" for name in function.arguments]
    return [*arguments, f"{names.real} z[]" if function.result == "z" else pointer(function.result)]


def _line(name: str, arguments: list[str]) -> str:
    line = f"void {name}({', '.join(arguments)})"
    return line if len(line) <= WIDTH else line.replace("(", "(\n    ").replace(", ", ",\n    ")


def _function(head: str, lines: list[str], arguments: Iterable[str]) -> str:
    text = "\n".join(lines)
    unused = [f"    (void){name};" for name in arguments if not re.search(rf"(?<![>.\w]){name}\b", text)]
    return "\n".join([head, "{", *unused, *lines, "}"])


def _lvalues(name: str, records: dict[str, Any]) -> list[str]:
    if name == "h":
        return [name]
    return [path.replace(f"{name}.", f"{name}->", 1) for path in paths(name, records[_letter(name)])]


VARIABLES = """/* {name}: its variables as its host sees them, written by build_fmus.py from {module}. */
#ifndef VARIABLES_H
#define VARIABLES_H

#include "variable.h"

#include <stddef.h>

static const char *const model_name = "{name}";
static const char *const model_guid = "{guid}";
static const int copes_with_bad_input = {copes}; /* inputs are not refused */
static const int gives_bad_output = {bad_output}; /* NaN may be what it is for */
enum {{ allows_model_exchange = {exchanges} }};
#define FIRST_INSTANCE {name}_instance /* the name of its place in the binary */
static const unsigned variable_count = {count};
static const unsigned reference_count = {references}; /* behind the variables comes what follows from the state */
static const unsigned last_reference = {last}; /* of all, also of those that the adapter has */

static const Variable variables[{references}] = {{
{rows}
}};

static const char *const input_names[] = {{
{inputs}
}};

static const char *const state_names[] = {{
{states}
}};

#endif
"""

FIELD = {"input": "u", "output": "y", "parameter": "p"}


def variables_header(fmu: Fmu, guid: str, fmi: int = 2) -> str:
    """variables.h: name, unit, place, bounds and start value of every variable, by value reference; for that FMI."""
    block, listed, records = fmu.block, interface(fmu.block), records_of(fmu.block)
    exchanged, indicators = states(block), event_indicators(block) if fmi == 3 else ()
    fields = block.State._fields * 2 if exchanged else ()
    following = [*map(_state_row, exchanged, fields), *(_indicator_row(v, n) for n, v in enumerate(indicators))]
    known = listed + exchanged + indicators
    return VARIABLES.format(
        name=fmu.name,
        module=fmu.module,
        guid=guid,
        copes=int(block.tolerates_bad_input),
        bad_output=int(block.gives_bad_output),
        exchanges=int(bool(exchanged)),
        count=len(listed),
        references=len(known),
        last=(shown_by_fmi3(block) if fmi == 3 else known)[-1].reference,
        rows="\n".join([*(_row(variable, fmi) for variable in listed), *following]),
        inputs=_names(records["u"]),
        states=_names(records["x"]),
    )


def _names(record: Any) -> str:
    """What stands behind the name of a record to name each number in it; there is one at least, as in C."""
    return "\n".join(f'    "{path}",' for path in list(paths("", record)) or [".none"])


def _row(variable: Variable, fmi: int) -> str:
    place = f"offsetof(Values, {FIELD[variable.causality]}.{variable.name})"
    is_enumeration = fmi == 3 and isinstance(variable.declaration, Enumeration)
    return _written(
        variable, "ENUMERATION" if is_enumeration else variable.fmi_type.upper(), variable.causality.upper(), place
    )


def _state_row(variable: Variable, field: str) -> str:
    kind = "STATE" if variable.of is None else "RATE"
    return _written(variable, "REAL", kind, f"offsetof(State, {field})")


def _indicator_row(variable: Variable, place: int) -> str:
    return _written(variable, "REAL", "INDICATOR", f"{place} * sizeof(double)")


def _written(variable: Variable, fmi_type: str, kind: str, place: str) -> str:
    low, high = variable.bounds()
    start = 0.0 if variable.start is None else variable.start
    numbers = ", ".join(_number(value) for value in (low, high, start))
    kinds = f"{fmi_type}, {kind}, {int(variable.variability == 'tunable')}"
    unit = f" {variable.unit}" if variable.unit else ""
    return f'    {{"{variable.name}", "{unit}", "{variable.allowed()}", {kinds}, {place}, {numbers}}},'


def _number(value: Any) -> str:
    return repr(float(value))


FRAME_HEADER = """/* {frame}: the frame that is sent, and the terminal; written by build_fmus.py from {module}. */
#ifndef FRAME_H
#define FRAME_H

#define FRAME_COUNTER {counter} /* among the outputs: one more with every frame */

enum {{ FRAME_IDENTIFIER = {identifier:#x}, FRAME_SIGNALS = {signals}, FRAME_LENGTH = {length} /* bytes */ }};
enum {{ BAUD_RATE = {baud_rate} /* bit/s */, OPERATIONS_SIZE = {size} /* bytes, at most */ }};
enum {{ TX_DATA = {first}, TX_CLOCK, RX_DATA, RX_CLOCK }}; /* value references */

static const unsigned frame_bits[FRAME_SIGNALS] = {{{bits}}};
static const char *const terminal_names[] = {{{names}}}; /* from TX_DATA on */

#endif
"""


def frame_header(fmu: Fmu) -> str:
    """The header, for the first frame of the block with its start values."""
    frame, terminal = fmu.block.frames[0], members(fmu.block)
    bits = [layout(content, fmu.block.Parameters()).bits for content in frame.contents]
    return FRAME_HEADER.format(
        frame=frame.name,
        module=fmu.module,
        counter=frame.counter,
        identifier=frame.identifier,
        signals=len(bits),
        length=(sum(bits) + 7) // 8,
        baud_rate=BAUD_RATE,
        size=OPERATIONS_SIZE,
        first=min(terminal.values()),
        bits=", ".join(map(str, bits)),
        names=", ".join(f'"{name}"' for name in terminal),
    )
