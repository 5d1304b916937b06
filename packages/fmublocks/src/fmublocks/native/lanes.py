"""A block of several cars at a time: a library of its functions for the lanes of this processor's vectors.

It is made of the same trace as the native FMU, whose saved states it takes over.
"""

from pathlib import Path

from ..block.types import ContinuousBlock
from ..fmu import Fmu
from .arithmetic import TRUTH_VALUES, Guard, Node
from .compiler import compile_in, host_compiler
from .packaging import C_FILES, c_sources
from .records import Names, records_of, structs
from .source import RARE, functions
from .statements import ATOM, CALLED, DOUBLE, PRODUCT, SIGN, Statements, Text
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
    traced = tuple(function for function in trace(block) if function.name not in RARE)
    code = functions(traced, records, LANES, NAMES, statements=LaneStatements)
    head = BLOCK.format(
        name=fmu.name,
        module=fmu.module,
        structs="\n\n".join(structs(records, NAMES, len(code.terms))),
        prototypes="\n".join(f"static {head};" for head, _ in code.heads),
    )
    continuous = isinstance(block, ContinuousBlock)
    sources = c_sources(fmu) | {name: (C_FILES / name).read_bytes() for name in ("lanes.h", "lanes.c", "lane_loop.c")}
    return sources | {
        "lane_block.h": head.encode(),
        "lane_block.c": code.text.encode(),
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


class LaneStatements(Statements):
    """Numbers are `lanes`, truth values `mask`, and a choice takes both values; see lanes.h.

    What is needed on one side of a choice alone is computed if a car is on that side.
    """

    LEAST = 16

    @staticmethod
    def is_not_zero(number: str) -> str:
        """Of a car."""
        return f"is_any({number} != 0.0)"

    def _type(self, node: Node) -> str:
        return "mask" if node.operation in (*TRUTH_VALUES, "INDEX") else "lanes"

    def _sides(self, condition: int, chosen: list[int], names: list[str], context: frozenset[Guard]) -> None:
        truth = self._truth(condition).text
        for opening, place in ((f"if (is_any({truth})) {{", 1), (f"if (is_any(~({truth}))) {{", 2)):
            self._line(opening)
            self._side(condition, place, chosen, names, context)
            self._line("}")

    def _side_value(self, condition: int, place: int, name: str, value: int) -> str:
        number = self._number(value).text
        return number if place == 1 else f"chosen({self._truth(condition).text}, {name}, {number})"

    def _number(self, k: int) -> Text:
        text = self._texts[k]
        if self._graph.nodes[k].operation not in TRUTH_VALUES:
            return text
        return Text(f"chosen({text.text}, {self._constant(1.0)}, {self._constant(0.0)})")

    def _constant(self, value: float) -> str:
        return f"all_lanes({super()._constant(value)})"

    def _expression(self, node: Node) -> Text:
        operation, operands = node.operation, node.operands
        match operation:
            case "INPUT" | "CONSTANT" | "LT" | "LE" | "EQ" | "NE":
                return super()._expression(node)
            case "CHOICE":
                return self._call("chosen", self._truth(operands[0]), *map(self._number, operands[1:]))
            case "INDEX":
                return self._call("index_of", self._number(operands[0]), Text(str(int(node.number))))
            case "WHOLE":
                return self._call("whole", self._number(operands[0]))
            case "ELEMENT":
                vector, element = node.place
                return self._call("element", Text(f"&{self._graph.inputs[vector][element]}"), self._texts[operands[0]])
            case "NOT":
                return Text(f"~{self._truth(operands[0]).within(ATOM)}", SIGN)
            case "AND" | "OR":
                sign = " & " if operation == "AND" else " | "
                return Text(f"({sign.join(self._truth(k).within(SIGN) for k in operands)})")
            case "DIV" if self._graph.nodes[operands[1]]._replace(value=0.0) == Node("CONSTANT"):
                inverse = 1.0 / self._graph.nodes[operands[1]].number
                return Text(f"{self._number(operands[0]).within(PRODUCT)} * {self._constant(inverse)}", PRODUCT)
            case "ADD" | "SUB" | "MUL" | "DIV" | "NEG":
                return super()._expression(node)
            case "TWICE" | "INV":
                sign, first = ("*", 2.0) if operation == "TWICE" else ("/", 1.0)
                return Text(f"{self._constant(first)} {sign} {self._number(operands[0]).within(SIGN)}", PRODUCT)
        name = {"SQ": "square", "FMOD": "modulo", "SIGN": "sign_of"}.get(operation) or CALLED.get(
            operation, operation.lower()
        )
        return self._call(f"{name}_in_lanes", *map(self._number, operands))

    @staticmethod
    def _call(function: str, *arguments: Text) -> Text:
        return Text(f"{function}({', '.join(argument.text for argument in arguments)})")
