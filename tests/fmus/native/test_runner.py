"""The ticks in C: what is said of those in Python, of the same block."""

import ctypes
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from fmublocks.block.runner import SampledRunner
from fmublocks.block.types import SampledBlock
from fmublocks.fmu import Fmu
from fmublocks.native.compiler import FLAGS, host_compiler
from fmublocks.native.packaging import c_sources
from tests.models.block.test_runner import (  # noqa: F401
    START,
    Counter,
    Number,
    counting,
    test_a_long_step_makes_all_ticks_in_it_with_the_inputs_held,
    test_a_tick_takes_the_inputs_of_the_step_that_begins_there_and_shows_one_sample_later,
    test_a_tick_within_a_thousandth_of_a_sample_before_the_end_of_a_step_is_at_it,
    test_a_tick_within_a_thousandth_of_a_sample_behind_the_end_of_a_step_is_at_it,
    test_the_first_tick_is_made_in_the_first_step_with_its_inputs,
    test_ticks_do_not_depend_on_the_steps,
)

TICK = """
#include "all.c"
void tick(double u, double duration, double numbers[3]);
void tick(double u, double duration, double numbers[3])
{
    Memory memory = {.values.u.n = u, .x.n = numbers[0], .coming.n = numbers[1], .to_tick = numbers[2]};
    Next next;
    stay(&memory, &next);
    advance(&memory, duration, &next);
    arrive(&memory, &next, 0.0);
    numbers[0] = memory.x.n;
    numbers[1] = memory.coming.n;
    numbers[2] = memory.to_tick;
}
"""


def compiled(folder: Path, block: SampledBlock) -> ctypes.CDLL:
    """All C of the block's FMU, and a function that advances the memory of an instance."""
    for name, text in (c_sources(Fmu(block, stop_time=1.0)) | {"tick.c": TICK.encode()}).items():
        folder.joinpath(name).write_bytes(text)
    command = [host_compiler(), *FLAGS, "-fvisibility=default", "-shared", "-fPIC", "tick.c", "-o", "counter.so", "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    return ctypes.CDLL(str(folder / "counter.so"))


class CompiledRunner(SampledRunner):
    """A counter that is advanced by C."""

    def __init__(self, library: ctypes.CDLL, block: SampledBlock) -> None:
        super().__init__(block, *START)
        library.tick.argtypes = [*[ctypes.c_double] * 2, ctypes.POINTER(ctypes.c_double)]
        self._library = library

    def advance(self, u: Any, duration: float) -> None:
        x, coming, to_tick = self.memory
        numbers = (ctypes.c_double * 3)(x.n, coming.n, to_tick)
        self._library.tick(u.n, duration, numbers)
        x, coming, to_tick = numbers
        self.restore((Number(x), Number(coming), to_tick))


@pytest.fixture(scope="module")
def counter(tmp_path_factory: pytest.TempPathFactory) -> Counter:
    """What those tests call the runner of a counter with a sample time."""
    library = cache(lambda T_s: compiled(tmp_path_factory.mktemp("counter"), counting(T_s)))
    return lambda T_s: CompiledRunner(library(T_s), counting(T_s))
