"""Back to back: the functions in Python and the same in C, on random arguments."""

import math
import random
import subprocess

import pytest
from fmutesting.functions import Functions
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks.block.noise import M
from fmublocks.block.types import ContinuousBlock, SampledBlock
from fmublocks.description.variables import interface
from fmublocks.native.compiler import host_compiler
from fmublocks.native.packaging import C_FILES
from fmublocks.native.trace import leaves

TOLERANCE = 1e-12
"""Relative. Every operation is the same and rounds the same; on another machine sin, tanh and so on may not."""

TIMES = 1000

every_fmu = pytest.mark.parametrize("name", FMUS)


@pytest.fixture(scope="module")
def functions(native_builder, tmp_path_factory):
    return {name: Functions(fmu, tmp_path_factory.mktemp(name)) for name, fmu in FMUS.items()}


def records(block, draw):
    """Random inputs and parameters within their bounds."""
    values = [value(v, draw) for v in interface(block) if v.causality != "output"]
    inputs = len(block.Input._fields)
    return block.Input._make(values[:inputs]), block.Parameters._make(values[inputs:])


def value(variable, draw):
    low, high = variable.bounds()
    if variable.fmi_type == "Boolean":
        return draw.random() < 0.5
    if variable.fmi_type == "Integer":
        return draw.randint(max(low, -1000), min(high, 1000000))
    if draw.random() < 0.5 and variable.start is not None:
        return variable.start
    return draw.uniform(max(low, -1e3), min(high, 1e3))


def moved(x, draw):
    """The state with all its numbers a little or a lot different; truth values and counts stay what they are."""
    if not isinstance(x, tuple):
        return x if type(x) is not float else x + draw.choice((0.0, 1e-3, 0.1, 10.0)) * draw.gauss(0.0, 1.0)
    return getattr(type(x), "_make", tuple)([moved(item, draw) for item in x])


def assert_same(computed, expected):
    expected = [float(number) for number in leaves(tuple(expected))]
    for c, python in zip(computed, expected, strict=True):
        assert c == python or math.isclose(c, python, rel_tol=TOLERANCE) or (math.isnan(c) and math.isnan(python))


@every_fmu
def test_start_and_outputs_are_equal(functions, name):
    block, draw = FMUS[name].block, random.Random(name)
    for _ in range(TIMES):
        u, p = records(block, draw)
        x = block.start(u, p)
        assert_same(functions[name]("start", u, p), x)
        x = moved(x, draw)
        assert_same(functions[name]("output", leaves(x), u, p), block.output(x, u, p))


@every_fmu
def test_what_moves_the_state_is_equal(functions, name):
    block, draw = FMUS[name].block, random.Random(name)
    function = "update" if isinstance(block, SampledBlock) else "derivative"
    for _ in range(TIMES):
        u, p = records(block, draw)
        x = moved(block.start(u, p), draw)
        assert_same(functions[name](function, leaves(x), u, p), getattr(block, function)(x, u, p))
        if isinstance(block, ContinuousBlock) and (indicators := block.event_indicators(x, u, p)):
            assert_same(functions[name]("event_indicators", leaves(x), u, p), indicators)


@together("value", [math.nan, math.inf, -math.inf, 1e300])
@together("signal", ["T_driver", "omega_1_meas", "T_mot_est", "omega_2_can"])
def test_the_controller_copes_with_the_same_bad_signals(functions, signal, value):
    block = FMUS["DampingController"].block
    assert isinstance(block, SampledBlock)
    u, p = block.Input(), block.Parameters()
    x = block.start(u, p)
    for k in range(100):
        u = u._replace(valid=True, counter=k // 10, omega_1_meas=100.0)._replace(**{signal: value})
        assert_same(functions["DampingController"]("update", leaves(x), u, p), block.update(x, u, p))
        x = block.update(x, u, p)


def computed_by_operators(tmp_path, expression):
    """The value of an expression in C."""
    program = f'#include "operators.h"\n#include <stdio.h>\nint main(void) {{ printf("%a", {expression}); }}'
    (tmp_path / "block.h").write_text("typedef double real;\n")
    (tmp_path / "operators.h").write_bytes((C_FILES / "operators.h").read_bytes())
    (tmp_path / "main.c").write_text(program)
    subprocess.run([host_compiler(), "main.c", "-o", "main", "-lm"], cwd=tmp_path, check=True)
    return float.fromhex(subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True).stdout)


@together("y", [2.0, 48.0, M, 2.0**26, 2.0**26 + 1.0, 5.5])
def test_remainders_are_exact_beside_multiples_and_halves(native_builder, tmp_path, y):
    multiples = [k * y for k in (0.0, 0.5, 1.0, 1.5, 2.0, y - 1.0, y - 0.5, y, 2.0**26, 2.0**26 + 1.0)]
    numbers = [math.nextafter(x, x + side) for x in multiples for side in (-1.0, 0.0, 1.0)]
    signs = " || ".join(f"modulo({x!r}, {y!r}) != {x % y!r}" for x in numbers)
    assert computed_by_operators(tmp_path, f"({signs}) ? 1.0 : 0.0") == 0.0


@together(
    "expression, value",
    [
        *((f"modulo({x}, {y})", x % y) for x, y in ((7.5, 2.0), (-7.5, 2.0), (-6.0, 3.0), (7.0, -3.0), (1e17, 7.0))),
        *((f"modulo({x}, {y})", x % y) for x, y in ((-0.25, 48.0), (5.5, 2.25), (7.75, 3.5), (-96.0, 48.0))),
        *((f"modulo({x}, 0.0)", math.nan) for x in (0.0, 3.0, 3.5)),
        *((f"sign_of({x})", value) for x, value in ((-2.5, -1.0), (-0.0, 0.0), (0.0, 0.0), (5e-324, 1.0), (2.5, 1.0))),
    ],
)
def test_a_remainder_has_the_sign_of_the_divisor_and_a_number_that_of_its_distance_from_zero(
    native_builder, tmp_path, expression, value
):
    assert str(computed_by_operators(tmp_path, expression)) == str(value)
