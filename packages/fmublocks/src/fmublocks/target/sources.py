"""A controller as plain C for the processor it is meant for.

Files without any FMI in them: the same structs and arithmetic as in the FMU, but with names that stand alone in a
project, and in single precision if wanted.
"""

from ..block.declaration import Enumeration, variables
from ..block.types import SampledBlock
from ..errors import BuildError
from ..fmu import Fmu
from ..native.records import Names, records_of, structs
from ..native.source import functions
from ..native.statements import DOUBLE, SINGLE, Precision, constant
from ..native.trace import trace

PRECISIONS = {"float": SINGLE, "double": DOUBLE}
"""By the type of a real number in C."""

HEADER = """/* {description}.

Written by fmublocks from {module}, which is its documentation:

{equations}
*/
#ifndef {guard}
#define {guard}

#define {macro}_SAMPLE_TIME {sample_time} /* s */

{structs}

{enumerations}

/* The parameters with their declared values. */
extern const {struct}Parameters {function}parameters;

/* A state and the next one are two records; what `update` computes at one sample, `output` shows at the next. */

{prototypes}

#endif
"""

SOURCE = """/* Arithmetic of {file}.h, written by fmublocks from {module}. */
#include "{file}.h"

#include <math.h>
#include <stdbool.h>

const {struct}Parameters {function}parameters = {{
{parameters}
}};

{functions}
"""


ANY = """/* The controller under names that do not tell which it is, written by fmublocks. */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "{file}.h"

typedef {struct}Input ControllerInput;
typedef {struct}Parameters ControllerParameters;
typedef {struct}State ControllerState;
typedef {struct}Output ControllerOutput;

#define CONTROLLER_NAME "{struct}"
#define CONTROLLER_SAMPLE_TIME {macro}_SAMPLE_TIME
#define controller_parameters {function}parameters
#define controller_start {function}start
#define controller_output {function}output
#define controller_update {function}update

#endif
"""


def target_sources(fmu: Fmu, precision: Precision) -> dict[str, str]:
    """Headers and source of a sampled block by file name, in C99 that calls nothing but math.h.

    Raises:
        BuildError: the block is continuous.
    """
    block = fmu.block
    if not isinstance(block, SampledBlock):
        raise BuildError(f"{fmu.name} is a continuous block; only sampled ones run on a target")
    file = fmu.module.rpartition(".")[2]
    names = Names(precision.real, fmu.name, f"{file}_")
    records = records_of(block)
    code = functions(trace(block), records, precision, names, computed_once=False)
    about = {"description": block.description, "module": fmu.module, "file": file, **names._asdict()}
    header = HEADER.format(
        **about,
        equations=fmu.equations.replace("*/", "* /").strip(),
        guard=f"{file.upper()}_H",
        macro=file.upper(),
        sample_time=constant(block.sample_time, precision),
        structs="\n\n".join(structs(records, names)),
        enumerations="\n\n".join(_enumerations(block.Output, names)),
        prototypes="\n".join(f"/* {meaning} */\n{head};" for head, meaning in code.heads),
    )
    source = SOURCE.format(
        **about,
        parameters="\n".join(
            f"    .{name} = {constant(float(value), precision)}," for name, value in records["p"]._asdict().items()
        ),
        functions=code.text,
    )
    return {f"{file}.h": header, f"{file}.c": source, "controller.h": ANY.format(**about, macro=file.upper())}


def _enumerations(record: type, names: Names) -> list[str]:
    """For each enumeration in a record a C type with its values."""
    return [
        _enumeration(variable.declaration, names)
        for variable in variables(record)
        if isinstance(variable.declaration, Enumeration)
    ]


def _enumeration(declaration: Enumeration, names: Names) -> str:
    rows = [
        (f"{names.function}{name}".upper() + f" = {number},", meaning)
        for number, (name, meaning) in enumerate(declaration.items, start=1)
    ]
    width = max(len(row) for row, _ in rows)
    lines = "\n".join(f"    {row:{width}}  /* {meaning} */" for row, meaning in rows)
    return f"enum {names.struct}{declaration.name} {{ /* {declaration.description} */\n{lines}\n}};"
