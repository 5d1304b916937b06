"""The integrator in C: what is said of the one in Python, of the same blocks, and the same numbers.

It is compiled with functions of a block that call back into Python.
"""

import ctypes
import math
import subprocess
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmutesting.together import together
from hypothesis import example, given, settings
from hypothesis import strategies as st

from driveline.models import two_mass_driveline as driveline
from fmublocks.block.explicit import TOLERANCE, small_sizes
from fmublocks.block.implicit import NotIntegrable
from fmublocks.block.integrator import Integrator, TooMuchWork
from fmublocks.block.types import ContinuousBlock
from fmublocks.native.compiler import FLAGS, host_compiler
from fmublocks.native.packaging import C_FILES
from fmublocks.native.shared_header import shared_header
from fmublocks.native.tableau import rosenbrock_header, step_header
from tests.models.block.test_integrator import *  # noqa: F403
from tests.models.block.test_integrator import LITTLE_WORK, LIVELY, Body, MakeIntegrator, Nothing, P, block

BLOCK = """
typedef double real;
typedef struct {{ real x[{states}]; }} State;
typedef struct {{ real u; }} Input, Parameters;
#define INDICATORS {indicators}
#define ALLOWED_ERROR 0.01
#define SMALL_SIZES {{ {sizes} }}
extern double LONGEST_STEP;
extern void (*derivative)(const State *x, const Input *u, const Parameters *p, State *dx);
extern void (*event_indicators)(const State *x, const Input *u, const Parameters *p, real z[]);
"""

RUN = """
#include "explicit.c"
#include "implicit.c"
#include "integrator.c"
double LONGEST_STEP;
void (*derivative)(const State *x, const Input *u, const Parameters *p, State *dx);
void (*event_indicators)(const State *x, const Input *u, const Parameters *p, real z[]);
int run(double duration, State *x, const Input *u, const Input *du);
int run(double duration, State *x, const Input *u, const Input *du)
{
    const Problem problem = {u, du, 0, 0, 0};
    return integrate(&problem, duration, x, x);
}
"""

BOUNDS = "-fsanitize=bounds", "-fsanitize-undefined-trap-on-error"
"""Ends the process at an index out of its array."""

Numbers = ctypes.POINTER(ctypes.c_double)
Function = ctypes.CFUNCTYPE(None, Numbers, Numbers, ctypes.c_void_p, Numbers)


def compiled(folder: Path, states: int, indicators: int, sizes: tuple[float, ...]) -> ctypes.CDLL:
    """integrator.c for blocks of that size."""
    folder.joinpath("block.h").write_text(
        BLOCK.format(states=states, indicators=indicators, sizes=", ".join(map(repr, sizes)))
    )
    folder.joinpath("run.c").write_text(RUN)
    folder.joinpath("dop853.h").write_text(step_header())
    folder.joinpath("rodas.h").write_text(rosenbrock_header())
    folder.joinpath("shared.h").write_text(shared_header())
    command = [
        host_compiler(),
        *FLAGS,
        *BOUNDS,
        "-fvisibility=default",
        "-shared",
        "-fPIC",
        "-I.",
        f"-I{C_FILES}",
        "run.c",
    ]
    subprocess.run([*command, "-o", "integrator.so", "-lm"], cwd=folder, check=True)
    return ctypes.CDLL(str(folder / "integrator.so"))


class CompiledIntegrator:
    """`advance` of the integrator, as C does it. Inputs given as a number move, at the rate that is given."""

    def __init__(self, library: Callable[[int, int, tuple[float, ...]], ctypes.CDLL], block: ContinuousBlock) -> None:
        self._library, self._block = library, block

    def advance(self, x: Any, u: Any, p: Any, duration: float, slope: float | None = None) -> Any:
        make, size = self._block.State._make, len(x)

        def called(function: Callable[..., Any]) -> Any:
            def call(x: Any, moved: Any, _p: Any, result: Any) -> None:
                for k, value in enumerate(function(make(x[:size]), u if slope is None else moved[0], p)):
                    result[k] = value

            return Function(call)

        library = self._library(size, len(self._block.event_indicators(x, u, p)), small_sizes(self._block))
        functions = {name: called(getattr(self._block, name)) for name in ("derivative", "event_indicators")}
        for name, function in functions.items():
            ctypes.c_void_p.in_dll(library, name).value = ctypes.cast(function, ctypes.c_void_p).value
        ctypes.c_double.in_dll(library, "LONGEST_STEP").value = self._block.step_size
        values = (ctypes.c_double * size)(*x)
        moving = (None, None) if slope is None else map(ctypes.byref, map(ctypes.c_double, (u, slope)))
        failed = library.run(ctypes.c_double(duration), values, *moving)
        if failed:
            raise (NotIntegrable if failed > 0 else TooMuchWork)(self._block.State._fields[abs(failed) - 1])
        return make(values)


