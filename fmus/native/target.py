"""Writes a controller as plain C for the processor it is meant for: `python -m fmus.native.target`.

Two files without any FMI in them, `damping_controller.h` and `damping_controller.c`: the same structs and
arithmetic as in the FMU, but with names that stand alone in a project, and in single precision if wanted.
"""

import argparse
from pathlib import Path

from models.block.declaration import Enumeration, variables
from models.block.types import SampledBlock

from ..damping_controller import FMU
from ..errors import ParameterFileError
from ..fmu import Fmu
from ..options import add_parameter_files
from ..parameter_files import read_files
from .records import Names, records_of, structs
from .source import MEANINGS, function, head
from .statements import DOUBLE, SINGLE, Precision, constant
from .trace import trace

PRECISIONS = {"float": SINGLE, "double": DOUBLE}

HEADER = """/* {description}.

Written by `python -m fmus.native.target` from {module}, which is its documentation:

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

SOURCE = """/* Arithmetic of {file}.h, written by `python -m fmus.native.target` from {module}. */
#include "{file}.h"

#include <math.h>

const {struct}Parameters {function}parameters = {{
{parameters}
}};

{functions}
"""


def target_sources(fmu: Fmu, precision: Precision) -> dict[str, str]:
    """Header and source of a sampled block by file name, in C99 that calls nothing but math.h.

    Raises:
        ValueError: the block is continuous.
    """
    block = fmu.block
    if not isinstance(block, SampledBlock):
        raise ValueError(f"{fmu.name} is a continuous block; only sampled ones run on a target")
    file = fmu.module.rpartition(".")[2]
    names = Names(precision.real, fmu.name, f"{file}_")
    records, traced = records_of(block), trace(block)
    about = {"description": block.description, "module": fmu.module, "file": file, **names._asdict()}
    header = HEADER.format(
        **about,
        equations=fmu.equations.replace("*/", "* /").strip(),
        guard=f"{file.upper()}_H",
        macro=file.upper(),
        sample_time=constant(block.sample_time, precision),
        structs="\n\n".join(structs(records, names)),
        enumerations="\n\n".join(_enumerations(block.Output, names)),
        prototypes="\n".join(f"/* {MEANINGS[each.name]} */\n{head(each, names)};" for each in traced),
    )
    source = SOURCE.format(
        **about,
        parameters="\n".join(
            f"    .{name} = {constant(float(value), precision)}," for name, value in records["p"]._asdict().items()
        ),
        functions="\n\n".join(function(each, records, precision, names) for each in traced),
    )
    return {f"{file}.h": header, f"{file}.c": source}


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


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m fmus.native.target", description="Write the controller as plain C."
    )
    parser.add_argument("--output", type=Path, default=Path("build/target"), help="folder (default: build/target)")
    parser.add_argument("--precision", choices=PRECISIONS, default="float", help="of its arithmetic (default: float)")
    add_parameter_files(parser)
    arguments = parser.parse_args()
    try:
        fmu = FMU.started_with(read_files(arguments.vehicle, arguments.parameters))
    except ParameterFileError as refusal:
        parser.error(str(refusal))
    arguments.output.mkdir(parents=True, exist_ok=True)
    for name, text in target_sources(fmu, PRECISIONS[arguments.precision]).items():
        path = arguments.output / name
        path.write_text(text, encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
