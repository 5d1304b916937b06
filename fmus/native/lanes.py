"""A block of several cars at a time: a library of its functions for the lanes of this processor's vectors.

It is made of the same trace as the native FMU, whose saved states it takes over.
"""

from pathlib import Path

from ...models.block.types import ContinuousBlock
from ..fmu import Fmu
from .compiler import compile_in, host_compiler
from .lane_statements import LaneStatements
from .packaging import C_FILES, c_sources
from .records import Names, records_of, structs
from .source import RARE, functions
from .statements import DOUBLE
from .tableau import lane_step_header
from .trace import trace

FLAGS = {
    4: ("-mavx2", "-mfma"),
    8: ("-mavx512f", "-mavx512dq", "-mavx512vl", "-mavx2", "-mfma", "-mprefer-vector-width=512"),
}
"""Of the compiler, by the number of lanes. Products may be added without being rounded first; nothing may be taken for
finite."""

COMMON = ("-std=gnu11", "-O2", "-ffp-contract=fast", "-fno-math-errno", "-fno-trapping-math", "-fvisibility=hidden")

LANES = DOUBLE._replace(real="lanes")

NAMES = Names(real="lanes", struct="Lanes", function="lanes_")

BLOCK = """/* {name} in lanes, written from {module}. */
#include "block.h"
#include "lanes.h"

{structs}

{prototypes}
"""

WHOLE = """/* The file to compile. */
#include "lanes.c"
#include "block.c"
#include "lane_block.c"
{integrator}
#include "lane_loop.c"
"""

INTEGRATOR = """#include "explicit.c"
#include "implicit.c"
#include "integrator.c"
"""


def lane_sources(fmu: Fmu) -> dict[str, bytes]:
    """All C files by name."""
    block = fmu.block
    records = records_of(block)
    traced = tuple(each for each in trace(block) if each.name not in RARE)
    made = functions(traced, records, LANES, NAMES, statements=LaneStatements)
    head = BLOCK.format(
        name=fmu.name,
        module=fmu.module,
        structs="\n\n".join(structs(records, NAMES, len(made.terms))),
        prototypes="\n".join(f"static {head};" for head, _ in made.heads),
    )
    continuous = isinstance(block, ContinuousBlock)
    sources = c_sources(fmu) | {name: (C_FILES / name).read_bytes() for name in ("lanes.h", "lanes.c", "lane_loop.c")}
    return sources | {
        "lane_block.h": head.encode(),
        "lane_block.c": made.text.encode(),
        "lane_dop853.h": lane_step_header().encode(),
        "whole.c": WHOLE.format(integrator=INTEGRATOR if continuous else "").encode(),
    }


def build_lanes(fmu: Fmu, lanes: int, path: Path) -> None:
    """Makes the library.

    Args:
        lanes: 4 or 8.

    Raises:
        CompilerError: there is no compiler, or it refuses the source.
    """
    command = [host_compiler(), *COMMON, *FLAGS[lanes], f"-DWIDTH={lanes}", "-shared", "-fPIC", "-s"]
    path.write_bytes(compile_in([*command, "whole.c", "-o", path.name, "-lm"], path.name, lane_sources(fmu)))