@pytest.fixture(scope="module")
def integrator(tmp_path_factory: pytest.TempPathFactory) -> MakeIntegrator:
    """What those tests call the integrator of a block."""
    library = cache(lambda *sizes: compiled(tmp_path_factory.mktemp("integrator"), *sizes))
    return lambda block: CompiledIntegrator(library, block)


@pytest.fixture
def hurried(monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> MakeIntegrator:
    """The same with little work allowed, which is compiled into it."""
    monkeypatch.setattr("fmublocks.block.integrator.MOST_WORK", LITTLE_WORK)
    library = cache(lambda *sizes: compiled(tmp_path_factory.mktemp("hurried"), *sizes))
    return lambda block: CompiledIntegrator(library, block)


@given(T_mot=st.floats(-200.0, 200.0), v=st.floats(-20.0, 20.0), duration=st.floats(1e-5, 0.05))
def test_it_is_that_of_python_bit_by_bit(integrator: MakeIntegrator, T_mot: float, v: float, duration: float) -> None:
    u, x = driveline.Input(T_mot=T_mot, T_brake=200.0), LIVELY._replace(v=v)
    p = P._replace(recorded_load=False)
    assert integrator(driveline.BLOCK).advance(x, u, p, duration) == Integrator(driveline.BLOCK).advance(
        x, u, p, duration
    )


Looked = Callable[[MakeIntegrator], tuple[set[Body], set[Body]]]


def looks(derivative: Callable[[Any], Body], start: Body, *indicators: Callable[[Any], float]) -> Looked:
    """Where an integrator looks at the derivative, and where at the first indicator."""

    def looked_at(make: MakeIntegrator) -> tuple[set[Body], set[Body]]:
        rates: set[Body] = set()
        zeros: set[Body] = set()

        def rate(x: Body, _u: Any, _p: Any) -> Body:
            rates.add(x)
            return derivative(x)

        def first(x: Body) -> float:
            zeros.add(x)
            return indicators[0](x)

        make(block(rate, first, *indicators[1:])).advance(start, Nothing(), Nothing(), 0.1)
        return rates, zeros

    return looked_at


@given(at=st.floats(0.001, 0.099), slope=st.floats(0.0, 100.0), power=st.sampled_from([0, 1, 3, 9]))
def test_it_looks_for_a_crossing_where_python_does(
    integrator: MakeIntegrator, at: float, slope: float, power: int
) -> None:
    looked_at = looks(
        lambda x: Body(1.0 + slope * x.x, 0.0, 0.0),
        Body(0.0, 0.0, 0.0),
        lambda x: math.copysign(abs(x.x - at) ** power, x.x - at),
    )
    assert looked_at(integrator) == looked_at(Integrator)


def end_of(make: MakeIntegrator, moved: ContinuousBlock) -> Body | str:
    """The state after a while, or that which changes too fast."""
    try:
        return make(moved).advance(Body(0.0, 0.0, 0.0), Nothing(), Nothing(), 0.1)
    except NotIntegrable as refusal:
        return str(refusal)


Rates = Callable[[Body, float], Body]
Zero = Callable[[Body, float], float]


def traced(derivative: Rates, zero: Zero) -> tuple[ContinuousBlock, list[Body], list[float]]:
    """A block with one number as its input, where its derivative is asked for, and what its indicator answered."""
    requested: list[Body] = []
    zeros: list[float] = []

    def watch(x: Body, u: float, _p: Any) -> Body:
        requested.append(x)
        return derivative(x, u)

    def indicators(x: Body, u: float, _p: Any) -> tuple[float]:
        zeros.append(zero(x, u))
        return (zeros[-1],)

    return replace(block(watch), event_indicators=indicators), requested, zeros


@together("power", [6, 12, 60, 150, 290])
def test_a_block_that_leaves_all_numbers_is_left_to_the_implicit_method_as_in_python(
    integrator: MakeIntegrator, power: int
) -> None:
    wild = block(lambda x, u, p: Body(-(10.0**power) * (x.x - 1.0), 1.0, 0.0), lambda x: 1.0)
    assert end_of(integrator, wild) == end_of(Integrator, wild)


@settings(max_examples=60)
@given(stiffness=st.floats(0.0, 6.0), coupling=st.floats(-1.0, 1.0), x=st.floats(-1.0, 1.0), v=st.floats(-10.0, 10.0))
def test_a_block_of_any_stiffness_is_integrated_as_in_python(
    integrator: MakeIntegrator, stiffness: float, coupling: float, x: float, v: float
) -> None:
    """Which method is taken depends on it."""
    rate = 10.0**stiffness
    stiff = block(lambda s, u, p: Body(s.v, -rate * (s.v + coupling * s.x), math.tanh(rate * s.x)), lambda s: 1.0)
    ends = (make(stiff).advance(Body(x, v, 0.0), Nothing(), Nothing(), 0.1) for make in (integrator, Integrator))
    assert next(ends) == next(ends)


def ends_with_moving_input(
    integrator: MakeIntegrator, derivative: Rates, start: Body, slope: float, zero: Zero = lambda x, u: 1.0
) -> tuple[list[float], list[float]]:
    """Are the same in C, whose input moves from start.beyond at that rate, and in Python, where it is the third state.

    A step may be off by TOLERANCE of the size of a state, so a fast body may be off by more.

    Returns:
        What the indicator answered, in both.
    """
    with_input, requested, zeros = traced(derivative, zero)
    as_state, asked_in_python, zeros_in_python = traced(
        lambda x, _u: derivative(x, x.beyond)._replace(beyond=slope), lambda x, _u: zero(x, x.beyond)
    )
    end = integrator(with_input).advance(start._replace(beyond=0.0), start.beyond, Nothing(), 0.1, slope)
    expected = Integrator(as_state).advance(start, 0.0, Nothing(), 0.1)
    assert end[:2] == pytest.approx(expected[:2], rel=TOLERANCE, abs=20.0 * TOLERANCE)
    assert len(requested) <= 1.5 * len(asked_in_python) + 20
    return zeros, zeros_in_python


@settings(max_examples=60)
@given(stiffness=st.floats(0.0, 5.0), u=st.floats(-1.0, 1.0), slope=st.floats(-100.0, 100.0), lag=st.floats(0.0, 3.0))
def test_an_input_that_moves_is_followed_like_a_state(
    integrator: MakeIntegrator, stiffness: float, u: float, slope: float, lag: float
) -> None:
    """With as few looks at the derivative, stiff or not: a drift that is wrong would cost many more."""

    def follows(x: Body, u: float) -> Body:
        return Body(10.0**stiffness * (math.sin(u) - x.x), 10.0**lag * (u * u - x.v), 0.0)

    ends_with_moving_input(integrator, follows, Body(math.sin(u), u * u, u), slope)


@example(at=0.08203125, slope=5.0, v=0.09375)
@example(at=0.02673431332317037, slope=77.921875, v=0.10546875)
@given(at=st.floats(0.001, 0.099), slope=st.floats(-100.0, 100.0), v=st.floats(-10.0, 10.0))
def test_a_zero_that_moves_with_an_input_is_located(
    integrator: MakeIntegrator, at: float, slope: float, v: float
) -> None:
    start = Body(at * (slope - v), v, 0.0)
    ends_with_moving_input(
        integrator, lambda x, u: Body(x.v, -1e4 * max(x.x - u, 0.0), 0.0), start, slope, lambda x, u: x.x - u
    )


@given(
    turn=st.floats(0.001, 0.099),
    depth=st.floats(1e-6, 1e-2),
    side=st.sampled_from([-1.0, 1.0]),
    slope=st.floats(-100.0, 100.0),
)
def test_an_excursion_beyond_a_zero_that_moves_is_found(
    integrator: MakeIntegrator, turn: float, depth: float, side: float, slope: float
) -> None:
    """A body thrown up to `depth` beyond what moves, where it turns at the time `turn`."""
    g = 50.0
    start = Body(side * (depth - 0.5 * g * turn**2), side * g * turn + slope, 0.0)

    def thrown(x: Body, u: float) -> Body:
        return Body(x.v, -side * g, 0.0)

    zeros = ends_with_moving_input(integrator, thrown, start, slope, lambda x, u: x.x - u)
    distances = np.abs(np.subtract.outer(*zeros))
    assert max(distances.min(axis=0).max(), distances.min(axis=1).max()) < 1e-6, "they look at other places"
