"""The controller on the emulated target, off-line: bit by bit that of this machine, and within its means."""

import json
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

from driveline.fmus.catalogue import CONTROLLERS
from driveline.harness.exchange.target.comparison import Comparison, InLoop, compare, responses
from driveline.harness.exchange.target.controllers import Programs, programs
from driveline.harness.exchange.target.costs import Schedule, Size, size_of
from driveline.harness.exchange.target.offline_cases import SAMPLES, Case, random_inputs, random_states, recorded
from driveline.harness.exchange.target.record import NUMBERS, Record, numbers, signals, write
from driveline.harness.loop.resolved import as_given
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.models.damping_controller import BLOCK

INPUTS, OUTPUTS = BLOCK.Input._fields, BLOCK.Output._fields
PLANT = "TwoMassDriveline"
KEPT = Schedule(samples=5000, missed=0, period=50000, latency=2000, response=8000, watchdog=60000)
FEW = 600
"""Samples of a random case."""


@pytest.fixture(scope="module")
def launch_brake(both_built: Path) -> Case:
    loop = as_given(PLANT, folder=both_built, build="native")
    return recorded(MANOEUVRES["launch_brake"], loop, INPUTS)


@pytest.fixture(scope="module")
def braked(target: Programs, launch_brake: Case) -> Comparison:
    return compare(target, launch_brake, OUTPUTS)


@pytest.fixture(scope="module")
def size(target: Programs) -> Size:
    return size_of(target)


def test_in_a_manoeuvre_no_bit_differs_and_the_torque_is_that_of_the_model(braked: Comparison, size: Size) -> None:
    assert Record([braked], [], KEPT, size).passed
    assert braked.differing == 0
    assert 0.0 < braked.margin <= 1.0
    assert braked.largest > 100.0
    table = signals(braked)
    assert table.dtype.names == ("time", *INPUTS, "target.T_ref", "model.T_ref")
    assert table["time"][-1] == pytest.approx(10.0)
    np.testing.assert_array_equal(table["model.T_ref"], braked.traces[1])


def test_absurd_inputs_and_states_from_anywhere_change_no_bit_either(target, launch_brake, braked) -> None:
    random, absurd = random_inputs([launch_brake], seed=1, samples=FEW)
    assert np.isnan(absurd.inputs).any()
    assert np.isinf(absurd.inputs).any()
    anywhere = random_states(random, braked.states, seed=1)
    for case in (random, absurd, anywhere):
        found = compare(target, case, OUTPUTS)
        assert found.differing == 0, case.name
        assert found.finite, case.name
        assert found.largest <= BLOCK.Parameters().T_max


def test_the_same_seed_draws_the_same_case_and_instructions_are_the_same_every_time(
    launch_brake: Case, target: Programs
) -> None:
    one, same, other = (list(random_inputs([launch_brake], seed))[1].inputs for seed in (1, 1, 2))
    assert len(one) == SAMPLES
    assert one.tobytes() == same.tobytes() != other.tobytes()
    short = launch_brake._replace(inputs=launch_brake.inputs[:300])
    counts = [[answer.count for answer in responses(target.target(), short)] for _ in range(2)]
    assert counts[0] == counts[1]
    assert 500 < min(counts[0][1:]) <= max(counts[0]) < 1010


def test_a_bit_that_differs_is_seen(target: Programs, launch_brake: Case, size: Size) -> None:
    """The target with another parameter, by its last bit."""

    def other() -> object:
        link = target.target()
        p = list(BLOCK.Parameters())
        p[BLOCK.Parameters._fields.index("k_d")] *= 1.0 + 1.2e-7
        link.set_parameters(p)
        return link

    found = compare(target._replace(target=other), launch_brake, OUTPUTS)  # type: ignore[arg-type]
    assert found.differing > 100
    assert not Record([found], [], KEPT, size).passed


def test_parameters_that_are_set_in_the_running_target_act(target: Programs, launch_brake: Case) -> None:
    p = BLOCK.Parameters()._replace(T_max=50.0)
    with target.target() as link:
        link.set_parameters(p)
        rows = launch_brake.inputs[:600].tolist()
        link.start(rows[0])
        T_ref = [link.update(row).outputs[0] for row in rows]
    assert max(T_ref) == 50.0
    assert max(answer.outputs[0] for answer in responses(target.target(), launch_brake)) > 100.0


def test_flash_ram_and_stack_are_those_of_the_records_and_a_caller(size: Size, braked: Comparison) -> None:
    assert size.calibration == 4 * len(BLOCK.Parameters._fields)
    assert size.ram < 512
    assert size.stack <= 256
    assert 4000 < size.flash < 6500 < size.image < 8192
    assert size.library == ("memcpy", "memset")
    assert size.stack <= braked.stack <= size.stack + 32


def test_no_arithmetic_is_in_double_precision(target: Programs) -> None:
    command = ["arm-none-eabi-objdump", "-d", str(target.image)]
    listing = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "vmul.f32" in listing
    assert not re.search(r"\.f64|__aeabi_[df]", listing)


def test_the_numbers_are_those_that_were_found(braked: Comparison, size: Size, tmp_path: Path) -> None:
    loops = [InLoop("launch_brake", 0, T_ref=0.01, T_gear=0.02, rms=0.001)]
    drawn = braked._replace(case=braked.case._replace(name="random states", drawn=True), instructions=(600.0, 950))
    found = Record([braked, drawn], loops, KEPT, size)
    given = numbers(found)
    assert given["loops"] == {"launch_brake": {"differing": 0, "T_ref": 0.01, "T_gear": 0.02, "rms": 0.001}}
    assert given["cases"]["launch_brake"]["samples"] == len(braked.case.inputs)
    assert given["cases"]["random states"]["instructions"] == (600.0, 950)
    assert (given["costs"]["driven"], given["costs"]["drawn"]) == (braked.instructions[1], 950)
    assert given["costs"]["flash"] == size.flash
    files = write(found, tmp_path)
    assert [path.name for path in files] == [NUMBERS, "launch_brake.csv", "random_states.csv"]
    assert json.loads(files[0].read_text()) == json.loads(json.dumps(given))


@pytest.mark.usefixtures("target")
def test_another_controller_runs_as_well(launch_brake: Case) -> None:
    with programs(CONTROLLERS["SpeedWashout"].started_with({"k_d": 1.0})) as washout:
        found = compare(washout, launch_brake, OUTPUTS)
    assert found.differing == 0
    assert found.finite
    assert found.instructions[1] < 1000
