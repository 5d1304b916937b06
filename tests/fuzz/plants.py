"""Parameters and inputs of the plants, anywhere within their bounds, with the integrator as it is in native FMUs.

The plants are compiled with three states more: the work done on the mechanical energy (see energy.py), what the gear
took, and the work turned over, all in units so large that they do not take part in the choice of steps.
"""

import ctypes
import math
import subprocess
from collections import namedtuple
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any

from driveline.models import two_mass_driveline, validation_vehicle
from fmublocks.block.declaration import Quantity, Real, variables
from fmublocks.block.types import ContinuousBlock
from fmublocks.fmu import Fmu
from fmublocks.native.compiler import host_compiler
from fmublocks.native.packaging import C_FILES
from fmublocks.native.shared_header import shared_header
from fmublocks.native.source import block_sources
from fmublocks.native.tableau import rosenbrock_header, step_header
from tests.fuzz.energy import ENERGIES
from tests.fuzz.target import Attempt, Unclean, target

PLANTS = (two_mass_driveline.BLOCK, validation_vehicle.BLOCK)

UNIT_OF_WORK = 1e9
"""In J."""

BALANCE = 1e-3
"""Of the work turned over and the energy there was: by how much energy less work may change. A step may be off by
1e-5 of every state, and hundreds make a sequence; and work is summed up at the steps of the states, which need not
resolve it where they damp what is stiff. Of 6000 sequences the worst is at 1.4e-5."""

LEAST_ENERGY = 1e-4
"""In J: what the absolute errors that are tolerated come to in a vehicle at rest."""

ROUNDING = 1e-9
"""Of the torques at the wheels, in the brake torque that is found from them."""

INPUTS, STEPS, STEP_SIZES = 8, 4, (1e-3, 5e-3, 1e-4, 2e-2)
"""Of a sequence: values of the inputs, steps with each, and sizes of these in s."""

FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared", "-w")

RUN = """
#include "block.c"
#include "explicit.c"
#include "implicit.c"
#include "integrator.c"
#include <stddef.h>
#include <string.h>
static Parameters complete(const double declared[])
{
    Parameters p;
    memcpy(&p, declared, offsetof(Parameters, terms));
    compute_terms(&p);
    return p;
}
void start_at(const Input *u, const double declared[], State *x)
{
    const Parameters p = complete(declared);
    start(u, &p, x);
}
void outputs(const State *x, const Input *u, const double declared[], Output *y)
{
    const Parameters p = complete(declared);
    output(x, u, &p, y);
}
int run(const Input *u, const double declared[], double duration, State *x)
{
    const Parameters p = complete(declared);
    const Problem problem = {u, 0, &p, 0, 0};
    return integrate(&problem, duration, x, x);
}
"""


def balanced(plant: ContinuousBlock) -> ContinuousBlock:
    """The plant with the work done on its energy, what its gear took and the work turned over as states."""
    State: Any = namedtuple("State", [*plant.State._fields, "work", "taken", "turnover"])
    State.__annotations__ = plant.State.__annotations__
    energy: Any = ENERGIES[plant.name]
    size = len(plant.State._fields)

    def derivative(x: Any, u: Any, p: Any) -> Any:
        own = plant.State(*x[:size])
        now: Any = energy(own, u, p)
        powers = [*now.powers, -now.taken]
        counted = sum(powers), now.taken, sum(abs(power) for power in powers)
        return State(*plant.derivative(own, u, p), *(power / UNIT_OF_WORK for power in counted))

    return replace(
        plant,
        State=State,
        start=lambda u, p: State(*plant.start(u, p), 0.0, 0.0, 0.0),
        derivative=derivative,
        output=lambda x, u, p: plant.output(plant.State(*x[:size]), u, p),
        event_indicators=lambda x, u, p: plant.event_indicators(plant.State(*x[:size]), u, p),
    )


