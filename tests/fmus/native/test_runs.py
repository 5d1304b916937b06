"""Runs of native FMUs, of either FMI, are those of the FMUs that run Python."""

import math
import random

import fmpy
import numpy as np
import pytest

from driveline.fmus.catalogue import FMUS
from driveline.fmus.description.variables import interface
from driveline.models.block.runner import runner
from driveline.models.block.types import ContinuousBlock
from tests.fmus.host import opened
from tests.slow import slow

TOLERANCE = 1e-9
"""Relative; flanks are crossed, where a difference of rounding may grow."""

STEP, STEPS = 0.001, 10_000
COMPARED = 10
"""Steps between two comparisons."""


def inputs(name, k, draw):
    """What the block sees from step k on."""
    swing = math.sin(1e-3 * k)
    if name == "WheelSpeedCan":
        return {"omega_wheel_L": 20.0 * swing, "omega_wheel_R": 20.0 * swing + 1.0}
    if name == "MotorTorqueLoop":
        return {"T_ref": draw.uniform(-200.0, 200.0), "omega_1": 300.0 * swing}
    if name == "DampingController":
        speed = 300.0 + 50.0 * swing
        return {
            "T_driver": draw.uniform(-50.0, 100.0),
            "omega_1_meas": speed + draw.gauss(0.0, 1.0),
            "T_mot_est": draw.uniform(-50.0, 100.0),
            "omega_2_can": speed,
            "valid": k % 3000 < 2000,
            "counter": k // 20,
            "enable": k < 8000,
        }
    return {"T_mot": draw.uniform(-60.0, 80.0), "T_brake": draw.choice((0.0, 0.0, 800.0)), "slope": 0.05 * swing}


@pytest.mark.parametrize("name", slow(FMUS, but=FMUS.keys() - {"ValidationVehicle"}))
def test_ten_seconds_are_equal(native, tmp_path, name):
    block, draw = FMUS[name].block, random.Random(name)
    start = {"v_0": 8.0, "T_0": 20.0} if "v_0" in block.Parameters._fields else {}
    u = block.Input()
    reference = runner(block, u, block.Parameters()._replace(**start))
    with opened(native / f"{name}.fmu", tmp_path) as host:
        host.initialize(**start)
        for k in range(STEPS):
            if k % 20 == 0:
                new = inputs(name, k, draw)
                host.set(**new)
                u = u._replace(**new)
            host.step(k * STEP, STEP)
            reference.advance(u, STEP)
            if k % COMPARED == 0:
                computed, expected = host.outputs(), reference.output(u)._asdict()
                assert computed == pytest.approx({n: y + 0 for n, y in expected.items()}, rel=TOLERANCE, abs=TOLERANCE)


CASES = [
    *(("CoSimulation", name) for name in FMUS),
    *(("ModelExchange", name) for name, fmu in FMUS.items() if isinstance(fmu.block, ContinuousBlock)),
]


@pytest.mark.parametrize(("kind", "name"), slow(CASES, but=CASES[:1] + CASES[-1:]))
def test_fmpy_gets_the_results_of_fmi_2(native, fmi3, kind, name):
    """Over two seconds with moving inputs, to the last bit; in model exchange by CVode."""
    paths = native / f"{name}.fmu", fmi3 / f"{name}.fmu"
    ours = interface(FMUS[name].block)
    time = np.arange(0.0, 2.0005, 1e-3)
    columns = {"time": time}
    for k, v in enumerate(ours):
        if v.causality == "input":
            wave = {"slope": 0.1}.get(v.name, 10.0) * np.sin(3.0 * time + k) + (v.name == "T_brake") * 10.0
            columns[v.name] = {"Real": wave, "Integer": np.arange(len(time)) % 7, "Boolean": time > 1.0}[v.fmi_type]
    inputs = np.rec.fromarrays([*columns.values()], names=[*columns])  # pyright: ignore[reportArgumentType]
    results = [
        fmpy.simulate_fmu(
            str(path),
            fmi_type=kind,
            stop_time=2.0,
            step_size=1e-3,
            output_interval=1e-3,
            input=inputs,
            record_events=False,
            output=[v.name for v in ours if v.causality == "output"],
        )
        for path in paths
    ]
    assert len(results[0]) == len(time)
    assert (results[0] == results[1]).all()
