"""How time passes: a sampled block ticks at k T_s whatever the steps, and a run goes on where it was taken up.

tests/fmus/native/test_runner.py has the same said of the ticks in C.
"""

import math
from collections.abc import Callable
from typing import Annotated, NamedTuple

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from driveline.models import two_mass_driveline
from fmublocks.block.declaration import Real
from fmublocks.block.integrator import Integrator
from fmublocks.block.runner import TICK_TOLERANCE, Runner, runner
from fmublocks.block.types import Block, SampledBlock
from tests.models.block.test_operators import every_block


class Number(NamedTuple):
    n: Annotated[float, Real("1", "a number")] = 0.0


def counting(T_s: float) -> SampledBlock:
    """Adds its input once every tick."""
    return SampledBlock(
        name="Counter",
        description="Sum over the ticks",
        module=__name__,
        Parameters=Number,
        Input=Number,
        State=Number,
        Output=Number,
        start=lambda u, p: Number(p.n),
        output=lambda x, u, p: x,
        update=lambda x, u, p: Number(x.n + u.n),
        sample_time=T_s,
    )


START = Number(), Number(100.0)
"""Input and parameters of a counter that begins at 100."""

Counter = Callable[[float], Runner]


@pytest.fixture(scope="module")
def counter() -> Counter:
    """Makes the runner of a counter with a sample time."""
    return lambda T_s: runner(counting(T_s), *START)


def shown(running: Runner) -> float:
    return running.output(Number()).n


def ticks(running: Runner, T_s: float = 1.0) -> float:
    """That were made since the start, what the last one computed on its way or not."""
    running.advance(Number(), 2.0 * T_s)
    return shown(running) - 100.0


ONE = Number(1.0)


def test_a_run_starts_with_the_state_of_the_start(counter: Counter) -> None:
    running = counter(1.0)
    assert (running.x, shown(running)) == (Number(100.0), 100.0)


def test_the_first_tick_is_made_in_the_first_step_with_its_inputs(counter: Counter) -> None:
    running = counter(1.0)
    running.advance(ONE, 0.25)
    running.advance(Number(50.0), 0.5)
    assert (shown(running), ticks(running)) == (100.0, 1.0)


def test_a_tick_takes_the_inputs_of_the_step_that_begins_there_and_shows_one_sample_later(counter: Counter) -> None:
    running, seen = counter(1.0), []
    for k in range(8):
        running.advance(Number(10.0**k), 0.5)
        seen.append(shown(running) - 100.0)
    assert seen == [0.0, 1.0, 1.0, 101.0, 101.0, 10101.0, 10101.0, 1010101.0]


@pytest.mark.parametrize("T_s", [0.25, 1.0, 4.0])
def test_a_long_step_makes_all_ticks_in_it_with_the_inputs_held(counter: Counter, T_s: float) -> None:
    running = counter(T_s)
    running.advance(ONE, 1.5 * T_s)
    running.advance(Number(10.0), 5.0 * T_s)
    assert shown(running) == 100.0 + 1.0 + 1.0 + 4.0 * 10.0
    assert ticks(running, T_s) == 2.0 + 5.0 * 10.0


@pytest.mark.parametrize("samples", [1.0, 7.0, 300.0])
def test_a_tick_within_a_thousandth_of_a_sample_behind_the_end_of_a_step_is_at_it(
    counter: Counter, samples: float
) -> None:
    """What was computed a sample before shows, and the tick itself is left to the step that begins there."""
    at, before = counter(1.0), counter(1.0)
    at.advance(ONE, samples - 0.9e-3)
    before.advance(ONE, samples - 1.1e-3)
    assert (shown(at), shown(before)) == (100.0 + samples, 99.0 + samples)
    assert ticks(at) == ticks(before) == samples


@pytest.mark.parametrize("samples", [1.0, 7.0, 300.0])
def test_a_tick_within_a_thousandth_of_a_sample_before_the_end_of_a_step_is_at_it(
    counter: Counter, samples: float
) -> None:
    at, after = counter(1.0), counter(1.0)
    at.advance(ONE, samples + 0.9e-3)
    after.advance(ONE, samples + 1.1e-3)
    assert shown(at) == shown(after) == 100.0 + samples
    assert (ticks(at), ticks(after)) == (samples, samples + 1.0)


@given(steps=st.lists(st.floats(1e-3, 20.0), min_size=1, max_size=30), T_s=st.sampled_from([0.001, 0.002, 0.5, 3.0]))
def test_ticks_do_not_depend_on_the_steps(counter: Counter, steps: list[float], T_s: float) -> None:
    pieces, whole = counter(T_s), counter(T_s)
    samples = math.fsum(steps)
    assume(abs((samples - TICK_TOLERANCE) % 1.0 - 0.5) < 0.5 - 1e-9)  # else rounding decides
    for step in steps:
        pieces.advance(ONE, step * T_s)
    whole.advance(ONE, samples * T_s)
    assert ticks(pieces, T_s) == ticks(whole, T_s)


def test_a_continuous_block_is_integrated() -> None:
    block, p = two_mass_driveline.BLOCK, two_mass_driveline.Parameters(v_0=5.0)
    u = two_mass_driveline.Input(T_mot=80.0)
    running, integrator = runner(block, u, p), Integrator(block)
    x = block.start(u, p)
    assert running.x == x
    for _ in range(4):
        running.advance(u, 0.003)
        x = integrator.advance(x, u, p, 0.003)
        assert running.x == x
    assert running.output(u) == block.output(x, u, p)


@every_block
def test_a_run_goes_on_from_its_memory_bit_by_bit(block: Block) -> None:
    """In a runner of its own, whatever it did meanwhile."""
    u = block.Input()._replace(**{block.Input._fields[0]: 20.0, block.Input._fields[1]: 30.0})
    first, second = (runner(block, u, block.Parameters()) for _ in range(2))
    for step in (0.0013, 0.01, 0.0004):
        first.advance(u, step)
    second.advance(u, 0.05)
    memory = first.memory
    second.restore(memory)
    assert second.memory == memory
    for step in (0.0007, 0.02, 0.0033):
        first.advance(u, step)
        second.advance(u, step)
        assert (second.output(u), second.memory) == (first.output(u), first.memory)
    first.restore(memory)
    assert first.memory == memory != second.memory