class Compiled:
    """A plant with its energy, compiled."""

    def __init__(self, plant: ContinuousBlock, folder: Path) -> None:
        folder.mkdir()
        block = balanced(plant)
        sources = block_sources(Fmu(block, stop_time=1.0)) | {"run.c": RUN, "shared.h": shared_header()}
        sources |= {"dop853.h": step_header(), "rodas.h": rosenbrock_header()}
        for name, text in sources.items():
            (folder / name).write_text(text, encoding="utf-8")
        command = [host_compiler(), *FLAGS, "-I.", f"-I{C_FILES}", "run.c", "-o", "plant.so", "-lm"]
        subprocess.run(command, cwd=folder, check=True)
        self.plant, self.State, self._library = plant, block.State, ctypes.CDLL(str(folder / "plant.so"))

    def start(self, u: Any, p: Any) -> Any:
        x = (ctypes.c_double * len(self.State._fields))()
        self._library.start_at(*map(_numbers, (u, p)), x)
        return self.State(*x)

    def outputs(self, x: Any, u: Any, p: Any) -> Any:
        y = (ctypes.c_double * len(self.plant.Output._fields))()
        self._library.outputs(*map(_numbers, (x, u, p)), y)
        return self.plant.Output(*y)

    def advance(self, x: Any, u: Any, p: Any, duration: float) -> Any:
        """The state `duration` s later; None if the step is refused."""
        state = _numbers(x)
        refused = self._library.run(_numbers(u), _numbers(p), ctypes.c_double(duration), state)
        return None if refused else self.State(*state)

    def energies(self, x: Any, u: Any, p: Any) -> tuple[float, float]:
        """Stored, and in the spring of the gear."""
        found: Any = ENERGIES[self.plant.name](self.plant.State(*x[: len(self.plant.State._fields)]), u, p)
        return found.stored, found.spring


def _numbers(record: Any) -> Any:
    return (ctypes.c_double * len(record))(*record)


def drawn(random: Random, quantity: Quantity) -> Any:
    """The start value, a bound, or anything between; small and large alike where the bounds are far apart."""
    declared = quantity.declaration
    if not isinstance(declared, Real):
        return random.random() < 0.1
    low, high, kind = declared.minimum, declared.maximum, random.random()
    if quantity.name == "v_0" and kind < 0.5:
        return random.uniform(0.0, 2.0)
    if kind < 0.5:
        return (float(quantity.start), float(quantity.start), float(quantity.start), low, high)[int(10.0 * kind)]
    if low > 0.0 and high > 30.0 * low:
        return math.exp(random.uniform(math.log(low), math.log(high)))
    return random.uniform(low, high)


def followed(compiled: Compiled, random: Random) -> str:
    """One sequence.

    Raises:
        Unclean: an output is not finite, energy appears or disappears, or the brakes have more than their capacity.
    """
    plant = compiled.plant
    p = plant.Parameters(*(drawn(random, q) for q in variables(plant.Parameters)))
    u = plant.Input(*(drawn(random, q) for q in variables(plant.Input)))
    x = compiled.start(u, p)
    first, strained = compiled.energies(x, u, p)
    most = first + strained
    for _ in range(INPUTS):
        u = plant.Input(*(drawn(random, q) for q in variables(plant.Input)))
        step_size = random.choice(STEP_SIZES)
        for _ in range(STEPS):
            x = compiled.advance(x, u, p, step_size)
            if x is None:
                return "refused by name"
            _judge(compiled.outputs(x, u, p), u, p, x)
            energy, spring = compiled.energies(x, u, p)
            most = max(most, energy + spring)
            lost = first + UNIT_OF_WORK * x.work - energy
            made = spring - strained - UNIT_OF_WORK * x.taken
            allowed = BALANCE * (most + UNIT_OF_WORK * x.turnover) + LEAST_ENERGY
            if not abs(lost) <= allowed:
                raise Unclean(f"{plant.name}: {lost:.3g} J of {most:.3g} J disappear, {p}, {u}, {x}")
            if not made <= allowed:
                raise Unclean(f"{plant.name}: the gear makes {made:.3g} J of {most:.3g} J, {p}, {u}, {x}")
    return "sequences followed, with finite outputs, energy kept, brakes within their capacity"


def _judge(y: Any, u: Any, p: Any, x: Any) -> None:
    if not all(map(math.isfinite, y)):
        raise Unclean(f"not finite: {y}, {p}, {u}")
    braking = -p.i * y.T_load - y.T_rim
    if not abs(braking) <= u.T_brake + ROUNDING * (abs(p.i * y.T_load) + abs(y.T_rim) + 1.0):
        raise Unclean(f"the brake has {braking} N.m of {u.T_brake}: {p}, {u}, {x}")


@target(
    "parameters and inputs of both plants, anywhere within their bounds",
    "outputs of a step that is made are finite, energy less work is kept to 0.1 % of what was turned over, no brake "
    "has more than its capacity",
    short=100,
    long=100_000,
)
def attempts(folder: Path) -> Iterator[Attempt]:
    compiled = [Compiled(plant, folder / plant.name) for plant in PLANTS]

    def attempt(random: Random) -> str:
        return followed(random.choice(compiled), random)

    yield attempt
